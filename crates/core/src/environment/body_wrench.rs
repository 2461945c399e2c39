//! Effect that applies a wrench with constant components in body axes during an interval.

use nalgebra::Vector3;

use super::body_index::BodyIndex;
use super::effect::Effect;
use super::error::EnvironmentError;
use super::scene::Scene;
use super::wrenches::{Wrench, Wrenches};
use crate::model::Model;

/// Constant force and torque in body axes, active from `start` until `end`.
///
/// In `W` about the centre of mass: `F = R f`, `T = R τ + (o + R p - c) × F`, with the force `f` and torque
/// `τ` in body axes, the rotation `R` of the body, its origin `o`, the point of application `p` in body axes,
/// and the centre of mass `c`. The wrench is active in a step if the middle of the step is in `[start, end)`.
/// Steps end at both times, so the wrench is never switched on or off within a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyWrench {
    body: BodyIndex,
    force: Vector3<f64>,
    torque: Vector3<f64>,
    point: Vector3<f64>,
    start: f64,
    end: f64,
}

impl BodyWrench {
    /// Creates a wrench that is always active: a force (N) at the origin of `body` and a torque (N m), both
    /// in body axes.
    ///
    /// A plain number selects a body of the first system.
    ///
    /// # Errors
    /// [`EnvironmentError::NotFinite`] for a force or torque that is not finite.
    pub fn new(
        body: impl Into<BodyIndex>,
        force: Vector3<f64>,
        torque: Vector3<f64>,
    ) -> Result<Self, EnvironmentError> {
        check_finite("force", &force)?;
        check_finite("torque", &torque)?;
        let (start, end) = (f64::NEG_INFINITY, f64::INFINITY);
        Ok(Self { body: body.into(), force, torque, point: Vector3::zeros(), start, end })
    }

    /// Creates a wrench on the first system that is always active: a force (N) at the origin of the frame
    /// with index `frame` and a torque (N m), both in frame axes.
    ///
    /// # Errors
    /// [`EnvironmentError::NotFinite`] for a force or torque that is not finite;
    /// [`EnvironmentError::UnknownFrame`] if `model` has no frame with this index.
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

    /// Returns the same wrench with the force applied at `point`, body axes, m.
    ///
    /// # Errors
    /// [`EnvironmentError::NotFinite`] for a point that is not finite.
    pub fn at(self, point: Vector3<f64>) -> Result<Self, EnvironmentError> {
        check_finite("point", &point)?;
        Ok(Self { point, ..self })
    }

    /// Returns the same wrench, active from simulation time `start` until `end`, s; either may be infinite.
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

    /// Returns the same wrench, acting on the system with the number `system` in the world.
    #[must_use]
    pub fn on_system(self, system: usize) -> Self {
        Self { body: BodyIndex { system, ..self.body }, ..self }
    }

    /// Returns the body on which the wrench acts.
    pub fn body(&self) -> BodyIndex {
        self.body
    }
}

/// Returns an error if a component of the vector is not finite.
fn check_finite(name: &'static str, x: &Vector3<f64>) -> Result<(), EnvironmentError> {
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

    fn acts_on(&self, system: usize) -> bool {
        self.body.system == system
    }

    fn reads_velocities(&self) -> bool {
        false
    }

    /// Adds the wrench if it is active in the step of the scene.
    ///
    /// # Errors
    /// [`EnvironmentError::UnknownBody`] if the scene or `wrenches` does not have the body.
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        let known = || scene.bodies.known(self.body.system);
        let unknown = || EnvironmentError::UnknownBody { body: self.body, known: known() };
        let body = scene.bodies.get(self.body).ok_or_else(unknown)?;
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
