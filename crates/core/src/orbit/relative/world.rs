//! State of an orbit in the frame W of a reference orbit.

use crate::earth::Earth;
use crate::orbit::{Orbit, OrbitError};
use nalgebra::Vector3;

/// Largest relative difference at which two gravitational parameters are those of the same planet; the values
/// of SGP4 and the IERS differ by 1e-6.
const SAME_PLANET: f64 = 1e-5;

/// Returns the position `r - r_ref` of `orbit` in the frame W of `reference`, m, and its time derivative,
/// m/s, at simulation time `t`, s, in axes of the reference.
///
/// `t` is the simulation time of the reference. An orbit with an epoch, such as that of an element set, is
/// evaluated at the same instant; if the reference has no epoch, the epoch of `earth` applies. If the axes of
/// the two orbits differ, `earth` is used to convert them. The velocities are time derivatives of the
/// positions, even if the orbit model reports different velocities (SGP4).
///
/// # Errors
/// The errors of the orbits; [`OrbitError::OtherPlanet`], [`OrbitError::NoEpoch`] and
/// [`OrbitError::OtherAxes`] for orbits that cannot be compared.
pub fn to_world(
    reference: &dyn Orbit,
    orbit: &dyn Orbit,
    t: f64,
    earth: Option<&Earth>,
) -> Result<[Vector3<f64>; 2], OrbitError> {
    if let (Some(mu), Some(expected)) = (orbit.mu(), reference.mu())
        && (mu / expected - 1.0).abs() > SAME_PLANET
    {
        return Err(OrbitError::OtherPlanet { mu, expected });
    }
    let origin = position_and_rate(reference, t)?;
    let zero = reference.epoch().or(earth.and_then(Earth::epoch));
    let shift = match (orbit.epoch(), zero) {
        (None, _) => 0.0,
        (Some(own), Some(zero)) => zero.seconds_since(own),
        (Some(own), None) => return Err(OrbitError::NoEpoch { epoch: own.to_string() }),
    };
    let own = position_and_rate(orbit, t + shift)?;
    let other = || OrbitError::OtherAxes { orbit: orbit.axes().name(), reference: reference.axes().name() };
    let own = if orbit.axes() == reference.axes() {
        own
    } else {
        // r_I = R_IF R_FI' r_I';  the axes of I and I' are at rest relative to each other
        let earth = earth.filter(|earth| earth.axes().is_some()).ok_or_else(other)?;
        let rot_fi = |orbit: &dyn Orbit| earth.in_axes(orbit.axes()).rot_fi(t);
        let rot = rot_fi(reference).transpose() * rot_fi(orbit);
        own.map(|vector| rot * vector)
    };
    Ok([own[0] - origin[0], own[1] - origin[1]])
}

/// Returns the position, m, at simulation time `t`, s, and its time derivative, m/s.
fn position_and_rate(orbit: &dyn Orbit, t: f64) -> Result<[Vector3<f64>; 2], OrbitError> {
    let state = orbit.state(t)?;
    Ok([state.position, orbit.rate_of_position(t, &state)?])
}
