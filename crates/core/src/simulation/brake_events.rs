//! Application of events that engage and disengage brakes.

use super::checkpoint::SystemProgress;
use super::event_audit::{Applied, Snapshot};
use super::members::Place;
use super::recording::{EventKind, EventRecord};
use super::run_state::RunState;
use crate::dynamics::{Data, base_rotation, kinematics};
use crate::model::{Axis, BASE_NV};
use crate::spatial::{Scalar, Vec3};
use crate::world::{Brake, BrakeIndex, FrameIndex};

impl<S: Scalar> RunState<'_, S> {
    /// Returns the brake with this index; its field `is_engaged` is up to date.
    pub(super) fn brake(&self, at: BrakeIndex) -> &Brake {
        &self.systems[at.system].brakes[at.brake]
    }

    /// Engages a brake at `t`, s, and returns the record of this event, whose index is `number`. A brake with
    /// an infinite slip torque stops its joint by an impulse, `Δv = −M⁻¹ e_j q̇_j / (M⁻¹)_jj`, with the unit
    /// vector `e_j` and the rate `q̇_j` of the joint. The mass matrix `M` is that of the motions that closed
    /// loops and other braked joints permit. An external engine instead stops the joint during the next
    /// steps.
    pub(super) fn engage(&mut self, number: usize, at: BrakeIndex, t: f64) -> EventRecord {
        let (before, slip_torque) = (self.snapshots(), self.brake(at).slip_torque);
        let (tree, joint) = self.set_brake(at, true);
        let (mut impulse, mut lost) = (0.0, 0.0);
        let (moved, state) = (&mut self.equations.trees[tree], &mut self.state.trees[tree]);
        let is_rigid = slip_torque.is_infinite() && !self.mover.is_external();
        if is_rigid && state.v[BASE_NV + joint].value() != 0.0 {
            (impulse, lost) = moved.strike(joint, 0.0, state);
        }
        self.equations.members.follow(&self.equations.trees, &self.state.trees);
        self.record_of_brake((number, EventKind::Engage, t), at, &before, (impulse, lost))
    }

    /// Disengages a brake at `t`, s, and returns the record of this event, whose index is `number`.
    pub(super) fn disengage(&mut self, number: usize, at: BrakeIndex, t: f64) -> EventRecord {
        self.set_brake(at, false);
        self.record_of_brake((number, EventKind::Disengage, t), at, &self.snapshots(), (0.0, 0.0))
    }

    /// Restores the engagement of all brakes from a checkpoint. The modes of the joints must be restored
    /// afterwards.
    pub(super) fn restore_brakes(&mut self, saved: &[SystemProgress]) {
        for (system, saved) in saved.iter().enumerate() {
            for (brake, &is_engaged) in saved.engaged.iter().enumerate() {
                self.set_brake(BrakeIndex { system, brake }, is_engaged);
            }
        }
    }

    /// Engages or disengages a brake. Returns the index of its tree and the index of its joint in that tree.
    fn set_brake(&mut self, at: BrakeIndex, is_engaged: bool) -> (usize, usize) {
        let brake = &mut self.systems[at.system].brakes[at.brake];
        brake.is_engaged = is_engaged;
        let (joint, slip_torque) = (brake.joint, if is_engaged { brake.slip_torque } else { 0.0 });
        let (trees, members) = (&mut self.equations.trees, &mut self.equations.members);
        let (tree, in_tree) = match members.places[at.system] {
            Place::Tree(tree) => (tree, joint),
            Place::Part(part) => {
                let part = &mut members.parts[part];
                part.own.modes.set_brake(joint, slip_torque);
                (part.tree, part.member.joints[joint])
            }
        };
        trees[tree].modes.set_brake(in_tree, slip_torque);
        self.pass_brakes();
        (tree, in_tree)
    }

    /// Returns the record of the engagement or disengagement of a brake, with the impulse, N m s or N s, on
    /// its joint and the energy lost, J.
    fn record_of_brake(
        &self,
        (number, kind, time): (usize, EventKind, f64),
        at: BrakeIndex,
        before: &[Snapshot],
        (impulse, lost): (f64, f64),
    ) -> EventRecord {
        let (axis, point, is_revolute) = self.joint_axis(at, &before[at.system]);
        let place = FrameIndex { system: at.system, frame: 0 };
        let mut record = self.audit(&Applied {
            number,
            kind,
            time,
            frames: [place; 2],
            before,
            pushed: &[],
            point,
            spring_work: -lost,
        });
        let start = if is_revolute { 3 } else { 0 };
        (axis * impulse).write(&mut record.impulse[start..]);
        record
    }

    /// Returns the axis of the joint of a brake, the origin of the link that this joint moves, m, both in W,
    /// and whether the joint is revolute.
    fn joint_axis(&self, at: BrakeIndex, state: &Snapshot) -> (Vec3<f64>, Vec3<f64>, bool) {
        let (model, joint) = (self.model(at.system), self.brake(at).joint);
        let mut data = Data::<f64>::new(model);
        kinematics(model, &mut data, &state.q, &state.v);
        let (body, rot_wb) = (&data.bodies[joint + 1], base_rotation::<f64>(&state.q));
        let point = rot_wb * body.pos_b + Vec3::from_slice(&state.q);
        (rot_wb * body.axis(), point, model.nodes()[joint + 1].axis == Axis::Revolute)
    }
}
