//! Jumps of the joint accelerations from the last stage of one step to the first stage of the next. Large
//! jumps indicate motion that the steps do not resolve.

use super::integrator::StepEnds;
use crate::model::BASE_NV;
use crate::spatial::Scalar;
use serde::{Deserialize, Serialize};

/// Fraction of the largest rate of a joint below which a velocity change `h |Δq̈|/6` is ignored, with the
/// step length `h` and the jump `Δq̈` of the acceleration. Step doubling measures such small errors.
const SMALL: f64 = 1e-6;

/// Acceleration jumps of each joint, summed over the steps of a run. Step doubling, by contrast, measures
/// only some of the steps.
///
/// The last stage of a Runge-Kutta step is evaluated at a prediction of the state at the end of the step, and
/// the first stage of the next step at that state itself. With the step length `h` and the jump `Δq̈` between
/// the two, `h |Δq̈|/6` is the difference between the joint rate and an embedded third-order solution. For an
/// oscillation with the angular frequency `ω` and `z = ω h`, this difference is `z⁴/72` times the amplitude
/// of the rate, and the error of a step is `z⁵/120 = 1.75 (z⁴/72)^(5/4)` times that amplitude.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct AccelerationJumps {
    /// Joint accelerations in the last stage of the previous step, `(n,)`, rad/s² or m/s².
    ended: Vec<f64>,
    /// Joint torques held during the previous step, `(n,)`, N m or N.
    command: Vec<f64>,
    /// Length of the previous step, s.
    h: f64,
    /// Sum `Σ (h |Δq̈|/6)^(5/4)` of each joint, `(n,)`, with `h |Δq̈|/6` in rad/s or m/s. The sum omits small
    /// jumps, and all jumps at a change of the torques or at an event.
    pub(super) jumps: Vec<f64>,
    /// Largest magnitude of the rate of each joint, `(n,)`, rad/s or m/s.
    pub(super) fastest: Vec<f64>,
}

impl AccelerationJumps {
    pub(super) fn new(joints: usize) -> Self {
        let zeros = vec![0.0; joints];
        Self { ended: zeros.clone(), command: zeros.clone(), h: 0.0, jumps: zeros.clone(), fastest: zeros }
    }

    /// Returns the lengths of `ended`, `command`, `jumps` and `fastest`. Each equals the number of joints,
    /// unless a checkpoint is damaged.
    pub(super) fn joints(&self) -> [usize; 4] {
        [&self.ended, &self.command, &self.jumps, &self.fastest].map(Vec::len)
    }

    /// Adds a step of length `h`, s, during which the joint torques `command`, `(n,)`, N m or N, were held.
    /// `is_smooth` is true if only a change of the torques can make the accelerations discontinuous at the
    /// start of the step. The jumps at the start are added if `is_smooth` is true and the torques are those
    /// of the previous step.
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
        S::enter(
            #[inline(always)]
            || self.add_jumps(step, sixth),
        );
        if !is_same {
            self.command.iter_mut().zip(command).for_each(|(to, from)| *to = from.value());
        }
        self.h = h;
    }

    /// Adds the jumps at the start of `step`. `sixth` is a sixth of the length of the previous step, s, which
    /// converts jumps to velocities; zero omits all jumps. Most jumps are small; the first loop has no
    /// branches, so that it is vectorised.
    #[inline(always)]
    fn add_jumps<S: Scalar>(&mut self, step: &StepEnds<'_, S>, sixth: f64) {
        let n = self.ended.len();
        let (ended, jumps, fastest) = (&mut self.ended[..n], &mut self.jumps[..n], &mut self.fastest[..n]);
        let (first, last) = (&step.first.acceleration[BASE_NV..][..n], &step.last.a[BASE_NV..][..n]);
        let v = &step.start.v[BASE_NV..][..n];
        let jump = |first: &S, ended: f64| (first.value() - ended).abs() * sixth;
        let mut has_large = false;
        for j in 0..n {
            let speed = v[j].value().abs();
            fastest[j] = if speed > fastest[j] { speed } else { fastest[j] };
            has_large |= jump(&first[j], ended[j]) > SMALL * fastest[j];
        }
        if has_large {
            for j in 0..n {
                let jump = jump(&first[j], ended[j]);
                if jump > SMALL * fastest[j] {
                    jumps[j] += jump * jump.sqrt().sqrt();
                }
            }
        }
        ended.iter_mut().zip(last).for_each(|(ended, last)| *ended = last.value());
    }
}
