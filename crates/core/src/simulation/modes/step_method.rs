//! Step method that ends a step early when a joint stops, starts to slip or reaches a limit, when the
//! conditions of a latch begin or cease to hold, or when the mode of a contact changes.

use super::margins::ModesOfStep;
use crate::simulation::equations::EquationsOfMotion;
use crate::simulation::error::SimulationError;
use crate::simulation::external_loads::ExternalLoads;
use crate::simulation::integrator::{Integration, StepSettings};
use crate::simulation::state::State;
use crate::spatial::Real;

/// Number of consecutive idle steps after which changes of slip no longer end a step and impacts have no
/// restitution, so that infinite sequences of such changes and of bounces end.
const MOST_IDLE_STEPS: usize = 32;
/// Length, as a fraction of a regular step, below which a step counts as idle if no joint came to rest or
/// reached its stop during the step.
const IDLE: f64 = 1e-6;
/// Displacement, rad or m, below which a step counts as idle: that of the joint that came to rest or reached
/// its stop during the step.
const STILL: f64 = 1e-9;
/// Smallest length to which a step may be shortened to improve its energy balance, relative to its length
/// before any mode change was located. If it were relative to the length after a change was located, and
/// the change were at a jump of the elastic energy, the steps would approach the jump without passing it.
const SHORTEST: f64 = 1e-4;
/// Bound on the rounding error of the energy balance, relative to the sum of the magnitudes of the kinetic
/// energies and of the work.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// Largest length of a step, relative to a regular step, in which bodies that rest on each other keep their
/// previous forces. In such a short step, the forces would be dominated by the rounding errors of the
/// velocities divided by the length of the step.
const SHORTEST_HOLD: f64 = 1e-9;
/// Time in which a gap or an overlap of bodies that rest on each other is corrected, in units of the step or,
/// if that is longer, of a regular step.
const CORRECTION: f64 = 4.0;
/// Largest number of trial steps with which the forces between bodies that rest on each other are determined.
const MOST_TRIALS: usize = 8;
/// Largest change of a velocity, m/s, for which a correction of the forces between bodies that rest on each
/// other is the last one.
const HELD: f64 = 1e-12;
/// Resolution with which the instant of a mode change is located, as a fraction of the step.
const RESOLUTION: f64 = 1e-14;

/// Method that integrates the equations of motion and locates changes of the modes of joints, latches and
/// contacts within a step.
pub(crate) struct StepMethod<S> {
    pub(crate) integration: Integration<S>,
    start: State<S>,
    settled: State<S>,
    /// True if changes between slip and rest do not end a step.
    ignores_slip: bool,
    /// Number of consecutive idle steps, which end at a change of a mode after almost no progress.
    pub(crate) idle_steps: usize,
    /// True if the elastic energy of contacts jumped in the last step.
    pub(crate) has_jumped: bool,
    time_step: f64,
}

impl<S: Real> StepMethod<S> {
    pub(crate) fn new(state: &State<S>, settings: &StepSettings) -> Self {
        Self {
            integration: Integration::new(state, settings),
            start: state.clone(),
            settled: state.clone(),
            ignores_slip: false,
            idle_steps: 0,
            has_jumped: false,
            time_step: settings.time_step,
        }
    }

    /// Resets the counters of the method at the start of another run.
    pub(crate) fn reset(&mut self) {
        (self.idle_steps, self.has_jumped) = (0, false);
    }

    /// Applies the impacts between bodies with an impact law, and those of joints that move into their stops,
    /// to `state` at the time `t`, s. `t` is `None` for a copy of the state, whose touches are not recorded.
    /// Requires the kinematics of `state`, with projected base twists, in `equations`, which afterwards
    /// contain the kinematics after the impacts. The loads must then be computed again.
    pub(crate) fn resolve_impacts(
        &self,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
        t: Option<f64>,
    ) -> Result<(), SimulationError> {
        let is_endless = self.idle_steps > MOST_IDLE_STEPS;
        equations.strike(t, state, is_endless)?;
        for (tree, state) in equations.trees.iter_mut().zip(&mut state.trees) {
            if tree.modes.is_active() {
                tree.resolve_impacts(state, is_endless);
            }
        }
        Ok(())
    }

