//! Assembly of the trees of a run for its active connections.

use super::accuracy::Accuracy;
use super::connections::SavedMembers;
use super::error::SimulationError;
use super::integrator::Stages;
use super::latch::Latch;
use super::members::{Members, Part, Place};
use super::modes::{JointModes, StepMethod};
use super::mover::Mover;
use super::run_state::RunState;
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::dynamics::{Momentum, center_of_mass};
use crate::model::{BASE_NQ, Model};
use crate::spatial::{Force, Real, Scalar, Vec3};
use crate::world::{
    Action, Assembly, Balance, FrameIndex, GivenJoint, Member, Moving, When, connected_velocity,
    loop_impulses,
};
use std::borrow::Cow;

/// System that has been removed from its tree before the next assembly: its state and its kinematics in its
/// own coordinates.
struct Loose<'a, S> {
    state: TreeState<S>,
    own: Tree<'a, S>,
    sign: f64,
}

impl<'a, S: Scalar> RunState<'a, S> {
    /// Assembles the trees for the active connections at `t`, s. Trees whose members, closed loops and joints
    /// with prescribed motion do not change remain the same. The other trees receive the states of their
    /// members and preserve their momenta. Requires the kinematics of the state, relative to W, in the trees,
    /// and the states of the parts; afterwards the new trees hold their kinematics. With an external engine,
    /// the connections are passed to the engine, and each system remains a tree.
    ///
    /// Returns the impulses of the closed loops of the new trees; see [`loop_impulses`].
    pub(super) fn recompile(&mut self, t: f64) -> Result<Vec<(String, [f64; 6])>, SimulationError> {
        if self.mover.is_external() {
            self.pass_welds();
            self.find_latches();
            return Ok(Vec::new());
        }
        self.conclude_trees();
        let assemblies = self.connections.assemble()?;
        let members = std::mem::replace(&mut self.equations.members, Members::alone(0));
        let mut sizes = vec![0; self.equations.trees.len()];
        members.parts.iter().for_each(|part| sizes[part.tree] += 1);
        let mut old = Old {
            sizes,
            trees: std::mem::take(&mut self.equations.trees).into_iter().map(Some).collect(),
            states: std::mem::take(&mut self.state.trees).into_iter().map(Some).collect(),
            parts: members.parts.into_iter().map(Some).collect(),
            places: members.places,
            impulses: Vec::new(),
        };
        let mut new = Members::alone(old.places.len());
        for Assembly { model, members, given } in assemblies {
            let tree = self.equations.trees.len();
            let (moved, state) = match (&model, old.unchanged(model.as_ref(), &members, &given)) {
                (None, _) => {
                    let Loose { own, state, .. } = old.take(members[0].system);
                    new.places[members[0].system] = Place::Tree(tree);
                    (own, state)
                }
                (Some(_), Some(number)) => old.take_tree(number, tree, &mut new),
                (Some(model), None) => join((model.clone(), members, given), (tree, t), &mut old, &mut new),
            };
            self.equations.trees.push(moved);
            self.state.trees.push(state);
        }
        self.equations.members = new;
        follow_centers(&self.equations.trees, &mut self.state.trees);
        self.resize()?;
        Ok(old.impulses)
    }

    /// Allocates all buffers whose dimensions depend on the trees, and updates the contacts, the latches and
    /// the trees that controllers know.
    fn resize(&mut self) -> Result<(), SimulationError> {
        if let Mover::Native(method) = &mut self.mover {
            let control = method.integration.control().cloned();
            *method = StepMethod::new(&self.state, &self.step_settings);
            if let Some(before) = control {
                method.integration.continue_from(before);
            }
        }
        self.row_buffers = (self.state.clone(), Stages::new(&self.state));
        let (trees, steps) = (&self.equations.trees, self.schedule.grid_steps());
        self.accuracy = Accuracy::of(trees, &self.state, self.accuracy.measures(), steps)?;
        self.place_contacts();
        self.find_latches();
        self.find_known()
    }

    /// Sets, for every frame of a contact, the index of its tree and its index in the model of that tree.
    fn place_contacts(&mut self) {
        let mut contacts = std::mem::take(&mut self.equations.contacts);
        contacts.place(|place| self.frame_in_tree(place));
        self.equations.contacts = contacts;
    }

