//! Systems as members of the integrated trees. A system is either the only member of a tree or a part of a
//! larger tree.
//!
//! Integration uses the coordinates of trees; controllers, loads and rows use the coordinates of systems.

use super::body_states::LoadedSystem;
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::dynamics::{Data, Momentum, base_rotation, inverse_dynamics, momentum_energy_com};
use crate::model::{Axis, BASE_NQ, BASE_NV, Model};
use crate::spatial::{Force, Mat3, Quat, Real, Scalar, Vec3};
use crate::world::{BodyPlace, Member};
use serde::{Deserialize, Serialize};

/// Place of a system in the list of trees or in the list of parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// The system is the only member of this tree, so both have the same coordinates.
    Tree(usize),
    /// The system is this part, which belongs to a tree with several members.
    Part(usize),
}

/// Places of all systems of a run, and the systems that share a tree with other systems.
pub(crate) struct Members<'a, S> {
    /// Place of each system.
    pub(super) places: Vec<Place>,
    pub(super) parts: Vec<Part<'a, S>>,
}

/// System that shares its tree with other systems.
pub(crate) struct Part<'a, S> {
    /// Index of the tree.
    pub(super) tree: usize,
    /// Index of the system among the members of the tree.
    share: usize,
    pub(super) member: Member,
    /// State in the coordinates of the system.
    pub(super) state: TreeState<S>,
    /// Kinematics, commanded torques and modes in the coordinates of the system.
    pub(super) own: Tree<'a, S>,
    /// Factor, 1 or −1, that makes the base quaternion continuous when the system joins the tree.
    pub(super) sign: f64,
    /// Work less kinetic energy at the instant at which the system joined the tree, J.
    work_ahead: S,
    /// Energy dissipated in the joints of the system before it joined the tree, J.
    dissipated_before: S,
}

/// State of a part, for checkpoints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedPart {
    pub(super) state: TreeState<f64>,
    pub(super) sign: f64,
    pub(super) work_ahead: f64,
    pub(super) dissipated_before: f64,
}

impl<S: Real> Members<'_, S> {
    /// Creates the places of `count` systems, each of which is the only member of its tree.
    pub(crate) fn alone(count: usize) -> Self {
        Self { places: (0..count).map(Place::Tree).collect(), parts: Vec::new() }
    }

    /// Returns the index of the tree that contains the system at a place.
    pub(super) fn tree_at(&self, place: Place) -> usize {
        match place {
            Place::Tree(tree) => tree,
            Place::Part(part) => self.parts[part].tree,
        }
    }

    /// Returns the state and the equations of motion of the system with index `number`, both in the
    /// coordinates of the system.
    pub(super) fn system<'m>(
        &'m self,
        number: usize,
        trees: &'m [Tree<'_, S>],
        states: &'m [TreeState<S>],
    ) -> (&'m TreeState<S>, &'m Tree<'m, S>)
    where
        Self: 'm,
    {
        match self.places[number] {
            Place::Tree(tree) => (&states[tree], &trees[tree]),
            Place::Part(part) => (&self.parts[part].state, &self.parts[part].own),
        }
    }
}

