//! Inverse of the mass matrix from the articulated-body inertias computed by forward dynamics.

use super::terms::{BodyTerms, components};
use crate::dynamics::data::BodyData;
use crate::dynamics::subspace::{add_joint_motion, joint_effort};
use crate::model::Node;
use crate::spatial::{Force, Motion, Real};

/// Computes `M⁻¹`, row major `(nv, nv)`: column `j` is the acceleration that a unit generalized force `τ_j`
/// causes at rest.
///
/// Because `M⁻¹` is symmetric, the entries of column `j` are computed only up to row `j`.
///
/// Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, Table 7.1.
#[inline(always)]
pub(super) fn inverse_mass<S: Real>(
    nodes: &[Node],
    bodies: &[BodyData<S>],
    terms: &mut [BodyTerms<S>],
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
        // u_j = 1,  P = U u/D
        for term in &mut terms[1..j] {
            term.torque = zero;
        }
        terms[j].torque = S::of(1.0);
        let mut force = bodies[j].u_force * bodies[j].d_inverse;
        let mut i = nodes[j].parent;
        while i > 0 {
            // ancestors of j: u = −Sᵀ P,  P ← P + U u/D
            let torque = -joint_effort(&nodes[i], bodies[i].axis(), force);
            terms[i].torque = torque;
            let shifted = force.from_point(bodies[i].offset);
            force = bodies[i].u_force.scale_add(torque * bodies[i].d_inverse, shifted);
            i = nodes[i].parent;
        }
        // a_0 = −IA⁻¹ P
        terms[0].acceleration = -base.apply(force);
        base_rows(terms[0].acceleration, nv, j + 5, out);
        for i in 0..6 {
            out[(j + 5) * nv + i] = out[i * nv + j + 5];
        }
        for k in 1..=j {
            // q̈ = (u − Uᵀ a_p)/D,  a = a_p + S q̈
            let parent = terms[nodes[k].parent].acceleration;
            let x = (terms[k].torque - parent.dot(bodies[k].u_force)) * bodies[k].d_inverse;
            let shifted = parent.referred_to(bodies[k].offset);
            terms[k].acceleration = add_joint_motion(&nodes[k], bodies[k].axis(), x, shifted);
            out[(k + 5) * nv + j + 5] = x;
            out[(j + 5) * nv + k + 5] = x;
        }
    }
}

/// Writes the acceleration of the base, `twist`, to the first six rows of column `j` of `out`.
#[inline(always)]
fn base_rows<S: Real>(twist: Motion<S>, nv: usize, j: usize, out: &mut [S]) {
    let rows = components(Force::new(twist.linear, twist.angular));
    for i in 0..6 {
        out[i * nv + j] = rows[i];
    }
}
