//! The one bridge from errors of the core to the classes of `onorbit_rs.exceptions`.

use crate::trace::PyTrace;
use onorbit_core::batch::InputError;
use onorbit_core::control::ControlError;
use onorbit_core::earth::EarthError;
use onorbit_core::environment::EnvironmentError;
use onorbit_core::environment::atmosphere::AtmosphereError;
use onorbit_core::environment::surfaces::SurfaceError;
use onorbit_core::gravity::GravityError;
use onorbit_core::model::ModelError;
use onorbit_core::model::urdf::{UrdfError, UrdfProblem};
use onorbit_core::orbit::sgp4::{ElementSetError, Sgp4Error};
use onorbit_core::orbit::{OrbitError, PathError};
use onorbit_core::reference::ReferenceError;
use onorbit_core::simulation::SimulationError;
use onorbit_core::spatial::SplineError;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// An error of the core that knows its Python class.
pub(crate) trait IntoPython {
    fn into_python(self, py: Python<'_>) -> PyErr;
}

/// `onorbit_rs.exceptions.<class>(message, **fields)`.
pub(crate) fn raise(py: Python<'_>, class: &str, message: &str, fields: &Bound<'_, PyDict>) -> PyErr {
    let make = || -> PyResult<Bound<'_, PyAny>> {
        let module = py.import("onorbit_rs.exceptions")?;
        module.getattr(class)?.call((message,), Some(fields))
    };
    match make() {
        Ok(error) => PyErr::from_value(error),
        Err(_) => PyRuntimeError::new_err(message.to_owned()),
    }
}

/// An error without fields.
pub(crate) fn plain(py: Python<'_>, class: &str, message: &str) -> PyErr {
    raise(py, class, message, &PyDict::new(py))
}

/// Collects the fields of an error; what cannot be converted is left out of them.
macro_rules! fields {
    ($py:expr, $($name:literal: $value:expr),* $(,)?) => {{
        let fields = pyo3::types::PyDict::new($py);
        $( let _ = fields.set_item($name, $value); )*
        fields
    }};
}
pub(crate) use fields;

impl IntoPython for ModelError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        match &self {
            Self::UnknownName { what, name, candidates } => {
                let fields = fields!(
                    py, "name": name, "kind": what, "known": candidates, "suggestion": self.suggestion(),
                );
                raise(py, "FrameError", &message, &fields)
            }
            Self::NotFinite { name, .. } => raise(py, "ModelError", &message, &fields!(py, "link": name)),
            Self::MasslessSubtree { joint, link } => {
                raise(py, "ModelError", &message, &fields!(py, "joint": joint, "link": link))
            }
            Self::MassNotPositive { link, .. }
            | Self::InertiaWithoutMass { link }
            | Self::IndefiniteInertia { link, .. }
            | Self::AsymmetricInertia { link, .. }
            | Self::SingularBase { link } => raise(py, "ModelError", &message, &fields!(py, "link": link)),
            Self::ZeroAxis { joint } | Self::Negative { joint, .. } | Self::LimitsReversed { joint, .. } => {
                raise(py, "ModelError", &message, &fields!(py, "joint": joint))
            }
            _ => plain(py, "ModelError", &message),
        }
    }
}

impl IntoPython for UrdfError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        let path = self.file.as_ref().map(|file| file.display().to_string());
        let fields = fields!(py, "path": path);
        let class = match &*self.problem {
            UrdfProblem::NotFound => "NotFoundError",
            UrdfProblem::IsFolder | UrdfProblem::Unreadable { .. } => "ReadError",
            _ => "ModelError",
        };
        raise(py, class, &message, &fields)
    }
}

