//! State of all systems of a run and its time derivatives.

use super::system::System;
use super::system_state::{SystemRate, SystemState};
use crate::spatial::Real;
use serde::{Deserialize, Serialize};

/// State of all systems of a run, in the order of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct State<S> {
    pub(crate) systems: Vec<SystemState<S>>,
}

/// Time derivatives of all systems at one stage.
#[derive(Clone, Debug)]
pub(crate) struct Rate<S> {
    pub(crate) systems: Vec<SystemRate<S>>,
}

impl<S: Real> State<S> {
    /// Returns the state of `systems` with the given configurations and velocities, one pair per system; see
    /// [`SystemState::at`].
    pub(crate) fn at(
        systems: &mut [System<'_, S>],
        starts: impl IntoIterator<Item = (Vec<S>, Vec<S>)>,
    ) -> Self {
        let pairs = systems.iter_mut().zip(starts);
        let at =
            |(system, (q, v)): (&mut System<'_, S>, _)| SystemState::at(system.model, &mut system.data, q, v);
        Self { systems: pairs.map(at).collect() }
    }

    /// Returns true if configurations and velocities are finite in every lane.
    pub(crate) fn is_finite(&self) -> bool {
        self.systems.iter().all(SystemState::is_finite)
    }

    /// Returns the state with `f` applied to every number.
    pub(crate) fn map<T>(&self, f: impl Fn(&S) -> T) -> State<T> {
        State { systems: self.systems.iter().map(|system| system.map(&f)).collect() }
    }

    /// Copies `from` without allocating.
    pub(crate) fn copy_from(&mut self, from: &Self) {
        for (to, from) in self.systems.iter_mut().zip(&from.systems) {
            to.copy_from(from);
        }
    }

    /// Writes `from ⊕ h rate`; see [`SystemState::move_from`].
    #[inline(always)]
    pub(crate) fn move_from(&mut self, from: &Self, rate: &Rate<S>, h: S) {
        for ((to, from), rate) in self.systems.iter_mut().zip(&from.systems).zip(&rate.systems) {
            to.move_from(from, rate, h);
        }
    }
}

impl<S: Real> Rate<S> {
    /// Returns zero rates with the dimensions of `state`.
    pub(crate) fn of(state: &State<S>) -> Self {
        Self { systems: state.systems.iter().map(|state| SystemRate::new(state.v.len())).collect() }
    }

    /// `self += s · other`, for weighted sums of stages.
    #[inline(always)]
    pub(crate) fn accumulate(&mut self, other: &Self, s: S) {
        for (sum, other) in self.systems.iter_mut().zip(&other.systems) {
            sum.accumulate(other, s);
        }
    }

    /// Copies `from` without allocating.
    pub(crate) fn copy_from(&mut self, from: &Self) {
        for (to, from) in self.systems.iter_mut().zip(&from.systems) {
            to.copy_from(from);
        }
    }

    /// Sets the rates that `accumulate` sums to zero.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.systems.iter_mut().for_each(SystemRate::clear);
    }
}
