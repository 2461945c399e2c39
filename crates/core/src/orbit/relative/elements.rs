//! Relative orbital elements of a deputy satellite with respect to a chief satellite.
//!
//! `δa = (a_d - a)/a`, `δλ = (u_d - u) + (Ω_d - Ω) cos i`, `δe = e_d (cos ω_d, sin ω_d) - e (cos ω, sin ω)`,
//! `δi = (i_d - i, (Ω_d - Ω) sin i)` with `u = M + ω`, the semi-major axis `a`, the eccentricity `e`, the
//! inclination `i`, the node `Ω`, the argument of periapsis `ω` and the mean anomaly `M`. The index `d`
//! denotes the deputy; symbols without index are the chief's. These elements are regular for circular orbits
//! and singular for an equatorial chief.
//!
//! Source: D'Amico and Montenbruck, J. Guidance, Control and Dynamics 29(3), 2006; D'Amico, thesis, TU Delft
//! 2010.

use crate::orbit::kepler::{Elements, Kepler, Phase, Size};
use crate::orbit::{Orbit, OrbitError};
use nalgebra::{Vector3, Vector6};
use std::f64::consts::{PI, TAU};

/// Sine of the chief's inclination up to which its node is treated as undefined.
const EQUATORIAL: f64 = 1e-6;

/// Orbital elements of one satellite in a form that is regular for circular orbits; `a` in m, angles in rad.
struct Regular {
    a: f64,
    /// Mean argument of latitude, `M + ω`, rad.
    u: f64,
    /// Components `e cos ω` and `e sin ω` of the eccentricity vector.
    e: [f64; 2],
    i: f64,
    node: f64,
}

impl Regular {
    fn of(r: &Vector3<f64>, v: &Vector3<f64>, mu: f64) -> Result<Self, OrbitError> {
        let kepler = Kepler::from_state(*r, *v, mu)?;
        let (elements, e) = (kepler.elements(), kepler.eccentricity());
        let (Some(anomaly), a) = (kepler.mean_anomaly(), kepler.semi_major_axis()) else {
            return Err(OrbitError::NotClosed { eccentricity: e });
        };
        let (sin, cos) = elements.argument_of_periapsis.sin_cos();
        let u = anomaly + elements.argument_of_periapsis;
        Ok(Self { a, u, e: [e * cos, e * sin], i: elements.inclination, node: elements.raan })
    }

    /// Returns these elements, or an error for an equatorial orbit.
    fn inclined(self) -> Result<Self, OrbitError> {
        if self.i.sin() > EQUATORIAL { Ok(self) } else { Err(OrbitError::Equatorial { inclination: self.i }) }
    }
}

/// Returns the relative elements `(δa, δλ, δex, δey, δix, δiy)` of a deputy with respect to a chief. `chief`
/// and `deputy` are `[position, velocity]` in `I` at one instant, m and m/s; `mu` is in m³/s². The elements
/// are dimensionless or in rad; multiplied by the chief's `a` they are lengths in m.
///
/// # Errors
/// [`OrbitError::NotClosed`] if an orbit is not an ellipse, [`OrbitError::Equatorial`] for an equatorial
/// chief, and the errors of [`Kepler::from_state`].
pub fn relative_elements(
    chief: [&Vector3<f64>; 2],
    deputy: [&Vector3<f64>; 2],
    mu: f64,
) -> Result<Vector6<f64>, OrbitError> {
    let c = Regular::of(chief[0], chief[1], mu)?.inclined()?;
    let d = Regular::of(deputy[0], deputy[1], mu)?;
    let (sin, cos) = c.i.sin_cos();
    let node = nearest(d.node - c.node);
    // wrapped twice, because u and Ω may each differ by a whole turn while δλ is small
    let along = nearest(nearest(d.u - c.u) + node * cos);
    Ok(Vector6::new((d.a - c.a) / c.a, along, d.e[0] - c.e[0], d.e[1] - c.e[1], d.i - c.i, node * sin))
}