impl IntoPython for InputError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        match &self {
            Self::WrongLength { name, expected, got } | Self::WrongBatch { name, expected, got } => raise(
                py,
                "ShapeError",
                &message,
                &fields!(py, "name": name, "expected": expected, "got": got),
            ),
            Self::NotFinite { name, value, .. } => {
                raise(py, "InputError", &message, &fields!(py, "name": name, "got": value))
            }
            Self::Singular { .. } => plain(py, "ConvergenceError", &message),
            Self::Adaptive => {
                let fields = fields!(py, "name": "integrator", "got": "dormand_prince");
                raise(py, "InputError", &message, &fields)
            }
            Self::NoThreads => raise(py, "InputError", &message, &fields!(py, "name": "threads", "got": 0)),
            Self::NeedsOrbit => plain(py, "ControlError", &message),
            Self::Orbit { orbit, source } => {
                let error = source.clone().into_python(py);
                for (name, value) in [("index", orbit.into_py_any(py)), ("message", message.into_py_any(py))]
                {
                    let _ = value.and_then(|value| error.value(py).setattr(name, value));
                }
                error
            }
            Self::NoEllipse { name, value, expected, .. } => {
                let fields = fields!(py, "name": name, "got": value, "expected": expected);
                raise(py, "InputError", &message, &fields)
            }
            Self::Diverged { .. } => plain(py, "SimulationError", &message),
            Self::QuaternionNorm { norm, .. } => {
                raise(py, "InputError", &message, &fields!(py, "name": "q", "got": norm, "expected": 1.0))
            }
        }
    }
}

impl IntoPython for OrbitError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        match &self {
            Self::NotFinite { name, value } | Self::NotPositive { name, value } => {
                raise(py, "OrbitError", &message, &fields!(py, "name": name, "got": value))
            }
            Self::AxisSign { semi_major_axis, .. } | Self::ParabolaHasNoAxis { semi_major_axis } => {
                let fields = fields!(py, "name": "semi_major_axis", "got": semi_major_axis);
                raise(py, "OrbitError", &message, &fields)
            }
            Self::NegativeEccentricity { value } => {
                raise(py, "OrbitError", &message, &fields!(py, "name": "eccentricity", "got": value))
            }
            Self::Inclination { value } => {
                raise(py, "OrbitError", &message, &fields!(py, "name": "inclination", "got": value))
            }
            Self::ParabolaHasNoMeanAnomaly { value } => {
                raise(py, "OrbitError", &message, &fields!(py, "name": "mean_anomaly", "got": value))
            }
            Self::BeyondAsymptote { value, .. } => {
                raise(py, "OrbitError", &message, &fields!(py, "name": "true_anomaly", "got": value))
            }
            Self::NotClosed { eccentricity } => {
                raise(py, "OrbitError", &message, &fields!(py, "name": "eccentricity", "got": eccentricity))
            }
            Self::BelowSurface { time, distance, smallest_radius } => {
                let fields =
                    fields!(py, "name": "t", "time": time, "got": distance, "expected": smallest_radius);
                raise(py, "OrbitError", &message, &fields)
            }
            Self::TooManySteps { time, .. } | Self::StepTooShort { time, .. } => {
                raise(py, "OrbitError", &message, &fields!(py, "name": "t", "time": time))
            }
            Self::Path(error) => path_error(py, error, &message),
            Self::Gravity(error) => error.clone().into_python(py),
            Self::ElementSet(error) => element_set_error(py, error, &message),
            Self::Sgp4(error) => sgp4_error(py, error, &message),
            _ => plain(py, "OrbitError", &message),
        }
    }
}

fn path_error(py: Python<'_>, error: &PathError, message: &str) -> PyErr {
    let fields = match error {
        PathError::TimeOutOfPath { time, start, end } => {
            fields!(py, "name": "t", "got": time, "time": time, "start": start, "end": end)
        }
        PathError::NotIncreasing { time, .. } => fields!(py, "name": "times", "got": time),
        PathError::NotFinite { name, value, .. } => fields!(py, "name": name, "got": value),
        PathError::WrongLength { name, expected, got } => {
            fields!(py, "name": name, "expected": expected, "got": got)
        }
        PathError::TooFewPoints { got } => fields!(py, "name": "times", "got": got, "expected": "at least 2"),
        PathError::QuaternionNorm { norm, .. } => {
            fields!(py, "name": "attitudes", "got": norm, "expected": 1.0)
        }
        PathError::TurnTooFar { angle, .. } => fields!(py, "name": "attitudes", "got": angle),
        _ => fields!(py,),
    };
    raise(py, "PathError", message, &fields)
}

