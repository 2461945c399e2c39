//! State of all trees of a run and its time derivatives.

use super::contact_state::{ContactRate, ContactState};
use super::tree::Tree;
use super::tree_state::{TreeRate, TreeState};
use crate::spatial::{Real, Vec3};
use serde::{Deserialize, Serialize};

/// State of all trees of a run, in the order of the trees.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct State<S> {
    pub(crate) trees: Vec<TreeState<S>>,
    /// Time integral of the moments of the external forces about the common centre of mass of all trees, with
    /// each force acting at the centre of mass of its tree, W axes, N m s; zero for a single tree.
    pub(crate) orbital: Vec3<S>,
    /// Integrated quantities of the pairs of shapes that are near each other, in ascending order of the
    /// indices of the pairs. At the start of a run and in checkpoints, the list contains all pairs. Empty
    /// without contacts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) contacts: Vec<ContactState>,
}

/// Time derivatives of all trees at one stage.
#[derive(Clone, Debug)]
pub(crate) struct Rate<S> {
    pub(crate) trees: Vec<TreeRate<S>>,
    /// Time derivative of [`State::orbital`], N m.
    pub(crate) orbital: Vec3<S>,
    /// Time derivatives of [`State::contacts`].
    pub(super) contacts: Vec<ContactRate>,
}

impl<S: Real> State<S> {
    /// Creates the state of `trees` from configurations and velocities, one pair per tree; see
    /// [`TreeState::at`].
    pub(crate) fn at(trees: &mut [Tree<'_, S>], starts: impl IntoIterator<Item = (Vec<S>, Vec<S>)>) -> Self {
        let pairs = trees.iter_mut().zip(starts);
        let at = |(tree, (q, v)): (&mut Tree<'_, S>, _)| TreeState::at(&tree.model, &mut tree.data, q, v);
        Self { trees: pairs.map(at).collect(), orbital: Vec3::zero(), contacts: Vec::new() }
    }

    /// Returns true if configurations and velocities are finite in every lane.
    pub(crate) fn is_finite(&self) -> bool {
        self.trees.iter().all(TreeState::is_finite)
    }

    /// Sets the clocks of those trees that have joints with prescribed motion to `t`, s.
    pub(super) fn set_clocks(&mut self, t: f64) {
        self.trees.iter_mut().filter_map(|tree| tree.clock.as_mut()).for_each(|clock| *clock = S::of(t));
    }

    /// Returns the state with `f` applied to every number except those of the contacts, which are copied.
    pub(crate) fn map<T>(&self, f: impl Fn(&S) -> T) -> State<T> {
        let trees = self.trees.iter().map(|tree| tree.map(&f)).collect();
        State { trees, orbital: self.orbital.map(&f), contacts: self.contacts.clone() }
    }

    /// Copies `from` into the existing buffers, of which only that of the contacts may grow.
    pub(crate) fn copy_from(&mut self, from: &Self) {
        for (to, from) in self.trees.iter_mut().zip(&from.trees) {
            to.copy_from(from);
        }
        if self.trees.len() > 1 {
            self.orbital = from.orbital;
        }
        self.contacts.clone_from(&from.contacts);
    }

    /// Stores `from ⊕ h rate` with the step `h`, s; see [`TreeState::move_from`].
    #[inline(always)]
    pub(crate) fn move_from(&mut self, from: &Self, rate: &Rate<S>, h: S) {
        for ((to, from), rate) in self.trees.iter_mut().zip(&from.trees).zip(&rate.trees) {
            to.move_from(from, rate, h);
        }
        if self.trees.len() > 1 {
            self.orbital = rate.orbital.scale_add(h, from.orbital);
        }
        if !(from.contacts.is_empty() && self.contacts.is_empty()) {
            self.move_contacts(from, rate, h.lane(0));
        }
    }

    #[inline(never)]
    fn move_contacts(&mut self, from: &Self, rate: &Rate<S>, h: f64) {
        self.contacts.resize(from.contacts.len(), ContactState::ZERO);
        for ((to, from), rate) in self.contacts.iter_mut().zip(&from.contacts).zip(&rate.contacts) {
            *to = from.plus(rate, h);
        }
    }
}

impl<S: Real> Rate<S> {
    /// Creates rates with the dimensions of `state`. Those of the trees are zero, except that clocks have the
    /// rate 1; those of the contacts are placeholders.
    pub(crate) fn of(state: &State<S>) -> Self {
        Self {
            trees: state.trees.iter().map(TreeRate::of).collect(),
            orbital: Vec3::zero(),
            contacts: state.contacts.clone(),
        }
    }

    /// Adds `s · other` to these rates, for weighted sums of stages.
    #[inline(always)]
    pub(crate) fn accumulate(&mut self, other: &Self, s: S) {
        for (sum, other) in self.trees.iter_mut().zip(&other.trees) {
            sum.accumulate(other, s);
        }
        if self.trees.len() > 1 {
            self.orbital = other.orbital.scale_add(s, self.orbital);
        }
        if !(other.contacts.is_empty() && self.contacts.is_empty()) {
            self.accumulate_contacts(other, s.lane(0));
        }
    }

    #[inline(never)]
    fn accumulate_contacts(&mut self, other: &Self, s: f64) {
        self.contacts.resize(other.contacts.len(), ContactState::ZERO);
        for (sum, other) in self.contacts.iter_mut().zip(&other.contacts) {
            *sum = sum.plus(other, s);
        }
    }

    /// Copies `from` into the existing buffers, of which only that of the contacts may grow.
    pub(crate) fn copy_from(&mut self, from: &Self) {
        for (to, from) in self.trees.iter_mut().zip(&from.trees) {
            to.copy_from(from);
        }
        self.orbital = from.orbital;
        self.contacts.clone_from(&from.contacts);
    }

    /// Resets the rates to which [`Rate::accumulate`] adds: zero for the trees, and none for the contacts.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.trees.iter_mut().for_each(TreeRate::clear);
        self.orbital = Vec3::zero();
        self.contacts.clear();
    }
}
