//! What every derivative is made of, body by body.

use crate::dynamics::data::{BodyData, Data};
use crate::dynamics::jacobian::unit_axes;
use crate::dynamics::rnea::net_force;
use crate::dynamics::subspace::{composite_force, joint_effort, subspace};
use crate::model::{Model, Node};
use crate::spatial::{Coriolis, Force, Motion, Real, SpatialInertia, Vec3};

/// Workspace of the derivatives for one state (or one set of lanes), allocated once per model.
#[derive(Clone, Debug)]
pub struct Derivatives<S> {
    pub(super) bodies: Vec<Terms<S>>,
    /// Rows of `∂τ/∂q_j` and `∂τ/∂q̇_j` that are not zero come first.
    joint: Vec<Row<S, 2>>,
    /// Rows for the base's three rates of turn.
    base: Vec<Row<S, 3>>,
    /// Columns of `Mbm`: `I_C S` about the base's origin.
    pub(super) coupling: Vec<Force<S>>,
    /// Generalized accelerations, `(nv,)`.
    pub(super) acceleration: Vec<S>,
    /// Generalized forces, `(nv,)`.
    pub(super) force: Vec<S>,
}

/// One row of some columns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<S, const N: usize> {
    pub(super) index: usize,
    pub(super) values: [S; N],
}

/// Quantities of one body and its subtree `C`, in base axes about the body's origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Terms<S> {
    /// `I_C`.
    pub(super) inertia: SpatialInertia<S>,
    /// `2B_C`.
    pub(super) coriolis: Coriolis<S>,
    /// `f_C`: the force through its joint.
    pub(super) force: Force<S>,
    /// `Ψ̇ = v × S`.
    pub(super) rate: Motion<S>,
    /// `Ψ̈ = a × S + v × Ψ̇`.
    pub(super) rate2: Motion<S>,
    /// `I_C S`, about the origin of the joint whose column is formed next; after all of them about the base's.
    pub(super) reach: Force<S>,
    /// `2B_Cᵀ S`, of which only the angular half is not zero.
    pub(super) reach_coriolis: Vec3<S>,
    /// Acceleration of the body for a column of `M⁻¹`.
    pub(super) response: Motion<S>,
    /// Torque left at its joint for a column of `M⁻¹`.
    pub(super) left: S,
}

impl<S: Real> Derivatives<S> {
    /// Space for `model`.
    pub fn new(model: &Model) -> Self {
        let nodes = model.nodes();
        let one = Terms {
            inertia: SpatialInertia::zero(),
            coriolis: Coriolis::default(),
            force: Force::zero(),
            rate: Motion::zero(),
            rate2: Motion::zero(),
            reach: Force::zero(),
            reach_coriolis: Vec3::zero(),
            response: Motion::zero(),
            left: S::of(0.0),
        };
        let nv = model.nv();
        Self {
            bodies: vec![one; nodes.len()],
            joint: vec![Row { index: 0, values: [S::of(0.0); 2] }; nv],
            base: vec![Row { index: 0, values: [S::of(0.0); 3] }; nv],
            coupling: vec![Force::zero(); nodes.len() - 1],
            acceleration: vec![S::of(0.0); nv],
            force: vec![S::of(0.0); nv],
        }
    }

    /// Fills `bodies`. Needs the velocities and accelerations of all bodies in `data`.
    #[inline(always)]
    pub(super) fn gather(&mut self, nodes: &[Node], data: &Data<S>) {
        let (terms, bodies) = (&mut self.bodies[..nodes.len()], &data.bodies[..nodes.len()]);
        for (term, body) in terms.iter_mut().zip(bodies) {
            let momentum = body.inertia.momentum(body.velocity);
            term.inertia = body.inertia.about_origin();
            term.coriolis = Coriolis::of(&term.inertia, body.velocity, momentum);
            term.force = net_force(body);
        }
        for k in (1..nodes.len()).rev() {
            let (before, rest) = terms.split_at_mut(k);
            let (body, term, parent) = (&bodies[k], &mut rest[0], &mut before[nodes[k].parent]);
            let unit = subspace(&nodes[k], body.axis());
            term.rate = body.velocity.cross(unit);
            term.rate2 = body.acceleration.cross(unit) + body.velocity.cross(term.rate);
            term.reach = composite_force(&nodes[k], body.axis(), &term.inertia);
            term.reach_coriolis = term.coriolis.transpose_apply(unit);
            parent.inertia += term.inertia.from_point(body.offset);
            parent.coriolis += term.coriolis.from_point(body.offset);
            parent.force += term.force.from_point(body.offset);
        }
    }

    /// Rows of `∂τ/∂q_j` and `∂τ/∂q̇_j` that are not zero: of the base, the joints that carry `j`, its subtree.
    ///
    /// Must be called for every joint once, the last one first.
    #[inline(always)]
    pub(super) fn joint_columns(&mut self, nodes: &[Node], bodies: &[BodyData<S>], j: usize) -> &[Row<S, 2>] {
        let (term, unit) = (&self.bodies[j], subspace(&nodes[j], bodies[j].axis()));
        let (rate, rate2) = (term.rate, term.rate2);
        let two = S::of(2.0);
        let mut force_q =
            term.coriolis.apply(rate.angular) + term.inertia.momentum(rate2) + unit.cross_force(term.force);
        let mut force_v = term.coriolis.apply(unit.angular) + term.inertia.momentum(rate) * two;
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
        // loops by index: arrays taken apart by iterators go through memory
        let (base_q, base_v) = (components(force_q), components(force_v));
        for i in 0..6 {
            self.joint[i] = Row { index: i, values: [base_q[i], base_v[i]] };
        }
        for k in j..nodes[j].end {
            // Sᵀ (2B_C Ψ̇_j + I_C Ψ̈_j),  Sᵀ (2B_C S_j + 2 I_C Ψ̇_j)
            let Terms { reach, reach_coriolis, .. } = &mut self.bodies[k];
            let row_q = reach_coriolis.dot_add(rate.angular, rate2.dot(*reach));
            let row_v = reach_coriolis.dot_add(unit.angular, rate.dot(*reach) * two);
            *reach = reach.from_point(bodies[j].offset);
            self.joint[count] = Row { index: k + 5, values: [row_q, row_v] };
            count += 1;
        }
        &self.joint[..count]
    }

    /// Rows of `[2B; Sᵀ 2B] e_m` for the base's three rates of turn.
    ///
    /// What is missing to `∂τ/∂v_b` is `M [v_b × e_m; 0]`: the base's axes turn.
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
            let row = self.bodies[k].reach_coriolis;
            self.base[k + 5] = Row { index: k + 5, values: [row.x, row.y, row.z] };
        }
        &self.base
    }
}

/// Linear before angular.
#[inline(always)]
pub(super) fn components<S: Real>(f: Force<S>) -> [S; 6] {
    [f.linear.x, f.linear.y, f.linear.z, f.angular.x, f.angular.y, f.angular.z]
}
