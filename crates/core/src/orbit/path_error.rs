//! Errors of paths through given points.

use crate::number_text::{count, exact, short, unlike};
use crate::spatial::SplineError;

/// Errors of paths: invalid points, or a time outside the path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)] // the fields are what the messages say
pub enum PathError {
    #[error("the path has {got}; give at least 2 points", got = count(*got, "point"))]
    TooFewPoints { got: usize },
    #[error("the array '{name}' has {got}; expected {expected}, one per time", got = count(*got, "row"))]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error(
        "{name}[{index}] holds {value}; expected finite numbers between -1e60 and 1e60 (SI units)",
        value = exact(*value)
    )]
    NotFinite { name: &'static str, index: usize, value: f64 },
    #[error(
        "times[{index}] is {time} s, but the time before it is {before} s; times must increase by at least 1e-9 s; \
         sort the rows and remove duplicates",
        before = short(*before), time = unlike(*time, &[*before])
    )]
    NotIncreasing { index: usize, before: f64, time: f64 },
    #[error("the path has accelerations without velocities; give both, only velocities, or neither")]
    AccelerationsAlone,
    #[error(
        "attitudes[{index}] (x, y, z, w) has norm {norm}; it must be 1 within 1e-6; normalise it",
        norm = unlike(*norm, &[1.0])
    )]
    QuaternionNorm { index: usize, norm: f64 },
    #[error(
        "the attitude rotates by {angle} rad from point {before} to point {index}; it must rotate by at \
         most 2 rad, so that the direction of the rotation is clear; give intermediate points",
        before = index - 1,
        angle = unlike(*angle, &[2.0])
    )]
    TurnTooFar { index: usize, angle: f64 },
    #[error(
        "the path covers {start} s to {end} s, but its state at t = {time} s is required; give points that cover \
         this time, or continue the path along a straight line beyond its ends with ends=\"coast\"",
        time = unlike(*time, &[*start, *end]), start = short(*start), end = short(*end)
    )]
    TimeOutOfPath { time: f64, start: f64, end: f64 },
    #[error(transparent)]
    Spline(#[from] SplineError),
}
