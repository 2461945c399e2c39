//! Methods of [`Earth`] that evaluate many instants, with row-major arrays.

use nalgebra::{Matrix3, Vector3};

use super::Earth;
use super::error::EarthError;
use super::geodetic::{Geodetic, WGS84};

fn check_length(name: &'static str, got: usize, expected: usize) -> Result<(), EarthError> {
    if got == expected { Ok(()) } else { Err(EarthError::WrongLength { name, expected, got }) }
}

/// Fills each row of `rows` with `at(index, time)`, where `index` is the row's index and `time` its instant,
/// s.
fn fill_rows<const N: usize>(
    times: &[f64],
    rows: &mut [f64],
    at: impl Fn(usize, f64) -> Result<[f64; N], EarthError>,
) -> Result<(), EarthError> {
    check_length("result", rows.len(), N * times.len())?;
    for (index, (&t, row)) in times.iter().zip(rows.chunks_exact_mut(N)).enumerate() {
        row.copy_from_slice(&at(index, t)?);
    }
    Ok(())
}

impl Earth {
    /// Computes the rotations `rot_fi` (T, 3, 3) from `I` to `F`, row-major, at the simulation times `times`
    /// (T,), s.
    ///
    /// # Errors
    /// The errors of [`Earth::covers`], and [`EarthError::WrongLength`] for arrays of the wrong length.
    pub fn rotations(&self, times: &[f64], rotations: &mut [f64]) -> Result<(), EarthError> {
        fill_rows::<9>(times, rotations, |_, t| {
            let transposed: Matrix3<f64> = self.checked_rotation(t)?.transpose(); // nalgebra is column-major
            let mut row = [0.0; 9];
            row.copy_from_slice(transposed.as_slice());
            Ok(row)
        })
    }

    /// Computes the angular velocities (T, 3) of `F` with respect to `I`, axes of `I`, rad/s, at the
    /// simulation times `times` (T,), s.
    ///
    /// # Errors
    /// The errors of [`Earth::covers`], and [`EarthError::WrongLength`] for arrays of the wrong length.
    pub fn angular_velocities(&self, times: &[f64], rates: &mut [f64]) -> Result<(), EarthError> {
        fill_rows(times, rates, |_, t| self.covers(t).map(|()| self.angular_velocity(t).into()))
    }

    /// Computes the positions of the Sun (T, 3) from the Earth's centre, axes of `I`, m, at the simulation
    /// times `times` (T,), s.
    ///
    /// # Errors
    /// The errors of [`Earth::sun`], and [`EarthError::WrongLength`] for arrays of the wrong length.
    pub fn suns(&self, times: &[f64], positions: &mut [f64]) -> Result<(), EarthError> {
        fill_rows(times, positions, |_, t| Ok(self.sun(t)?.into()))
    }

    /// Computes the positions of the Moon (T, 3) from the Earth's centre, axes of `I`, m, at the simulation
    /// times `times` (T,), s.
    ///
    /// # Errors
    /// The errors of [`Earth::moon`], and [`EarthError::WrongLength`] for arrays of the wrong length.
    pub fn moons(&self, times: &[f64], positions: &mut [f64]) -> Result<(), EarthError> {
        fill_rows(times, positions, |_, t| Ok(self.moon(t)?.into()))
    }

    /// Converts positions (T, 3), m, at the simulation times `times` (T,), s, from axes of `I` to axes of
    /// `F`.
    ///
    /// # Errors
    /// The errors of [`Earth::covers`], and [`EarthError::WrongLength`] for arrays of the wrong length.
    pub fn to_fixed(&self, times: &[f64], positions: &[f64], fixed: &mut [f64]) -> Result<(), EarthError> {
        check_length("positions", positions.len(), 3 * times.len())?;
        fill_rows(times, fixed, |k, t| Ok((self.checked_rotation(t)? * row(positions, k)).into()))
    }

    /// Computes latitude (rad), longitude (rad) and altitude (m) on WGS84, (T, 3), from positions in axes of
    /// `I`, (T, 3), m, at the simulation times `times` (T,), s.
    ///
    /// # Errors
    /// The errors of [`Earth::covers`] and [`Geodetic::of`], and [`EarthError::WrongLength`] for arrays of
    /// the wrong length.
    pub fn geodetics(
        &self,
        times: &[f64],
        positions: &[f64],
        coordinates: &mut [f64],
    ) -> Result<(), EarthError> {
        check_length("positions", positions.len(), 3 * times.len())?;
        fill_rows(times, coordinates, |k, t| {
            let geodetic = Geodetic::of(&(self.checked_rotation(t)? * row(positions, k)), &WGS84)?;
            Ok([geodetic.latitude, geodetic.longitude, geodetic.altitude])
        })
    }

    fn checked_rotation(&self, t: f64) -> Result<Matrix3<f64>, EarthError> {
        self.covers(t).map(|()| self.rot_fi(t))
    }
}

fn row(rows: &[f64], k: usize) -> Vector3<f64> {
    Vector3::from_row_slice(&rows[3 * k..3 * k + 3])
}
