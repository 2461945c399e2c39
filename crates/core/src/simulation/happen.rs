//! Application of events between two steps: captures and releases, and brakes that are engaged or disengaged.

use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::event_audit::{Applied, Snapshot};
use super::latch::Latch;
use super::members::Part;
use super::recording::{EventKind, EventRecord};
use super::run_state::RunState;
use crate::spatial::{Force, Quat, Scalar, Vec3};
use crate::world::{Action, FrameIndex, RigidPose, Seat, Seating, Weld, WorldError, impulse_response};

impl<S: Scalar> RunState<'_, S> {
    /// Applies the events that are due at `t`, s, the start of a step over `interval`, s, in the order of
    /// their declaration. If any of them has an effect, one row is recorded before them and one after them.
    /// Requires the kinematics of the current state, with projected base twists, in the equations of motion.
    #[inline(never)]
    pub(super) fn happen(&mut self, t: f64, interval: (f64, f64)) -> Result<(), SimulationError> {
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

    /// Moves the records of touch-downs and lift-offs from the contacts to the events that have happened.
    pub(super) fn take_touches(&mut self) {
        let Self { equations, events, numbers, .. } = self;
        if equations.contacts.happened.is_empty() {
            return;
        }
        for mut record in equations.contacts.happened.drain(..) {
            record.systems = record.systems.map(|system| numbers[system]);
            events.records.push(record);
        }
    }

    /// Determines which latches satisfy their conditions at `t`, s, and sets or clears the times at which
    /// their captures are due.
    fn update_latches(&mut self, t: f64) {
        let EquationsOfMotion { trees, latches, contacts, .. } = &mut self.equations;
        for latch in latches {
            latch.is_touching = contacts.are_touching(&latch.touching);
            let holds = latch.is_touching && Latch::holds(latch.inside(trees, &self.state.trees));
            if holds != latch.is_held {
                latch.is_held = holds;
                let state = &mut self.events.states[latch.event];
                (state.is_held, state.due) = (holds, holds.then_some(t + latch.envelope.held_for));
            }
        }
    }

    /// Returns true if the event with index `number` has an effect. A release of frames that are not
    /// connected has none, and neither has the engagement of an engaged brake or the disengagement of a
    /// disengaged one.
    fn has_effect(&self, number: usize) -> bool {
        match self.events.list[number].action {
            Action::Capture { .. } => true,
            Action::Release { capture, .. } => self.weld_of(capture).is_some(),
            Action::Engage(brake) => !self.brake(brake).is_engaged,
            Action::Disengage(brake) => self.brake(brake).is_engaged,
        }
    }

    fn weld_of(&self, capture: usize) -> Option<usize> {
        self.connections.active.welds.iter().position(|weld| weld.capture == capture)
    }

    fn execute(&mut self, number: usize, t: f64) -> Result<EventRecord, SimulationError> {
        let record = self.keep_balance(|run| match run.events.list[number].action {
            Action::Capture { by, of, seat } => run.capture(number, [by, of], seat, t),
            Action::Release { capture, impulse } => run.release(number, capture, impulse, t),
            Action::Engage(brake) => Ok(run.engage(number, brake, t)),
            Action::Disengage(brake) => Ok(run.disengage(number, brake, t)),
        })?;
        self.ledger.work -= record.energy_lost;
        self.ledger.dissipated += record.energy_lost.max(0.0);
        Ok(record)
    }

    /// Assembles new trees without the joints of seating motions that have ended by `t`, s; the frames are
    /// then rigidly connected at the nominal pose.
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
        if has_ended { self.keep_balance(|run| run.recompile(t)).map(|_| ()) } else { Ok(()) }
    }

    /// Calls `change`, which assembles new trees, and corrects the ledger so that the totals of the group do
    /// not change, although the integrals of new trees start at zero.
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

    /// Connects two frames at `t`, s: rigidly at their current relative pose or, with `seat`, by a motion
    /// from that pose to a nominal pose. `number` is the index of the event.
    fn capture(
        &mut self,
        number: usize,
        frames: [FrameIndex; 2],
        seat: Option<Seat>,
        t: f64,
    ) -> Result<EventRecord, SimulationError> {
        let [by, of] = frames;
        let captured = self.connections.connected_to(of.system);
        let closes_loop = captured.contains(&by.system);
        if closes_loop && seat.is_some() {
            let name = |place: FrameIndex| self.layout.systems()[place.system].name.clone();
            let (event, first, second) = (self.events.list[number].name.clone(), name(by), name(of));
            return Err(WorldError::SeatInLoop { event, time: t, first, second }.into());
        }
        let before = self.snapshots();
        let [pose_by, pose_of] = frames.map(|place| self.pose_and_twist(place, &before).0);
        let rot_by_of = pose_by.rot_wf.transpose() * pose_of.rot_wf;
        let (mut rotation, mut position) = ([0.0; 4], [0.0; 3]);
        Quat::from_matrix(&rot_by_of).normalized().write_xyzw(&mut rotation);
        pose_by.rot_wf.transpose_mul(pose_of.pos_w - pose_by.pos_w).write(&mut position);
        let pose = RigidPose { rotation, position };
        let seating = seat.map(|Seat { duration, pose }| Seating { start: t, duration, pose });
        self.connections.add(Weld { capture: number, by, of, pose, seating });
        let impulses = self.recompile(t)?;
        let mut record = self.audit(&Applied {
            number,
            kind: EventKind::Capture,
            time: t,
            frames,
            before: &before,
            pushed: &captured,
            point: pose_of.pos_w,
            spring_work: 0.0,
        });
        if closes_loop {
            // both systems belong to the same tree, whose momentum does not change
            let name = self.connections.active.welds.last().map(Weld::loop_name);
            let own = impulses.into_iter().find(|(closing, _)| Some(closing) == name.as_ref());
            record.impulse = own.map_or([0.0; 6], |(_, impulse)| impulse);
        }
        Ok(record)
    }

    /// Removes the connection of the event with index `capture`. Then applies `impulse`, N s and N m s, to
    /// the system of the captured frame, and the opposite impulse to the other system. The impulse acts at
    /// the origin of the capturing frame and is in the axes of this frame.
    fn release(
        &mut self,
        number: usize,
        capture: usize,
        impulse: [f64; 6],
        t: f64,
    ) -> Result<EventRecord, SimulationError> {
        let weld = self.weld_of(capture).expect("the capture is active");
        let Weld { by, of, .. } = self.connections.active.welds[weld];
        let before = self.snapshots();
        self.connections.remove(weld);
        self.recompile(t)?;
        let spring_work = if impulse == [0.0; 6] { 0.0 } else { self.push_apart([by, of], impulse, &before) };
        Ok(self.audit(&Applied {
            number,
            kind: EventKind::Release,
            time: t,
            frames: [by, of],
            before: &before,
            pushed: &self.connections.connected_to(of.system),
            point: self.pose_and_twist(by, &before).0.pos_w,
            spring_work,
        }))
    }

    /// Applies an impulse to the tree of the second frame and the opposite impulse to the tree of the first.
    /// The impulse, N s and N m s, acts at the origin of the first frame and is in the axes of this frame.
    /// Returns the work of the impulses, J: `½ Σ iᵀ (u⁻ + u⁺)` over both frames, with the impulses `i` on
    /// them and their twists `u⁻` before and `u⁺` after the impulses.
    fn push_apart(&mut self, frames: [FrameIndex; 2], impulse: [f64; 6], states: &[Snapshot]) -> f64 {
        let [(pose_by, twist_by), (pose_of, twist_of)] =
            frames.map(|place| self.pose_and_twist(place, states));
        let impulse = Force::from_slice(&impulse);
        let force = pose_by.rot_wf * impulse.linear;
        let moment = pose_by.rot_wf * impulse.angular;
        let on_by = -Force::new(force, moment);
        let on_of = Force::new(force, moment + (pose_by.pos_w - pose_of.pos_w).cross(force));
        let to_of = |vector: Vec3<f64>| pose_of.rot_wf.transpose_mul(vector);
        let in_frames = [-impulse, Force::new(to_of(on_of.linear), to_of(on_of.angular))];
        for (place, impulse) in frames.into_iter().zip(in_frames) {
            let (tree, frame) = self.frame_in_tree(place);
            let (moved, state) = (&mut self.equations.trees[tree], &mut self.state.trees[tree]);
            let [q, _] = state.values();
            let given = moved.modes.given().iter().map(|given| given.joint);
            let locked: Vec<usize> = given.chain(moved.modes.held()).collect();
            let change = impulse_response(&moved.model, &q, frame, impulse, &locked);
            moved.jump(state, &change);
        }
        let EquationsOfMotion { trees, members, .. } = &mut self.equations;
        members.follow(trees, &self.state.trees);
        let after = self.snapshots();
        let [after_by, after_of] = frames.map(|place| self.pose_and_twist(place, &after).1);
        0.5 * ((twist_by + after_by).dot(on_by) + (twist_of + after_of).dot(on_of))
    }
}
