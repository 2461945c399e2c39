//! Forward dynamics with closed loops.

use super::{ClosedLoops, constraint_force, dense_response, response, rows};
use crate::dynamics::aba::{forward_dynamics_recursion, locked_dynamics_recursion};
use crate::dynamics::data::Data;
use crate::dynamics::external::{FrameWrench, apply_external};
use crate::dynamics::kinematics::kinematics;
use crate::model::Model;
use crate::spatial::Real;

/// Locked joints: for each joint, `(n,)`, whether it is locked, and the accelerations of the locked joints,
/// `(n,)`, rad/s² (m/s²), or an empty slice if these are zero. `None` if no joint is locked.
pub(crate) type Locked<'a> = Option<(&'a [bool], &'a [f64])>;

/// Computes the acceleration `a = M⁻¹ (τ − c + Σ Jᵀ F + Jᵀ λ)` under the constraints `J a + J̇ v = 0` of
/// `loops`. Afterwards [`ClosedLoops::forces`] returns the constraint forces `λ`. Returns the rank of `J`,
/// which is the number of independent constraints.
///
/// `q`: `(nq,)`; `v`, `tau`, `a` (out): `(nv,)`; `tau[..6]` is a wrench on the base, about its origin in base
/// axes, N and N m. The velocity must satisfy the constraints.
///
/// Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, section 8.3.
pub fn constrained_forward_dynamics<S: Real>(
    (model, data, loops): (&Model, &mut Data<S>, &mut ClosedLoops<S>),
    q: &[S],
    v: &[S],
    tau: &[S],
    external: &[FrameWrench<S>],
    a: &mut [S],
) -> S {
    kinematics(model, data, q, v);
    apply_external(model, data, external);
    constrained_recursion(model, data, loops, (v, tau), None, a)
}

/// Computes [`constrained_forward_dynamics`] with the external wrenches stored in `data` and with locked
/// joints. Requires up-to-date [`kinematics`] in `data`. The holding torques of locked joints are stored in
/// `data`.
#[inline]
pub(crate) fn constrained_recursion<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    loops: &mut ClosedLoops<S>,
    (v, tau): (&[S], &[S]),
    locked: Locked<'_>,
    a: &mut [S],
) -> S {
    match locked {
        Some((locked, given)) => locked_dynamics_recursion(model, data, v, tau, locked, given, a),
        None => forward_dynamics_recursion(model, data, v, tau, a),
    }
    if loops.is_empty() { S::of(0.0) } else { constrain(model, data, loops, (v, tau), locked, a) }
}

/// Adds the response to the constraint forces to the accelerations `a` of forward dynamics without loops, and
/// returns the rank of `J`; see [`constrained_forward_dynamics`].
#[inline(never)]
fn constrain<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    loops: &mut ClosedLoops<S>,
    (v, tau): (&[S], &[S]),
    locked: Locked<'_>,
    a: &mut [S],
) -> S {
    let locked = locked.map(|(locked, _)| locked);
    let rank = S::enter(
        #[inline(always)]
        || {
            loops.update_rows(data);
            loops.constraint_accelerations(data, a);
            loops.solve(model, data, locked)
        },
    );
    loops.respond(model, data, (v, tau, locked), a);
    loops.refine(model, data, (v, tau, locked), a);
    rank
}

impl<S: Real> ClosedLoops<S> {
    /// Computes the right-hand sides `−(J a + J̇ v)` from the accelerations in `data` and `a`.
    #[inline(always)]
    pub(super) fn constraint_accelerations(&mut self, data: &Data<S>, a: &[S]) {
        for (right, row) in self.force.iter_mut().zip(&self.rows) {
            *right = row.acceleration(data, a);
        }
        let mut start = 0;
        for closure in &self.closures {
            let range = start..start + closure.rows();
            start = range.end;
            rows::add_drift(closure, data, &self.rows[range.clone()], &mut self.force[range]);
        }
        for right in &mut self.force {
            *right = -*right;
        }
    }

    /// Solves `A λ = b`, where `force` contains `b` before and `λ` after the call, and returns the rank of
    /// `A`. Requires the articulated-body inertias, or the factors of `M`, of forward dynamics with the same
    /// locked joints in `data`.
    #[inline(always)]
    pub(super) fn solve(&mut self, model: &Model, data: &Data<S>, locked: Option<&[bool]>) -> S {
        self.update_matrix(model, data, locked);
        let Self { force, matrix, compliance, scale, .. } = self;
        constraint_force::solve(matrix, compliance, scale, force)
    }

    /// Computes the lower triangle of `A` and the compliances of the base. Has the same requirements as
    /// [`solve`](Self::solve).
    #[inline(always)]
    pub(super) fn update_matrix(&mut self, model: &Model, data: &Data<S>, locked: Option<&[bool]>) {
        let Self { rows, matrix, supported, scratch, compliance, base, .. } = self;
        if model.is_heavy_on_light() {
            dense_response::jacobian(model, data, rows, &mut scratch.dense);
            dense_response::inverse_apparent_mass(data, &scratch.dense, locked, model.nv(), matrix);
            dense_response::compliance(data, rows, compliance);
        } else {
            *base = data.bodies[0].articulated.inverse();
            let tree = (model.nodes(), &data.bodies[..]);
            response::inverse_apparent_mass(tree, base, (rows, supported), scratch, (matrix, compliance));
        }
    }

    /// Adds the response to the constraint forces to `a` and to the accelerations in `data`. Requires the
    /// results of [`solve`](Self::solve) with the same inertias.
    #[inline(always)]
    pub(super) fn respond(
        &mut self,
        model: &Model,
        data: &mut Data<S>,
        (v, tau, locked): (&[S], &[S], Option<&[bool]>),
        a: &mut [S],
    ) {
        let Self { rows, force, supported, scratch, base, .. } = self;
        if model.is_heavy_on_light() {
            let jacobian = std::mem::take(&mut scratch.dense);
            dense_response::add_response(model, data, (&jacobian, force), (v, tau, locked), a);
            scratch.dense = jacobian;
            return;
        }
        S::enter(
            #[inline(always)]
            || {
                let tree = (model.nodes(), &mut data.bodies[..]);
                response::add_response(tree, base, (rows, force), (supported, locked), scratch, a);
            },
        );
    }
}
