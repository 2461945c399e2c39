//! Integration steps of an orbit, stored in both directions from the initial state.

use super::collocation::NODES;
use super::step::{Start, Step};
use crate::orbit::{OrbitError, OrbitState};
use nalgebra::Vector3;
use std::sync::{PoisonError, RwLock};

/// Largest estimated position error within a step, relative to the distance from the planet's centre.
const TOLERANCE: f64 = 1e-14;
/// Length of the first step, in units of `√(r³/μ)` with the distance `r` from the planet's centre.
const FIRST: f64 = 0.1;
/// Length, in units of `√(r³/μ)`, up to which a step counts as too short, so that the integration fails.
const SHORTEST: f64 = 1e-9;
/// Ratio of the length of the next step to the estimated longest length that the tolerance permits.
const SAFETY: f64 = 0.9;
/// Smallest and largest factor by which the length is changed after an accepted or a rejected step.
const CHANGE: (f64, f64) = (0.25, 2.0);
/// Largest number of steps on either side of the initial state. They cover years of a low orbit and use 90 MB
/// of memory.
const MOST_STEPS: usize = 1 << 18;

/// Integration steps of an orbit after and before the initial state.
#[derive(Debug)]
pub(super) struct Arcs {
    mu: f64,
    minimum: f64,
    after: RwLock<Half>,
    before: RwLock<Half>,
    initial: Start,
}

/// Integration steps in one direction of time.
#[derive(Debug)]
struct Half {
    steps: Vec<Step>,
    /// Start of the next step, and its length, s, which is negative before the initial state.
    next: (Start, f64),
    /// Error that ended the integration in this direction; `None` while further steps are possible.
    ended: Option<OrbitError>,
}

impl Arcs {
    pub(super) fn new(t0: f64, r: Vector3<f64>, v: Vector3<f64>, mu: f64) -> Result<Self, OrbitError> {
        let minimum = crate::gravity::lowest_ground_cubed(mu).cbrt();
        let distance = r.norm();
        if distance < minimum {
            return Err(OrbitError::BeginsBelowSurface { distance, minimum });
        }
        let (initial, length) = (Start::new(t0, r, v), FIRST * (distance.powi(3) / mu).sqrt());
        let half = |length| RwLock::new(Half { steps: Vec::new(), next: (initial, length), ended: None });
        Ok(Self { mu, minimum, after: half(length), before: half(-length), initial })
    }

    /// Returns the state at `t`, s, after computing the missing steps. `field(t, r)` returns the
    /// acceleration, m/s², at time `t` and position `r`, m.
    pub(super) fn state(
        &self,
        t: f64,
        mut field: impl FnMut(f64, &Vector3<f64>) -> Result<Vector3<f64>, OrbitError>,
    ) -> Result<OrbitState, OrbitError> {
        let half = if t >= self.initial.time { &self.after } else { &self.before };
        if let Some(state) = half.read().unwrap_or_else(PoisonError::into_inner).state(t) {
            return Ok(state);
        }
        let mut half = half.write().unwrap_or_else(PoisonError::into_inner);
        loop {
            if let Some(state) = half.state(t) {
                return Ok(state);
            }
            if let Some(error) = &half.ended {
                return Err(error.clone());
            }
            if let Err(error) = self.extend(&mut half, &mut field) {
                half.ended = Some(error);
            }
        }
    }

    /// Computes at most `most_steps` steps in each direction towards `times`, s, in the given `field` (see
    /// [`Arcs::state`]). Returns true if no further step is needed or possible.
    pub(super) fn prepare(
        &self,
        times: &[f64],
        most_steps: usize,
        mut field: impl FnMut(f64, &Vector3<f64>) -> Result<Vector3<f64>, OrbitError>,
    ) -> bool {
        let (first, last) = times
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(first, last), &t| (first.min(t), last.max(t)));
        let begin = self.initial.time;
        let mut towards = |half: &RwLock<Half>, t: f64| {
            if half.read().unwrap_or_else(PoisonError::into_inner).needs_no_step(t) {
                return true;
            }
            let mut half = half.write().unwrap_or_else(PoisonError::into_inner);
            for _ in 0..most_steps {
                if half.needs_no_step(t) {
                    return true;
                }
                if let Err(error) = self.extend(&mut half, &mut field) {
                    half.ended = Some(error);
                }
            }
            half.needs_no_step(t)
        };
        (last < begin || towards(&self.after, last)) && (first >= begin || towards(&self.before, first))
    }

    /// Computes the next step of `half` and appends it to the steps of `half`.
    fn extend(
        &self,
        half: &mut Half,
        mut field: impl FnMut(f64, &Vector3<f64>) -> Result<Vector3<f64>, OrbitError>,
    ) -> Result<(), OrbitError> {
        let (start, mut length) = half.next;
        let distance = start.position[0].norm();
        let time = start.time;
        if half.steps.len() == MOST_STEPS {
            return Err(OrbitError::TooManySteps { time, epoch: self.initial.time, steps: MOST_STEPS });
        }
        let minimum = self.minimum;
        let shortest = SHORTEST * (distance.powi(3) / self.mu).sqrt();
        let mut outside = |t: f64, r: &Vector3<f64>| {
            let distance = r.norm();
            if distance >= minimum {
                field(t, r)
            } else {
                Err(OrbitError::BelowSurface { time: t, distance, minimum })
            }
        };
        loop {
            // use the length by which the rounded time actually advances
            length = (time + length) - time;
            if length.abs() <= shortest {
                return Err(OrbitError::StepTooShort { time, length, shortest });
            }
            let shorter = match start.step(length, half.steps.last(), &mut outside) {
                Ok(Some((step, error))) => {
                    let share = (TOLERANCE * distance / error).powf(1.0 / (NODES + 1) as f64);
                    let factor = (SAFETY * share).clamp(CHANGE.0, CHANGE.1);
                    if share >= 1.0 {
                        half.next = (step.end(), length * factor);
                        half.steps.push(step);
                        return Ok(());
                    }
                    factor
                }
                Ok(None) => 0.5,
                // positions predicted with too long a step may be outside the domain of the field
                Err(error) if 0.25 * length.abs() <= shortest => return Err(error),
                Err(_) => 0.25,
            };
            length *= shorter;
        }
    }
}

impl Half {
    /// Returns true if a step contains `t`, s, or if the steps cannot be extended to `t`.
    fn needs_no_step(&self, t: f64) -> bool {
        !t.is_finite() || self.ended.is_some() || self.state(t).is_some()
    }

    /// Returns the state at `t`, s; `None` if no step contains `t`.
    fn state(&self, t: f64) -> Option<OrbitState> {
        let ahead = |time: f64| if self.next.1 > 0.0 { time <= t } else { time >= t };
        if self.steps.is_empty() || (ahead(self.next.0.time) && t != self.next.0.time) {
            return None;
        }
        let count = self.steps.partition_point(|step| ahead(step.start.time));
        Some(self.steps[count.max(1) - 1].state(t))
    }
}

#[cfg(test)]
#[path = "arc_tests.rs"]
mod tests;
