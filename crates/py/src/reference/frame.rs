//! Frames in which references are expressed.

use super::{Any, pose};
use crate::arrays::fixed;
use crate::errors::{IntoPython, fields, raise};
use onorbit_core::orbit::Orbit;
use onorbit_core::reference::{ReferenceFrame, Target};
use pyo3::prelude::*;
use std::sync::Arc;

/// Uniformly moving and rotating spacecraft, which defines a frame for references.
///
/// No forces act on it.
///
/// Parameters
/// ----------
/// pose : (4, 4) array
///     Pose in W at time zero, m.
/// velocity : (3,) array, optional
///     Constant velocity, W axes, m/s.
/// spin : (3,) array, optional
///     Constant angular velocity, W axes, rad/s.
#[pyclass(name = "Target", frozen, module = "onorbit_rs")]
pub(crate) struct PyTarget {
    target: Target,
}

#[pymethods]
impl PyTarget {
    #[new]
    #[pyo3(signature = (pose, *, velocity=None, spin=None))]
    fn new(
        py: Python<'_>,
        pose: Any<'_, '_>,
        velocity: Option<Any<'_, '_>>,
        spin: Option<Any<'_, '_>>,
    ) -> PyResult<Self> {
        let start = self::pose(pose)?;
        let vector = |value: Option<Any<'_, '_>>, name| {
            value.map_or(Ok([0.0; 3]), |value| fixed::<3>(value, name, &[3]))
        };
        let (velocity, spin) = (vector(velocity, "velocity")?, vector(spin, "spin")?);
        let target = Target::at(start, velocity.into(), spin.into());
        Ok(Self { target: target.map_err(|error| error.into_python(py))? })
    }
}

/// Frame of a reference before the orbit of the simulation is known.
pub(super) enum Frame {
    World,
    Lvlh,
    Base,
    Target(Target),
}

impl Frame {
    /// Reads ``frame=``: a name or a target; W by default.
    pub(super) fn of(value: Option<Any<'_, '_>>) -> PyResult<Self> {
        let Some(value) = value else { return Ok(Self::World) };
        if let Ok(target) = value.cast::<PyTarget>() {
            return Ok(Self::Target(target.get().target.clone()));
        }
        let name: Option<String> = value.extract().ok();
        match name.as_deref() {
            Some("world") => Ok(Self::World),
            Some("lvlh") => Ok(Self::Lvlh),
            Some("base") => Ok(Self::Base),
            _ => {
                let py = value.py();
                let got = value.repr().map_or_else(|_| "?".to_owned(), |text| text.to_string());
                let message = format!("frame is {got}; it must be 'world', 'lvlh', 'base' or a Target");
                Err(raise(py, "ControlError", &message, &fields!(py, "name": "frame", "got": got)))
            }
        }
    }

    /// Returns the frame of the core; `"lvlh"` requires the orbit.
    pub(super) fn bind(&self, py: Python<'_>, orbit: Option<&Arc<dyn Orbit>>) -> PyResult<ReferenceFrame> {
        Ok(match self {
            Self::World => ReferenceFrame::World,
            Self::Base => ReferenceFrame::Base,
            Self::Target(target) => ReferenceFrame::Target(target.clone()),
            Self::Lvlh => {
                let message = "a reference in the frame 'lvlh' requires an orbit; set orbit";
                let orbit = orbit.ok_or_else(|| {
                    raise(py, "ControlError", message, &fields!(py, "name": "frame", "got": "lvlh"))
                })?;
                ReferenceFrame::Lvlh(Arc::clone(orbit))
            }
        })
    }
}
