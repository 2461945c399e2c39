//! Derivatives of forward dynamics.

use super::inverse_mass::inverse_mass;
use super::terms::{Derivatives, Row};
use crate::dynamics::aba::forward_dynamics;
use crate::dynamics::data::Data;
use crate::dynamics::dense;
use crate::dynamics::external::FrameWrench;
use crate::dynamics::jacobian::unit_axes;
use crate::model::Model;
use crate::spatial::{Real, Vec3};

/// Computes the derivatives `dq`, `dv` and `dtau` of [`forward_dynamics`] with respect to `q`, `v` and `tau`.
///
/// Each matrix is row major `(nv, nv)`, with the derivatives of `a_i` in row `i`: `∂a/∂τ = M⁻¹` and
/// `∂a/∂x = −M⁻¹ ∂τ/∂x` for `x = q, v`, where `∂τ/∂x` is the derivative of inverse dynamics at the
/// acceleration `a`. The tangent space of `q` and the quantities held constant are defined in
/// [`derivatives`](super).
pub fn forward_dynamics_derivatives<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    work: &mut Derivatives<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
    external: &[FrameWrench<S>],
    [dq, dv, dtau]: [&mut [S]; 3],
) {
    forward_dynamics(model, data, q, v, tau, external, &mut work.acceleration);
    S::enter(
        #[inline(always)]
        || kernel(model, data, work, dq, dv, dtau),
    );
}

#[inline(always)]
fn kernel<S: Real>(
    model: &Model,
    data: &Data<S>,
    work: &mut Derivatives<S>,
    dq: &mut [S],
    dv: &mut [S],
    dtau: &mut [S],
) {
    let (nodes, nv) = (model.nodes(), model.nv());
    if model.is_heavy_on_light() {
        dense::inverse_mass(data, nv, dtau);
    } else {
        inverse_mass(nodes, &data.bodies, &mut work.bodies, dtau);
    }
    work.compute_bodies(nodes, data);
    for i in 0..nv {
        dq[i * nv..i * nv + 6].fill(S::of(0.0));
        dv[i * nv..i * nv + 3].fill(S::of(0.0));
    }
    for j in (1..nodes.len()).rev() {
        // ∂a/∂q_j = −M⁻¹ ∂τ/∂q_j,  ∂a/∂q̇_j = −M⁻¹ ∂τ/∂q̇_j
        product(dtau, nv, work.joint_columns(nodes, &data.bodies, j), |i, x| {
            dq[i * nv + j + 5] = -x[0];
            dv[i * nv + j + 5] = -x[1];
        });
    }
    product(dtau, nv, work.base_columns(), |i, x| {
        for m in 0..3 {
            dv[i * nv + m + 3] = -x[m];
        }
    });
    // M⁻¹ M (v_b × e_m) = v_b × e_m: [[ω×, v×], [0, ω×]]
    let twist = data.bodies[0].velocity;
    subtract_cross(twist.angular, 0, 0, nv, dv);
    subtract_cross(twist.linear, 0, 3, nv, dv);
    subtract_cross(twist.angular, 3, 3, nv, dv);
}

/// Subtracts `v×` from the 3 × 3 block of `out` that begins at `row` and `column`.
#[inline(always)]
fn subtract_cross<S: Real>(v: Vec3<S>, row: usize, column: usize, nv: usize, out: &mut [S]) {
    for j in 0..3 {
        let product = v.cross(unit_axes()[j]);
        let rows = [product.x, product.y, product.z];
        for i in 0..3 {
            out[(row + i) * nv + column + j] -= rows[i];
        }
    }
}

/// Number of rows of a product that are computed together, so that their sums stay in registers.
const TILE: usize = 4;

/// Computes `A b` for a symmetric matrix `A`, `(nv, nv)` with `nv ≥ 6`, and `N` columns `b`, given by their
/// nonzero rows. Passes the index and the values of each row of the result to `write`, for some rows twice.
#[inline(always)]
fn product<S: Real, const N: usize>(
    a: &[S],
    nv: usize,
    b: &[Row<S, N>],
    mut write: impl FnMut(usize, [S; N]),
) {
    for start in (0..nv).step_by(TILE) {
        let start = start.min(nv - TILE); // the last tile may overlap the preceding tile
        let mut sums = [[S::of(0.0); N]; TILE];
        for row in b {
            let a = &a[row.index * nv + start..][..TILE];
            for t in 0..TILE {
                for c in 0..N {
                    sums[t][c] = a[t].mul_add(row.values[c], sums[t][c]);
                }
            }
        }
        for t in 0..TILE {
            write(start + t, sums[t]);
        }
    }
}
