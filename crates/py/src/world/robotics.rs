//! Settings of one robot: initial state, controls, tool and stops.

use crate::arrays::{Input, fixed, wrong_shape};
use crate::control::{Robot, controls_of};
use crate::model::PyModel;
use crate::reference::{self, Around};
use onorbit_core::model::Model;
use onorbit_core::world::System;
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Settings of one robot that come from Python.
pub(crate) struct Robotics<'a, 'py> {
    pub(crate) controller: Option<Any<'a, 'py>>,
    pub(crate) reference: Option<Any<'a, 'py>>,
    pub(crate) tool: Option<Any<'a, 'py>>,
    pub(crate) control_period: Option<f64>,
    pub(crate) enforce_limits: bool,
    pub(crate) restitution: f64,
    pub(crate) reference_start_tolerance: Option<Any<'a, 'py>>,
}

impl Robotics<'_, '_> {
    /// Sets controls, reference, tool and stops of a system.
    pub(crate) fn apply(&self, model: &PyModel, around: &Around<'_>, system: &mut System) -> PyResult<()> {
        if let Some(tolerance) = self.reference_start_tolerance {
            system.reference_start_tolerance = fixed(tolerance, "reference_start_tolerance", &[2])?;
        }
        system.tool = self.tool.map(|tool| model.frame(tool)).transpose()?;
        if let Some(controller) = self.controller {
            let robot = Robot { model: &model.model, tool: system.tool, around: *around };
            system.controls = controls_of(controller, self.reference, &robot)?;
            let tracked = system.controls.iter().find_map(|control| control.law.task());
            system.tool = system.tool.or(tracked.map(|(frame, _)| frame));
        } else if let Some(reference) = self.reference {
            system.reference = Some(reference::extract(reference, around)?);
        }
        system.control_period = self.control_period;
        system.stops = self.enforce_limits.then_some(self.restitution);
        Ok(())
    }
}

/// Reads an initial configuration and velocity.
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
