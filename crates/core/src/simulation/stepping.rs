//! From one cut to the next: a step, ended where a joint stops, breaks away or comes to a limit.

use super::contacts::AT_LIMIT;
use super::error::SimulationError;
use super::integrator::{Integrator, Stages};
use super::pair::Memory;
use super::plant::{Plant, World};
use super::state::State;
use crate::model::Model;
use crate::spatial::Real;

/// Cuts in a row that get nowhere; beyond, friction stops joints at the ends of steps and stops give
/// nothing back, so that bounces without end come to an end.
const MOST_CUTS: usize = 32;
/// A cut gets nowhere within this share of a regular step,
const IDLE: f64 = 1e-6;
/// or where the joint that comes to rest or to its stop moved by less than this, rad or m, since the last.
const STILL: f64 = 1e-9;
/// Where within a step something happened is found to this share of it.
const RESOLUTION: f64 = 1e-14;

/// How to step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stepping {
    pub(crate) integrator: Integrator,
    /// Of the adaptive integrator.
    pub(crate) tolerance: f64,
    /// s.
    pub(crate) time_step: f64,
    /// Of the run, s.
    pub(crate) duration: f64,
}

/// Steps a plant and finds what happens in between.
pub(crate) struct Stepper<S> {
    pub(crate) stages: Stages<S>,
    start: State<S>,
    seen: State<S>,
    /// Joints whose slip may turn within a step without a cut.
    is_forgiven: Vec<bool>,
    /// Cuts in a row that got nowhere.
    pub(super) cuts: usize,
    time_step: f64,
}

impl<S: Real> Stepper<S> {
    pub(crate) fn new(model: &Model, state: &State<S>, how: &Stepping) -> Self {
        Self {
            stages: Stages::new(model, state, how),
            start: state.clone(),
            seen: state.clone(),
            is_forgiven: vec![false; model.joint_count()],
            cuts: 0,
            time_step: how.time_step,
        }
    }

    /// Forgets the run before.
    pub(crate) fn restart(&mut self) {
        self.cuts = 0;
    }

    /// What the control of the step remembers, if it adapts.
    pub(super) fn memory(&self) -> Option<Memory> {
        self.stages.pair.as_ref().map(|pair| pair.memory)
    }

    /// Goes on from what was kept.
    pub(super) fn go_on_from(&mut self, memory: Memory, cuts: usize) {
        self.cuts = cuts;
        if let Some(pair) = &mut self.stages.pair {
            pair.memory = memory;
        }
    }

    /// Puts a settled state past impacts. Needs kinematics; leaves them, and wrenches are to follow.
    pub(crate) fn bounce(&self, plant: &mut Plant<'_, S, impl World<S>>, state: &mut State<S>) {
        if plant.contacts.is_active() {
            let restitution = if self.cuts > MOST_CUTS { 0.0 } else { plant.contacts.restitution };
            plant.bounce(state, restitution);
        }
    }

    /// Moves `state` from the start of `interval` towards its end; returns where it got. Expects a
    /// settled state, wrenches and modes of its joints in the plant.
    pub(crate) fn advance(
        &mut self,
        plant: &mut Plant<'_, S, impl World<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<f64, SimulationError> {
        if !plant.contacts.is_active() {
            return self.stages.advance(plant, state, interval);
        }
        self.start.copy_from(state);
        let end = self.stages.advance(plant, state, interval)?;
        if !state.is_finite() {
            return Ok(end);
        }
        self.is_forgiven.fill(self.cuts >= MOST_CUTS);
        let share = self.locate(plant, state, (interval.0, end))?;
        let reached = if share < 1.0 { interval.0 + share * (end - interval.0) } else { end };
        self.snap(plant, state);
        self.cuts = if self.is_idle(plant, state, reached - interval.0) { self.cuts + 1 } else { 0 };
        Ok(reached)
    }

    /// Whether the step of `h` that ended in `state` got nowhere.
    fn is_idle(&self, plant: &Plant<'_, S, impl World<S>>, state: &State<S>, h: f64) -> bool {
        let rate = |state: &State<S>, j: usize| state.v[j + 6].lane(0).abs();
        let came_to_rest = |j: &usize| rate(state, *j) == 0.0 && rate(&self.start, *j) > 0.0;
        match plant.hits(state).or_else(|| (0..self.is_forgiven.len()).find(came_to_rest)) {
            Some(j) => rate(&self.start, j).max(rate(state, j)) * h < STILL,
            None => h < IDLE * self.time_step,
        }
    }

