//! States and frames of an orbit at many instants.

use super::{Orbit, OrbitError, PathFrame, StateRows};

/// Computes positions and velocities of an orbit at many instants, in the inertial axes `I` of the orbit.
///
/// `times` (T,) are simulation times in s, `positions` (T, 3) in m from the planet's centre and `velocities`
/// (T, 3) in m/s, row-major.
///
/// # Errors
/// [`OrbitError::WrongLength`] if an output does not hold 3 T numbers; otherwise the first error of
/// [`Orbit::position_velocity`]. The rows of the instants before that error have then been written.
pub fn states(
    orbit: &dyn Orbit,
    times: &[f64],
    positions: &mut [f64],
    velocities: &mut [f64],
) -> Result<(), OrbitError> {
    orbit.fill(times, StateRows::new(times.len(), positions, velocities)?)
}

/// Computes the local orbital frames `L` (Hill) at many instants.
///
/// `times` (T,) are simulation times in s. `rotations` (T, 3, 3), row-major, receives `rot_il`, the rotation
/// from `L` axes to the inertial axes `I`, and `rates` (T, 3) the angular velocity of `L` with respect to `I`
/// in `L` axes, rad/s.
///
/// # Errors
/// [`OrbitError::WrongLength`] for outputs of the wrong length; otherwise the first error of [`Orbit::lvlh`].
pub fn lvlh_frames(
    orbit: &dyn Orbit,
    times: &[f64],
    rotations: &mut [f64],
    rates: &mut [f64],
) -> Result<(), OrbitError> {
    frames_at(times, rotations, rates, |t| orbit.lvlh(t).map(PathFrame::from))
}

/// Computes the frames attached to the orbit ([`Orbit::frame`]) at many instants. The arrays have the shapes
/// and units of those of [`lvlh_frames`].
///
/// # Errors
/// [`OrbitError::WrongLength`] for outputs of the wrong length; otherwise the first error of
/// [`Orbit::frame`].
pub fn path_frames(
    orbit: &dyn Orbit,
    times: &[f64],
    rotations: &mut [f64],
    rates: &mut [f64],
) -> Result<(), OrbitError> {
    frames_at(times, rotations, rates, |t| orbit.frame(t))
}

fn frames_at(
    times: &[f64],
    rotations: &mut [f64],
    rates: &mut [f64],
    frame: impl Fn(f64) -> Result<PathFrame, OrbitError>,
) -> Result<(), OrbitError> {
    for (name, expected, got) in
        [("rotations", 9 * times.len(), rotations.len()), ("rates", 3 * times.len(), rates.len())]
    {
        if got != expected {
            return Err(OrbitError::WrongLength { name, expected, got });
        }
    }
    let rows = rotations.chunks_exact_mut(9).zip(rates.chunks_exact_mut(3));
    for (&t, (rotation, rate)) in times.iter().zip(rows) {
        let frame = frame(t)?;
        rotation.copy_from_slice(frame.rot_ip.transpose().as_slice()); // nalgebra is column-major
        rate.copy_from_slice(frame.rate_p.as_slice());
    }
    Ok(())
}