    /// Finds the latches whose captures have not happened and whose frames belong to systems that are not
    /// connected.
    pub(super) fn find_latches(&mut self) {
        let mut latches = Vec::new();
        for (event, (declared, state)) in self.events.list.iter().zip(&self.events.states).enumerate() {
            let (When::Latch(envelope), &Action::Capture { by, of, .. }) = (&declared.when, &declared.action)
            else {
                continue;
            };
            let frames = [by, of].map(|place| self.frame_in_tree(place));
            let is_apart = !self.connections.connected_to(by.system).contains(&of.system);
            if state.happened.is_none() && is_apart {
                let touching = self.equations.contacts.numbers_of(&envelope.touching);
                let is_touching = self.equations.contacts.are_touching(&touching);
                let (envelope, is_held) = (envelope.clone(), state.is_held);
                latches.push(Latch { event, frames, envelope, touching, is_touching, is_held });
            }
        }
        self.equations.latches = latches;
    }

    /// Returns the index of the tree that contains a frame of a system, and the index of the frame in the
    /// model of the tree.
    pub(super) fn frame_in_tree(&self, place: FrameIndex) -> (usize, usize) {
        match self.equations.members.places[place.system] {
            Place::Tree(tree) => (tree, place.frame),
            Place::Part(part) => {
                let tree = self.equations.members.parts[part].tree;
                let frame = self.equations.trees[tree].model.frame(self.connections.frame_name(place));
                (tree, frame.expect("a tree has the frames of its members"))
            }
        }
    }
}

/// Returns the total momentum of systems, W axes, N s and N m s, with the angular part about `center` in W,
/// m.
fn momentum_of<S: Scalar>(systems: &[Moving<'_>], center: Vec3<S>) -> Momentum<S> {
    let point = center.map(|x| x.value());
    let balances = systems.iter().map(|system| Balance::of(system.model, system.q, system.v, point));
    let total = balances.fold(Force::zero(), |sum, balance| sum + balance.momentum);
    let lift = |vector: Vec3<f64>| vector.map(|x| S::of(*x));
    Momentum { linear: lift(total.linear), angular: lift(total.angular) }
}

/// Initializes the centres of mass that are integrated from the momenta of several trees. For a single tree,
/// the centre of mass is not integrated. Requires the kinematics of the states in the trees.
pub(super) fn follow_centers<S: Real>(trees: &[Tree<'_, S>], states: &mut [TreeState<S>]) {
    let is_needed = states.len() > 1;
    for (tree, state) in trees.iter().zip(states) {
        let center = || center_of_mass(&tree.data, &state.q);
        state.center = is_needed.then(|| state.center.unwrap_or_else(center));
    }
}

/// Trees, states and parts before an assembly; each entry becomes `None` when the assembly has used it.
struct Old<'a, S> {
    trees: Vec<Option<Tree<'a, S>>>,
    states: Vec<Option<TreeState<S>>>,
    parts: Vec<Option<Part<'a, S>>>,
    places: Vec<Place>,
    /// Number of the parts of each tree.
    sizes: Vec<usize>,
    /// Names of the closed loops of new trees, with their impulses, N s and N m s.
    impulses: Vec<(String, [f64; 6])>,
}

impl<'a, S: Scalar> Old<'a, S> {
    /// Returns the index of the tree that has exactly these members, these joints with prescribed motion and
    /// the closed loops of `model`; `None` if there is no such tree or no `model`.
    fn unchanged(&self, model: Option<&Model>, members: &[Member], given: &[GivenJoint]) -> Option<usize> {
        let tree = |system: usize| match self.places[system] {
            Place::Part(part) => self.parts[part].as_ref().map(|part| part.tree),
            Place::Tree(_) => None,
        };
        let first = tree(members[0].system)?;
        let is_same = members.iter().all(|member| tree(member.system) == Some(first));
        let before = self.trees[first].as_ref()?;
        let has_given = before.modes.given() == given;
        let has_loops =
            model.is_some_and(|model| model.description().loops() == before.model.description().loops());
        (is_same && has_given && has_loops && self.sizes[first] == members.len()).then_some(first)
    }

    /// Removes the tree with index `number`, which has several members, from the old trees and returns it.
    /// Its index among the new trees is `to`.
    fn take_tree(
        &mut self,
        number: usize,
        to: usize,
        new: &mut Members<'a, S>,
    ) -> (Tree<'a, S>, TreeState<S>) {
        for part in &mut self.parts {
            if let Some(mut part) = part.take_if(|part| part.tree == number) {
                part.tree = to;
                new.places[part.member.system] = Place::Part(new.parts.len());
                new.parts.push(part);
            }
        }
        let taken = self.trees[number].take().zip(self.states[number].take());
        taken.expect("every tree is taken once")
    }

    /// Removes a system from its tree and returns it.
    fn take(&mut self, system: usize) -> Loose<'a, S> {
        match self.places[system] {
            Place::Tree(tree) => {
                let taken = self.trees[tree].take().zip(self.states[tree].take());
                let (own, state) = taken.expect("every system is taken once");
                Loose { state, own, sign: 1.0 }
            }
            Place::Part(part) => {
                let Part { state, own, sign, .. } =
                    self.parts[part].take().expect("every system is taken once");
                Loose { state, own, sign }
            }
        }
    }
}