    /// The share of the step after which something happens, `state` moved there; 1 if nothing does.
    ///
    /// Regula falsi on the step's length (Illinois), so that the state at the cut has the order of the
    /// integrator.
    fn locate(
        &mut self,
        plant: &mut Plant<'_, S, impl World<S>>,
        state: &mut State<S>,
        whole: (f64, f64),
    ) -> Result<f64, SimulationError> {
        let (mut high, mut beyond) = (1.0, self.margin(plant, state, whole)?);
        if beyond >= 0.0 {
            return Ok(1.0);
        }
        state.copy_from(&self.start);
        let (mut low, mut before) = (0.0, self.room(plant, state));
        // a joint that starts to slip has no margin at first: it gets one soon, or sticks for this step
        let mut share = 1.0;
        for _ in 0..10 {
            if before > 0.0 {
                break;
            }
            share *= 0.5;
            let margin = self.again(plant, state, whole, share)?;
            if margin > 0.0 {
                (low, before) = (share, margin);
            } else {
                (high, beyond) = (share, margin);
            }
        }
        if before <= 0.0 && self.hold_back(plant, state) {
            self.again(plant, state, whole, 1.0)?;
            return self.locate(plant, state, whole);
        }
        for round in 0..100 {
            if high - low <= RESOLUTION {
                break;
            }
            let secant = (low * beyond - high * before) / (beyond - before);
            let inside = secant > low && secant < high && round < 40 && before > 0.0;
            let middle = if inside { secant } else { 0.5 * (low + high) };
            let margin = self.again(plant, state, whole, middle)?;
            if margin < 0.0 {
                (high, beyond) = (middle, margin);
                before *= 0.5;
            } else {
                (low, before) = (middle, margin);
                beyond *= 0.5;
            }
        }
        self.again(plant, state, whole, high)?;
        Ok(high)
    }

    /// Repeats the step over a share of it; returns the margin there.
    fn again(
        &mut self,
        plant: &mut Plant<'_, S, impl World<S>>,
        state: &mut State<S>,
        whole: (f64, f64),
        share: f64,
    ) -> Result<f64, SimulationError> {
        let end = if share < 1.0 { whole.0 + share * (whole.1 - whole.0) } else { whole.1 };
        state.copy_from(&self.start);
        plant.settle(state);
        plant.surround(whole.0, (whole.0, end), &state.q)?;
        self.stages.step(plant, state, (whole.0, end))?;
        self.margin(plant, state, (whole.0, end))
    }

    /// What is left, as shares, before a joint changes its mode; negative when one should have.
    fn margin(
        &mut self,
        plant: &mut Plant<'_, S, impl World<S>>,
        state: &State<S>,
        interval: (f64, f64),
    ) -> Result<f64, SimulationError> {
        let mut least = self.room(plant, state);
        if plant.contacts.locked().is_some() && self.cuts < MOST_CUTS {
            self.seen.copy_from(state);
            plant.settle(&mut self.seen);
            plant.surround(interval.1, interval, &self.seen.q)?;
            least = least.min(plant.least_hold(&self.seen.q, &self.seen.v));
        }
        Ok(least)
    }

    /// What the moving joints have left.
    fn room(&self, plant: &Plant<'_, S, impl World<S>>, state: &State<S>) -> f64 {
        let left = |j| self.slip(plant, state, j).min(self.clearance(plant, state, j));
        (0..self.is_forgiven.len()).map(left).fold(f64::INFINITY, f64::min)
    }

    /// Rate of a slipping joint along its slip.
    fn slip(&self, plant: &Plant<'_, S, impl World<S>>, state: &State<S>, j: usize) -> f64 {
        let direction = plant.contacts.direction(j);
        if self.is_forgiven[j] || direction == 0.0 || !plant.contacts.has_friction(j) {
            return f64::INFINITY;
        }
        let (first, last) = (self.start.v[j + 6].lane(0), state.v[j + 6].lane(0));
        direction * last / (first.abs() + last.abs()).max(f64::MIN_POSITIVE)
    }

    /// Way to the nearer limit.
    fn clearance(&self, plant: &Plant<'_, S, impl World<S>>, state: &State<S>, j: usize) -> f64 {
        let (lower, upper) = plant.contacts.limits(j);
        if plant.contacts.is_locked(j) || (lower, upper) == (f64::NEG_INFINITY, f64::INFINITY) {
            return f64::INFINITY;
        }
        let (first, last) = (self.start.q[j + 7].lane(0), state.q[j + 7].lane(0));
        let way = |q: f64| (upper - q).min(q - lower);
        (way(last) + AT_LIMIT) / (way(first).abs() + AT_LIMIT)
    }

    /// Locks a joint that would leave rest only to slip back at once; whether there was one.
    fn hold_back(&self, plant: &mut Plant<'_, S, impl World<S>>, state: &State<S>) -> bool {
        let turned = |j: &usize| self.start.v[j + 6].lane(0) == 0.0 && self.slip(plant, state, *j) <= 0.0;
        let found = (0..self.is_forgiven.len()).find(turned);
        if let Some(j) = found {
            plant.contacts.lock(j);
        }
        found.is_some()
    }

    /// Joints that came to rest are at rest, and those past a limit at it: what is left is rounding.
    fn snap(&self, plant: &Plant<'_, S, impl World<S>>, state: &mut State<S>) {
        for j in 0..self.is_forgiven.len() {
            let direction = plant.contacts.direction(j) * f64::from(plant.contacts.has_friction(j));
            let (first, rate) = (self.start.v[j + 6].lane(0), state.v[j + 6].lane(0));
            if direction != 0.0 && direction * rate <= 1e-13 * first.abs() {
                state.v[j + 6] = S::of(0.0);
            }
            let (lower, upper) = plant.contacts.limits(j);
            let q = state.q[j + 7].lane(0);
            if !plant.contacts.is_locked(j) && (q > upper || q < lower) {
                state.q[j + 7] = S::of(q.clamp(lower, upper));
            }
        }
    }
}
