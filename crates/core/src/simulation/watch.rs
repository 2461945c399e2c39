//! Jumps of the joints' accelerations between the end of one step and the start of the next: what a step did not resolve.

use super::integrator::Stages;
use crate::spatial::Scalar;
use serde::{Deserialize, Serialize};

/// Jumps below this share of a joint's rate are left to the probes.
const SMALL: f64 = 1e-6;

/// Running sums over all steps, of each joint. Probes see one step in many; this sees every step.
///
/// The last stage of a Runge-Kutta step stands where the step was to end, the first one of the next step where it did
/// end. `h |Δq̈|/6` is the difference to a solution of third order, `z⁴/72` of an oscillation with `z = ω h`,
/// whose error of a step is `z⁵/120 = 1.75 (z⁴/72)^(5/4)`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Watch {
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

impl Watch {
    pub(super) fn new(joints: usize) -> Self {
        let zeros = vec![0.0; joints];
        Self { ended: zeros.clone(), command: zeros.clone(), h: 0.0, jumps: zeros.clone(), fastest: zeros }
    }

    /// Numbers of joints for which it holds something; all the same where it was not damaged.
    pub(super) fn joints(&self) -> [usize; 4] {
        [&self.ended, &self.command, &self.jumps, &self.fastest].map(Vec::len)
    }

    /// Adds a step of `h` that `stages` took; `is_smooth` says that no event and no impact is at its start.
    #[inline]
    pub(super) fn step<S: Scalar>(&mut self, stages: &Stages<S>, command: &[S], h: f64, is_smooth: bool) {
        let is_same = is_smooth && self.command.iter().zip(command).all(|(a, b)| *a == b.value());
        let sixth = if is_same { self.h / 6.0 } else { 0.0 };
        let n = self.ended.len();
        let (ended, jumps, fastest) = (&mut self.ended[..n], &mut self.jumps[..n], &mut self.fastest[..n]);
        let (first, last) = (&stages.first_acceleration()[6..][..n], &stages.rate.a[6..][..n]);
        let v = &stages.start.v[6..][..n];
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
