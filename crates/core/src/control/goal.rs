//! When a control has done its work: tolerances on the way, at the end, and what came of it.

use super::error::ControlError;
use super::gains::{PerJoint, check_numbers};

/// Tolerances of a tracked path, after the joint trajectory controller of ROS.
///
/// The components are the joints of the group, rad or m; for a task the distance, m, and the angle, rad.
/// While the path lasts, an error beyond `path` ends the goal and the control holds where it is, in W (or
/// relative to the base, where its reference is). From the
/// end of the path on, the goal is reached once all errors are within `tolerance`, and missed where that
/// takes longer than `time`.
#[derive(Clone, Debug)]
pub struct Goal {
    /// Largest errors on the way; none asked for where `None`.
    pub path: Option<PerJoint>,
    /// Largest errors at the end.
    pub tolerance: PerJoint,
    /// Time allowed after the end of the path, s; any where `None`.
    pub time: Option<f64>,
}

/// What came of a goal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Outcome {
    /// Not decided: the control never ran, was stopped, or the run ended first.
    #[default]
    Unfinished,
    /// All errors were within the goal's tolerance at `time`, s.
    Succeeded {
        /// When, s of simulation.
        time: f64,
    },
    /// An error left the tolerance of the path.
    PathToleranceViolated(Miss),
    /// The goal was not reached in the time allowed.
    GoalToleranceViolated(Miss),
}

/// The error that was too large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Miss {
    /// Place of the joint in the group; for a task 0 is the position and 1 the attitude.
    pub component: usize,
    /// When, s of simulation.
    pub time: f64,
    /// The error, rad or m.
    pub error: f64,
}

impl Outcome {
    /// As results and summaries call it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Unfinished => "unfinished",
            Self::Succeeded { .. } => "succeeded",
            Self::PathToleranceViolated(_) => "path_tolerance_violated",
            Self::GoalToleranceViolated(_) => "goal_tolerance_violated",
        }
    }

    /// The error that was too large, if one was.
    pub fn miss(&self) -> Option<Miss> {
        match self {
            Self::PathToleranceViolated(miss) | Self::GoalToleranceViolated(miss) => Some(*miss),
            _ => None,
        }
    }

    /// Whether nothing more can change.
    pub fn is_decided(&self) -> bool {
        *self != Self::Unfinished
    }

    /// When it was decided, s of simulation.
    pub fn time(&self) -> Option<f64> {
        match self {
            Self::Unfinished => None,
            Self::Succeeded { time } => Some(*time),
            Self::PathToleranceViolated(miss) | Self::GoalToleranceViolated(miss) => Some(miss.time),
        }
    }
}

impl Goal {
    /// The same tolerance for all components at the end, none on the way, any time.
    pub fn within(tolerance: f64) -> Self {
        Self { path: None, tolerance: tolerance.into(), time: None }
    }

    pub(super) fn check(&self, components: usize) -> Result<(), ControlError> {
        if let Some(path) = &self.path {
            path.check_limit("path_tolerance", components)?;
        }
        self.tolerance.check_limit("tolerance", components)?;
        check_numbers("goal_time", self.time.as_slice())
    }

    /// What `errors` say at `time`, `clock` s after the start of a path of `duration` s.
    pub(super) fn judge(&self, time: f64, clock: f64, duration: f64, errors: &[f64]) -> Outcome {
        let miss = |tolerance: &PerJoint| {
            let component = errors.iter().enumerate().position(|(i, e)| e.abs() > tolerance.at(i))?;
            Some(Miss { component, time, error: errors[component] })
        };
        if clock < duration {
            let missed = self.path.as_ref().and_then(miss);
            return missed.map_or(Outcome::Unfinished, Outcome::PathToleranceViolated);
        }
        match miss(&self.tolerance) {
            None => Outcome::Succeeded { time },
            Some(miss) if self.time.is_some_and(|allowed| clock >= duration + allowed) => {
                Outcome::GoalToleranceViolated(miss)
            }
            Some(_) => Outcome::Unfinished,
        }
    }
}
