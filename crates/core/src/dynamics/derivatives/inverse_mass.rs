//! The inverse of the mass matrix, from the articulated bodies that forward dynamics left.

use super::terms::{Terms, components};
use crate::dynamics::data::BodyData;
use crate::dynamics::subspace::{along, joint_effort};
use crate::model::Node;
use crate::spatial::{Force, Motion, Real};

/// `M⁻¹`, row major `(nv, nv)`: column `j` is the acceleration that a unit of `τ_j` gives.
///
/// Bodies numbered higher than `j` need not be asked, since `M⁻¹` is symmetric.
///
/// Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, Table 7.1, at rest.
#[inline(always)]
pub(super) fn inverse_mass<S: Real>(
    nodes: &[Node],
    bodies: &[BodyData<S>],
    terms: &mut [Terms<S>],
    out: &mut [S],
) {
    let (nv, zero) = (nodes.len() + 5, S::of(0.0));
    let base = bodies[0].articulated.inverse();
    for j in 0..6 {
        let mut unit = [zero; 6];
        unit[j] = S::of(1.0);
        base_rows(base.apply(Force::from_slice(&unit)), nv, j, out);
    }
    for j in 1..nodes.len() {
        // u_j = 1,  P = U u/D;  of those that carry j: u = −Sᵀ P,  P ← P + U u/D
        for term in &mut terms[1..j] {
            term.left = zero;
        }
        terms[j].left = S::of(1.0);
        let mut force = bodies[j].reach * bodies[j].inverse_pivot;
        let mut i = nodes[j].parent;
        while i > 0 {
            let left = -joint_effort(&nodes[i], bodies[i].axis(), force);
            terms[i].left = left;
            let moved = force.from_point(bodies[i].offset);
            force = bodies[i].reach.scale_add(left * bodies[i].inverse_pivot, moved);
            i = nodes[i].parent;
        }
        // a_0 = −IA⁻¹ P
        terms[0].response = -base.apply(force);
        base_rows(terms[0].response, nv, j + 5, out);
        for i in 0..6 {
            out[(j + 5) * nv + i] = out[i * nv + j + 5];
        }
        for k in 1..=j {
            // q̈ = (u − Uᵀ a_p)/D,  a = a_p + S q̈
            let carried = terms[nodes[k].parent].response;
            let x = (terms[k].left - carried.dot(bodies[k].reach)) * bodies[k].inverse_pivot;
            terms[k].response = along(&nodes[k], bodies[k].axis(), x, carried.referred_to(bodies[k].offset));
            out[(k + 5) * nv + j + 5] = x;
            out[(j + 5) * nv + k + 5] = x;
        }
    }
}

/// A twist as the base's rows of column `j`.
#[inline(always)]
fn base_rows<S: Real>(twist: Motion<S>, nv: usize, j: usize, out: &mut [S]) {
    let rows = components(Force::new(twist.linear, twist.angular));
    for i in 0..6 {
        out[i * nv + j] = rows[i];
    }
}
