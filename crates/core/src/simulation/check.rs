//! What can be known to be wrong before a run.

use super::contacts::AT_LIMIT;
use super::error::SimulationError;
use super::settings::Simulation;
use super::start::{check_control_starts, check_start};
use super::state_range::check_range;
use crate::control::{Control, ControlLaw, check_controls};
use crate::model::Model;

/// Largest deviation of a given quaternion from unit norm.
const UNIT_NORM: f64 = 1e-6;
/// Time steps that are believed, s: light passes a third of a millimetre in the shortest, the longest are thirty years.
const STEPS: std::ops::RangeInclusive<f64> = 1e-12..=1e9;

impl Simulation {
    /// Checks everything that can be known before a run.
    ///
    /// # Errors
    /// Wrong lengths, numbers that are not finite, a quaternion off unit norm, steps that are not
    /// positive, an effect without its orbit, a controller without its reference, a frame that the
    /// robot does not have, a reference that starts away from its tool, an Earth of another epoch or in
    /// other axes than the orbit's.
    pub fn check(&self) -> Result<(), SimulationError> {
        check_state(&self.model, &self.q, &self.v)?;
        let periods = [("time_step", Some(self.time_step)), ("control_period", self.control_period)];
        for (name, value) in periods {
            if let Some(value) = value.filter(|x| !(x.is_finite() && *x > 0.0)) {
                return Err(SimulationError::NotPositive { name, value });
            }
        }
        if !STEPS.contains(&self.time_step) {
            return Err(SimulationError::TimeStep { value: self.time_step });
        }
        if !(1e-13..=0.1).contains(&self.tolerance) {
            return Err(SimulationError::Tolerance { value: self.tolerance });
        }
        if self.rereference_beyond.is_nan() || self.rereference_beyond < 1.0 {
            return Err(SimulationError::RereferenceBeyond { value: self.rereference_beyond });
        }
        self.check_stops()?;
        if self.record_every == 0 {
            return Err(SimulationError::RecordEvery);
        }
        let mu = self.orbit.as_ref().and_then(|orbit| orbit.mu());
        let has_planet = mu.is_some();
        if let Some(gravity) = &self.gravity {
            let missing = || SimulationError::NeedsOrbit { effect: "a gravity field".to_owned() };
            gravity.check_orbit(mu.ok_or_else(missing)?)?;
        }
        if let Some(effect) = self.effects.iter().find(|effect| effect.requires_orbit() && !has_planet) {
            return Err(SimulationError::NeedsOrbit { effect: effect.name().to_owned() });
        }
        self.check_that_none_counts_twice()?;
        if let (Some(orbit), Some(earth)) = (&self.orbit, &self.earth) {
            earth.fits(orbit.axes(), orbit.epoch())?;
        }
        self.check_control()?;
        match (self.tool, &self.reference) {
            (None, Some(_)) => Err(SimulationError::NeedsTool),
            (Some(tool), Some(reference)) => {
                check_start(&self.model, &self.q, tool, reference, self.reference_start_tolerance)
            }
            _ => Ok(()),
        }
    }

    /// The frames that are followed, and whether the law can work on this robot.
    fn check_control(&self) -> Result<(), SimulationError> {
        let tracked = match &self.control {
            ControlLaw::ComputedTorque(law) => Some(law.frame),
            _ => None,
        };
        let count = self.model.frames().len();
        if let Some(frame) = [self.tool, tracked].into_iter().flatten().find(|&frame| frame >= count) {
            return Err(SimulationError::UnknownFrame { frame, count });
        }
        if let ControlLaw::ComputedTorque(law) = &self.control {
            law.check(&self.model)?;
            if let Some(tool) = self.tool.filter(|tool| *tool != law.frame) {
                let name = |frame: usize| self.model.frames()[frame].name.clone();
                return Err(SimulationError::OtherTool { controller: name(law.frame), tool: name(tool) });
            }
            if self.reference.is_none() {
                return Err(SimulationError::NeedsReference);
            }
        }
        if let ControlLaw::Stack(controls) = &self.control {
            let known = |control: &Control| control.task().is_none_or(|(frame, _)| frame < count);
            if let Some(frame) = controls.iter().find(|c| !known(c)).and_then(|c| c.task()) {
                return Err(SimulationError::UnknownFrame { frame: frame.0, count });
            }
            check_controls(controls, &self.model)?;
            let tolerance = self.reference_start_tolerance;
            check_control_starts(&self.model, &self.q, controls, tolerance)?;
        }
        Ok(())
    }

    /// Refuses two effects that do the same to a body; gravity is always there around a planet.
    fn check_that_none_counts_twice(&self) -> Result<(), SimulationError> {
        let effects = self.all_effects();
        for (k, effect) in effects.iter().enumerate() {
            let before = effects[..k].iter().filter(|before| before.name() == effect.name());
            for before in before {
                let both = |body: &usize| before.counts_once_on(*body) && effect.counts_once_on(*body);
                if let Some(body) = (0..self.model.nodes().len()).find(both) {
                    let (effect, body) = (effect.name().to_owned(), self.model.body_frame(body).name.clone());
                    return Err(SimulationError::EffectTwice { effect, body });
                }
            }
        }
        Ok(())
    }

    /// Restitution, and whether the joints start within their limits.
    fn check_stops(&self) -> Result<(), SimulationError> {
        let Some(restitution) = self.stops else { return Ok(()) };
        if !(0.0..=1.0).contains(&restitution) {
            return Err(SimulationError::Restitution { value: restitution });
        }
        for (joint, &value) in self.model.joints().iter().zip(&self.q[7..]) {
            let Some((lower, upper)) = joint.limits.position else { continue };
            if value < lower - AT_LIMIT || value > upper + AT_LIMIT {
                let joint = joint.name.clone();
                return Err(SimulationError::OutsideLimits { joint, value, lower, upper });
            }
        }
        Ok(())
    }
}

fn check_state(model: &Model, q: &[f64], v: &[f64]) -> Result<(), SimulationError> {
    for (name, values, expected) in [("q", q, model.nq()), ("v", v, model.nv())] {
        if values.len() != expected {
            return Err(SimulationError::WrongLength { name, expected, got: values.len() });
        }
        if let Some(index) = values.iter().position(|x| !x.is_finite()) {
            return Err(SimulationError::NotFinite { name, index, value: values[index] });
        }
    }
    check_range(model, q, v)?;
    let norm = q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
    if (norm - 1.0).abs() > UNIT_NORM { Err(SimulationError::QuaternionNorm { norm }) } else { Ok(()) }
}