impl<S: Scalar> Members<'_, S> {
    /// Computes the states of all parts from the kinematics of their trees.
    pub(super) fn follow(&mut self, trees: &[Tree<'_, S>], states: &[TreeState<S>]) {
        for part in &mut self.parts {
            part.follow(&trees[part.tree], &states[part.tree]);
        }
    }

    /// Passes the modes of the joints of the trees to their parts.
    #[cold]
    pub(super) fn take_modes(&mut self, trees: &[Tree<'_, S>]) {
        self.parts.iter_mut().for_each(|part| part.take_modes(&trees[part.tree]));
    }

    /// Computes the states and the balances of all parts for a row.
    #[cold]
    pub(super) fn prepare_rows(&mut self, trees: &[Tree<'_, S>], states: &[TreeState<S>]) {
        self.follow(trees, states);
        self.parts.iter_mut().for_each(Part::update_balance);
    }
}

impl<'a, S: Scalar> Part<'a, S> {
    /// Creates the part for a system that joins a tree; `tree` is the index of the tree and `share` the index
    /// of the system among its members. `state` and `own` are those at the instant at which the system joins
    /// the tree, before any impulse.
    pub(super) fn new(
        (tree, share): (usize, usize),
        member: Member,
        mut state: TreeState<S>,
        own: Tree<'a, S>,
    ) -> Self {
        state.center = None; // only the centre of mass of the tree is integrated
        state.clock = None;
        let energy = momentum_energy_com(&own.model, &own.data, &state.q, &state.v).1;
        let (work_ahead, dissipated_before) = (state.work - energy, state.dissipated);
        Self { tree, share, member, state, own, sign: 1.0, work_ahead, dissipated_before }
    }

    /// Computes the state of the system and its kinematics from the state and the kinematics of its tree.
    pub(super) fn follow(&mut self, tree: &Tree<'_, S>, state: &TreeState<S>) {
        let base = &self.member.bodies[0];
        let body = &tree.data.bodies[base.body];
        let rot_wb = base_rotation(&state.q);
        let offset = body.rot_bk * Vec3::of(&base.pos_kb);
        let position = rot_wb * (body.pos_b + offset) + Vec3::from_slice(&state.q);
        position.write(&mut self.state.q);
        let attitude = attitude_of(&tree.model, &state.q, base);
        let turned = if self.sign < 0.0 { Quat { v: -attitude.v, w: -attitude.w } } else { attitude };
        turned.write_xyzw(&mut self.state.q[3..]);
        let rot_bp = body.rot_bk * Mat3::of(&base.rot_kb);
        rot_bp.transpose_mul(body.velocity.at(offset)).write(&mut self.state.v);
        rot_bp.transpose_mul(body.velocity.angular).write(&mut self.state.v[3..]);
        for (own, &joint) in self.member.joints.iter().enumerate() {
            self.state.q[BASE_NQ + own] = state.q[BASE_NQ + joint];
            self.state.v[BASE_NV + own] = state.v[BASE_NV + joint];
        }
        self.state.dissipated = self.dissipated_before + state.shares[self.share];
        self.own.follow_frame(tree.frame_velocity());
        self.own.update_stage_kinematics(&mut self.state);
    }

    /// Chooses the sign of the base quaternion so that the quaternion is continuous with `before`, (x, y, z,
    /// w). Requires the kinematics of the tree.
    pub(super) fn choose_sign(&mut self, before: &[S]) {
        let dot: f64 = before.iter().zip(&self.state.q[3..]).map(|(a, b)| a.value() * b.value()).sum();
        if dot < 0.0 {
            self.sign = -self.sign;
            self.state.q[3..BASE_NQ].iter_mut().for_each(|x| *x = -*x);
        }
    }

    /// Computes the impulse and the work of the system from the changes of its momentum and of its kinetic
    /// energy. Both include the effect of the connections to other systems. Requires the state and the
    /// kinematics of the system relative to W.
    pub(super) fn update_balance(&mut self) {
        let (h, energy, _) =
            momentum_energy_com(&self.own.model, &self.own.data, &self.state.q, &self.state.v);
        let start = &self.state.initial_momentum;
        self.state.impulse = Momentum { linear: h.linear - start.linear, angular: h.angular - start.angular };
        self.state.work = energy + self.work_ahead;
    }

    /// Returns the state that [`Part::restore`] restores.
    pub(super) fn save(&self) -> SavedPart {
        SavedPart {
            state: self.state.map(|x| x.value()),
            sign: self.sign,
            work_ahead: self.work_ahead.value(),
            dissipated_before: self.dissipated_before.value(),
        }
    }

    /// Restores the state that [`Part::save`] returned.
    pub(super) fn restore(&mut self, saved: SavedPart) {
        self.state = saved.state.map(|x| S::of(*x));
        (self.sign, self.work_ahead) = (saved.sign, S::of(saved.work_ahead));
        self.dissipated_before = S::of(saved.dissipated_before);
    }

    /// Returns the data of the system that the computation of external wrenches reads and writes.
    pub(super) fn loaded(&mut self) -> LoadedSystem<'_, S> {
        self.own.loaded(&self.state.q)
    }

    /// Adds the external wrenches on the bodies of the system to those on the bodies of its tree.
    pub(super) fn add_wrenches_to(&self, tree: &mut Tree<'_, S>) {
        self.add_wrenches(&self.member, &mut tree.data);
    }

    /// Adds the external wrenches on the bodies of the system to those in `tree`, in which `member` is the
    /// place of the system.
    pub(super) fn add_wrenches<T: Scalar>(&self, member: &Member, tree: &mut Data<T>) {
        let base = &member.bodies[0];
        let rot_bp = tree.bodies[base.body].rot_bk * Mat3::of(&base.rot_kb);
        let vector = |v: &Vec3<S>| v.map(|x| T::of(x.value()));
        for (body, place) in self.own.data.bodies.iter().zip(&member.bodies) {
            let to = &mut tree.bodies[place.body];
            let force = rot_bp * vector(&body.external.linear);
            let moment = rot_bp * vector(&body.external.angular);
            to.external += Force::at(force, moment, to.rot_bk * Vec3::of(&place.pos_kb));
        }
    }

    /// Passes the commanded torques and the accelerations requested for joints with friction compensation to
    /// the tree.
    pub(super) fn drive(&self, tree: &mut Tree<'_, S>) {
        for (own, &joint) in self.member.joints.iter().enumerate() {
            tree.command[joint] = self.own.command[own];
            tree.modes.requested_mut()[joint] = self.own.modes.requested()[own];
        }
    }

    /// Copies the modes of the joints of the system from those of the tree.
    pub(super) fn take_modes(&mut self, tree: &Tree<'_, S>) {
        self.own.modes.take(&tree.modes, &self.member.joints);
    }

    /// Returns the acceleration of the system, `(nv,)`, m/s² and rad/s², from the acceleration `a` of its
    /// tree at `state`, relative to W.
    pub(super) fn acceleration(&self, tree: &Tree<'_, S>, state: &TreeState<S>, a: &[S]) -> Vec<S> {
        let ([q, v], a) = (state.values(), a.iter().map(|x| x.value()).collect::<Vec<f64>>());
        let mut data = Data::<f64>::new(&tree.model);
        inverse_dynamics(&tree.model, &mut data, &q, &v, &a, &[], &mut vec![0.0; v.len()]);
        let base = &self.member.bodies[0];
        let body = &data.bodies[base.body];
        let rot_bp = body.rot_bk * base.rot_kb;
        let mut own = vec![S::of(0.0); self.state.v.len()];
        let mut write = |start: usize, vector: Vec3<f64>| {
            vector.map(|x| S::of(*x)).write(&mut own[start..]);
        };
        // the derivative of a twist in body-fixed axes is the spatial acceleration
        write(0, rot_bp.transpose_mul(body.acceleration.at(body.rot_bk * base.pos_kb)));
        write(3, rot_bp.transpose_mul(body.acceleration.angular));
        for (joint, &in_tree) in self.member.joints.iter().enumerate() {
            own[BASE_NV + joint] = S::of(a[BASE_NV + in_tree]);
        }
        own
    }
}

/// Returns the attitude in W of a body at a place in a tree: the product of the rotations along the path from
/// the base. Unlike a quaternion computed from a rotation matrix, this product is continuous in the joint
/// positions.
fn attitude_of<S: Real>(tree: &Model, q: &[S], place: &BodyPlace) -> Quat<S> {
    let constant = |q: Quat<f64>| Quat { v: Vec3::of(&q.v), w: S::of(q.w) };
    let mut attitude = constant(place.quaternion());
    let mut body = place.body;
    while body > 0 {
        let node = &tree.nodes()[body];
        if node.axis == Axis::Revolute {
            let (sin, cos) = (q[BASE_NQ + body - 1] * S::of(0.5)).sin_cos();
            let turn = Quat { v: Vec3::new(S::of(0.0), S::of(0.0), sin), w: cos };
            attitude = turn.product(attitude);
        }
        attitude = constant(Quat::from_matrix(&node.rot_pk)).product(attitude);
        body = node.parent;
    }
    Quat::from_xyzw(&q[3..]).product(attitude).normalized()
}
