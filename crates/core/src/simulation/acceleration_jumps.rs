//! Jumps of the joints' accelerations between the end of one step and the start of the next, which the steps do not
//! resolve.

use super::integrator::StepEnds;
use crate::model::BASE_NV;
use crate::spatial::Scalar;
use serde::{Deserialize, Serialize};

/// Jumps below this fraction of a joint's largest rate are left to step doubling.
const SMALL: f64 = 1e-6;

/// Sums over all steps, for each joint; step doubling measures only some of the steps.
///
/// The last stage of a Runge-Kutta step is evaluated at a prediction of the end of the step, the first stage of the next
/// step at the end itself. `h |Δq̈|/6` is the difference to a solution of third order, `z⁴/72` of an oscillation with `z = ω h`,
/// whose error of a step is `z⁵/120 = 1.75 (z⁴/72)^(5/4)`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct AccelerationJumps {
    /// Accelerations in the last stage of the step before, and the torques held during it.
    ended: Vec<f64>,
    command: Vec<f64>,
    /// Length of that step, s; zero where the motion is not smooth in between.
    h: f64,
    /// `Σ (h |Δq̈|/6)^(5/4)`
    pub(super) jumps: Vec<f64>,
    /// Largest rates, rad/s (m/s).
    pub(super) fastest: Vec<f64>,
}

impl AccelerationJumps {
    pub(super) fn new(joints: usize) -> Self {
        let zeros = vec![0.0; joints];
        Self { ended: zeros.clone(), command: zeros.clone(), h: 0.0, jumps: zeros.clone(), fastest: zeros }
    }

    /// Lengths of the sums, one entry per joint each unless a checkpoint was damaged.
    pub(super) fn joints(&self) -> [usize; 4] {
        [&self.ended, &self.command, &self.jumps, &self.fastest].map(Vec::len)
    }

    /// Adds a step of length `h`; `is_smooth`: neither an event nor an impact is at its start.
    #[inline]
    pub(super) fn add_step<S: Scalar>(
        &mut self,
        step: &StepEnds<'_, S>,
        command: &[S],
        h: f64,
        is_smooth: bool,
    ) {
        let is_same = is_smooth && self.command.iter().zip(command).all(|(a, b)| *a == b.value());
        let sixth = if is_same { self.h / 6.0 } else { 0.0 };
        let n = self.ended.len();
        let (ended, jumps, fastest) = (&mut self.ended[..n], &mut self.jumps[..n], &mut self.fastest[..n]);
        let (first, last) = (&step.first.acceleration[BASE_NV..][..n], &step.last.a[BASE_NV..][..n]);
        let v = &step.start.v[BASE_NV..][..n];
        for j in 0..n {
            fastest[j] = fastest[j].max(v[j].value().abs());
            let jump = (first[j].value() - ended[j]).abs() * sixth;
            if jump > SMALL * fastest[j] {
                jumps[j] += jump * jump.sqrt().sqrt();
            }
            ended[j] = last[j].value();
        }
        if !is_same {
            self.command.iter_mut().zip(command).for_each(|(to, from)| *to = from.value());
        }
        self.h = h;
    }
}
