//! Frames in which references are expressed.

use super::{Any, pose};
use crate::arrays::vector;
use crate::errors::{IntoPython, fields, raise};
use crate::pickling::{ConstructorCall, Reduced, call_of};
use onorbit_core::model::Model;
use onorbit_core::number_text::names;
use onorbit_core::orbit::Orbit;
use onorbit_core::reference::{MovingFrame, ReferenceFrame, Target};
use pyo3::prelude::*;
use std::sync::Arc;

/// Frame for references that moves with constant velocity and constant angular velocity in W.
///
/// Parameters
/// ----------
/// pose : (4, 4) array
///     Pose in W at time zero, m.
/// velocity : (3,) array, optional
///     Constant velocity of the origin, W axes, m/s; default: zero.
/// spin : (3,) array, optional
///     Constant angular velocity, W axes, rad/s; default: zero.
///
/// Raises
/// ------
/// ControlError, InputError, ShapeError
///     If the pose is not a rigid transform, a number is not finite, or an array has the wrong shape.
#[pyclass(name = "Target", frozen, module = "onorbit_rs")]
pub(crate) struct PyTarget {
    target: Target,
    constructor_call: ConstructorCall,
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
        let constructor_call = call_of!(py, "Target", pose, velocity, spin)?;
        let start = self::pose(pose)?;
        let (velocity, spin) = (vector(velocity, "velocity", [0.0; 3])?, vector(spin, "spin", [0.0; 3])?);
        let target = Target::at(start, velocity, spin);
        Ok(Self { target: target.map_err(|error| error.into_python(py))?, constructor_call })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }
}

/// Objects to which references and controls of a system may refer: the reference orbit, and the events and
/// systems of the world.
#[derive(Clone, Copy, Default)]
pub(crate) struct Around<'a> {
    pub(crate) orbit: Option<&'a Arc<dyn Orbit>>,
    /// Names of the events of the world.
    pub(crate) events: &'a [String],
    /// Names and models of the systems; empty for a single robot.
    pub(crate) systems: &'a [(String, Arc<Model>)],
}

/// Frame of a reference whose names are not yet resolved in the world of a simulation.
pub(super) enum Frame {
    World,
    Lvlh,
    Base,
    Target(Target),
    /// Frame of another system, as the path ``SYSTEM/FRAME``.
    System(String),
}

impl Frame {
    /// Reads the argument `frame`: a name or a target; W by default. Any other value is an error.
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
            Some(path) if path.contains('/') => Ok(Self::System(path.to_owned())),
            _ => {
                let py = value.py();
                let got = value.repr().map_or_else(|_| "?".to_owned(), |text| text.to_string());
                let message = format!(
                    "frame is {got}; it must be 'world', 'lvlh', 'base', a frame of another system as \
                     SYSTEM/FRAME, or a Target"
                );
                Err(raise(py, "ControlError", &message, &fields!(py, "name": "frame", "got": got)))
            }
        }
    }

    /// Returns the frame of the core. The frame `"lvlh"` requires the orbit of `around`, and a frame of
    /// another system requires its systems.
    pub(super) fn bind(&self, py: Python<'_>, around: &Around<'_>) -> PyResult<ReferenceFrame> {
        Ok(match self {
            Self::World => ReferenceFrame::World,
            Self::Base => ReferenceFrame::Base,
            Self::Target(target) => ReferenceFrame::Target(target.clone()),
            Self::System(path) => {
                ReferenceFrame::System(moving_frame(py, "the reference is given in", path, around.systems)?)
            }
            Self::Lvlh => {
                let message =
                    "a reference in the frame 'lvlh' requires an orbit, but there is none; set orbit";
                let orbit = around.orbit.ok_or_else(|| {
                    raise(py, "ControlError", message, &fields!(py, "name": "frame", "got": "lvlh"))
                })?;
                ReferenceFrame::Lvlh(Arc::clone(orbit))
            }
        })
    }
}

/// Returns the frame with the path `SYSTEM/FRAME`. The message of an error begins with `what`.
pub(crate) fn moving_frame(
    py: Python<'_>,
    what: &str,
    path: &str,
    systems: &[(String, Arc<Model>)],
) -> PyResult<MovingFrame> {
    let (name, frame) = path.split_once('/').unwrap_or((path, ""));
    let Some(system) = systems.iter().position(|(known, _)| known == name) else {
        let known: Vec<&str> = systems.iter().map(|(name, _)| name.as_str()).collect();
        let reason = if known.is_empty() {
            "the run has only one robot; simulate a World that contains this system, or omit the frame"
                .to_owned()
        } else {
            format!("no system of the world is named '{name}'; {}", names(&known, "system"))
        };
        let message = format!("{what} the frame '{path}' of another system, but {reason}");
        return Err(raise(py, "ControlError", &message, &fields!(py, "name": "frame", "got": path)));
    };
    let frame = systems[system].1.frame(frame).map_err(|error| error.into_python(py))?;
    Ok(MovingFrame::new(system, frame))
}