/// Returns the position (m) and velocity (m/s) in `I` of a deputy with the given relative elements. This is
/// the inverse of [`relative_elements`], with the same units.
///
/// # Errors
/// The errors of [`relative_elements`], and those of [`Kepler::new`] for the elements of the deputy.
pub fn deputy_state(
    chief: [&Vector3<f64>; 2],
    elements: &Vector6<f64>,
    mu: f64,
) -> Result<[Vector3<f64>; 2], OrbitError> {
    let c = Regular::of(chief[0], chief[1], mu)?.inclined()?;
    let (sin, cos) = c.i.sin_cos();
    let node = elements[5] / sin;
    let e = [c.e[0] + elements[2], c.e[1] + elements[3]];
    let argument = e[1].atan2(e[0]);
    let u = c.u + elements[1] - node * cos;
    let deputy = Elements {
        size: Size::SemiMajorAxis(c.a * (1.0 + elements[0])),
        eccentricity: e[0].hypot(e[1]),
        inclination: c.i + elements[4],
        raan: c.node + node,
        argument_of_periapsis: argument,
        phase: Phase::MeanAnomaly(u - argument),
        mu,
        epoch: 0.0,
    };
    let (r, v) = Kepler::new(&deputy)?.position_velocity(0.0)?;
    Ok([r, v])
}

/// Computes [`relative_elements`] for many pairs: `chief` and `deputy` hold positions (m) and velocities
/// (m/s), (B, 3) each, and `out` is (B, 6).
///
/// # Errors
/// The errors of [`relative_elements`], and [`OrbitError::WrongLength`] for arrays of the wrong length.
pub fn relative_elements_rows(
    chief: [&[f64]; 2],
    deputy: [&[f64]; 2],
    mu: f64,
    out: &mut [f64],
) -> Result<(), OrbitError> {
    let expected = out.len() / 2;
    super::check(&[
        ("chief positions", expected, chief[0].len()),
        ("chief velocities", expected, chief[1].len()),
        ("deputy positions", expected, deputy[0].len()),
        ("deputy velocities", expected, deputy[1].len()),
    ])?;
    for (index, to) in out.chunks_exact_mut(6).enumerate() {
        let [c, d] = [chief, deputy].map(|state| state.map(|rows| super::row(rows, index)));
        to.copy_from_slice(relative_elements([&c[0], &c[1]], [&d[0], &d[1]], mu)?.as_slice());
    }
    Ok(())
}

/// Computes [`deputy_state`] for many chiefs: `chief` and `out` hold positions (m) and velocities (m/s), (B,
/// 3) each, and `elements` is (B, 6).
///
/// # Errors
/// The errors of [`deputy_state`], and [`OrbitError::WrongLength`] for arrays of the wrong length.
pub fn deputy_states(
    chief: [&[f64]; 2],
    elements: &[f64],
    mu: f64,
    out: [&mut [f64]; 2],
) -> Result<(), OrbitError> {
    let (expected, [to_r, to_v]) = (elements.len() / 2, out);
    super::check(&[
        ("chief positions", expected, chief[0].len()),
        ("chief velocities", expected, chief[1].len()),
        ("positions out", expected, to_r.len()),
        ("velocities out", expected, to_v.len()),
    ])?;
    let to = to_r.chunks_exact_mut(3).zip(to_v.chunks_exact_mut(3));
    for (index, (elements, (to_r, to_v))) in elements.chunks_exact(6).zip(to).enumerate() {
        let c = chief.map(|rows| super::row(rows, index));
        let [r, v] = deputy_state([&c[0], &c[1]], &Vector6::from_column_slice(elements), mu)?;
        to_r.copy_from_slice(r.as_slice());
        to_v.copy_from_slice(v.as_slice());
    }
    Ok(())
}

/// Wraps an angle, rad, to [-π, π].
fn nearest(angle: f64) -> f64 {
    let turns = (angle / TAU).round();
    let angle = angle - turns * TAU;
    if angle > PI { angle - TAU } else { angle }
}
