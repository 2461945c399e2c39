//! Semi-implicit Euler method, of first order.

use super::stages::Stages;
use crate::model::integrate;
use crate::simulation::equations::EquationsOfMotion;
use crate::simulation::external_loads::ExternalLoads;
use crate::simulation::state::State;
use crate::spatial::{Real, Vec3};

/// Computes a step: `v' = v + h a(q, v)`, `q' = q ⊕ h v'`, for each tree in the moving frame of its step.
/// Requires the first stage in `stages`.
pub(super) fn semi_implicit_euler<S: Real>(
    stages: &mut Stages<S>,
    equations: &EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
    state: &mut State<S>,
    interval: (f64, f64),
) {
    let Stages { start, rate, sum, .. } = stages;
    let h = S::of(interval.1 - interval.0);
    S::enter(
        #[inline(always)]
        || {
            state.move_from(start, rate, h);
            let parts = state.trees.iter_mut().zip(&start.trees).zip(&mut sum.trees);
            for (((state, start), sum), tree) in parts.zip(&equations.trees) {
                let increment = &mut sum.a; // this method needs no sum, so that its memory is free
                for (increment, v) in increment.iter_mut().zip(&state.v) {
                    *increment = *v * h;
                }
                integrate(&start.q, increment, &mut state.q);
                tree.frame_velocity().scale_add(h, Vec3::from_slice(&state.q)).write(&mut state.q);
            }
        },
    );
}