    /// Computes the forces between bodies with an impact law that rest on each other, for a step over
    /// `interval`, s, that starts at `state`. Repeated trial steps determine the forces with which the
    /// velocities at the end of the step satisfy the law. Returns true if bodies have separated. Requires
    /// projected base twists in `state`, and its kinematics, loads and joint modes in `equations`; computes
    /// all of these again.
    #[inline(never)]
    pub(crate) fn hold_contacts(
        &mut self,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<bool, SimulationError> {
        let h = interval.1 - interval.0;
        if h <= SHORTEST_HOLD * self.time_step {
            return Ok(false);
        }
        let correction = CORRECTION * h.max(self.time_step);
        let mut hold = equations.contacts.hold([h, correction], &equations.trees, state);
        self.start.copy_from(state);
        for _ in 0..MOST_TRIALS {
            self.integration.step(equations, state, interval)?;
            let is_finite = state.is_finite();
            let change = if is_finite {
                equations.project_momentum(state);
                equations.correct_forces(&mut hold, interval.0, state)
            } else {
                Ok(0.0) // the step itself reports the divergence
            };
            state.copy_from(&self.start);
            equations.project_momentum(state);
            equations.apply_loads(interval.0, interval, state)?;
            equations.solve_modes(state);
            if change? <= HELD {
                break;
            }
        }
        Ok(equations.contacts.end_hold(interval.0, &hold))
    }

    /// Advances `state` from the start of `interval`, s, towards its end and returns the time reached, s.
    /// Requires projected base twists in `state`, and its kinematics, loads and joint modes in `equations`.
    pub(crate) fn advance(
        &mut self,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<f64, SimulationError> {
        if equations.has_modes() {
            self.advance_to_change(equations, state, interval)
        } else {
            self.integration.advance(equations, state, interval)
        }
    }

    /// Advances `state` as [`advance`](Self::advance) does, at most to the first change of a mode.
    #[inline(never)]
    fn advance_to_change(
        &mut self,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<f64, SimulationError> {
        let has_balance = !equations.contacts.is_empty() && equations.contacts.energy_error.is_finite();
        let is_balanced = has_balance && self.integration.is_rk4();
        let balance = is_balanced.then(|| equations.energy_balance(state)[0]);
        self.start.copy_from(state);
        let end = self.integration.advance(equations, state, interval)?;
        if !state.is_finite() {
            return Ok(end);
        }
        self.ignores_slip = self.idle_steps >= MOST_IDLE_STEPS;
        equations.contacts.ignores_slip = self.ignores_slip;
        let fraction = self.locate(equations, state, (interval.0, end))?;
        let reached = if fraction < 1.0 { interval.0 + fraction * (end - interval.0) } else { end };
        let reached = match balance {
            Some(balance) => {
                let shortest = SHORTEST * (end - interval.0);
                self.close_energy_balance(equations, state, (interval.0, reached), balance, shortest)?
            }
            None => reached,
        };
        let parts = equations.trees.iter().zip(&self.start.trees).zip(&mut state.trees);
        parts.for_each(|((tree, start), state)| tree.snap_to_event(start, state));
        if reached <= interval.0 {
            equations.contacts.repeat_instant();
        }
        let is_idle = fraction < 1.0 && self.is_idle(equations, state, reached - interval.0);
        self.idle_steps = if is_idle { self.idle_steps + 1 } else { 0 };
        Ok(reached)
    }

    /// Shortens the step from `start` to `end`, s, which ended at `state`, until the energy balance at its
    /// end agrees with `balance`, J, the value at its start, or its length is at most `shortest`, s. Returns
    /// the time reached, s. A force that jumps within a step, for example where the nearest faces of two
    /// bodies change, causes an error of the balance that is proportional to the square of the step length.
    fn close_energy_balance(
        &mut self,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
        (start, mut end): (f64, f64),
        balance: S,
        shortest: f64,
    ) -> Result<f64, SimulationError> {
        let permitted = equations.contacts.energy_error;
        loop {
            self.settled.copy_from(state);
            equations.project_momentum(&mut self.settled);
            let [now, scale] = equations.energy_balance(&self.settled);
            let [before, after] = equations.contacts.open_energies;
            let permitted = permitted + ROUNDING * scale.lane(0);
            let is_stored = (after - before).abs() <= permitted;
            let is_balanced = (now - balance).lane(0).abs() <= permitted && (is_stored || self.has_jumped);
            if is_balanced || end - start <= shortest {
                self.has_jumped = !is_stored;
                return Ok(end);
            }
            end = 0.5 * (start + end);
            self.repeat_step(equations, state, (start, end), 1.0)?;
        }
    }

    /// Returns true if the step of length `h`, s, that ended at `state` is idle, that is, if it made almost
    /// no progress.
    fn is_idle(
        &self,
        equations: &EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &State<S>,
        h: f64,
    ) -> bool {
        match self.modes_of(equations, state).find_map(|step| step.rate_of_first_stopped()) {
            Some(rate) => rate * h < STILL,
            None => h < IDLE * self.time_step,
        }
    }

    /// Returns each tree with its modes, its state at the start of the step and its state in `end`.
    fn modes_of<'a, 's, W>(
        &'a self,
        equations: &'a EquationsOfMotion<'s, S, W>,
        end: &'a State<S>,
    ) -> impl Iterator<Item = ModesOfStep<'a, 's, S>> {
        let parts = equations.trees.iter().zip(&self.start.trees).zip(&end.trees);
        let ignores_slip = self.ignores_slip;
        parts.map(move |((tree, start), end)| ModesOfStep { tree, start, end, ignores_slip })
    }

    /// Returns the fraction of the step `whole` at which the first mode changes, and sets `state` to the
    /// state there; returns 1 if no mode changes.
    ///
    /// The fraction is found by regula falsi (Illinois variant) on the length of the step, so that the state
    /// at the change has the order of accuracy of the integrator.
    fn locate(
        &mut self,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
        whole: (f64, f64),
    ) -> Result<f64, SimulationError> {
        let (mut high, mut after) = (1.0, self.margin(equations, state, whole)?);
        if after >= 0.0 {
            return Ok(1.0);
        }
        state.copy_from(&self.start);
        let others = equations.margin(whole.0, state)?;
        let (mut low, mut before) = (0.0, self.least_margin(equations, state).min(others));
        // the margin of a joint that starts to slip is initially zero: either it soon becomes positive, or
        // the joint is locked for this step
        let mut fraction = 1.0;
        for _ in 0..10 {
            if before > 0.0 {
                break;
            }
            fraction *= 0.5;
            let margin = self.repeat_step(equations, state, whole, fraction)?;
            if margin > 0.0 {
                (low, before) = (fraction, margin);
            } else {
                (high, after) = (fraction, margin);
            }
        }
        if before <= 0.0 && self.keep_stuck(equations, state) {
            self.repeat_step(equations, state, whole, 1.0)?;
            return self.locate(equations, state, whole);
        }
        for round in 0..100 {
            if high - low <= RESOLUTION {
                break;
            }
            let secant = (low * after - high * before) / (after - before);
            let is_inside = secant > low && secant < high && round < 40 && before > 0.0;
            let middle = if is_inside { secant } else { 0.5 * (low + high) };
            let margin = self.repeat_step(equations, state, whole, middle)?;
            if margin < 0.0 {
                (high, after) = (middle, margin);
                before *= 0.5;
            } else {
                (low, before) = (middle, margin);
                after *= 0.5;
            }
        }
        self.repeat_step(equations, state, whole, high)?;
        Ok(high)
    }

    /// Repeats the step `whole` over a fraction of its length and returns the margin at the end; see
    /// [`StepMethod::margin`].
    fn repeat_step(
        &mut self,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
        whole: (f64, f64),
        fraction: f64,
    ) -> Result<f64, SimulationError> {
        let end = if fraction < 1.0 { whole.0 + fraction * (whole.1 - whole.0) } else { whole.1 };
        state.copy_from(&self.start);
        equations.project_momentum(state);
        equations.apply_loads(whole.0, (whole.0, end), state)?;
        self.integration.step(equations, state, (whole.0, end))?;
        self.margin(equations, state, (whole.0, end))
    }

    /// Returns the margin at `state`, the end of a step over `interval`, s, to the next change of the mode of
    /// a joint, a latch or a contact. The margin is negative if the change is overdue.
    fn margin(
        &mut self,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &State<S>,
        interval: (f64, f64),
    ) -> Result<f64, SimulationError> {
        let mut least = self.least_margin(equations, state).min(equations.margin(interval.1, state)?);
        if equations.any_locked() && self.idle_steps < MOST_IDLE_STEPS {
            self.settled.copy_from(state);
            equations.project_momentum(&mut self.settled);
            equations.apply_loads(interval.1, interval, &self.settled)?;
            for (tree, state) in equations.trees.iter_mut().zip(&self.settled.trees) {
                least = least.min(tree.least_stick_margin(&state.q, &state.v));
            }
        }
        Ok(least)
    }

    /// Returns the smallest margin of the joints of all trees that are not locked.
    fn least_margin(
        &self,
        equations: &EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &State<S>,
    ) -> f64 {
        self.modes_of(equations, state).map(|step| step.least_margin()).fold(f64::INFINITY, f64::min)
    }

    /// Locks the first joint that would start to slip and immediately reverse its direction. Returns false if
    /// there is no such joint.
    fn keep_stuck(
        &self,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &State<S>,
    ) -> bool {
        let steps = self.modes_of(equations, state).enumerate();
        let found = steps.filter_map(|(number, step)| Some((number, step.first_that_slips_back()?))).next();
        if let Some((number, j)) = found {
            equations.trees[number].modes.set_slip(j, 0.0);
        }
        found.is_some()
    }
}
