//! What every derivative is made of, body by body.

use crate::dynamics::data::{BodyData, Data};
use crate::dynamics::jacobian::unit_axes;
use crate::dynamics::rnea::net_force;
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

/// Quantities of one body and its subtree `C`, in base axes about the base's origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Terms<S> {
    /// One past the last body of the subtree: bodies are numbered depth first.
    pub(super) end: usize,
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
    /// `I_C S`.
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
        let one = |k| Terms {
            end: k + 1,
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
        let mut bodies: Vec<_> = (0..nodes.len()).map(one).collect();
        for k in (1..nodes.len()).rev() {
            let end = bodies[k].end;
            let parent = &mut bodies[nodes[k].parent];
            parent.end = parent.end.max(end);
        }
        let nv = model.nv();
        Self {
            bodies,
            joint: vec![Row { index: 0, values: [S::of(0.0); 2] }; nv],
            base: vec![Row { index: 0, values: [S::of(0.0); 3] }; nv],
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
            term.inertia = body.inertia;
            term.coriolis = Coriolis::of(&body.inertia, body.velocity, momentum);
            term.force = net_force(body);
        }
        for k in (1..nodes.len()).rev() {
            let (before, rest) = terms.split_at_mut(k);
            let (body, term, parent) = (&bodies[k], &mut rest[0], &mut before[nodes[k].parent]);
            term.rate = body.velocity.cross(body.subspace);
            term.rate2 = body.acceleration.cross(body.subspace) + body.velocity.cross(term.rate);
            term.reach = term.inertia.momentum(body.subspace);
            term.reach_coriolis = term.coriolis.transpose_apply(body.subspace);
            parent.inertia += term.inertia;
            parent.coriolis += term.coriolis;
            parent.force += term.force;
        }
    }

    /// Rows of `∂τ/∂q_j` and `∂τ/∂q̇_j` that are not zero: of the base, the joints that carry `j`, its subtree.
    #[inline(always)]
    pub(super) fn joint_columns(&mut self, nodes: &[Node], bodies: &[BodyData<S>], j: usize) -> &[Row<S, 2>] {
        let (term, subspace) = (&self.bodies[j], bodies[j].subspace);
        let two = S::of(2.0);
        let force_q = term.coriolis.apply(term.rate.angular)
            + term.inertia.momentum(term.rate2)
            + subspace.cross_force(term.force);
        let force_v = term.coriolis.apply(subspace.angular) + term.inertia.momentum(term.rate) * two;
        // loops by index: arrays taken apart by iterators go through memory
        let (base_q, base_v) = (components(force_q), components(force_v));
        for i in 0..6 {
            self.joint[i] = Row { index: i, values: [base_q[i], base_v[i]] };
        }
        let mut count = 6;
        let mut i = nodes[j].parent;
        while i > 0 {
            let s = bodies[i].subspace;
            self.joint[count] = Row { index: i + 5, values: [s.dot(force_q), s.dot(force_v)] };
            (i, count) = (nodes[i].parent, count + 1);
        }
        for k in j..term.end {
            // Sᵀ (2B_C Ψ̇_j + I_C Ψ̈_j),  Sᵀ (2B_C S_j + 2 I_C Ψ̇_j)
            let below = &self.bodies[k];
            let row_q = below.reach_coriolis.dot(term.rate.angular) + term.rate2.dot(below.reach);
            let row_v = below.reach_coriolis.dot(subspace.angular) + term.rate.dot(below.reach) * two;
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