fn element_set_error(py: Python<'_>, error: &ElementSetError, message: &str) -> PyErr {
    let fields = match error {
        ElementSetError::Length { line, got } => fields!(py, "line": line, "got": got, "expected": 69),
        ElementSetError::Column { line, column, got, expected } => {
            fields!(py, "line": line, "column": column, "got": got, "expected": expected)
        }
        ElementSetError::Checksum { line, got, expected } => {
            fields!(py, "line": line, "column": 69, "got": got, "expected": expected)
        }
        ElementSetError::TwoSatellites { first, second } => {
            fields!(py, "line": 2, "column": 3, "got": second, "expected": first)
        }
        ElementSetError::Missing { key } => fields!(py, "name": key),
        ElementSetError::Entry { key, got, expected } => {
            fields!(py, "name": key, "got": got, "expected": expected)
        }
        ElementSetError::Range { name, got, range } => {
            fields!(py, "name": name, "got": got, "expected": (*range.start(), *range.end()))
        }
        _ => fields!(py,),
    };
    raise(py, "ElementSetError", message, &fields)
}

fn sgp4_error(py: Python<'_>, error: &Sgp4Error, message: &str) -> PyErr {
    let fields = fields!(py, "code": error.code(), "time": error.time(), "got": error.value());
    raise(py, "Sgp4Error", message, &fields)
}

impl IntoPython for EarthError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        let fields = match &self {
            Self::Epoch { text } | Self::BeforeUtc { text } => fields!(py, "name": "epoch", "got": text),
            Self::NeedsEpoch { what } => fields!(py, "name": what),
            Self::OutsideSpan { what, time, from, to, .. } => {
                fields!(py, "name": what, "got": time, "expected": (from, to))
            }
            Self::NotFinite { name, value } => fields!(py, "name": name, "got": value),
            Self::Parameter { name, value, expected, .. } => {
                fields!(py, "name": name, "got": value, "expected": expected)
            }
            Self::Table { line, .. } => fields!(py, "name": "eop", "got": line),
            Self::NearCentre { distance, minimum } => {
                fields!(py, "name": "r", "got": distance, "expected": minimum)
            }
            Self::OtherEpoch { orbit, run } => fields!(py, "name": "epoch", "got": run, "expected": orbit),
            Self::OtherAxes { orbit, run } => fields!(py, "name": "axes", "got": run, "expected": orbit),
            Self::WrongLength { name, expected, got } => {
                fields!(py, "name": name, "got": got, "expected": expected)
            }
            _ => fields!(py,),
        };
        raise(py, "EarthError", &message, &fields)
    }
}

impl IntoPython for GravityError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let fields = match &self {
            Self::Earth(error) => return error.clone().into_python(py),
            Self::NotFinite { name, value } | Self::NotPositive { name, value } => {
                fields!(py, "name": name, "got": value)
            }
            Self::Degree { degree } | Self::ZonalDegree { degree } => {
                fields!(py, "name": "degree", "got": degree)
            }
            Self::BeyondModel { degree, highest, .. } => {
                fields!(py, "name": "degree", "got": degree, "expected": highest)
            }
            Self::OrderAboveDegree { degree, order } => {
                fields!(py, "name": "order", "got": order, "expected": degree)
            }
            Self::UnknownModel { name, known } => {
                fields!(py, "name": "model", "got": name, "expected": known)
            }
            Self::WrongLength { name, expected, got } => {
                fields!(py, "name": name, "got": got, "expected": expected)
            }
            Self::Unreadable { file, .. } | Self::Truncated { file, .. } => fields!(py, "path": file),
            Self::Header { file, key, .. } => fields!(py, "path": file, "name": key),
            Self::Row { file, line, .. }
            | Self::Twice { file, line, .. }
            | Self::VariesWithTime { file, line, .. } => fields!(py, "path": file, "line": line),
            Self::BelowSurface { distance, minimum } => {
                fields!(py, "name": "r", "got": distance, "expected": minimum)
            }
            Self::OtherPlanet { field, orbit } => {
                fields!(py, "name": "mu", "got": orbit, "expected": field)
            }
            _ => fields!(py,),
        };
        raise(py, "GravityError", &self.to_string(), &fields)
    }
}

