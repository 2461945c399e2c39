//! A wrench fixed in a body, on for a while.

use nalgebra::Vector3;

use super::{Effect, EnvironmentError, Scene, Wrench, Wrenches};
use crate::model::Model;

/// Constant force and torque in a body's own axes, on from `start` until `end`.
///
/// In `W` about the centre of mass: `F = R f`, `T = R τ + (o + R p - c) × F`, with `R` the body's
/// rotation, `o` its origin, `p` the point of application in body axes, `c` the centre of mass.
/// On for a step iff the step's middle lies in `[start, end)`: since both are events, a step
/// never straddles a switch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyWrench {
    body: usize,
    force: Vector3<f64>,
    torque: Vector3<f64>,
    point: Vector3<f64>,
    start: f64,
    end: f64,
}

impl BodyWrench {
    /// Force (N) at the body's origin and torque (N m) on the body with index `body`, body axes,
    /// always on.
    ///
    /// # Errors
    /// [`EnvironmentError::NotFinite`].
    pub fn new(body: usize, force: Vector3<f64>, torque: Vector3<f64>) -> Result<Self, EnvironmentError> {
        finite("force", &force)?;
        finite("torque", &torque)?;
        let (start, end) = (f64::NEG_INFINITY, f64::INFINITY);
        Ok(Self { body, force, torque, point: Vector3::zeros(), start, end })
    }

    /// Force (N) at the origin of a frame (index) and torque (N m), both in the frame's axes, always
    /// on.
    ///
    /// # Errors
    /// [`EnvironmentError::NotFinite`], [`EnvironmentError::UnknownFrame`].
    pub fn on_frame(
        model: &Model,
        frame: usize,
        force: Vector3<f64>,
        torque: Vector3<f64>,
    ) -> Result<Self, EnvironmentError> {
        let count = model.frames().len();
        let frame = model.frames().get(frame).ok_or(EnvironmentError::UnknownFrame { frame, count })?;
        let rot_kf = frame.rot_kf.to_nalgebra();
        Self::new(frame.body, rot_kf * force, rot_kf * torque)?.at(frame.pos_kf.to_nalgebra())
    }

    /// The same with its force applied at `point`, body axes, m.
    ///
    /// # Errors
    /// [`EnvironmentError::NotFinite`].
    pub fn at(self, point: Vector3<f64>) -> Result<Self, EnvironmentError> {
        finite("point", &point)?;
        Ok(Self { point, ..self })
    }

    /// The same, on from `start` until `end`, s of simulation; either may be infinite.
    ///
    /// # Errors
    /// [`EnvironmentError::EmptyInterval`] unless `start < end`.
    pub fn during(self, start: f64, end: f64) -> Result<Self, EnvironmentError> {
        if start < end {
            Ok(Self { start, end, ..self })
        } else {
            Err(EnvironmentError::EmptyInterval { start, end })
        }
    }

    /// Index of the body it acts on.
    pub fn body(&self) -> usize {
        self.body
    }
}

/// Refuses a vector with a component that is not finite.
fn finite(name: &'static str, x: &Vector3<f64>) -> Result<(), EnvironmentError> {
    match x.iter().find(|c| !c.is_finite()) {
        Some(&value) => Err(EnvironmentError::NotFinite { name, value }),
        None => Ok(()),
    }
}

impl Effect for BodyWrench {
    fn name(&self) -> &str {
        "body wrench"
    }

    fn event_times(&self) -> Vec<f64> {
        [self.start, self.end].into_iter().filter(|t| t.is_finite()).collect()
    }

    fn reads_velocities(&self) -> bool {
        false
    }

    /// # Errors
    /// [`EnvironmentError::UnknownBody`].
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        let count = scene.bodies.len();
        let unknown = EnvironmentError::UnknownBody { body: self.body, count };
        let body = scene.bodies.get(self.body).ok_or(unknown)?;
        let middle = scene.middle();
        if self.start <= middle && middle < self.end {
            // F = R f,  T = R τ + (o + R p - c) × F
            let force = body.rot_wk * self.force;
            let arm = body.origin + body.rot_wk * self.point - body.com;
            let torque = body.rot_wk * self.torque + arm.cross(&force);
            wrenches.add(self.body, Wrench { force, torque })?;
        }
        Ok(())
    }
}
