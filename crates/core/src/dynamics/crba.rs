//! Mass matrix: the composite-rigid-body algorithm (CRBA).

use super::data::Data;
use super::kinematics::positions_kernel;
use super::passes::leaf_to_root;
use super::subspace::{composite_force, joint_effort};
use crate::model::Model;
use crate::spatial::{Real, SpatialInertia};

/// Computes the mass matrix `M(q)`, row major `(nv, nv)`, in kg, kg m and kg m², at `q`, `(nq,)`.
///
/// The base block is `Mbb = I_0^c`, where `I_k^c` is the composite inertia of the subtree of body `k`. With
/// the motion subspace `S_k` of joint `k`, the force `I_k^c S_k` is shifted from body origin to body origin
/// towards the base. Its component along each ancestor joint `j` is `M_jk = S_jᵀ I_k^c S_k`, and its value at
/// the base is column `k` of `Mbm`.
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

/// Computes [`mass_matrix`]. Requires up-to-date poses ([`positions`](super::positions)) in `data`.
#[inline(always)]
pub(super) fn kernel<S: Real>(model: &Model, data: &mut Data<S>, out: &mut [S]) {
    let (nodes, nv) = (model.nodes(), model.nv());
    let bodies = &mut data.bodies[..nodes.len()];
    let children = leaf_to_root(
        nodes,
        bodies,
        #[inline(always)]
        |_, node, body, children| {
            // I^c = I + Σ I^c of the children
            let composite: SpatialInertia<S> = children + body.inertia.about_origin();
            // F = I^c S
            body.force = composite_force(node, body.axis(), &composite);
            composite.from_point(body.offset)
        },
    );
    base_block(&(children + bodies[0].inertia.about_origin()), nv, out);
    for k in 1..nodes.len() {
        let row = k + 5;
        // M_kk = S_kᵀ F + rotor
        out[row * nv + row] =
            joint_effort(&nodes[k], bodies[k].axis(), bodies[k].force) + S::of(nodes[k].rotor_inertia);
        let mut force = bodies[k].force.from_point(bodies[k].offset);
        let mut ancestor = nodes[k].parent;
        for j in (1..k).rev() {
            let mut entry = S::of(0.0);
            if j == ancestor {
                // M_jk = S_jᵀ F
                entry = joint_effort(&nodes[j], bodies[j].axis(), force);
                force = force.from_point(bodies[j].offset);
                ancestor = nodes[j].parent;
            }
            out[row * nv + j + 5] = entry;
        }
        force.write(&mut out[row * nv..]);
        for i in 0..row {
            out[i * nv + row] = out[row * nv + i];
        }
    }
}

/// Writes the base block of the mass matrix, `Mbb = [[m 1, −h×], [h×, I_o]]`, with the mass `m`, the first
/// moment of mass `h` and the inertia `I_o` of the robot about the base origin.
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
