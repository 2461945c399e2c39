//! The Earth at many instants, into arrays as numpy lays them out.

use nalgebra::{Matrix3, Vector3};

use super::{Earth, EarthError, Geodetic, WGS84};

fn long_enough(name: &'static str, got: usize, expected: usize) -> Result<(), EarthError> {
    if got == expected { Ok(()) } else { Err(EarthError::WrongLength { name, expected, got }) }
}

fn into_rows<const N: usize>(
    times: &[f64],
    rows: &mut [f64],
    at: impl Fn(usize, f64) -> Result<[f64; N], EarthError>,
) -> Result<(), EarthError> {
    long_enough("the result", rows.len(), N * times.len())?;
    for (index, (&t, row)) in times.iter().zip(rows.chunks_exact_mut(N)).enumerate() {
        row.copy_from_slice(&at(index, t)?);
    }
    Ok(())
}

impl Earth {
    /// Row-major `rot_fi` (T, 3, 3) at `times` (T,), s.
    ///
    /// # Errors
    /// Those of [`Earth::covers`].
    pub fn rotations(&self, times: &[f64], rotations: &mut [f64]) -> Result<(), EarthError> {
        into_rows::<9>(times, rotations, |_, t| {
            let transposed: Matrix3<f64> = self.known_rotation(t)?.transpose(); // column major
            let mut row = [0.0; 9];
            row.copy_from_slice(transposed.as_slice());
            Ok(row)
        })
    }

    /// Angular velocities of `F` in `I` (T, 3), axes of `I`, rad/s.
    ///
    /// # Errors
    /// Those of [`Earth::covers`].
    pub fn angular_velocities(&self, times: &[f64], rates: &mut [f64]) -> Result<(), EarthError> {
        into_rows(times, rates, |_, t| self.covers(t).map(|()| self.angular_velocity(t).into()))
    }

    /// Positions of the Sun (T, 3), axes of `I`, m.
    ///
    /// # Errors
    /// Those of [`Earth::sun`].
    pub fn suns(&self, times: &[f64], positions: &mut [f64]) -> Result<(), EarthError> {
        into_rows(times, positions, |_, t| Ok(self.sun(t)?.into()))
    }

    /// Positions of the Moon (T, 3), axes of `I`, m.
    ///
    /// # Errors
    /// Those of [`Earth::moon`].
    pub fn moons(&self, times: &[f64], positions: &mut [f64]) -> Result<(), EarthError> {
        into_rows(times, positions, |_, t| Ok(self.moon(t)?.into()))
    }

    /// Positions (T, 3) from axes of `I` to those of the Earth, m.
    ///
    /// # Errors
    /// Those of [`Earth::covers`].
    pub fn to_fixed(&self, times: &[f64], positions: &[f64], fixed: &mut [f64]) -> Result<(), EarthError> {
        long_enough("the positions", positions.len(), 3 * times.len())?;
        into_rows(times, fixed, |k, t| Ok((self.known_rotation(t)? * row(positions, k)).into()))
    }

    /// Latitude, longitude (rad) and altitude (m) (T, 3) above WGS84 of positions (T, 3), axes of `I`.
    ///
    /// # Errors
    /// Those of [`Earth::covers`] and [`Geodetic::of`].
    pub fn geodetics(&self, times: &[f64], positions: &[f64], places: &mut [f64]) -> Result<(), EarthError> {
        long_enough("the positions", positions.len(), 3 * times.len())?;
        into_rows(times, places, |k, t| {
            let place = Geodetic::of(&(self.known_rotation(t)? * row(positions, k)), &WGS84)?;
            Ok([place.latitude, place.longitude, place.altitude])
        })
    }

    fn known_rotation(&self, t: f64) -> Result<Matrix3<f64>, EarthError> {
        self.covers(t).map(|()| self.rot_fi(t))
    }
}

fn row(rows: &[f64], k: usize) -> Vector3<f64> {
    Vector3::from_row_slice(&rows[3 * k..3 * k + 3])
}