/// Joins systems at `t`, s, into a tree with this model, these members and these joints with prescribed
/// motion. The index of the tree is `number`.
fn join<'a, S: Scalar>(
    (model, members, given): (Model, Vec<Member>, Vec<GivenJoint>),
    (number, t): (usize, f64),
    old: &mut Old<'a, S>,
    new: &mut Members<'a, S>,
) -> (Tree<'a, S>, TreeState<S>) {
    let loose: Vec<Loose<'a, S>> = members.iter().map(|member| old.take(member.system)).collect();
    let states: Vec<_> = loose.iter().map(|one| one.state.values()).collect();
    let mut q = vec![0.0; model.nq()];
    q[..BASE_NQ].copy_from_slice(&states[0][0][..BASE_NQ]);
    for (member, [own, _]) in members.iter().zip(&states) {
        member.joints.iter().enumerate().for_each(|(j, &joint)| q[BASE_NQ + joint] = own[BASE_NQ + j]);
    }
    let mut rates = Vec::new();
    for joint in &given {
        let [position, rate, _] = joint.at(t);
        q[BASE_NQ + joint.joint] = position;
        rates.push((joint.joint, rate));
    }
    let parts = members.iter().zip(&loose).zip(&states);
    let moving: Vec<_> =
        parts.map(|((member, one), [q, v])| Moving { member, model: &one.own.model, q, v }).collect();
    let held = held_joints(&loose, &members).map(|joint| (joint, 0.0));
    let locked: Vec<(usize, f64)> = rates.iter().copied().chain(held).collect();
    let (v, loops) = connected_velocity(&model, &q, &moving, &locked);
    old.impulses.extend(loop_impulses(&model, &q, &loops));
    let modes = loose.iter().zip(&members).map(|(one, member)| (&one.own.modes, &member.joints[..]));
    let modes = JointModes::joined(model.joint_count(), given, modes);
    let mut tree = Tree::with_modes(Cow::Owned(model), modes);
    let lift = |x: Vec<f64>| x.into_iter().map(S::of).collect::<Vec<S>>();
    let mut state = TreeState::at(&tree.model, &mut tree.data, lift(q), lift(v));
    state.initial_momentum = momentum_of(&moving, center_of_mass(&tree.data, &state.q));
    state.shares = vec![S::of(0.0); members.len()];
    state.clock = (!rates.is_empty()).then(|| S::of(t));
    tree.project_momentum(&mut state);
    tree.shares = members.iter().map(|member| member.joints.clone()).collect();
    for (share, (member, Loose { state: before, own, sign })) in members.into_iter().zip(loose).enumerate() {
        let quaternion = before.q[3..BASE_NQ].to_vec();
        let mut part = Part::new((number, share), member, before, own);
        part.sign = sign;
        part.drive(&mut tree);
        part.follow(&tree, &state);
        part.choose_sign(&quaternion);
        new.places[part.member.system] = Place::Part(new.parts.len());
        new.parts.push(part);
    }
    (tree, state)
}

/// Returns the indices, in the tree of `members`, of the joints that brakes hold rigidly.
fn held_joints<S: Real>(loose: &[Loose<'_, S>], members: &[Member]) -> impl Iterator<Item = usize> {
    let pairs = loose.iter().zip(members);
    pairs.flat_map(|(one, member)| one.own.modes.held().map(|joint| member.joints[joint]))
}

impl<S: Scalar> RunState<'_, S> {
    /// Returns the state of the connections and of the systems that share trees, for checkpoints.
    pub(super) fn save_members(&self) -> SavedMembers {
        let parts = self.equations.members.parts.iter().map(Part::save).collect();
        SavedMembers { active: self.connections.active.clone(), parts }
    }

    /// Restores the connections and the states of the systems that share trees; the states of the trees must
    /// be restored afterwards.
    pub(super) fn restore_members(&mut self, saved: SavedMembers) -> Result<(), SimulationError> {
        if self.connections.active != saved.active {
            self.connections.active = saved.active;
            self.recompile(self.time)?;
        }
        for (part, saved) in self.equations.members.parts.iter_mut().zip(saved.parts) {
            part.restore(saved);
        }
        Ok(())
    }
}
