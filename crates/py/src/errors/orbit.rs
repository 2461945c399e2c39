//! Converts errors of orbits to Python exceptions: invalid definitions, and times without a state.

use super::{IntoPython, fields, plain, raise};
use onorbit_core::orbit::sgp4::{ElementSetError, Sgp4Error};
use onorbit_core::orbit::{OrbitError, PathError};
use pyo3::prelude::*;

impl IntoPython for OrbitError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        match &self {
            Self::NotFinite { name, value }
            | Self::TooLarge { name, value }
            | Self::NotPositive { name, value } => {
                raise(py, "OrbitError", &message, &fields!(py, "name": name, "got": value))
            }
            Self::OutOfRange { name, value, expected } => {
                let fields = fields!(py, "name": name, "got": value, "expected": expected);
                raise(py, "OrbitError", &message, &fields)
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
            Self::BelowSurface { time, distance, minimum } => {
                let fields = fields!(py, "name": "t", "time": time, "got": distance, "expected": minimum);
                raise(py, "OrbitError", &message, &fields)
            }
            Self::BeginsBelowSurface { distance, minimum } => {
                let fields = fields!(py, "name": "r", "got": distance, "expected": minimum);
                raise(py, "OrbitError", &message, &fields)
            }
            Self::TooManySteps { time, .. } | Self::StepTooShort { time, .. } => {
                raise(py, "OrbitError", &message, &fields!(py, "name": "t", "time": time))
            }
            Self::OtherPlanet { mu, expected } => {
                let fields = fields!(py, "name": "mu", "got": mu, "expected": expected);
                raise(py, "OrbitError", &message, &fields)
            }
            Self::NoEpoch { epoch } => {
                raise(py, "OrbitError", &message, &fields!(py, "name": "earth", "got": epoch))
            }
            Self::OtherAxes { orbit, reference } => {
                let fields = fields!(py, "name": "earth", "got": orbit, "expected": reference);
                raise(py, "OrbitError", &message, &fields)
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
        ElementSetError::Range { name, got, range, .. } => {
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
