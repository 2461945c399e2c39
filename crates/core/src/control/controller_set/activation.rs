//! Starts and stops controls during a run: at given times, at events and when a goal is decided.

use super::ControllerSet;
use crate::control::check::check_disjoint;
use crate::control::control::{Begin, Control};
use crate::control::control_state::Phase;
use crate::control::error::ControlError;
use crate::model::{BASE_NQ, Model};
use crate::spatial::Scalar;

impl<S: Scalar> ControllerSet<'_, S> {
    /// Evaluates the goals at `t`, s, stops the controls whose end time is reached and starts those that are
    /// due. Returns true if the set of active controls changed or a control missed its goal.
    pub(super) fn activate(&mut self, t: f64, model: &Model) -> Result<bool, ControlError> {
        let mut has_changed = self.stop_due(t);
        for i in 0..self.controls.len() {
            if self.states[i].is_waiting() && self.is_due(i, t) {
                self.start(i, t)?;
                has_changed = true;
            }
        }
        if has_changed {
            self.check_running(model, t)?;
        }
        Ok(has_changed)
    }

    /// Evaluates the goals at `t`, s, and stops the controls whose end time is reached. Controls that miss
    /// their goal hold their present pose or joint positions. Returns true if a control ended or missed its
    /// goal.
    fn stop_due(&mut self, t: f64) -> bool {
        let Self { controls, states, same_instant, .. } = self;
        let now = t + *same_instant;
        let mut has_changed = false;
        for (control, state) in controls.iter().zip(states.iter_mut()) {
            if let Some(goal) = &control.goal
                && state.is_running()
                && !state.memory.outcome.is_decided()
            {
                state.memory.outcome = state.judge(goal, control, t, now - state.memory.start);
                if state.memory.outcome.miss().is_some() {
                    state.hold(control, &self.q[BASE_NQ..]);
                    has_changed = true;
                }
            }
            if state.memory.phase != Phase::Over && control.end <= now {
                state.memory.phase = Phase::Over;
                has_changed = true;
            }
        }
        has_changed
    }

    /// Returns true if the condition under which control `i` starts is met at `t`, s.
    fn is_due(&self, i: usize, t: f64) -> bool {
        match self.controls[i].begin {
            Begin::At(start) => start <= t + self.same_instant,
            Begin::AfterEvent(event) => self.events.contains(&event),
            Begin::After(before) => {
                let before = &self.states[before].memory;
                before.phase == Phase::Over || before.outcome.is_decided()
            }
        }
    }

    /// Starts control `i` at `t`, s, and stops the controls that it replaces.
    fn start(&mut self, i: usize, t: f64) -> Result<(), ControlError> {
        let Self { controls, states, .. } = self;
        match controls[i].begin {
            Begin::At(_) => {}
            Begin::After(before) => states[before].memory.phase = Phase::Over,
            // because the time of an event is not known in advance, the control replaces those that drive
            // its joints
            Begin::AfterEvent(_) => {
                let drives = |other: &Control| other.joints.iter().any(|j| controls[i].joints.contains(j));
                let replaced = states.iter_mut().zip(controls.iter()).filter(|(_, other)| drives(other));
                replaced
                    .filter(|(state, _)| state.is_running())
                    .for_each(|(state, _)| state.memory.phase = Phase::Over);
            }
        }
        let started = states[i].start(&controls[i], t, &self.q[BASE_NQ..]);
        let Control { law, joints, .. } = &mut controls[i];
        if let Some(law) = law.external_mut() {
            law.start(joints.iter().map(|&j| self.q[BASE_NQ + j]));
        }
        started.map_err(|source| ControlError::Reference { time: t, source })
    }

    /// Checks that no two running controls drive the same joint at `t`, s.
    fn check_running(&self, model: &Model, t: f64) -> Result<(), ControlError> {
        let running = |i: &usize| self.states[*i].is_running();
        for i in (0..self.controls.len()).filter(running) {
            for j in (0..i).filter(running) {
                check_disjoint(&self.controls[j], &self.controls[i], model, t)?;
            }
        }
        Ok(())
    }
}
