//! Terms of the derivatives of the equations of motion for each body and its subtree.

use crate::dynamics::data::{BodyData, Data};
use crate::dynamics::jacobian::unit_axes;
use crate::dynamics::rnea::net_force;
use crate::dynamics::subspace::{composite_force, joint_effort, subspace};
use crate::model::{Model, Node};
use crate::spatial::{Coriolis, Force, Motion, Real, SpatialInertia, Vec3};

/// Workspace of the derivatives for one state (or one group of SIMD lanes), allocated once per model.
#[derive(Clone, Debug)]
pub struct Derivatives<S> {
    pub(super) bodies: Vec<BodyTerms<S>>,
    /// Nonzero rows of `∂τ/∂q_j` and `∂τ/∂q̇_j`, for one joint at a time.
    joint: Vec<Row<S, 2>>,
    /// Rows of `[2B; Sᵀ 2B] e_m`, where `e_m` is a unit angular velocity of the base about axis `m`.
    base: Vec<Row<S, 3>>,
    /// Columns of `Mbm`: `I_C S` about the base origin.
    pub(super) coupling: Vec<Force<S>>,
    /// Generalized accelerations, `(nv,)`, m/s² and rad/s².
    pub(super) acceleration: Vec<S>,
    /// Generalized forces, `(nv,)`, N and N m.
    pub(super) force: Vec<S>,
}

/// One row of a block with `N` columns, and its index in the whole matrix.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<S, const N: usize> {
    pub(super) index: usize,
    pub(super) values: [S; N],
}

/// Quantities of one body and its subtree `C`, in base axes about the body origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyTerms<S> {
    /// `I_C`, composite inertia.
    pub(super) inertia: SpatialInertia<S>,
    /// `2B_C`, composite Coriolis operator.
    pub(super) coriolis: Coriolis<S>,
    /// `f_C`, force through the joint.
    pub(super) force: Force<S>,
    /// `Ψ̇ = v × S`.
    pub(super) subspace_rate: Motion<S>,
    /// `Ψ̈ = a × S + v × Ψ̇`.
    pub(super) subspace_rate2: Motion<S>,
    /// `I_C S`, about the origin of the joint whose column is computed next; after all columns, about the
    /// base origin.
    pub(super) composite_force: Force<S>,
    /// Angular half of `2B_Cᵀ S`; the linear half is zero.
    pub(super) coriolis_moment: Vec3<S>,
    /// Acceleration of the body, m/s² and rad/s², for one column of `M⁻¹`.
    pub(super) acceleration: Motion<S>,
    /// Joint torque `u` for one column of `M⁻¹`.
    pub(super) torque: S,
}

impl<S: Real> Derivatives<S> {
    /// Allocates the workspace for `model`.
    pub fn new(model: &Model) -> Self {
        let nodes = model.nodes();
        let zero = BodyTerms {
            inertia: SpatialInertia::zero(),
            coriolis: Coriolis::default(),
            force: Force::zero(),
            subspace_rate: Motion::zero(),
            subspace_rate2: Motion::zero(),
            composite_force: Force::zero(),
            coriolis_moment: Vec3::zero(),
            acceleration: Motion::zero(),
            torque: S::of(0.0),
        };
        let nv = model.nv();
        Self {
            bodies: vec![zero; nodes.len()],
            joint: vec![Row { index: 0, values: [S::of(0.0); 2] }; nv],
            base: vec![Row { index: 0, values: [S::of(0.0); 3] }; nv],
            coupling: vec![Force::zero(); nodes.len() - 1],
            acceleration: vec![S::of(0.0); nv],
            force: vec![S::of(0.0); nv],
        }
    }

    /// Computes the terms of all bodies. Requires the velocities and accelerations of all bodies in `data`.
    #[inline(always)]
    pub(super) fn compute_bodies(&mut self, nodes: &[Node], data: &Data<S>) {
        let (terms, bodies) = (&mut self.bodies[..nodes.len()], &data.bodies[..nodes.len()]);
        for (term, body) in terms.iter_mut().zip(bodies) {
            let momentum = body.inertia.momentum(body.velocity);
            term.inertia = body.inertia.about_origin();
            term.coriolis = Coriolis::of(&term.inertia, body.velocity, momentum);
            term.force = net_force(body);
        }
        for k in (1..nodes.len()).rev() {
            let (before, after) = terms.split_at_mut(k);
            let (body, term, parent) = (&bodies[k], &mut after[0], &mut before[nodes[k].parent]);
            let s = subspace(&nodes[k], body.axis());
            // Ψ̇ = v × S,  Ψ̈ = a × S + v × Ψ̇
            term.subspace_rate = body.velocity.cross(s);
            term.subspace_rate2 = body.acceleration.cross(s) + body.velocity.cross(term.subspace_rate);
            term.composite_force = composite_force(&nodes[k], body.axis(), &term.inertia);
            term.coriolis_moment = term.coriolis.transpose_apply(s);
            parent.inertia += term.inertia.from_point(body.offset);
            parent.coriolis += term.coriolis.from_point(body.offset);
            parent.force += term.force.from_point(body.offset);
        }
    }

