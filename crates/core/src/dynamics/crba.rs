//! Mass matrix (composite rigid bodies).

use super::data::Data;
use super::kinematics::positions_kernel;
use super::walk::inward;
use crate::model::Model;
use crate::spatial::{Real, SpatialInertia};

/// Mass matrix `M(q)`, row major `(nv, nv)`, kg, kg m, kg m².
///
/// In base coordinates the composite inertias add, `Mbb = I_0^c`, the coupling column of joint `k`
/// is `I_k^c S_k` itself, and `M_jk = S_jᵀ I_k^c S_k` for `j` an ancestor of `k`.
///
/// Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, Table 6.2.
pub fn mass_matrix<S: Real>(model: &Model, data: &mut Data<S>, q: &[S], out: &mut [S]) {
    S::enter(
        #[inline(always)]
        || {
            positions_kernel(model, data, q);
            kernel(model, data, out);
        },
    );
}

#[inline(always)]
fn kernel<S: Real>(model: &Model, data: &mut Data<S>, out: &mut [S]) {
    let (nodes, nv) = (model.nodes(), model.nv());
    let bodies = &mut data.bodies[..nodes.len()];
    let carried = inward(
        nodes,
        bodies,
        #[inline(always)]
        |_, _, body, carried| {
            // I^c = I + Σ I^c of what it carries,  F = I^c S
            let composite: SpatialInertia<S> = carried + body.inertia;
            body.force = composite.momentum(body.subspace);
            composite
        },
    );
    base_block(&(carried + bodies[0].inertia), nv, out);
    for k in 1..nodes.len() {
        let (force, row) = (bodies[k].force, k + 5);
        force.write(&mut out[row * nv..]);
        let mut ancestor = nodes[k].parent;
        for j in (1..k).rev() {
            let mut entry = S::of(0.0);
            if j == ancestor {
                entry = bodies[j].subspace.dot(force);
                ancestor = nodes[j].parent;
            }
            out[row * nv + j + 5] = entry;
        }
        for i in 0..row {
            out[i * nv + row] = out[row * nv + i];
        }
        out[row * nv + row] = bodies[k].subspace.dot(force) + S::of(nodes[k].rotor_inertia);
    }
}

/// `Mbb = [[m 1, −h×], [h×, I_o]]`.
#[inline(always)]
fn base_block<S: Real>(composite: &SpatialInertia<S>, nv: usize, out: &mut [S]) {
    let o = S::of(0.0);
    let (m, h, r) = (composite.mass, composite.moment, &composite.about_origin);
    let rows = [
        [m, o, o, o, h.z, -h.y],
        [o, m, o, -h.z, o, h.x],
        [o, o, m, h.y, -h.x, o],
        [o, -h.z, h.y, r.xx, r.xy, r.xz],
        [h.z, o, -h.x, r.xy, r.yy, r.yz],
        [-h.y, h.x, o, r.xz, r.yz, r.zz],
    ];
    for (i, row) in rows.iter().enumerate() {
        out[i * nv..i * nv + 6].copy_from_slice(row);
    }
}
