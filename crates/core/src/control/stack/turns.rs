//! Which controls run.

use super::Stack;
use crate::control::check::check_disjoint;
use crate::control::error::ControlError;
use crate::control::group::Begin;
use crate::control::progress::Phase;
use crate::model::Model;
use crate::spatial::Scalar;

impl<S: Scalar> Stack<'_, S> {
    /// Stops, judges and starts what is due at `t`; whether anything changed.
    pub(super) fn take_turns(&mut self, t: f64, model: &Model) -> Result<bool, ControlError> {
        let Self { controls, progress, same_instant, .. } = self;
        let now = t + *same_instant;
        let mut has_changed = false;
        for (control, progress) in controls.iter().zip(progress.iter_mut()) {
            if progress.phase == Phase::Running
                && let Some(goal) = &control.goal
                && !progress.outcome.is_decided()
            {
                let (task, is_task) = progress.components();
                let errors = if is_task { &task[..] } else { &progress.error };
                progress.outcome = goal.judge(t, now - progress.start, control.duration(), errors);
                if progress.outcome.miss().is_some() {
                    progress.hold(control, &self.q[7..]);
                    has_changed = true;
                }
            }
            if progress.phase != Phase::Over && control.end <= now {
                progress.phase = Phase::Over;
                has_changed = true;
            }
        }
        for i in 0..controls.len() {
            let is_due = match controls[i].begin {
                Begin::At(start) => start <= now,
                Begin::After(before) => {
                    let before = &progress[before];
                    before.phase == Phase::Over || before.outcome.is_decided()
                }
            };
            if progress[i].phase == Phase::Waiting && is_due {
                if let Begin::After(before) = controls[i].begin {
                    progress[before].phase = Phase::Over;
                }
                let started = progress[i].start(&controls[i], t, &self.q[7..]);
                started.map_err(|source| ControlError::Reference { time: t, source })?;
                has_changed = true;
            }
        }
        if has_changed {
            let running = |i: &usize| progress[*i].phase == Phase::Running;
            for i in (0..controls.len()).filter(running) {
                for j in (0..i).filter(running) {
                    check_disjoint(&controls[j], &controls[i], model, t)?;
                }
            }
        }
        Ok(has_changed)
    }
}
