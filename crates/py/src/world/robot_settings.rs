//! Settings of one robot: its controls, reference, tool, stops and actuators, and its initial state.

use super::brake::brakes_of;
use crate::arrays::{Input, fixed, wrong_shape};
use crate::control::{Robot, controls_of};
use crate::model::PyModel;
use crate::reference::{self, Around};
use onorbit_core::model::Model;
use onorbit_core::world::System;
use pyo3::prelude::*;
use pyo3::types::PyDict;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Settings of one robot, as given to `Simulation` or `System` in Python.
pub(crate) struct RobotSettings {
    pub(crate) controller: Option<Py<PyAny>>,
    pub(crate) reference: Option<Py<PyAny>>,
    pub(crate) tool: Option<Py<PyAny>>,
    pub(crate) control_period: Option<f64>,
    pub(crate) enforce_limits: bool,
    pub(crate) restitution: f64,
    pub(crate) reference_start_tolerance: Option<Py<PyAny>>,
    pub(crate) actuators: Option<Py<PyAny>>,
}

impl RobotSettings {
    /// Sets controls, control period, reference with its start tolerance, tool, stops and brakes of `system`.
    /// References and controls may refer to the objects in `around`.
    pub(crate) fn apply(
        &self,
        py: Python<'_>,
        model: &PyModel,
        around: &Around<'_>,
        system: &mut System,
    ) -> PyResult<()> {
        if let Some(tolerance) = &self.reference_start_tolerance {
            system.reference_start_tolerance = fixed(tolerance.bind(py), "reference_start_tolerance", &[2])?;
        }
        system.tool = self.tool.as_ref().map(|tool| model.frame(tool.bind(py))).transpose()?;
        let reference = self.reference.as_ref().map(|reference| reference.bind(py));
        if let Some(controller) = &self.controller {
            let robot = Robot { model: &model.model, tool: system.tool, around: *around };
            system.controls = controls_of(controller.bind(py), reference, &robot)?;
            let tracked = system.controls.iter().find_map(|control| control.law.task());
            system.tool = system.tool.or(tracked.map(|(frame, _)| frame));
        } else if let Some(reference) = reference {
            system.reference = Some(reference::extract(reference, around)?);
        }
        if let Some(actuators) = &self.actuators {
            system.brakes = brakes_of(py, actuators.bind(py), &model.model)?;
        }
        system.control_period = self.control_period;
        system.stops = self.enforce_limits.then_some(self.restitution);
        Ok(())
    }

    /// Stores the settings in `keywords`, the keyword arguments of the constructor of `System`.
    pub(super) fn write_to(&self, keywords: &Bound<'_, PyDict>) -> PyResult<()> {
        keywords.set_item("controller", &self.controller)?;
        keywords.set_item("reference", &self.reference)?;
        keywords.set_item("tool", &self.tool)?;
        keywords.set_item("control_period", self.control_period)?;
        keywords.set_item("enforce_limits", self.enforce_limits)?;
        keywords.set_item("restitution", self.restitution)?;
        keywords.set_item("reference_start_tolerance", &self.reference_start_tolerance)?;
        keywords.set_item("actuators", &self.actuators)
    }
}

/// Reads an initial configuration (m and rad) and velocity (m/s and rad/s), each a vector, without a check of
/// their lengths.
pub(crate) fn initial_state(
    py: Python<'_>,
    model: &Model,
    q: Any<'_, '_>,
    v: Any<'_, '_>,
) -> PyResult<(Vec<f64>, Vec<f64>)> {
    let (q, v) = (Input::new(q, "q")?, Input::new(v, "v")?);
    for (input, name, n) in [(&q, "q", model.nq()), (&v, "v", model.nv())] {
        if input.shape().len() != 1 {
            return Err(wrong_shape(py, name, &format!("({n},)"), input.shape()));
        }
    }
    Ok((q.data().to_vec(), v.data().to_vec()))
}
