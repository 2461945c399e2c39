//! Local exponential model of the density near a robot, fitted to two evaluations of an atmosphere model.

use super::error::AtmosphereError;
use super::model::Atmosphere;
use super::point::AtmospherePoint;
use crate::earth::Earth;
use crate::spatial::{Lanes8, Real, Vec3};
use nalgebra::Vector3;

/// Distance from the centre of a local atmosphere within which its density is used, m.
///
/// The horizontal scale length of the density is at least a third of the Earth's radius in every model, so
/// the relative error is at most 8e-5, or 1e-4 including the vertical change of the scale height. Where the
/// layers of a table are discontinuous, the jump is displaced by at most this distance.
const VALID_RADIUS: f64 = 160.0;

/// Spacing of the grid of centres in space, m, and in time, s. Robots close to each other, and successive
/// steps, use the same centre.
const GRID: (f64, f64) = (128.0, 0.125);

/// Altitude difference from which the scale height is computed, m.
const RISE: f64 = 100.0;

/// Density near a point `r₀`: `ρ(r) = ρ₀ exp(-κ û·(r - r₀))` with the density `ρ₀`, kg/m³, and the inverse
/// scale height `κ`, 1/m, at `r₀`, and the upward unit vector `û`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalAtmosphere {
    time: f64,
    centre: Vector3<f64>,
    up: Vector3<f64>,
    density: f64,
    /// Inverse of the scale height, 1/m.
    decay: f64,
    /// Angular velocity of the Earth at `time`, axes of `I`, rad/s; its relative change is less than 1e-6 per
    /// day.
    pub(in crate::environment) earth_rate: Vector3<f64>,
}

impl LocalAtmosphere {
    /// Computes the local atmosphere about `centre`, axes of `I`, m, at simulation time `time`, s.
    ///
    /// # Errors
    /// The errors of [`AtmospherePoint::new`] and of the model at the centre; the error of the model 100 m
    /// below the centre if it is defined neither there nor 100 m above the centre.
    pub fn new(
        atmosphere: &dyn Atmosphere,
        earth: &Earth,
        time: f64,
        centre: &Vector3<f64>,
    ) -> Result<Self, AtmosphereError> {
        let point = AtmospherePoint::new(earth, time, centre)?;
        let density = atmosphere.density(&point)?;
        // κ = ln(ρ/ρ⁺)/Δh, with Δh < 0 at the upper limit of a model
        let slope = |rise: f64| Ok((density / atmosphere.density(&point.raised(rise))?).ln() / rise);
        let decay = if density > 0.0 { slope(RISE).or_else(|_: AtmosphereError| slope(-RISE))? } else { 0.0 };
        let earth_rate = earth.angular_velocity(time);
        Ok(Self { time, centre: *centre, up: point.up, density, decay, earth_rate })
    }

    /// Returns the density, kg/m³, at positions `r`, axes of `I`, m.
    ///
    /// At positions more than 160 m from the centre, `model` is evaluated instead, except in lanes for which
    /// `counts` returns false, whose densities are not used.
    #[inline(always)]
    pub(in crate::environment) fn densities<S: Real, E>(
        &self,
        r: Vec3<S>,
        counts: impl Fn(usize) -> bool,
        model: impl Fn(Vector3<f64>) -> Result<f64, E>,
    ) -> Result<S, E> {
        let offset = r - Vec3::of(&self.centre.into());
        if S::any(S::of(VALID_RADIUS * VALID_RADIUS).less(offset.dot(offset))) {
            let mut found = [0.0; Lanes8::LANES];
            for (i, density) in found.iter_mut().enumerate().take(S::LANES).filter(|(i, _)| counts(*i)) {
                let r = r.lane(i).to_nalgebra();
                *density = self.density(&r).map_or_else(|| model(r), Ok)?;
            }
            return Ok(S::from_lanes(|i| found[i]));
        }
        Ok(self.extrapolate(offset))
    }

    /// Returns the density, kg/m³, at `r`, axes of `I`, m; `None` more than 160 m from the centre.
    pub fn density(&self, r: &Vector3<f64>) -> Option<f64> {
        let offset = r - self.centre;
        (offset.norm_squared() <= VALID_RADIUS * VALID_RADIUS).then(|| self.extrapolate(offset.into()))
    }

    #[inline(always)]
    fn extrapolate<S: Real>(&self, offset: Vec3<S>) -> S {
        // ρ = ρ₀ e⁻ˣ,  x = κ û·(r - r₀), to third order: |x| is at most 0.03 (near the ground)
        let (s, x) = (S::of, Vec3::of(&self.up.into()).dot(offset) * S::of(self.decay));
        s(self.density) * (s(1.0) - x * (s(1.0) - x * (s(0.5) - x * s(1.0 / 6.0))))
    }

    /// Returns true if this is the atmosphere around `centre` at `time`.
    pub(in crate::environment) fn is_about(&self, time: f64, centre: &Vector3<f64>) -> bool {
        self.time == time && self.centre == *centre
    }

    /// Returns the latest grid time that is not after `time`, s, and the grid point nearest to `r`, m, at
    /// most 111 m away.
    pub(in crate::environment) fn grid_point(time: f64, r: &Vector3<f64>) -> (f64, Vector3<f64>) {
        let (spacing, tick) = GRID;
        ((time / tick).floor() * tick, r.map(|x| (x / spacing).round() * spacing))
    }
}
