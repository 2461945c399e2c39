//! Converts errors of epochs, Earth orientation, Sun and Moon to Python exceptions.

use super::{IntoPython, fields, raise};
use onorbit_core::earth::EarthError;
use pyo3::prelude::*;

impl IntoPython for EarthError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        let fields = match &self {
            Self::Epoch { text, .. } | Self::BeforeUtc { text } => fields!(py, "name": "epoch", "got": text),
            Self::NeedsEpoch { what } => fields!(py, "name": what),
            Self::OutsideSpan { what, time, from, to, .. } => {
                fields!(py, "name": what, "got": time, "expected": (from, to))
            }
            Self::NotFinite { name, value } => fields!(py, "name": name, "got": value),
            Self::Parameter { name, value, expected, .. } | Self::Segment { name, value, expected } => {
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
            Self::ShortTable { got } => {
                fields!(py, "name": "eop", "got": got, "expected": "at least 2 rows")
            }
            Self::SegmentLength { got, per_interval } => {
                let expected = format!("a positive multiple of {}", per_interval.saturating_mul(3));
                fields!(py, "name": "coefficients", "got": got, "expected": expected)
            }
            _ => fields!(py,),
        };
        raise(py, "EarthError", &message, &fields)
    }
}
