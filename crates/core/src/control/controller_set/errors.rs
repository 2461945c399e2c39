//! Desired motions and tracking errors of the controls.

use super::ControllerSet;
use crate::control::control_state::{ControlState, Phase};
use crate::control::error::ControlError;
use crate::control::fingers::measure;
use crate::dynamics::{Data, base_rotation, frame_pose};
use crate::model::{BASE_NQ, BASE_NV, Model};
use crate::spatial::{Scalar, Vec3};

impl<S: Scalar> ControllerSet<'_, S> {
    /// Evaluates the desired motion and the tracking error of every active control at `t`, s, and the state
    /// `q`, `(nq,)`, and `v`, `(nv,)`. Requires up-to-date kinematics
    /// ([`kinematics`](crate::dynamics::kinematics)) in `data`.
    ///
    /// # Errors
    /// [`ControlError::Reference`] if a reference is not defined at this time.
    pub fn update_errors(
        &mut self,
        t: f64,
        model: &Model,
        data: &Data<S>,
        q: &[S],
        v: &[S],
    ) -> Result<(), ControlError> {
        if self.controls.is_empty() {
            return Ok(());
        }
        // rows are often recorded at the time and state of the last control tick
        let is_same = |last: &[f64], now: &[S]| last.iter().zip(now).all(|(last, now)| *last == now.value());
        if self.evaluated_at == t && (!self.reads_state || is_same(&self.q, q) && is_same(&self.v, v)) {
            return Ok(());
        }
        self.evaluated_at = f64::NAN;
        if self.reads_state {
            self.q.iter_mut().zip(q).for_each(|(to, from)| *to = from.value());
            self.v.iter_mut().zip(v).for_each(|(to, from)| *to = from.value());
        }
        for (control, state) in self.controls.iter().zip(&mut self.states) {
            if state.memory.phase == Phase::Over {
                state.error.fill(0.0);
                continue;
            }
            if let Some((frame, reference)) = control.law.task().filter(|_| state.needs_error) {
                let pose = frame_pose(model, data, q, frame);
                let (rot, pos) = (pose.rot_wf.map(|x| x.value()), pose.pos_w.map(|x| x.value()));
                state.pose = if reference.is_relative_to_base() {
                    let rot_wb = base_rotation(&self.q);
                    (rot_wb.transpose() * rot, rot_wb.transpose_mul(pos - Vec3::from_slice(&self.q)))
                } else {
                    (rot, pos)
                };
            }
            if let Some(law) = control.law.grip().filter(|_| state.is_running()) {
                let ControlState { fingers, finger_forces, .. } = state;
                let robot = (model, data, &self.q[..]);
                let loops = self.finger_loops.as_mut();
                let rates =
                    loops.map(|loops| (loops.rates(model, data, &control.joints), control.joints.len()));
                measure(fingers, &law.closing_rate, &self.normal_forces, rates, robot, finger_forces);
            }
            if state.is_running() {
                let evaluated = state.evaluate(control, t, &self.q[BASE_NQ..], &self.v[BASE_NV..]);
                evaluated.map_err(|source| ControlError::Reference { time: t, source })?;
            }
        }
        self.evaluated_at = t;
        Ok(())
    }
}
