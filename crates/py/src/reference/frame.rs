//! The frame a reference is given in.

use super::{Any, pose};
use crate::arrays::fixed;
use crate::errors::{IntoPython, fields, raise};
use onorbit_core::orbit::Orbit;
use onorbit_core::reference::{ReferenceFrame, Target};
use pyo3::prelude::*;
use std::sync::Arc;

/// A spacecraft that nothing acts on, for references given relative to it.
///
/// ``pose`` (4, 4) at time zero in W, ``velocity`` (3,) m/s and ``spin`` (3,) rad/s in W axes, both constant.
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

/// A frame before it is known which orbit the simulation flies on.
pub(super) enum Frame {
    World,
    Lvlh,
    Base,
    Target(Target),
}

impl Frame {
    /// From ``frame=``: a name or a target; W where not given.
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
                let message = format!("frame is {got}; there are 'world', 'lvlh', 'base' and a Target");
                Err(raise(py, "ControlError", &message, &fields!(py, "name": "frame", "got": got)))
            }
        }
    }

    pub(super) fn bind(&self, py: Python<'_>, orbit: Option<&Arc<dyn Orbit>>) -> PyResult<ReferenceFrame> {
        Ok(match self {
            Self::World => ReferenceFrame::World,
            Self::Base => ReferenceFrame::Base,
            Self::Target(target) => ReferenceFrame::Target(target.clone()),
            Self::Lvlh => {
                let needs = "the reference is given in the frame 'lvlh', which needs an orbit: give one";
                let orbit = orbit.ok_or_else(|| {
                    raise(py, "ControlError", needs, &fields!(py, "name": "frame", "got": "lvlh"))
                })?;
                ReferenceFrame::Lvlh(Arc::clone(orbit))
            }
        })
    }
}