impl IntoPython for EnvironmentError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        match &self {
            Self::Gravity(error) => error.clone().into_python(py),
            Self::NotFinite { name, value } => {
                raise(py, "EffectError", &message, &fields!(py, "name": name, "got": value))
            }
            Self::EmptyInterval { start, end } => {
                raise(py, "EffectError", &message, &fields!(py, "name": "start, end", "got": (*start, *end)))
            }
            Self::Atmosphere(source) => source.clone().into_python(py),
            Self::Surface(source) => source.clone().into_python(py),
            Self::Earth(source) => source.clone().into_python(py),
            _ => plain(py, "EffectError", &message),
        }
    }
}

impl IntoPython for AtmosphereError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        let fields = match &self {
            Self::Earth(source) => return source.clone().into_python(py),
            Self::BelowSurface { altitude } => {
                fields!(py, "name": "altitude", "got": altitude, "expected": "at least 0 m")
            }
            Self::OutsideLayers { altitude, lowest, highest, .. } => {
                fields!(py, "name": "altitude", "got": altitude, "expected": (lowest, highest))
            }
            Self::Value { name, value, expected } => {
                fields!(py, "name": name, "got": value, "expected": expected)
            }
            Self::MissingSpaceWeather { name, date } => fields!(py, "name": name, "got": date),
            Self::OutsideTable { date, first, last } => {
                fields!(py, "name": "date", "got": date, "expected": (first, last))
            }
            _ => fields!(py,),
        };
        raise(py, "EffectError", &message, &fields)
    }
}

impl IntoPython for SurfaceError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        let fields = match &self {
            Self::Value { name, value, expected } => {
                fields!(py, "name": name, "got": value, "expected": expected)
            }
            Self::Reflection { specular, diffuse } => {
                fields!(py, "name": "specular, diffuse", "got": (*specular, *diffuse))
            }
            _ => fields!(py, "name": "surfaces"),
        };
        raise(py, "EffectError", &message, &fields)
    }
}

impl IntoPython for ReferenceError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        match &self {
            Self::DurationNotPositive { value } => {
                raise(py, "ControlError", &message, &fields!(py, "name": "duration", "got": value))
            }
            Self::Ramp { value } => {
                raise(py, "ControlError", &message, &fields!(py, "name": "ramp", "got": value))
            }
            Self::LimitNotPositive { value } => {
                raise(py, "ControlError", &message, &fields!(py, "name": "limit", "got": value))
            }
            Self::LastRow { row } => {
                raise(py, "ControlError", &message, &fields!(py, "name": "pose", "got": row.to_vec()))
            }
            Self::WrongLength { name, expected, got } => raise(
                py,
                "ShapeError",
                &message,
                &fields!(py, "name": name, "expected": expected, "got": got),
            ),
            Self::NoJoint { joint, .. } => {
                raise(py, "ControlError", &message, &fields!(py, "name": "joint", "got": joint))
            }
            Self::Spline(SplineError::WrongLength { name, expected, got }) => raise(
                py,
                "ShapeError",
                &message,
                &fields!(py, "name": name, "expected": expected, "got": got),
            ),
            _ => plain(py, "ControlError", &message),
        }
    }
}

impl IntoPython for ControlError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        match self {
            Self::User(error) => match error.downcast::<PyErr>() {
                Ok(raised) => *raised, // that very object, traceback included
                Err(other) => plain(py, "ControlError", &other.to_string()),
            },
            Self::WrongLength { name, expected, got } => raise(
                py,
                "ShapeError",
                &message,
                &fields!(py, "name": name, "expected": expected, "got": got),
            ),
            Self::NotFinite { name, value } | Self::Negative { name, value } => {
                raise(py, "ControlError", &message, &fields!(py, "name": name, "got": value))
            }
            _ => plain(py, "ControlError", &message),
        }
    }
}

impl SimulationErrorExt for SimulationError {}

