//! The air around a robot, from two looks at the model.

use super::{AirPlace, Atmosphere, AtmosphereError};
use crate::earth::Earth;
use crate::spatial::{Lanes8, Real, Vec3};
use nalgebra::Vector3;

/// How far from its centre a local density is trusted, m.
///
/// Sideways the density of no model changes faster than by e within a third of the Earth's radius, so the density is
/// wrong by at most 8e-5 of itself there, and by 1e-4 with the change of the scale height upwards. Where the layers of a
/// table do not meet, the place of the jump is off by that much.
const TRUST: f64 = 160.0;

/// Pitch of the points about which local air is made, m and s: robots near each other, and in steps that follow
/// each other, share one.
const PITCH: (f64, f64) = (128.0, 0.125);

/// Rise over which the scale height is taken, m.
const RISE: f64 = 100.0;

/// Density about a place: `ρ(r) = ρ₀ exp(-κ û·(r - r₀))`, `û` up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalAir {
    time: f64,
    centre: Vector3<f64>,
    up: Vector3<f64>,
    density: f64,
    /// One by the scale height, 1/m.
    decay: f64,
    /// Angular velocity of the air, axes of `I`, rad/s: changes by 1e-7 of itself a day.
    pub(in crate::environment) spin: Vector3<f64>,
}

impl LocalAir {
    /// About `centre`, axes of `I`, m.
    ///
    /// # Errors
    /// What the model refuses at the centre.
    pub fn new(
        atmosphere: &dyn Atmosphere,
        earth: &Earth,
        time: f64,
        centre: &Vector3<f64>,
    ) -> Result<Self, AtmosphereError> {
        let place = AirPlace::new(earth, time, centre)?;
        let density = atmosphere.density(&place)?;
        // κ = ln(ρ/ρ⁺)/Δh, downwards where the model ends
        let slope = |rise: f64| Ok((density / atmosphere.density(&place.raised(rise))?).ln() / rise);
        let decay = if density > 0.0 { slope(RISE).or_else(|_: AtmosphereError| slope(-RISE))? } else { 0.0 };
        let spin = earth.angular_velocity(time);
        Ok(Self { time, centre: *centre, up: place.up, density, decay, spin })
    }

    /// Density at places `r`, axes of `I`, m, kg/m³; found `afresh` where one that counts is beyond 160 m from the centre.
    #[inline(always)]
    pub(in crate::environment) fn densities<S: Real, E>(
        &self,
        r: Vec3<S>,
        counts: impl Fn(usize) -> bool,
        afresh: impl Fn(Vector3<f64>) -> Result<f64, E>,
    ) -> Result<S, E> {
        let offset = r - Vec3::of(&self.centre.into());
        if S::any(S::of(TRUST * TRUST).less(offset.dot(offset))) {
            let mut found = [0.0; Lanes8::LANES];
            for (i, density) in found.iter_mut().enumerate().take(S::LANES).filter(|(i, _)| counts(*i)) {
                let r = r.lane(i).to_nalgebra();
                *density = self.density(&r).map_or_else(|| afresh(r), Ok)?;
            }
            return Ok(S::from_lanes(|i| found[i]));
        }
        Ok(self.near(offset))
    }

    /// Density at `r`, axes of `I`, m, kg/m³; none beyond 160 m from the centre.
    pub fn density(&self, r: &Vector3<f64>) -> Option<f64> {
        let offset = r - self.centre;
        (offset.norm_squared() <= TRUST * TRUST).then(|| self.near(offset.into()))
    }

    #[inline(always)]
    fn near<S: Real>(&self, offset: Vec3<S>) -> S {
        // e⁻ˣ to third order: x is at most 160 m by the scale height, 0.03 near the ground
        let (s, x) = (S::of, Vec3::of(&self.up.into()).dot(offset) * S::of(self.decay));
        s(self.density) * (s(1.0) - x * (s(1.0) - x * (s(0.5) - x * s(1.0 / 6.0))))
    }

    /// Whether this is the air about `centre` at `time`.
    pub(in crate::environment) fn is_about(&self, time: f64, centre: &Vector3<f64>) -> bool {
        self.time == time && self.centre == *centre
    }

    /// The point of the grid near a place, at most 111 m and 1/8 s away, about which its local air is made.
    pub(in crate::environment) fn grid_point(time: f64, r: &Vector3<f64>) -> (f64, Vector3<f64>) {
        let (pitch, tick) = PITCH;
        ((time / tick).floor() * tick, r.map(|x| (x / pitch).round() * pitch))
    }
}
