//! Steps kept, from the initial state outwards.

use super::collocation::NODES;
use super::step::{Start, Step};
use crate::orbit::{OrbitError, OrbitState};
use nalgebra::Vector3;
use std::sync::{PoisonError, RwLock};

/// Share of the distance by which the position within a step may be wrong.
const TOLERANCE: f64 = 1e-14;
/// First step, and least one, as shares of `√(r³/μ)`.
const FIRST: f64 = 0.1;
const SHORTEST: f64 = 1e-9;
/// Share of the longest step allowed that the next one takes, and how fast lengths may change.
const SAFETY: f64 = 0.9;
const CHANGE: (f64, f64) = (0.25, 2.0);
/// Steps on either side of the initial state: years of a low orbit, 150 MB.
const MOST_STEPS: usize = 1 << 18;

/// The two halves of an orbit: after and before the initial state.
#[derive(Debug)]
pub(super) struct Arcs {
    mu: f64,
    minimum: f64,
    after: RwLock<Half>,
    before: RwLock<Half>,
    initial: Start,
}

/// Steps in one direction.
#[derive(Debug)]
struct Half {
    steps: Vec<Step>,
    /// Where the next step begins, and how long it is to be, s.
    next: (Start, f64),
    /// Why there is no further step.
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

    /// The state at `t`, steps to it being made where they are missing.
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

    /// Takes at most `most_steps` steps in each direction towards `times`; whether none is missing.
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

    /// Adds the next step.
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
            // as the clock has it: the sum of lengths is the time
            length = (time + length) - time;
            if length.abs() <= shortest {
                return Err(OrbitError::StepTooShort { time, length });
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
                // a guess may lie where the orbit does not go
                Err(error) if 0.25 * length.abs() <= shortest => return Err(error),
                Err(_) => 0.25,
            };
            length *= shorter;
        }
    }
}

impl Half {
    /// Whether a step holds `t`, or none will.
    fn needs_no_step(&self, t: f64) -> bool {
        !t.is_finite() || self.ended.is_some() || self.state(t).is_some()
    }

    /// The state at `t` if a step holds it.
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
