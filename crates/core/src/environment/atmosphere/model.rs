//! Interface of atmosphere models.

use super::error::AtmosphereError;
use super::point::AtmospherePoint;
use crate::earth::{Earth, Geodetic};
use nalgebra::Vector3;

/// Model of the density of the atmosphere.
pub trait Atmosphere: Send + Sync + std::fmt::Debug {
    /// Returns the short name that messages use for the model.
    fn name(&self) -> &'static str;

    /// Returns the density, kg/m³, at a point outside the Earth. Implementations must be pure functions of
    /// the point.
    ///
    /// # Errors
    /// [`AtmosphereError`] if the model is not defined at this point.
    fn density(&self, point: &AtmospherePoint<'_>) -> Result<f64, AtmosphereError>;
}

/// Writes to `out` the densities, kg/m³, at geodetic altitudes, m, latitudes and longitudes, rad, and
/// simulation times, s. All arrays are `(n,)`.
///
/// # Errors
/// The error of the first point that is invalid or at which the model is not defined.
pub fn densities_over(
    atmosphere: &dyn Atmosphere,
    earth: &Earth,
    [altitudes, latitudes, longitudes, times]: [&[f64]; 4],
    out: &mut [f64],
) -> Result<(), AtmosphereError> {
    let points = altitudes.iter().zip(latitudes).zip(longitudes).zip(times);
    for (density, (((&altitude, &latitude), &longitude), &time)) in out.iter_mut().zip(points) {
        let geodetic = Geodetic { latitude, longitude, altitude };
        *density = atmosphere.density(&AtmospherePoint::at(earth, time, geodetic)?)?;
    }
    Ok(())
}

/// Writes to `out` the densities `(n,)`, kg/m³, at positions `(n, 3)` from the Earth's centre, axes of `I`,
/// m, and simulation times `(n,)`, s.
///
/// # Errors
/// The error of the first point that is inside the Earth or at which the model is not defined.
pub fn densities_at(
    atmosphere: &dyn Atmosphere,
    earth: &Earth,
    positions: &[f64],
    times: &[f64],
    out: &mut [f64],
) -> Result<(), AtmosphereError> {
    for ((density, r), &time) in out.iter_mut().zip(positions.chunks_exact(3)).zip(times) {
        *density = atmosphere.density(&AtmospherePoint::new(earth, time, &Vector3::from_column_slice(r))?)?;
    }
    Ok(())
}
