//! Events at a cut: captures and releases, with their audits.

use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::latch::Latch;
use super::members::Part;
use super::recording::{EventKind, EventRecord};
use super::run_state::RunState;
use crate::dynamics::{Data, FramePose, frame_pose, frame_velocity, kinematics};
use crate::model::Model;
use crate::spatial::{Force, Motion, Quat, Scalar, Vec3};
use crate::world::{
    Action, Balance, FrameIndex, RigidPose, Seat, Seating, Weld, WorldError, energy, energy_of_change,
    impulse_response,
};

/// State of a system in `f64`.
struct Snapshot {
    q: Vec<f64>,
    v: Vec<f64>,
}

impl<S: Scalar> RunState<'_, S> {
    /// Applies the events that are due at `t`, s, in the order of their declaration. There is one row before them and
    /// one after them. Expects kinematics with projected base twists in the equations of motion.
    pub(super) fn happen(&mut self, t: f64, interval: (f64, f64)) -> Result<(), SimulationError> {
        if self.events.list.is_empty() {
            return Ok(());
        }
        self.end_seatings(t)?;
        self.update_latches(t);
        while let Some(number) = self.events.next_due(t, &self.schedule) {
            if self.has_effect(number) {
                if !self.has_event && t < self.records_before {
                    self.record_before_jump(t, interval)?;
                }
                self.has_event = true;
                let record = self.execute(number, t)?;
                self.events.records.push(record);
            }
            self.events.happen(number, t);
            self.find_latches();
            self.update_latches(t);
        }
        self.events_changed();
        Ok(())
    }

    /// Opens and closes the latches at `t`, s.
    fn update_latches(&mut self, t: f64) {
        let EquationsOfMotion { trees, latches, .. } = &mut self.equations;
        for latch in latches {
            let holds = Latch::holds(latch.inside(trees, &self.state.trees));
            if holds != latch.is_held {
                latch.is_held = holds;
                let state = &mut self.events.states[latch.event];
                (state.is_held, state.due) = (holds, holds.then_some(t + latch.envelope.held_for));
            }
        }
    }

    /// Returns true if an event changes anything: the release of what is not connected does not.
    fn has_effect(&self, number: usize) -> bool {
        match self.events.list[number].action {
            Action::Capture { .. } => true,
            Action::Release { capture, .. } => self.weld_of(capture).is_some(),
        }
    }

    fn weld_of(&self, capture: usize) -> Option<usize> {
        self.connections.active.welds.iter().position(|weld| weld.capture == capture)
    }

    fn execute(&mut self, number: usize, t: f64) -> Result<EventRecord, SimulationError> {
        let record = self.keep_balance(|run| match run.events.list[number].action {
            Action::Capture { by, of, seat } => run.capture(number, (by, of), seat, t),
            Action::Release { capture, impulse } => run.release(number, capture, impulse, t),
        })?;
        self.ledger.work -= record.energy_lost;
        self.ledger.dissipated += record.energy_lost.max(0.0);
        Ok(record)
    }

    /// Compiles new trees for the connections whose seating has ended by `t`, s: they are rigid at the nominal pose.
    fn end_seatings(&mut self, t: f64) -> Result<(), SimulationError> {
        let (schedule, welds) = (&self.schedule, &mut self.connections.active.welds);
        let mut has_ended = false;
        for weld in welds {
            if weld.seated_at().is_some_and(|end| !schedule.is_later(end, t))
                && let Some(seating) = weld.seating.take()
            {
                (weld.pose, has_ended) = (seating.pose, true);
            }
        }
        if has_ended { self.keep_balance(|run| run.recompile(t)) } else { Ok(()) }
    }

    /// Calls `change`, which compiles new trees, and keeps the balance of the group: the new trees count from zero.
    fn keep_balance<T>(
        &mut self,
        change: impl FnOnce(&mut Self) -> Result<T, SimulationError>,
    ) -> Result<T, SimulationError> {
        let EquationsOfMotion { trees, members, .. } = &mut self.equations;
        members.follow(trees, &self.state.trees);
        members.parts.iter_mut().for_each(Part::update_balance);
        let before = self.totals(&self.state);
        let changed = change(self)?;
        let after = self.totals(&self.state);
        self.ledger.impulse.linear += before.impulse.linear - after.impulse.linear;
        self.ledger.impulse.angular += before.impulse.angular - after.impulse.angular;
        self.ledger.work += before.work - after.work;
        self.ledger.dissipated += before.dissipated - after.dissipated;
        Ok(changed)
    }

    /// Connects two frames rigidly at their current relative pose, or from there in the motion `seat` to a nominal pose.
    fn capture(
        &mut self,
        number: usize,
        (by, of): (FrameIndex, FrameIndex),
        seat: Option<Seat>,
        t: f64,
    ) -> Result<EventRecord, SimulationError> {
        if self.connections.connected_to(by.system).contains(&of.system) {
            let name = |place: FrameIndex| self.layout.systems()[place.system].name.clone();
            let (event, first, second) = (self.events.list[number].name.clone(), name(by), name(of));
            return Err(WorldError::AlreadyConnected { event, time: t, first, second }.into());
        }
        let (roots, captured) =
            ([self.root_of(by.system), self.root_of(of.system)], self.tree_members(of.system));
        let before = self.snapshots();
        let [pose_by, pose_of] = [by, of].map(|place| self.pose_and_twist(place, &before).0);
        let point = pose_of.pos_w;
        let rot_by_of = pose_by.rot_wf.transpose() * pose_of.rot_wf;
        let (mut rotation, mut position) = ([0.0; 4], [0.0; 3]);
        Quat::from_matrix(&rot_by_of).normalized().write_xyzw(&mut rotation);
        pose_by.rot_wf.transpose_mul(pose_of.pos_w - pose_by.pos_w).write(&mut position);
        let active = &mut self.connections.active;
        let pose = RigidPose { rotation, position };
        let seating = seat.map(|Seat { duration, pose }| Seating { start: t, duration, pose });
        active.welds.push(Weld { capture: number, by, of, pose, seating });
        active.roots.retain(|root| !roots.contains(root));
        active.roots.push(roots[0]);
        self.recompile(t)?;
        let mut record = self.audit(number, EventKind::Capture, t, (by, of), (&before, &captured), point);
        if self.mover.is_external() {
            return Ok(record); // the engine removes the relative velocity during the next steps
        }
        let after = self.snapshots();
        let twist = |snapshots: &[Snapshot]| self.relative_twist((by, of), snapshots);
        let (left, was) = (twist(&after), twist(&before));
        record.twist_left = [ratio(left.linear, was.linear), ratio(left.angular, was.angular)];
        Ok(record)
    }

    /// Removes a connection; `impulse` acts on the system of the captured frame.
    fn release(
        &mut self,
        number: usize,
        capture: usize,
        impulse: [f64; 6],
        t: f64,
    ) -> Result<EventRecord, SimulationError> {
        let weld = self.weld_of(capture).expect("the capture is active");
        let Weld { by, of, .. } = self.connections.active.welds.remove(weld);
        let before = self.snapshots();
        self.recompile(t)?;
        if self.mover.is_external() {
            let point = self.pose_and_twist(by, &before).0.pos_w;
            return Ok(self.audit(number, EventKind::Release, t, (by, of), (&before, &[]), point));
        }
        // the part that the root has left gets its own root
        for place in [by, of] {
            let root = self.root_of(place.system);
            if root == place.system && !self.connections.active.roots.contains(&root) {
                self.connections.active.roots.push(root);
            }
        }
        let point = self.pose_and_twist(by, &before).0.pos_w;
        if impulse != [0.0; 6] {
            self.push_apart((by, of), impulse, &before);
        }
        let released = self.tree_members(of.system);
        Ok(self.audit(number, EventKind::Release, t, (by, of), (&before, &released), point))
    }

    /// Applies an impulse, given in the axes of the frame `by` at its origin, to the tree of `of`, and the opposite one
    /// to the tree of `by`.
    fn push_apart(&mut self, (by, of): (FrameIndex, FrameIndex), impulse: [f64; 6], states: &[Snapshot]) {
        let [pose_by, pose_of] = [by, of].map(|place| self.pose_and_twist(place, states).0);
        let impulse = Force::from_slice(&impulse);
        let force = pose_by.rot_wf * impulse.linear;
        let moment = pose_by.rot_wf * impulse.angular + (pose_by.pos_w - pose_of.pos_w).cross(force);
        let to_of = |vector: Vec3<f64>| pose_of.rot_wf.transpose_mul(vector);
        let on_of = Force::new(to_of(force), to_of(moment));
        for (place, impulse) in [(by, -impulse), (of, on_of)] {
            let (tree, frame) = self.frame_in_tree(place);
            let (moved, state) = (&mut self.equations.trees[tree], &mut self.state.trees[tree]);
            let [q, _] = state.values();
            let given: Vec<usize> = moved.modes.given().iter().map(|given| given.joint).collect();
            let change = impulse_response(&moved.model, &q, frame, impulse, &given);
            moved.jump(state, &change);
        }
        let EquationsOfMotion { trees, members, .. } = &mut self.equations;
        members.follow(trees, &self.state.trees);
    }

    /// Returns the record of an event: the balances of all systems before it and now. The impulse is that on the systems
    /// `others`, about `point`.
    fn audit(
        &mut self,
        number: usize,
        kind: EventKind,
        t: f64,
        (by, of): (FrameIndex, FrameIndex),
        (before, others): (&[Snapshot], &[usize]),
        point: Vec3<f64>,
    ) -> EventRecord {
        let after = self.snapshots();
        let (mut totals, mut energies, mut lost) = ([Balance::default(); 2], [0.0; 2], 0.0);
        let mut impulse = Force::zero();
        for system in 0..self.systems.len() {
            let model = self.model(system);
            let states = [&before[system], &after[system]];
            let balances = states.map(|state| Balance::of(model, &state.q, &state.v, point));
            for (i, state) in states.into_iter().enumerate() {
                totals[i].add(&balances[i]);
                energies[i] += energy(model, &state.q, &state.v);
            }
            if others.contains(&system) {
                impulse += balances[1].momentum - balances[0].momentum;
            }
            lost += energy_of_change(model, &before[system].q, &before[system].v, &after[system].v);
        }
        // a joint whose rate is given does work during the impulse, which is not part of `lost`
        let is_driven = self.equations.trees.iter().any(|tree| !tree.modes.given().is_empty());
        let energy_lost = match kind {
            EventKind::Capture if !is_driven => lost,
            _ => energies[0] - energies[1],
        };
        let (mut impulse_w, mut point_w) = ([0.0; 6], [0.0; 3]);
        impulse.write(&mut impulse_w);
        point.write(&mut point_w);
        EventRecord {
            name: self.events.list[number].name.clone(),
            kind,
            time: t,
            systems: [by, of].map(|place| self.numbers[place.system]),
            impulse: impulse_w,
            point: point_w,
            energy_lost,
            momentum_error: totals[1].error_since(&totals[0]),
            twist_left: [0.0; 2],
            energy_error: ((energies[0] - energies[1]) - energy_lost).abs()
                / energies[0].max(energies[1]).max(f64::MIN_POSITIVE),
        }
    }

    /// Returns the model of a system.
    pub(super) fn model(&self, system: usize) -> &Model {
        let EquationsOfMotion { trees, members, .. } = &self.equations;
        &members.system(system, trees, &self.state.trees).1.model
    }

    /// Returns the systems in the same tree as a system.
    fn tree_members(&self, system: usize) -> Vec<usize> {
        (0..self.systems.len()).filter(|&other| self.tree_of(other) == self.tree_of(system)).collect()
    }

    /// Returns the states of all systems. Expects the states of the parts.
    fn snapshots(&self) -> Vec<Snapshot> {
        let EquationsOfMotion { trees, members, .. } = &self.equations;
        let snapshot = |system| {
            let state = members.system(system, trees, &self.state.trees).0;
            let [q, v] = state.values();
            Snapshot { q, v }
        };
        (0..self.systems.len()).map(snapshot).collect()
    }

    /// Returns the pose and the twist in W of a frame of a system.
    fn pose_and_twist(&self, place: FrameIndex, states: &[Snapshot]) -> (FramePose<f64>, Motion<f64>) {
        let (model, Snapshot { q, v }) = (self.model(place.system), &states[place.system]);
        let mut data = Data::<f64>::new(model);
        kinematics(model, &mut data, q, v);
        (frame_pose(model, &data, q, place.frame), frame_velocity(model, &data, q, place.frame))
    }

    /// Returns the twist of the second frame relative to the first, at the origin of the second.
    fn relative_twist(&self, (by, of): (FrameIndex, FrameIndex), states: &[Snapshot]) -> Motion<f64> {
        let (pose_by, twist_by) = self.pose_and_twist(by, states);
        let (pose_of, twist_of) = self.pose_and_twist(of, states);
        twist_of - twist_by.referred_to(pose_of.pos_w - pose_by.pos_w)
    }
}

/// Returns the magnitude of a vector relative to that of another one, or to 1 if that is larger.
fn ratio(left: Vec3<f64>, was: Vec3<f64>) -> f64 {
    left.norm() / was.norm().max(1.0)
}
