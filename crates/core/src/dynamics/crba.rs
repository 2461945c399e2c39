//! Mass matrix (composite rigid bodies).

use super::data::{BodyData, Data};
use super::kinematics::positions_kernel;
use crate::model::{Model, Node};
use crate::spatial::{Force, Real};

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
    out.fill(S::of(0.0));
    composites(nodes, bodies);
    for k in (1..nodes.len()).rev() {
        let force = bodies[k].force;
        let row = k + 5;
        out[row * nv + row] = bodies[k].subspace.dot(force) + S::of(nodes[k].rotor_inertia);
        let mut j = nodes[k].parent;
        while j > 0 {
            let entry = bodies[j].subspace.dot(force);
            out[row * nv + j + 5] = entry;
            out[(j + 5) * nv + row] = entry;
            j = nodes[j].parent;
        }
        force.write(&mut out[row * nv..]);
        for i in 0..6 {
            out[i * nv + row] = out[row * nv + i];
        }
    }
    base_block(&bodies[0], nv, out);
}

/// Inward: composite inertias, and `force = I^c S` of every joint.
#[inline(always)]
pub(super) fn composites<S: Real>(nodes: &[Node], bodies: &mut [BodyData<S>]) {
    bodies.iter_mut().for_each(|body| body.composite = body.inertia);
    for k in (1..nodes.len()).rev() {
        let composite = bodies[k].composite;
        bodies[nodes[k].parent].composite += composite;
        bodies[k].force = composite.momentum(bodies[k].subspace);
    }
}

/// `Mbb = [[m 1, −h×], [h×, I_o]]`.
#[inline(always)]
fn base_block<S: Real>(base: &BodyData<S>, nv: usize, out: &mut [S]) {
    let (o, i) = (S::of(0.0), &base.composite);
    let (m, h, r) = (i.mass, i.moment, &i.about_origin);
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

/// `I^c S` of joint `k`: column `k` of `Mbm`. Needs [`composites`].
#[inline(always)]
pub(super) fn coupling<S: Real>(bodies: &[BodyData<S>], k: usize) -> Force<S> {
    bodies[k].force
}
