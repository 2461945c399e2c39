//! Checks that the connections and contacts in a checkpoint belong to systems and events of the run.

use super::checkpoint::{Progress, WorldProgress, check_each};
use super::checkpoint_error::CheckpointError;
use super::contacts::Touch;
use super::run_state::RunState;
use crate::spatial::Scalar;
use crate::world::FrameIndex;

impl<S: Scalar> RunState<'_, S> {
    /// Checks that the checkpoint states for each brake whether it is engaged.
    pub(super) fn check_brakes(&self, progress: &Progress) -> Result<(), CheckpointError> {
        let pairs = progress.systems.iter().zip(&self.systems);
        check_each(pairs.map(|(saved, run)| ("brakes", saved.engaged.len(), run.brakes.len())))
    }

    /// Checks that connections and event records refer to existing systems, frames and events.
    pub(super) fn check_connections(&self, world: &WorldProgress) -> Result<(), CheckpointError> {
        let (count, active) = (self.systems.len(), &world.members.active);
        let is_frame = |at: FrameIndex| at.system < count && at.frame < self.model(at.system).frames().len();
        let reason = if active.roots.iter().any(|root| *root >= count) {
            "the root of a tree is not a system of the run"
        } else if active.welds.iter().any(|weld| weld.capture >= self.events.list.len()) {
            "a connection does not belong to an event of the run"
        } else if !active.welds.iter().all(|weld| is_frame(weld.by) && is_frame(weld.of)) {
            "a connection does not belong to frames of the run"
        } else if world.records.iter().flat_map(|record| record.systems).any(|n| !self.numbers.contains(&n)) {
            "an event does not belong to systems of the run"
        } else {
            return Ok(());
        };
        Err(CheckpointError::Unreadable { reason: reason.to_owned() })
    }

    /// Checks that the checkpoint has as many contacts and pairs of pieces as the run, and that touches refer
    /// to systems of the run.
    pub(super) fn check_contacts(&self, progress: &Progress) -> Result<(), CheckpointError> {
        let (Progress { state, world, .. }, own) = (progress, &self.equations.contacts);
        let pieces = own.pairs();
        check_each([
            ("pairs of pieces that may touch", state.contacts.len(), pieces),
            ("modes of contacts", world.contacts.len(), pieces),
            ("contacts", world.touches.len(), own.count()),
            ("pairs with resting points", world.resting.len(), own.rigid_pairs()),
        ])?;
        let count = self.systems.len();
        if world.touches.iter().flat_map(Touch::systems).all(|system| system < count) {
            return Ok(());
        }
        let reason = "a contact does not belong to systems of the run".to_owned();
        Err(CheckpointError::Unreadable { reason })
    }

    /// Checks the sizes of the states of systems that share trees. Requires that the connections have been
    /// restored.
    pub(super) fn check_members(&self, world: &WorldProgress) -> Result<(), CheckpointError> {
        let parts = &self.equations.members.parts;
        check_each([("systems that share trees", world.members.parts.len(), parts.len())])?;
        for part in parts {
            let (state, model) = (&part.state, &part.own.model);
            check_each([
                ("coordinates", state.q.len(), model.nq()),
                ("velocities", state.v.len(), model.nv()),
            ])?;
        }
        Ok(())
    }
}