    /// Returns the nonzero rows of `∂τ/∂q_j` and `∂τ/∂q̇_j`: those of the base, of the ancestors of joint
    /// `j`, and of the joints in its subtree.
    ///
    /// Must be called exactly once per joint, in descending order.
    #[inline(always)]
    pub(super) fn joint_columns(&mut self, nodes: &[Node], bodies: &[BodyData<S>], j: usize) -> &[Row<S, 2>] {
        let (term, s) = (&self.bodies[j], subspace(&nodes[j], bodies[j].axis()));
        let (rate, subspace_rate2) = (term.subspace_rate, term.subspace_rate2);
        let two = S::of(2.0);
        // ∂f_C/∂q_j = 2B_C Ψ̇ + I_C Ψ̈ + S ×* f_C
        let mut force_q = term.coriolis.apply(rate.angular)
            + term.inertia.momentum(subspace_rate2)
            + s.cross_force(term.force);
        // ∂f_C/∂q̇_j = 2B_C S + 2 I_C Ψ̇
        let mut force_v = term.coriolis.apply(s.angular) + term.inertia.momentum(rate) * two;
        let (mut i, mut count) = (j, 6);
        loop {
            let r = bodies[i].offset;
            (force_q, force_v, i) = (force_q.from_point(r), force_v.from_point(r), nodes[i].parent);
            if i == 0 {
                break;
            }
            let (node, z) = (&nodes[i], bodies[i].axis());
            let values = [joint_effort(node, z, force_q), joint_effort(node, z, force_v)];
            self.joint[count] = Row { index: i + 5, values };
            count += 1;
        }
        // loops run over indices, because LLVM moves arrays through memory when iterators destructure them
        let (base_q, base_v) = (components(force_q), components(force_v));
        for i in 0..6 {
            self.joint[i] = Row { index: i, values: [base_q[i], base_v[i]] };
        }
        for k in j..nodes[j].end {
            let BodyTerms { composite_force, coriolis_moment, .. } = &mut self.bodies[k];
            // S_kᵀ (2B_C Ψ̇_j + I_C Ψ̈_j)
            let row_q = coriolis_moment.dot_add(rate.angular, subspace_rate2.dot(*composite_force));
            // S_kᵀ (2B_C S_j + 2 I_C Ψ̇_j)
            let row_v = coriolis_moment.dot_add(s.angular, rate.dot(*composite_force) * two);
            *composite_force = composite_force.from_point(bodies[j].offset);
            self.joint[count] = Row { index: k + 5, values: [row_q, row_v] };
            count += 1;
        }
        &self.joint[..count]
    }

    /// Returns the rows of `[2B; Sᵀ 2B] e_m` for the unit angular velocities `e_m` of the base about its
    /// three axes.
    ///
    /// `∂τ/∂v_b` also contains `M [v_b × e_m; 0]`, because the base axes rotate; the caller adds this term.
    #[inline(always)]
    pub(super) fn base_columns(&mut self) -> &[Row<S, 3>] {
        let ([x, y, z], coriolis) = (unit_axes(), &self.bodies[0].coriolis);
        let x = components(coriolis.apply(x));
        let y = components(coriolis.apply(y));
        let z = components(coriolis.apply(z));
        for i in 0..6 {
            self.base[i] = Row { index: i, values: [x[i], y[i], z[i]] };
        }
        for k in 1..self.bodies.len() {
            let row = self.bodies[k].coriolis_moment;
            self.base[k + 5] = Row { index: k + 5, values: [row.x, row.y, row.z] };
        }
        &self.base
    }
}

/// Returns the six components of a force, linear before angular.
#[inline(always)]
pub(super) fn components<S: Real>(f: Force<S>) -> [S; 6] {
    [f.linear.x, f.linear.y, f.linear.z, f.angular.x, f.angular.y, f.angular.z]
}
