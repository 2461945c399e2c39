//! Pairs of pieces that are not far apart. Only these pairs are evaluated during a step, and only their
//! states change.

use super::mode::{Mode, Phase};
use super::rigid::RestingPoint;
use super::touching::Touching;
use super::{Contacts, Touch};
use crate::simulation::contact_state::ContactState;
use crate::simulation::state::State;
use crate::simulation::tree::Tree;
use crate::spatial::Real;

/// Discrete state of the contacts of a run, as stored in a checkpoint.
pub(in crate::simulation) struct SavedContacts {
    /// Modes of all pairs of pieces.
    pub(in crate::simulation) modes: Vec<Mode>,
    /// Present or last touch of each declared contact, with the totals of its touches.
    pub(in crate::simulation) touches: Vec<Touch>,
    /// For each pair, the points at which its pieces rest on each other, or `None` while they do not rest;
    /// empty if no contact has an impact law.
    pub(in crate::simulation) resting: Vec<Option<Vec<RestingPoint>>>,
}

impl Contacts {
    /// Copies the states of the near pairs to the list of the states of all pairs.
    pub(super) fn keep(&mut self, states: &[ContactState]) {
        for (&number, state) in self.near.iter().zip(states) {
            self.states[number] = *state;
            self.has_touched[number] |= *state != ContactState::ZERO;
        }
    }

    /// Returns the states of all pairs, of which those of the near pairs are `near`.
    pub(in crate::simulation) fn all_states(&self, near: &[ContactState]) -> Vec<ContactState> {
        let mut all = self.states.clone();
        self.near.iter().zip(near).for_each(|(&number, state)| all[number] = *state);
        all
    }

    /// Returns the discrete state of the contacts for a checkpoint.
    pub(in crate::simulation) fn save(&self) -> SavedContacts {
        let mut modes: Vec<Mode> = self.list.iter().map(|touching| touching.mode).collect();
        for number in self.known_far() {
            modes[number].since = self.begun_at;
        }
        let points = |touching: &Touching| touching.rigid.as_ref().and_then(|rigid| rigid.points.clone());
        let resting = self.list.iter().map(points).take(self.rigid_pairs());
        SavedContacts { modes, touches: self.touches.clone(), resting: resting.collect() }
    }

    /// Restores the values that [`Self::save`] returned. All pairs then count as near, so the next
    /// state must contain the states of all pairs.
    pub(in crate::simulation) fn restore(
        &mut self,
        SavedContacts { modes, touches, resting }: SavedContacts,
    ) {
        self.begun.clear();
        self.list.iter_mut().zip(modes).for_each(|(touching, mode)| {
            (touching.mode, touching.clearance) = (mode, 0.0);
        });
        self.touches = touches;
        for (touching, points) in self.list.iter_mut().zip(resting) {
            touching.rigid.iter_mut().for_each(|rigid| rigid.points.clone_from(&points));
        }
        self.near = (0..self.list.len()).collect();
        self.begun_at = f64::NAN;
    }

    /// Returns the number of pairs whose resting points a checkpoint contains: that of all pairs, or 0 if no
    /// contact has an impact law.
    pub(in crate::simulation) fn rigid_pairs(&self) -> usize {
        if self.has_impact_laws() { self.list.len() } else { 0 }
    }

    /// Stores the instant of the present modes in the modes of far pairs, before all modes are determined
    /// again at the same instant.
    pub(super) fn write_instant(&mut self) {
        for number in self.known_far() {
            self.list[number].mode.since = self.begun_at;
        }
        self.begun_at = f64::NAN;
    }

    /// Marks all modes so that the next step determines them again, although it begins at the same instant
    /// after a step of length zero. A change of mode so close to the start of a step would otherwise recur
    /// without end.
    pub(in crate::simulation) fn repeat_instant(&mut self) {
        self.write_instant();
        self.list.iter_mut().for_each(|touching| touching.mode.since = Mode::REPEATED);
    }

    /// Returns the indices of the pairs that have been far apart since the start of the step; empty if the
    /// modes must be determined again or the rigid pairs have not been found.
    fn known_far(&self) -> Vec<usize> {
        if self.begun_at.is_nan() || self.is_rigid.len() < self.list.len() {
            return Vec::new();
        }
        let mut is_far: Vec<bool> = self.is_rigid.iter().map(|is_rigid| !is_rigid).collect();
        self.near.iter().for_each(|&number| is_far[number] = false);
        (0..is_far.len()).filter(|&number| is_far[number]).collect()
    }

    /// Finds the pairs whose pieces are rigidly connected to each other, unless they are known, and sets
    /// their phase to [`Phase::Far`].
    pub(super) fn find_rigid<S: Real>(&mut self, trees: &[Tree<'_, S>]) {
        if self.is_rigid.len() == self.list.len() {
            return;
        }
        self.is_rigid = self.list.iter().map(|touching| touching.is_rigid(trees)).collect();
        let rigid = self.list.iter_mut().zip(&self.is_rigid).filter(|(_, is_rigid)| **is_rigid);
        rigid.for_each(|(touching, _)| {
            (touching.mode.phase, touching.last) = (Phase::Far, None);
            touching.rigid.iter_mut().for_each(|rigid| rigid.points = None);
        });
    }

    /// Writes the indices of at least those pairs that are not far apart in the step from `t` to `end`, s, to
    /// `candidates`, and sets the phase of the other pairs to [`Phase::Far`].
    pub(super) fn find_candidates<S: Real>(
        &mut self,
        (t, end): (f64, f64),
        trees: &[Tree<'_, S>],
        state: &State<S>,
    ) {
        let Self { list, frames, steps, near, candidates: found, broad_phase, is_rigid, .. } = self;
        // modes that were determined at `t` remain
        let is_known = |number: &usize| list[*number].mode.since == t;
        found.clear();
        found.extend(near.iter().copied().filter(is_known));
        if !steps.has_broad_phase {
            found.extend(0..list.len());
            found.sort_unstable();
        } else if self.begun_at != t {
            broad_phase.find(frames, trees, state, end - t, found);
        }
        found.dedup();
        found.retain(|number| !is_rigid[*number]);
        for &number in near.iter() {
            list[number].last = None;
            if found.binary_search(&number).is_err() {
                let mode = &mut list[number].mode;
                mode.phase = Phase::Far;
                mode.since = if is_rigid[number] { mode.since } else { t };
            }
        }
    }
}
