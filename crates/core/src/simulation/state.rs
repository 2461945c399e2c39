//! State of all trees of a run and its time derivatives.

use super::tree::Tree;
use super::tree_state::{TreeRate, TreeState};
use crate::spatial::Real;
use serde::{Deserialize, Serialize};

/// State of all trees of a run, in the order of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct State<S> {
    pub(crate) trees: Vec<TreeState<S>>,
}

/// Time derivatives of all trees at one stage.
#[derive(Clone, Debug)]
pub(crate) struct Rate<S> {
    pub(crate) trees: Vec<TreeRate<S>>,
}

impl<S: Real> State<S> {
    /// Returns the state of `trees` with the given configurations and velocities, one pair per tree; see
    /// [`TreeState::at`].
    pub(crate) fn at(trees: &mut [Tree<'_, S>], starts: impl IntoIterator<Item = (Vec<S>, Vec<S>)>) -> Self {
        let pairs = trees.iter_mut().zip(starts);
        let at = |(tree, (q, v)): (&mut Tree<'_, S>, _)| TreeState::at(tree.model, &mut tree.data, q, v);
        Self { trees: pairs.map(at).collect() }
    }

    /// Returns true if configurations and velocities are finite in every lane.
    pub(crate) fn is_finite(&self) -> bool {
        self.trees.iter().all(TreeState::is_finite)
    }

    /// Returns the state with `f` applied to every number.
    pub(crate) fn map<T>(&self, f: impl Fn(&S) -> T) -> State<T> {
        State { trees: self.trees.iter().map(|tree| tree.map(&f)).collect() }
    }

    /// Copies `from` without allocating.
    pub(crate) fn copy_from(&mut self, from: &Self) {
        for (to, from) in self.trees.iter_mut().zip(&from.trees) {
            to.copy_from(from);
        }
    }

    /// Writes `from ⊕ h rate`; see [`TreeState::move_from`].
    #[inline(always)]
    pub(crate) fn move_from(&mut self, from: &Self, rate: &Rate<S>, h: S) {
        for ((to, from), rate) in self.trees.iter_mut().zip(&from.trees).zip(&rate.trees) {
            to.move_from(from, rate, h);
        }
    }
}

impl<S: Real> Rate<S> {
    /// Returns zero rates with the dimensions of `state`.
    pub(crate) fn of(state: &State<S>) -> Self {
        Self { trees: state.trees.iter().map(|state| TreeRate::new(state.v.len())).collect() }
    }

    /// `self += s · other`, for weighted sums of stages.
    #[inline(always)]
    pub(crate) fn accumulate(&mut self, other: &Self, s: S) {
        for (sum, other) in self.trees.iter_mut().zip(&other.trees) {
            sum.accumulate(other, s);
        }
    }

    /// Copies `from` without allocating.
    pub(crate) fn copy_from(&mut self, from: &Self) {
        for (to, from) in self.trees.iter_mut().zip(&from.trees) {
            to.copy_from(from);
        }
    }

    /// Sets the rates that `accumulate` sums to zero.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.trees.iter_mut().for_each(TreeRate::clear);
    }
}
