//! Responses to constraint forces of robots whose forward dynamics use the dense mass matrix.

use super::rows::Row;
use crate::dynamics::data::Data;
use crate::dynamics::dense;
use crate::dynamics::momentum::composite_momentum;
use crate::dynamics::rnea::inverse_dynamics_recursion;
use crate::dynamics::subspace::joint_effort;
use crate::model::{BASE_NV, Model};
use crate::spatial::{Force, Real, dot};

/// Computes the constraint Jacobian `J`, row major `(m, nv)`.
#[inline(always)]
pub(super) fn jacobian<S: Real>(model: &Model, data: &Data<S>, rows: &[Row<S>], out: &mut [S]) {
    let (nodes, nv) = (model.nodes(), model.nv());
    out.fill(S::of(0.0));
    for (row, out) in rows.iter().zip(out.chunks_exact_mut(nv)) {
        let mut base = Force::zero();
        for side in 0..2 {
            let (mut k, mut force) = (row.bodies[side], row.forces[side]);
            if k > 0 {
                out[k + 5] += row.efforts[side];
            }
            while k > 0 {
                let body = &data.bodies[k];
                out[k + 5] += joint_effort(&nodes[k], body.axis(), force);
                (force, k) = (force.from_point(body.offset), nodes[k].parent);
            }
            base += force;
        }
        base.write(out);
    }
}

/// Computes the lower triangle of `A = J M⁻¹ Jᵀ` from the factors of `M` in `data` and from `J`, `(m, nv)`.
#[inline(always)]
pub(super) fn inverse_apparent_mass<S: Real>(
    data: &Data<S>,
    jacobian: &[S],
    locked: Option<&[bool]>,
    nv: usize,
    matrix: &mut [S],
) {
    let m = jacobian.len() / nv;
    let mut response = vec![S::of(0.0); nv]; // such robots are rare, so an allocation is acceptable
    for c in 0..m {
        response.copy_from_slice(&jacobian[c * nv..(c + 1) * nv]);
        clear_locked(&mut response, locked);
        dense::solve_factored(data, nv, &mut response);
        for r in c..m {
            matrix[r * m + c] = dot(&jacobian[r * nv..(r + 1) * nv], &response);
        }
    }
}

/// Computes the compliance `Fᵀ I_0⁻¹ F` of each row, `(m,)`, from its force `F` on the second body, about the
/// base origin, and the inertia `I_0` of the whole robot.
#[inline(always)]
pub(super) fn compliance<S: Real>(data: &Data<S>, rows: &[Row<S>], out: &mut [S]) {
    for (out, row) in out.iter_mut().zip(rows) {
        let force = row.forces[1].from_point(data.bodies[row.bodies[1]].pos_b);
        *out = composite_momentum(data).0.inverse().apply(force).dot(force);
    }
}

/// Adds the change of acceleration `M⁻¹ Jᵀ λ`, `(nv,)`, to `a`. Stores the accelerations of all bodies at the
/// velocity `v`, and the holding torques of the joints `locked` under the efforts `tau`, in `data`.
pub(super) fn add_response<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    (jacobian, lambda): (&[S], &[S]),
    (v, tau, locked): (&[S], &[S], Option<&[bool]>),
    a: &mut [S],
) {
    let nv = model.nv();
    let mut efforts = vec![S::of(0.0); nv];
    for (row, &lambda) in jacobian.chunks_exact(nv).zip(lambda) {
        efforts.iter_mut().zip(row).for_each(|(sum, x)| *sum += *x * lambda);
    }
    let mut response = efforts.clone();
    clear_locked(&mut response, locked);
    S::enter(
        #[inline(always)]
        || dense::solve_factored(data, nv, &mut response),
    );
    a.iter_mut().zip(&response).for_each(|(a, change)| *a += *change);
    inverse_dynamics_recursion(model, data, v, Some(a), &mut response);
    for j in (0..model.joint_count()).filter(|&j| locked.is_some_and(|locked| locked[j])) {
        let i = BASE_NV + j;
        data.bodies[j + 1].holding_torque = response[i] - tau[i] - efforts[i];
    }
}

/// Sets the entries of locked joints in `x`, `(nv,)`, to zero, because the factors of `M` do not contain
/// these joints.
#[inline(always)]
fn clear_locked<S: Real>(x: &mut [S], locked: Option<&[bool]>) {
    if let Some(locked) = locked {
        for (x, locked) in x[BASE_NV..].iter_mut().zip(locked) {
            *x = if *locked { S::of(0.0) } else { *x };
        }
    }
}
