//! Projection of configurations and velocities onto the constraints of closed loops.

use super::constrained::Locked;
use super::{ClosedLoops, rows};
use crate::dynamics::aba::{forward_dynamics_recursion, locked_dynamics_recursion};
use crate::dynamics::data::Data;
use crate::dynamics::kinematics::{kinematics, positions};
use crate::model::{Model, integrate};
use crate::spatial::Real;

/// Largest constraint error that is treated as rounding error, relative to 1 m plus the largest distance of a
/// constrained body from the base.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Largest number of Newton steps of one projection within a run, where the error is that of one step of the
/// integrator.
const CORRECTIONS: usize = 3;

impl<S: Real> ClosedLoops<S> {
    /// Computes the constraint errors `φ(q)`, `(m,)`, m and rad. Requires up-to-date poses in `data`.
    #[inline(always)]
    pub(crate) fn update_errors(&mut self, data: &Data<S>, q: &[S]) {
        let mut start = 0;
        for closure in &self.closures {
            let end = start + closure.rows();
            rows::errors(closure, data, q, &mut self.error[start..end]);
            start = end;
        }
    }

    /// Returns the constraint errors `φ` computed last, `(m,)`, m and rad.
    pub fn errors(&self) -> &[S] {
        &self.error
    }

    /// Returns true for each lane in which an error exceeds the rounding errors of the poses in `data`.
    #[inline(always)]
    pub(super) fn is_open(&self, data: &Data<S>) -> S::Mask {
        let (mut largest, mut reach) = (S::of(0.0), S::of(0.0));
        for (error, row) in self.error.iter().zip(&self.rows) {
            largest = S::select(largest.less(error.abs()), error.abs(), largest);
            for body in row.bodies {
                let distance = data.bodies[body].pos_b.norm();
                reach = S::select(reach.less(distance), distance, reach);
            }
        }
        let rounding = (reach + S::of(1.0)) * S::of(ROUNDING);
        rounding.less(largest)
    }

    /// Computes the response `δ = −M⁻¹ Jᵀ A⁻¹ x`, `(nv,)`, to the residuals `x`, which `residual` returns for
    /// each of the `m` rows, with the inertias of the last forward dynamics in `data`. Requires up-to-date
    /// poses in `data`, and changes the accelerations in `data`.
    pub(super) fn correction(
        &mut self,
        model: &Model,
        data: &mut Data<S>,
        locked: Locked<'_>,
        residual: impl Fn(&Self, usize) -> S,
        delta: &mut [S],
    ) {
        delta.fill(S::of(0.0));
        let locked = locked.map(|(locked, _)| locked);
        S::enter(
            #[inline(always)]
            || {
                self.update_rows(data);
                for i in 0..self.force.len() {
                    self.force[i] = -residual(self, i);
                }
                self.solve(model, data, locked)
            },
        );
        let zeros = std::mem::take(&mut self.buffers.zeros);
        self.respond(model, data, (&zeros, &zeros, locked), delta);
        self.buffers.zeros = zeros;
    }
}

/// Projects the configuration `q` onto the constraints by steps `δ = −M⁻¹ Jᵀ (J M⁻¹ Jᵀ)⁻¹ φ` over all
/// coordinates, until the error is a rounding error, but by at most three steps. Locked joints do not move.
/// To first order in `φ`, the centre of mass does not move. Afterwards `data` holds the poses at `q` and the
/// articulated-body inertias near `q`.
pub(crate) fn project_configuration<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    loops: &mut ClosedLoops<S>,
    q: &mut [S],
    locked: Locked<'_>,
) {
    let mut delta = std::mem::take(&mut loops.buffers.change);
    let mut moved = std::mem::take(&mut loops.buffers.moved);
    factorize(model, data, q, locked, (&loops.buffers.zeros, &mut delta));
    for _ in 0..CORRECTIONS {
        loops.update_errors(data, q);
        let is_open = loops.is_open(data);
        if !S::any(is_open) {
            break;
        }
        loops.correction(model, data, locked, |loops, i| loops.error[i], &mut delta);
        S::enter(
            #[inline(always)]
            || {
                integrate(q, &delta, &mut moved);
                // the numbers in lanes without errors do not change
                for (q, moved) in q.iter_mut().zip(&moved) {
                    *q = S::select(is_open, *moved, *q);
                }
            },
        );
        positions(model, data, q);
    }
    (loops.buffers.change, loops.buffers.moved) = (delta, moved);
}

/// Changes the velocity `v` by `−M⁻¹ Jᵀ (J M⁻¹ Jᵀ)⁻¹ J v`, so that it satisfies the constraints. The change
/// does not affect the momentum. Where rows are nearly dependent, the change is repeated, because its
/// rounding errors may violate the constraints. Requires the kinematics of `q` and `v`, and the results of
/// [`project_configuration`] with the same locked joints, in `data`.
pub(crate) fn project_velocity<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    loops: &mut ClosedLoops<S>,
    (q, v): (&[S], &mut [S]),
    locked: Locked<'_>,
) {
    let mut change = std::mem::take(&mut loops.buffers.change);
    loops.rates(data, v);
    loops.correction(model, data, locked, |loops, i| loops.buffers.rates[i], &mut change);
    v.iter_mut().zip(&change).for_each(|(v, change)| *v += *change);
    let is_repeated = loops.is_nearly_dependent();
    if S::any(is_repeated) {
        kinematics(model, data, q, v);
        loops.rates(data, v);
        loops.correction(model, data, locked, |loops, i| loops.buffers.rates[i], &mut change);
        for (v, change) in v.iter_mut().zip(&change) {
            *v = S::select(is_repeated, *v + *change, *v);
        }
    }
    loops.buffers.change = change;
}

/// Computes the articulated-body inertias, or the factors of `M`, at the configuration `q`, at rest. `zeros`,
/// `(nv,)`, contains only zeros; `scratch`, `(nv,)`, is a buffer.
pub(super) fn factorize<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    q: &[S],
    locked: Locked<'_>,
    (zeros, scratch): (&[S], &mut [S]),
) {
    kinematics(model, data, q, zeros);
    match locked {
        Some((locked, _)) => locked_dynamics_recursion(model, data, zeros, zeros, locked, &[], scratch),
        None => forward_dynamics_recursion(model, data, zeros, zeros, scratch),
    }
}

/// Computes the constraint errors of `loops` at `q`, `(nq,)`; [`ClosedLoops::errors`] returns them
/// afterwards.
pub fn closure_errors<S: Real>(model: &Model, data: &mut Data<S>, loops: &mut ClosedLoops<S>, q: &[S]) {
    positions(model, data, q);
    loops.update_errors(data, q);
}

/// Replaces the velocity `v`, `(nv,)`, by the nearest one, in the metric of the kinetic energy, that
/// satisfies the constraints of `loops`. The configuration `q`, `(nq,)`, must close the loops. The momentum
/// does not change.
pub fn close_velocity(
    model: &Model,
    data: &mut Data<f64>,
    loops: &mut ClosedLoops<f64>,
    q: &[f64],
    v: &mut [f64],
) {
    let (zeros, mut scratch) = (vec![0.0; model.nv()], vec![0.0; model.nv()]);
    factorize(model, data, q, None, (&zeros, &mut scratch));
    kinematics(model, data, q, v);
    project_velocity(model, data, loops, (q, v), None);
}
