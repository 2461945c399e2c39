//! Contacts whose forces an external engine computes.

use super::Contacts;
use super::mobility::mobility;
use super::touching::{Loading, Touching};
use crate::simulation::contact_state::ContactState;
use crate::simulation::engine::ContactOutput;
use crate::simulation::tree::Tree;
use crate::simulation::tree_state::TreeState;
use crate::spatial::{Real, Vec3};

impl Contacts {
    /// Prepares the contacts for an external engine, which computes their forces. The contacts still limit
    /// the length of steps and record distances, normals and elastic energies. Touch-down and lift-off are
    /// not located, so the steps are not shortened near them.
    pub(in crate::simulation) fn follow_engine(&mut self) {
        self.has_engine = true;
        self.steps.is_graded = false;
        for law in self.list.iter_mut().filter_map(|touching| touching.law.as_mut()) {
            law.friction = None; // friction is known to the engine alone
        }
    }

    /// Returns, for each pair of pieces, true if the bodies of its two links are one of the connected `pairs`
    /// of bodies, each given as (system, body). `body` returns the body (system, body) of a frame (system,
    /// frame).
    pub(in crate::simulation) fn held_by(
        &self,
        pairs: Vec<[(usize, usize); 2]>,
        body: impl Fn((usize, usize)) -> (usize, usize),
    ) -> Vec<bool> {
        let is_held = |touching: &Touching| {
            let [a, b] = [0, 1].map(|side| body(touching.sides[side].place));
            pairs.iter().any(|pair| *pair == [a, b] || *pair == [b, a])
        };
        self.list.iter().map(is_held).collect()
    }

    /// Sets, for each pair of pieces, whether a connection of the external engine holds both of its links.
    pub(in crate::simulation) fn set_held(&mut self, held: &[bool]) {
        self.list.iter_mut().zip(held).for_each(|(touching, held)| touching.is_held = *held);
        self.is_rigid = Vec::new();
    }

    /// Adds the impulse and the work of the declared contact with index `contact` in a step of the engine to
    /// the state of its first pair of pieces.
    pub(in crate::simulation) fn add_exchanged(
        &self,
        contact: usize,
        done: &ContactOutput,
        states: &mut [ContactState],
    ) {
        let (linear, angular) = (Vec3::from_slice(&done.impulse), Vec3::from_slice(&done.impulse[3..]));
        let mut pairs = self.list.iter().zip(states);
        if let Some((_, state)) = pairs.find(|(touching, _)| touching.contact == contact) {
            state.normal_work += done.work;
            state.impulse += linear;
            state.angular_impulse += angular - self.touches[contact].center.cross(linear);
        }
    }
}

impl Touching {
    /// Determines the effective masses of pieces that an external engine may bring into contact during the
    /// next step.
    pub(super) fn prepare_for_engine<S: Real>(
        &mut self,
        trees: &[Tree<'_, S>],
        states: &[TreeState<S>],
        loading: &Loading,
    ) {
        if self.law.is_some() && self.mode.mobility[0] == 0.0 {
            self.mode.mobility = mobility(&self.sides, trees, states, loading);
        }
    }
}
