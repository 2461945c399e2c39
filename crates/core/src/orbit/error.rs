//! Errors of reference orbits.

use super::path_error::PathError;
use super::sgp4::{ElementSetError, Sgp4Error};
use crate::gravity::GravityError;
use crate::number_text::{count, exact, short, unlike};

/// Errors of the `orbit` module, with the offending values.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OrbitError {
    /// The gravity field cannot be evaluated.
    #[error(transparent)]
    Gravity(#[from] GravityError),
    /// An orbit and its reference orbit are around different planets.
    #[error(
        "mu of the orbit is {mu} m³/s², but that of its reference orbit is {expected} m³/s²; give orbits around the same \
         planet",
        mu = unlike(*mu, &[*expected]), expected = short(*expected)
    )]
    OtherPlanet {
        /// Gravitational parameter of the orbit, m³/s².
        mu: f64,
        /// Gravitational parameter of the reference, m³/s².
        expected: f64,
    },
    /// An orbit has an epoch, but the reference has none.
    #[error(
        "the epoch of the orbit is {epoch}, but its reference orbit has no epoch; give 'earth' with an epoch"
    )]
    NoEpoch {
        /// Epoch of the orbit.
        epoch: String,
    },
    /// The axes of an orbit and of its reference orbit differ, and no Earth with an epoch is given to convert
    /// them.
    #[error(
        "the orbit has {orbit} axes, but its reference orbit has {reference} axes; give 'earth' with an \
         epoch, which converts the axes"
    )]
    OtherAxes {
        /// Axes of the orbit.
        orbit: &'static str,
        /// Axes of the reference.
        reference: &'static str,
    },
    /// An input is infinite or not a number.
    #[error("{name} is {value}; expected a finite number", value = short(*value))]
    NotFinite {
        /// Name of the input.
        name: &'static str,
        /// Given value: infinite or NaN.
        value: f64,
    },
    /// An input is outside its accepted range.
    #[error("{name} is {value}; expected {expected}", value = exact(*value))]
    OutOfRange {
        /// Name of the input.
        name: &'static str,
        /// Given value, in SI units.
        value: f64,
        /// Text that describes the accepted range.
        expected: &'static str,
    },
    /// A number is so large that products of several such numbers would overflow.
    #[error(
        "{name} is {value}; it must lie between -1e60 and 1e60 (in SI units)",
        value = exact(*value)
    )]
    TooLarge {
        /// Name of the input.
        name: &'static str,
        /// Given value, in SI units.
        value: f64,
    },
    /// A quantity that must be positive is zero or negative.
    #[error("{name} is {value}; it must be greater than zero (SI units)", value = short(*value))]
    NotPositive {
        /// Name of the input.
        name: &'static str,
        /// Given value, in SI units.
        value: f64,
    },
    /// The eccentricity is negative.
    #[error("eccentricity is {value}; it must be zero or greater", value = short(*value))]
    NegativeEccentricity {
        /// Given eccentricity.
        value: f64,
    },
    /// The sign of the semi-major axis contradicts the eccentricity.
    #[error(
        "semi-major axis is {semi_major_axis} m with eccentricity {eccentricity}; it must be positive below \
         eccentricity 1 and negative above 1",
        semi_major_axis = short(*semi_major_axis), eccentricity = exact(*eccentricity)
    )]
    AxisSign {
        /// Semi-major axis, m.
        semi_major_axis: f64,
        /// Eccentricity.
        eccentricity: f64,
    },
    /// A semi-major axis is given for a parabola, which has none.
    #[error(
        "a semi-major axis of {semi_major_axis} m is given with eccentricity 1, but a parabola has none; give its \
         semi-latus rectum",
        semi_major_axis = short(*semi_major_axis)
    )]
    ParabolaHasNoAxis {
        /// Semi-major axis, m.
        semi_major_axis: f64,
    },
    /// A mean anomaly is given for a parabola, which has none.
    #[error(
        "a mean anomaly of {value} rad is given with eccentricity 1, but a parabola has none; give the true \
         anomaly or the time of periapsis",
        value = short(*value)
    )]
    ParabolaHasNoMeanAnomaly {
        /// Given value, rad.
        value: f64,
    },
    /// The orbit is not an ellipse, but secular rates and relative elements are defined only for ellipses.
    #[error(
        "eccentricity is {eccentricity}; it must be below 1, because secular rates and relative elements require an ellipse",
        eccentricity = exact(*eccentricity)
    )]
    NotClosed {
        /// Eccentricity.
        eccentricity: f64,
    },
    /// The orbit of the chief is equatorial, so its node and the relative elements are undefined.
    #[error(
        "the chief's inclination is {inclination} rad; its sine must exceed 1e-6, because an equatorial orbit has no \
         node and no relative elements; use local coordinates",
        inclination = exact(*inclination)
    )]
    Equatorial {
        /// Inclination of the chief, rad.
        inclination: f64,
    },
    /// No impulse leads to the origin in the given time.
    #[error(
        "no impulse leads to the origin in {time} s at a mean motion of {mean_motion} rad/s, because one direction \
         of the final position does not depend on the initial velocity; choose a different time",
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
        "inclination is {value} rad; it must lie between 0 and π (are these degrees?)",
        value = exact(*value)
    )]
    Inclination {
        /// Given value, rad.
        value: f64,
    },
    /// The true anomaly lies beyond the asymptote of a parabola or hyperbola.
    #[error(
        "true anomaly is {value} rad; at eccentricity {eccentricity} it must lie strictly within ±{limit} rad",
        value = unlike(*value, &[*limit, -*limit]), eccentricity = short(*eccentricity), limit = short(*limit)
    )]
    BeyondAsymptote {
        /// Given value, rad.
        value: f64,
        /// Eccentricity.
        eccentricity: f64,
        /// True anomaly of the asymptote, rad.
        limit: f64,
    },
    /// Position and velocity are parallel, or one of them is zero.
    #[error(
        "the orbit is rectilinear: position ({radius} m) and velocity ({speed} m/s) must be nonzero, and the sine of \
         the angle between them must exceed {limit}{sine}; give a velocity that is not parallel to the position",
        radius = short(*radius), speed = short(*speed), sine = actual_sine(*sine, *limit), limit = short(*limit)
    )]
    Rectilinear {
        /// Distance from the planet's centre, m.
        radius: f64,
        /// Speed, m/s.
        speed: f64,
        /// Sine of the angle between position and velocity; NaN if one of them is zero.
        sine: f64,
        /// Limit that the sine must exceed.
        limit: f64,
    },
    /// The local orbital frame is undefined, because position and velocity are parallel or one of them is
    /// zero.
    #[error(
        "the local orbital frame is undefined: position ({radius} m) and velocity ({speed} m/s) must be \
         nonzero and not parallel{sine}; give an orbit that is not rectilinear",
        radius = short(*radius), speed = short(*speed), sine = sine_between(*sine)
    )]
    UndefinedFrame {
        /// Distance from the planet's centre, m.
        radius: f64,
        /// Speed, m/s.
        speed: f64,
        /// Sine of the angle between position and velocity; NaN if one of them is zero.
        sine: f64,
    },
    /// The time is so far from the epoch that the state would be inaccurate.
    #[error(
        "time is {time} s; it must be within {limit} s of the epoch, {epoch} s",
        time = exact(*time), epoch = short(*epoch), limit = short(*limit)
    )]
    TimeOutOfRange {
        /// Given value, s.
        time: f64,
        /// Epoch of the orbit, s.
        epoch: f64,
        /// Largest distance from the epoch, s.
        limit: f64,
    },
    /// An array has the wrong length.
    #[error("the array '{name}' has {got}; expected {expected}", got = count(*got, "number"))]
    WrongLength {
        /// Name of the array.
        name: &'static str,
        /// Required number of elements.
        expected: usize,
        /// Number of elements of the given array.
        got: usize,
    },
    /// The output arrays of a propagation do not have one row per time.
    #[error(
        "the arrays of positions and velocities have {got}; expected {expected}, one per time",
        got = count(*got, "row")
    )]
    WrongRows {
        /// Number of times.
        expected: usize,
        /// Number of rows.
        got: usize,
    },
    /// A row beyond the last row of the output arrays is set.
    #[error(
        "row {index} does not exist; the arrays of positions and velocities have {rows}",
        rows = count(*rows, "row")
    )]
    UnknownRow {
        /// Index of the row, counted from 0.
        index: usize,
        /// Number of rows.
        rows: usize,
    },
    /// The orbit lies inside the planet.
    #[error(
        "the orbit is inside the planet at t = {time} s, {distance} m from its centre; expected at least \
         {minimum} m; end the run earlier or raise the orbit",
        time = short(*time), distance = unlike(*distance, &[*minimum]), minimum = short(*minimum)
    )]
    BelowSurface {
        /// Simulation time, s.
        time: f64,
        /// Distance from the planet's centre, m.
        distance: f64,
        /// Smallest accepted distance from the planet's centre, m: the lowest ground, or the limit of the
        /// gravity field.
        minimum: f64,
    },
    /// The initial position of the orbit is inside the planet.
    #[error(
        "the orbit begins inside the planet, {distance} m from its centre; expected at least {minimum} m; \
         give position and velocity relative to the centre in m and m/s (are these kilometres, or an altitude?)",
        distance = unlike(*distance, &[*minimum]), minimum = short(*minimum)
    )]
    BeginsBelowSurface {
        /// Distance from the planet's centre, m.
        distance: f64,
        /// Smallest accepted distance from the planet's centre, m: the lowest ground, or the limit of the
        /// gravity field.
        minimum: f64,
    },
    /// The requested time needs more integration steps than permitted.
    #[error(
        "the integration from {epoch} s reached the limit of {steps} steps at {time} s; give an initial state \
         nearer to the requested times",
        time = short(*time), epoch = short(*epoch)
    )]
    TooManySteps {
        /// End of the last step, s.
        time: f64,
        /// Time of the initial state, s.
        epoch: f64,
        /// Largest permitted number of steps.
        steps: usize,
    },
    /// The integration needs a smaller step than permitted.
    #[error(
        "the orbit cannot be integrated beyond t = {time} s: the integrator requires a step of {length} s, but steps \
         must be longer than {shortest} s; check whether the gravity field is discontinuous there, or whether t is \
         so large that shorter steps do not change it",
        time = short(*time), length = short(length.abs()), shortest = short(*shortest)
    )]
    StepTooShort {
        /// Simulation time at which the step begins, s.
        time: f64,
        /// Length of the step that is too short, s; negative for an integration backwards in time.
        length: f64,
        /// Length that steps must exceed, s.
        shortest: f64,
    },
    /// An element set cannot be read.
    #[error(transparent)]
    ElementSet(#[from] ElementSetError),
    /// SGP4 has no state at the requested time.
    #[error(transparent)]
    Sgp4(#[from] Sgp4Error),
    /// A path cannot be built, or has no state at the requested time.
    #[error(transparent)]
    Path(#[from] PathError),
}

/// Largest accepted magnitude of an input; the product of five such numbers does not overflow.
pub(crate) const LARGEST: f64 = 1e60;

/// Returns `value`, or an error if it is too large or not finite.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64, OrbitError> {
    if !value.is_finite() {
        return Err(OrbitError::NotFinite { name, value });
    }
    if value.abs() > LARGEST {
        return Err(OrbitError::TooLarge { name, value });
    }
    Ok(value)
}

/// Returns `value`, or an error if it is not positive, too large or not finite.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, OrbitError> {
    if finite(name, value)? > 0.0 { Ok(value) } else { Err(OrbitError::NotPositive { name, value }) }
}

/// Returns the part of a message that states the sine of the angle between position and velocity, or an empty
/// text if the sine is not finite.
fn sine_between(sine: f64) -> String {
    match sine.is_finite() {
        true => format!(" (the sine of the angle between them is {})", short(sine)),
        false => String::new(),
    }
}

/// Returns ` (it is …)` with the sine of an angle, with enough digits to distinguish it from `limit`, or an
/// empty text if the sine is not finite.
fn actual_sine(sine: f64, limit: f64) -> String {
    if sine.is_finite() { format!(" (it is {})", unlike(sine, &[limit])) } else { String::new() }
}
