//! Rounding errors of the accelerations while bodies press on each other.

use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::external_loads::ExternalLoads;
use super::integrator::{FirstStage, Integration};
use super::state::State;
use crate::model::{BASE_NQ, BASE_NV};
use crate::spatial::Scalar;

/// Number of displaced states in which the accelerations are computed.
const SAMPLES: u32 = 4;
/// Displacement of each coordinate, in units of the machine epsilon `ε` times one plus the magnitude of the
/// coordinate, rad or m.
const DISPLACEMENT: f64 = 2.0;

/// Rounding errors of the accelerations of a run with contacts.
///
/// The distance of two shapes is at a minimum at its witness points, so that rounding errors of `ε` determine
/// the points and the normal of curved shapes only to `√ε`. The rounding errors of the accelerations are
/// therefore far larger than `ε` times their terms. They are measured: as the change of the accelerations
/// when all coordinates are displaced by rounding errors.
pub(super) struct RoundingErrors<S> {
    displaced: State<S>,
    /// First stage of each tree at the start of the step: force over mass, W axes, m/s², then the joint
    /// accelerations, rad/s² or m/s².
    start: Vec<Vec<f64>>,
    /// Root mean square of the changes for each tree: the change of the acceleration of the centre of mass,
    /// m/s², then that of each joint, rad/s² or m/s². Zero while no bodies press on each other.
    changes: Vec<Vec<f64>>,
}

impl<S: Scalar> RoundingErrors<S> {
    pub(super) fn new(state: &State<S>) -> Self {
        let zeros = |extra: usize| {
            state.trees.iter().map(|tree| vec![0.0; tree.v.len() - BASE_NV + extra]).collect::<Vec<_>>()
        };
        Self { displaced: state.clone(), start: zeros(3), changes: zeros(1) }
    }

    /// Returns the rounding errors of the tree with index `number`: that of the acceleration of the centre of
    /// mass, m/s², then that of each joint, rad/s² or m/s².
    pub(super) fn of(&self, number: usize) -> &[f64] {
        &self.changes[number]
    }

    /// Measures the rounding errors at the start of a step over `interval`, s, from `state`. Requires the
    /// first stage at `state` in `integration`, and overwrites it.
    pub(super) fn measure(
        &mut self,
        interval: (f64, f64),
        state: &State<S>,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        integration: &mut Integration<S>,
    ) -> Result<(), SimulationError> {
        self.changes.iter_mut().for_each(|changes| changes.fill(0.0));
        if !equations.contacts.press() {
            return Ok(());
        }
        let masses: Vec<f64> = equations.trees.iter().map(|tree| tree.model.mass()).collect();
        let firsts = integration.stages.first.iter().zip(&masses);
        for (start, (first, mass)) in self.start.iter_mut().zip(firsts) {
            start.iter_mut().zip(terms(first, *mass)).for_each(|(to, from)| *to = from);
        }
        for sample in 0..SAMPLES {
            self.displace(sample, state);
            equations.project_momentum(&mut self.displaced);
            equations.apply_loads(interval.0, interval, &self.displaced)?;
            integration.stages.evaluate_first(equations, &self.displaced);
            let firsts = integration.stages.first.iter().zip(&masses);
            for ((changes, start), (first, mass)) in self.changes.iter_mut().zip(&self.start).zip(firsts) {
                for (i, (now, start)) in terms(first, *mass).zip(start).enumerate() {
                    changes[i.saturating_sub(2)] += (now - start) * (now - start);
                }
            }
        }
        let root = |change: &mut f64| *change = (*change / f64::from(SAMPLES)).sqrt();
        self.changes.iter_mut().flatten().for_each(root);
        Ok(())
    }

    /// Sets the displaced state: `state` with every position of a base and of a joint displaced by rounding
    /// errors, whose signs differ between the samples.
    fn displace(&mut self, sample: u32, state: &State<S>) {
        self.displaced.copy_from(state);
        let mut number = 0_u32;
        for q in self.displaced.trees.iter_mut().map(|tree| &mut tree.q) {
            for i in (0..3).chain(BASE_NQ..q.len()) {
                number = number.wrapping_add(1);
                let sign = if (number >> (sample % 3)) % 2 == sample / 3 { 1.0 } else { -1.0 };
                let error = sign * DISPLACEMENT * f64::EPSILON * (1.0 + q[i].value().abs());
                q[i] += S::of(error);
            }
        }
    }
}

/// Returns the force over the mass, W axes, m/s², and the joint accelerations of a first stage.
fn terms<S: Scalar>(first: &FirstStage<S>, mass: f64) -> impl Iterator<Item = f64> + '_ {
    let force = [first.force.x, first.force.y, first.force.z];
    let joints = first.acceleration[BASE_NV..].iter().map(|x| x.value());
    force.into_iter().map(move |x| x.value() / mass).chain(joints)
}
