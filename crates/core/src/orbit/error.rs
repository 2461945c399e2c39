//! What can be wrong with a reference orbit.

use super::custom_path::PathError;
use super::sgp4::{ElementSetError, Sgp4Error};
use crate::gravity::GravityError;
use crate::number_text::{count, short, unlike};

/// Refusals of the `orbit` module; each carries the offending numbers.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OrbitError {
    /// The field that the orbit obeys has no answer.
    #[error(transparent)]
    Gravity(#[from] GravityError),
    /// An input is infinite or not a number.
    #[error("{name} is {value}, a finite number is needed", value = short(*value))]
    NotFinite {
        /// Which input.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A quantity is beyond what makes sense.
    #[error("{name} is {value}, {expected} is needed", value = short(*value))]
    OutOfRange {
        /// Which input.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is accepted.
        expected: &'static str,
    },
    /// A number so large that products of a few like it would overflow.
    #[error(
        "{name} is {value}, numbers between -1e60 and 1e60 are accepted (in SI units)",
        value = short(*value)
    )]
    TooLarge {
        /// Which input.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A quantity that must be positive is not.
    #[error("{name} is {value}, it must be greater than zero", value = short(*value))]
    NotPositive {
        /// Which input.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// The eccentricity is below zero.
    #[error("eccentricity is {value}, it must be zero or greater", value = short(*value))]
    NegativeEccentricity {
        /// What was given.
        value: f64,
    },
    /// The sign of the semi-major axis contradicts the eccentricity.
    #[error(
        "semi-major axis is {semi_major_axis} m with eccentricity {eccentricity}: \
         it must be positive below eccentricity 1 and negative above it",
        semi_major_axis = short(*semi_major_axis), eccentricity = short(*eccentricity)
    )]
    AxisSign {
        /// Semi-major axis, m.
        semi_major_axis: f64,
        /// Eccentricity.
        eccentricity: f64,
    },
    /// A parabola has no semi-major axis.
    #[error(
        "semi-major axis is {semi_major_axis} m with eccentricity 1: a parabola has none, \
         give its semi-latus rectum",
        semi_major_axis = short(*semi_major_axis)
    )]
    ParabolaHasNoAxis {
        /// Semi-major axis, m.
        semi_major_axis: f64,
    },
    /// A parabola has no mean anomaly.
    #[error(
        "mean anomaly {value} rad is given with eccentricity 1: a parabola has none, \
         give the true anomaly or the time of periapsis",
        value = short(*value)
    )]
    ParabolaHasNoMeanAnomaly {
        /// What was given, rad.
        value: f64,
    },
    /// Secular rates and relative elements belong to ellipses.
    #[error(
        "eccentricity is {eccentricity}, it must be below 1: this is for ellipses alone",
        eccentricity = short(*eccentricity)
    )]
    NotClosed {
        /// Eccentricity.
        eccentricity: f64,
    },
    /// The chief flies in the equator's plane.
    #[error(
        "the chief's inclination is {inclination} rad: in the equator's plane it has no node and no relative \
         elements; use local coordinates instead",
        inclination = short(*inclination)
    )]
    Equatorial {
        /// Inclination of the chief, rad.
        inclination: f64,
    },
    /// No velocity leads to the origin in this time.
    #[error(
        "no impulse leads to the origin in {time} s at a mean motion of {mean_motion} rad/s: \
         x or z return at that time whatever the velocity; choose another",
        time = short(*time), mean_motion = short(*mean_motion)
    )]
    NoIntercept {
        /// Time to the origin, s.
        time: f64,
        /// Mean motion, rad/s.
        mean_motion: f64,
    },
    /// The inclination lies outside [0, π].
    #[error(
        "inclination is {value} rad, it must lie between 0 and π (are these degrees?)",
        value = short(*value)
    )]
    Inclination {
        /// What was given, rad.
        value: f64,
    },
    /// The true anomaly lies beyond the asymptote of an open orbit.
    #[error(
        "true anomaly is {value} rad, at eccentricity {eccentricity} it must lie \
         strictly within ±{limit} rad",
        value = unlike(*value, &[*limit, -*limit]), eccentricity = short(*eccentricity), limit = short(*limit)
    )]
    BeyondAsymptote {
        /// What was given, rad.
        value: f64,
        /// Eccentricity.
        eccentricity: f64,
        /// True anomaly of the asymptote, rad.
        limit: f64,
    },
    /// Position and velocity are parallel, or one of them is zero.
    #[error(
        "rectilinear orbit: position ({radius} m) and velocity ({speed} m/s) enclose an \
         angle of sine {sine}, it must exceed {limit}",
        radius = short(*radius), speed = short(*speed), sine = unlike(*sine, &[*limit]), limit = short(*limit)
    )]
    Rectilinear {
        /// Length of the position, m.
        radius: f64,
        /// Length of the velocity, m/s.
        speed: f64,
        /// Sine of the angle between them.
        sine: f64,
        /// Smallest sine accepted.
        limit: f64,
    },
    /// No local orbital frame exists here.
    #[error(
        "the local orbital frame is undefined at {radius} m and {speed} m/s (sine {sine} \
         between them): a reference that stands still or moves along its radius has none",
        radius = short(*radius), speed = short(*speed), sine = short(*sine)
    )]
    UndefinedFrame {
        /// Length of the position, m.
        radius: f64,
        /// Length of the velocity, m/s.
        speed: f64,
        /// Sine of the angle between them.
        sine: f64,
    },
    /// The time lies too far from the epoch for the phase to mean anything.
    #[error(
        "time {time} s is too far from the epoch {epoch} s, at most {limit} s from it are accepted",
        time = short(*time), epoch = short(*epoch), limit = short(*limit)
    )]
    TimeOutOfRange {
        /// What was given, s.
        time: f64,
        /// Epoch of the orbit, s.
        epoch: f64,
        /// Largest distance from the epoch, s.
        limit: f64,
    },
    /// An array has the wrong length.
    #[error("{name} holds {got}, expected {expected}", got = count(*got, "number"))]
    WrongLength {
        /// Which array.
        name: &'static str,
        /// Length needed.
        expected: usize,
        /// Length given.
        got: usize,
    },
    /// The orbit lies inside the planet.
    #[error(
        "the orbit is inside the planet at t = {time} s: {distance} m from its centre, \
         at least {minimum} m are accepted: end the run earlier, or raise the orbit",
        time = short(*time), distance = unlike(*distance, &[*minimum]), minimum = short(*minimum)
    )]
    BelowSurface {
        /// When, s.
        time: f64,
        /// Distance from the planet's centre, m.
        distance: f64,
        /// Of the planet's lowest ground, or of where its field ends: distance from the centre, m.
        minimum: f64,
    },
    /// The orbit begins inside the planet.
    #[error(
        "the orbit begins inside the planet: {distance} m from its centre, at least {minimum} m are \
         accepted (m and m/s from the centre are needed: are these kilometres, or an altitude?)",
        distance = unlike(*distance, &[*minimum]), minimum = short(*minimum)
    )]
    BeginsBelowSurface {
        /// Distance from the planet's centre, m.
        distance: f64,
        /// Of the planet's lowest ground, or of where its field ends: distance from the centre, m.
        minimum: f64,
    },
    /// The time is more steps away than are kept.
    #[error(
        "integrating from {epoch} s took {steps} steps to {time} s, no more are kept: \
         give an initial state nearer to the times asked for",
        time = short(*time), epoch = short(*epoch)
    )]
    TooManySteps {
        /// Where the steps end, s.
        time: f64,
        /// Time of the initial state, s.
        epoch: f64,
        /// How many there are.
        steps: usize,
    },
    /// No step is short enough for the field.
    #[error(
        "the orbit cannot be integrated beyond t = {time} s: a step of {length} s is still too long \
         (does the field jump there?)",
        time = short(*time), length = short(*length)
    )]
    StepTooShort {
        /// When, s.
        time: f64,
        /// Length of the step, s.
        length: f64,
    },
    /// An element set cannot be read.
    #[error(transparent)]
    ElementSet(#[from] ElementSetError),
    /// SGP4 has no state here.
    #[error(transparent)]
    Sgp4(#[from] Sgp4Error),
    /// A path cannot be built, or has no state here.
    #[error(transparent)]
    Path(#[from] PathError),
}

/// Largest size of an input: products of five of them are still numbers.
pub(crate) const LARGEST: f64 = 1e60;

/// Returns `value` if it is finite and not too large.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64, OrbitError> {
    if !value.is_finite() {
        return Err(OrbitError::NotFinite { name, value });
    }
    if value.abs() > LARGEST {
        return Err(OrbitError::TooLarge { name, value });
    }
    Ok(value)
}

/// `value` if it is finite and greater than zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, OrbitError> {
    if finite(name, value)? > 0.0 { Ok(value) } else { Err(OrbitError::NotPositive { name, value }) }
}
