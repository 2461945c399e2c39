//! Detection of controls whose frame is rigidly connected to the frame that they follow, so that their
//! torques cannot reduce their errors.

use super::events::Attached;
use super::run_state::RunState;
use crate::spatial::Scalar;
use crate::world::{FrameIndex, Weld};

/// Control whose frame is rigidly connected to the frame that its reference follows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AttachedControl {
    /// Name of the control.
    pub control: String,
    /// Path of the frame that the control moves, `SYSTEM/FRAME`.
    pub frame: String,
    /// Path of the frame that the control follows, `SYSTEM/FRAME`.
    pub followed: String,
    /// Name of the capture that connects the two frames.
    pub capture: String,
}

impl<S: Scalar> RunState<'_, S> {
    /// Finds the active controls whose frames have become rigidly connected to the frames that they follow,
    /// and adds them to `self.events.attached`.
    pub(super) fn find_attached(&mut self) {
        let welds = &self.connections.active.welds;
        if welds.is_empty() || self.moving_frames.is_empty() {
            return;
        }
        let mut found = Vec::new();
        for (system, run) in self.systems.iter().enumerate() {
            for (control, law) in run.controllers.set.running() {
                let Some((frame, reference)) = law.task() else { continue };
                let Some(moving) = reference.moving_frame() else { continue };
                let Some(other) = self.numbers.iter().position(|number| *number == moving.system) else {
                    continue;
                };
                let frame = FrameIndex { system, frame };
                let followed = FrameIndex { system: other, frame: moving.frame };
                let connects = |count: &usize| self.are_rigid(&welds[..*count], frame, followed);
                if let Some(count) = (1..=welds.len()).find(connects) {
                    found.push(Attached { control, frame, followed, capture: welds[count - 1].capture });
                }
            }
        }
        let known = &mut self.events.attached;
        found.retain(|attached| !known.contains(attached));
        known.extend(found);
    }

    /// Returns true if `welds` without a seating motion connect the bodies of two frames, or if both frames
    /// belong to the same body.
    fn are_rigid(&self, welds: &[Weld], a: FrameIndex, b: FrameIndex) -> bool {
        let body = |at: FrameIndex| (at.system, self.model(at.system).frames()[at.frame].body);
        let (mut found, mut next) = (vec![body(a)], 0);
        while let Some(&at) = found.get(next) {
            next += 1;
            for weld in welds.iter().filter(|weld| weld.seating.is_none()) {
                let ends = [body(weld.by), body(weld.of)];
                let others = ends.into_iter().filter(|_| ends.contains(&at));
                let new: Vec<_> = others.filter(|other| !found.contains(other)).collect();
                found.extend(new);
            }
        }
        found.contains(&body(b))
    }

    /// Returns the controls found so far in the run whose frames are rigidly connected to the frames that
    /// they follow.
    pub(super) fn attached_controls(&self) -> Vec<AttachedControl> {
        let named = self.events.attached.iter().map(|attached| {
            let run = &self.systems[attached.frame.system];
            AttachedControl {
                control: run.controllers.set.controls()[attached.control].name.clone(),
                frame: self.connections.frame_name(attached.frame).to_owned(),
                followed: self.connections.frame_name(attached.followed).to_owned(),
                capture: self.events.list[attached.capture].name.clone(),
            }
        });
        named.collect()
    }
}
