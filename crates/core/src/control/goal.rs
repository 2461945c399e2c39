//! Goals of a tracked path: tolerances and outcomes.

use super::error::ControlError;
use super::gains::{PerJoint, check_numbers};
use serde::{Deserialize, Serialize};

/// Tolerances of a tracked path, as in the joint trajectory controller of ROS.
///
/// The error has one component per joint of the group, rad or m (rad/s or m/s if rates are commanded). The
/// error of a tracked frame has two components: the distance, m, and the angle, rad. That of a grip-force law
/// has one: the error of the grip force, N.
///
/// The goal fails if an error exceeds `path` before the end of the path. After the end of the path, the goal
/// is reached as soon as all errors are within `tolerance`. It fails if this has not happened `time` seconds
/// after the end. After a failure the control holds the present joint positions, or the present pose:
/// relative to the base if the reference is, otherwise in W. If rates are commanded, the desired rates are
/// then zero.
///
/// A grip-force law has no path: its goal is evaluated from the start of the control, and cannot be reached
/// before the desired force has risen to its final value. After a failure, the law continues unchanged.
#[derive(Clone, Debug)]
pub struct Goal {
    /// Largest permitted errors during the path, in units of the error; `None` for no limit.
    pub path: Option<PerJoint>,
    /// Largest permitted errors at the end, in units of the error.
    pub tolerance: PerJoint,
    /// Time allowed after the end of the path, s; `None` for no limit.
    pub time: Option<f64>,
}

/// Outcome of a goal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Outcome {
    /// No decision yet, or none at all because the control has no goal, was never active, was stopped first,
    /// or the run ended first.
    #[default]
    Unfinished,
    /// All errors were within the goal's tolerance at `time`, s.
    Succeeded {
        /// Simulation time of the decision, s.
        time: f64,
    },
    /// An error exceeded the tolerance of the path.
    PathToleranceViolated(Miss),
    /// The goal was not reached within the time allowed.
    GoalToleranceViolated(Miss),
}

/// Error that exceeded its tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Miss {
    /// Index of the joint in the group. For a tracked frame, 0 is the position and 1 the attitude; for a
    /// grip-force law, 0 is the grip force.
    pub component: usize,
    /// Simulation time at which the error was evaluated, s.
    pub time: f64,
    /// Error of the component, desired less actual, rad or m (rad/s or m/s if rates are commanded). For a
    /// tracked frame, it is the distance, m, or the angle, rad; for a grip-force law, the error of the force,
    /// N.
    pub error: f64,
}

impl Outcome {
    /// Returns the name of the outcome in results and summaries.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Unfinished => "unfinished",
            Self::Succeeded { .. } => "succeeded",
            Self::PathToleranceViolated(_) => "path_tolerance_violated",
            Self::GoalToleranceViolated(_) => "goal_tolerance_violated",
        }
    }

    /// Returns the error that exceeded its tolerance, if the goal failed.
    pub fn miss(&self) -> Option<Miss> {
        match self {
            Self::PathToleranceViolated(miss) | Self::GoalToleranceViolated(miss) => Some(*miss),
            _ => None,
        }
    }

    /// Returns true if the outcome is final.
    pub fn is_decided(&self) -> bool {
        *self != Self::Unfinished
    }

    /// Returns the simulation time of the decision, s; `None` without a decision.
    pub fn time(&self) -> Option<f64> {
        match self {
            Self::Unfinished => None,
            Self::Succeeded { time } => Some(*time),
            Self::PathToleranceViolated(miss) | Self::GoalToleranceViolated(miss) => Some(miss.time),
        }
    }
}

impl Goal {
    /// Creates a goal with one tolerance for all components at the end, in units of the error, without a
    /// tolerance during the path and without a time limit.
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

    /// Returns the outcome for `errors` at the simulation time `time`, s, which is `clock` seconds after the
    /// start of a path that lasts `duration`, s.
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
