//! Positions and velocities in local orbital frames, without linearization.

use crate::orbit::error::finite;
use crate::orbit::{Lvlh, Nadir, Orbit, OrbitError, OrbitState};
use nalgebra::{Matrix3, Vector3};

/// Kind of local orbital frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LocalFrame {
    /// [`Lvlh`]: x outward, y along track, z along the angular momentum.
    #[default]
    Lvlh,
    /// [`Nadir`]: x along track, y against the angular momentum, z towards the planet's centre.
    Nadir,
}

impl LocalFrame {
    /// All kinds, each with the name used in Python.
    pub const ALL: [(&'static str, Self); 2] = [("lvlh", Self::Lvlh), ("nadir", Self::Nadir)];

    /// Returns the rotation from local axes to `I`, and the angular velocity of the local frame with respect
    /// to `I` in local axes, rad/s.
    fn of(self, reference: &OrbitState) -> Result<(Matrix3<f64>, Vector3<f64>), OrbitError> {
        match self {
            Self::Lvlh => Lvlh::of(reference).map(|frame| (frame.rot_il, frame.rate_l)),
            Self::Nadir => Nadir::of(reference).map(|frame| (frame.rot_in, frame.rate_n)),
        }
    }
}

/// Returns the position (m) and velocity (m/s) relative to `reference` in its rotating local frame.
///
/// `ρ = R_ilᵀ (r - R)`, `ρ̇ = R_ilᵀ (v - V) - ω × ρ`, with the position `r` (m) and velocity `v` (m/s) in
/// `I`, those of the reference `R` and `V`, the rotation `R_il` from local axes to `I` and the angular
/// velocity `ω` of the local frame in its axes.
///
/// # Errors
/// [`OrbitError::UndefinedFrame`] for a reference at rest or in rectilinear motion.
pub fn to_local(
    reference: &OrbitState,
    frame: LocalFrame,
    r: &Vector3<f64>,
    v: &Vector3<f64>,
) -> Result<[Vector3<f64>; 2], OrbitError> {
    let (rot_il, rate_l) = frame.of(reference)?;
    let rho = rot_il.tr_mul(&(r - reference.position));
    Ok([rho, rot_il.tr_mul(&(v - reference.velocity)) - rate_l.cross(&rho)])
}

/// Returns the position (m) and velocity (m/s) in `I` from `rho` (m) and `rho_dot` (m/s) in the local
/// frame. This is the inverse of [`to_local`].
///
/// # Errors
/// [`OrbitError::UndefinedFrame`] for a reference at rest or in rectilinear motion.
pub fn from_local(
    reference: &OrbitState,
    frame: LocalFrame,
    rho: &Vector3<f64>,
    rho_dot: &Vector3<f64>,
) -> Result<[Vector3<f64>; 2], OrbitError> {
    let (rot_il, rate_l) = frame.of(reference)?;
    let velocity = reference.velocity + rot_il * (rho_dot + rate_l.cross(rho));
    Ok([reference.position + rot_il * rho, velocity])
}

/// Function that converts a state: [`to_local`] or [`from_local`].
type Convert =
    fn(&OrbitState, LocalFrame, &Vector3<f64>, &Vector3<f64>) -> Result<[Vector3<f64>; 2], OrbitError>;

/// Computes [`to_local`] at each of `times` (T,), s: `given` and `out` are pairs of positions (m) and
/// velocities (m/s), (T, 3) each.
///
/// # Errors
/// The errors of [`to_local`] and [`Orbit::state`]; [`OrbitError::NotFinite`] and [`OrbitError::TooLarge`]
/// for a given position or velocity; [`OrbitError::WrongLength`] for arrays of the wrong length.
pub fn to_local_rows(
    orbit: &dyn Orbit,
    frame: LocalFrame,
    times: &[f64],
    given: [&[f64]; 2],
    out: [&mut [f64]; 2],
) -> Result<(), OrbitError> {
    rows(orbit, frame, times, given, out, to_local)
}

/// Computes [`from_local`] at each of `times`. The arrays have the shapes and units of those of
/// [`to_local_rows`].
///
/// # Errors
/// The errors of [`to_local_rows`].
pub fn from_local_rows(
    orbit: &dyn Orbit,
    frame: LocalFrame,
    times: &[f64],
    given: [&[f64]; 2],
    out: [&mut [f64]; 2],
) -> Result<(), OrbitError> {
    rows(orbit, frame, times, given, out, from_local)
}

fn rows(
    orbit: &dyn Orbit,
    frame: LocalFrame,
    times: &[f64],
    given: [&[f64]; 2],
    out: [&mut [f64]; 2],
    convert: Convert,
) -> Result<(), OrbitError> {
    let ([r, v], [to_r, to_v], expected) = (given, out, 3 * times.len());
    super::check(&[
        ("positions", expected, r.len()),
        ("velocities", expected, v.len()),
        ("positions out", expected, to_r.len()),
        ("velocities out", expected, to_v.len()),
    ])?;
    for (name, values) in [("r", r), ("v", v)] {
        values.iter().try_for_each(|x| finite(name, *x).map(drop))?;
    }
    let to = to_r.chunks_exact_mut(3).zip(to_v.chunks_exact_mut(3));
    for (index, (&t, (to_r, to_v))) in times.iter().zip(to).enumerate() {
        let state = orbit.state(t)?;
        let [position, velocity] = convert(&state, frame, &super::row(r, index), &super::row(v, index))?;
        to_r.copy_from_slice(position.as_slice());
        to_v.copy_from_slice(velocity.as_slice());
    }
    Ok(())
}