/// Turns the error of a run into its class, the trace so far attached where there is one.
pub(crate) trait SimulationErrorExt: Sized + Into<SimulationError> {
    fn into_python_with(self, py: Python<'_>, trace: Option<Py<PyTrace>>) -> PyErr {
        let error: SimulationError = self.into();
        let message = error.to_string();
        match error {
            SimulationError::WrongLength { name, expected, got } => raise(
                py,
                "ShapeError",
                &message,
                &fields!(py, "name": name, "expected": expected, "got": got),
            ),
            SimulationError::NotFinite { name, value, .. } | SimulationError::NotPositive { name, value } => {
                raise(py, "InputError", &message, &fields!(py, "name": name, "got": value))
            }
            SimulationError::QuaternionNorm { norm } => {
                raise(py, "InputError", &message, &fields!(py, "name": "q", "got": norm, "expected": 1.0))
            }
            SimulationError::Tolerance { value } => {
                raise(py, "InputError", &message, &fields!(py, "name": "tolerance", "got": value))
            }
            SimulationError::RereferenceBeyond { value } => {
                raise(py, "InputError", &message, &fields!(py, "name": "rereference_beyond", "got": value))
            }
            SimulationError::Restitution { value } => {
                raise(py, "InputError", &message, &fields!(py, "name": "restitution", "got": value))
            }
            SimulationError::OutsideLimits { joint, value, lower, upper } => raise(
                py,
                "InputError",
                &message,
                &fields!(py, "name": joint, "got": value, "expected": (lower, upper)),
            ),
            SimulationError::StepTooSmall { time, step } => raise(
                py,
                "SimulationError",
                &message,
                &fields!(py, "time": time, "step": step, "trace": trace),
            ),
            SimulationError::Earth(source) => source.into_python(py),
            SimulationError::RecordEvery => plain(py, "InputError", &message),
            SimulationError::NeedsOrbit { .. } => plain(py, "OrbitError", &message),
            SimulationError::NeedsReference
            | SimulationError::NeedsTool
            | SimulationError::OtherTool { .. } => plain(py, "ControlError", &message),
            SimulationError::ReferenceStartsAway { position, angle, tolerance } => raise(
                py,
                "ControlError",
                &message,
                &fields!(py, "name": "reference", "got": (position, angle), "expected": tolerance.to_vec()),
            ),
            SimulationError::JointsStartAway { offset, tolerance, .. } => raise(
                py,
                "ControlError",
                &message,
                &fields!(py, "name": "reference", "got": offset, "expected": tolerance),
            ),
            SimulationError::UnknownFrame { .. } | SimulationError::TooManyRows { .. } => {
                plain(py, "InputError", &message)
            }
            SimulationError::Diverged { time, q, v } => raise(
                py,
                "SimulationError",
                &message,
                &fields!(py, "time": time, "q": q, "v": v, "trace": trace),
            ),
            SimulationError::Interrupted { time } => {
                raise(py, "RunInterrupted", &message, &fields!(py, "time": time, "trace": trace))
            }
            SimulationError::Orbit { time, source } => with_trace(py, source.into_python(py), time, trace),
            SimulationError::Environment { time, source } => {
                with_trace(py, source.into_python(py), time, trace)
            }
            SimulationError::Gravity(source) => source.into_python(py),
            SimulationError::Checkpoint(_) => plain(py, "CheckpointError", &message),
            SimulationError::Reference { time, source } => {
                with_trace(py, source.into_python(py), time, trace)
            }
            SimulationError::Control(source @ ControlError::User(_)) => {
                let raised = source.into_python(py);
                let _ = raised.value(py).setattr("trace", trace); // an object without attributes goes without
                raised
            }
            SimulationError::Control(source) => source.into_python(py),
        }
    }
}

/// Adds the instant and the trace so far to an error.
fn with_trace(py: Python<'_>, error: PyErr, time: f64, trace: Option<Py<PyTrace>>) -> PyErr {
    let value = error.value(py);
    let _ = value.setattr("time", time);
    let _ = value.setattr("trace", trace);
    error
}
