//! Orbits of published element sets, computed by SGP4 and SDP4 in improved mode.
//!
//! Source of the theory: Hoots and Roehrich, Spacetrack Report #3, 1980, as revised by Vallado, Crawford,
//! Hujsak and Kelso, Revisiting Spacetrack Report #3, AIAA 2006-6753.

mod constants;
mod deep_space;
mod elements;
mod epoch;
mod error;
mod harmonics;
mod lunar_solar;
mod near_earth;
mod periodics;
mod propagate;
mod resonance;
mod theory;
mod tle;

use nalgebra::Vector3;
use std::f64::consts::TAU;
use std::sync::Arc;

use super::error::finite;
use super::lanes::fill_lanes;
use super::reference_orbit::fill_each;
use super::{Axes, Orbit, OrbitError, OrbitState, StateRows};
use crate::spatial::{InstructionSet, Lanes4, Lanes8, Real};
pub use constants::EarthModel;
pub use elements::MeanElements;
pub use epoch::Epoch;
pub use error::{ElementSetError, Sgp4Error};
use propagate::Propagator;
pub use theory::ExternalSgp4;
use theory::{State, Theory};

/// Largest time from the epoch, s: a hundred years, although the elements lose their accuracy within weeks.
const LONGEST_TIME: f64 = 100.0 * 365.25 * 86_400.0;

/// Step of the finite differences for the acceleration, s.
const STEP: f64 = 30.0;

/// Weights, multiplied by 180, of the central second difference of sixth order, at 0 to ±3 steps.
const WEIGHTS: [f64; 4] = [-490.0, 270.0, -27.0, 2.0];

/// Weights, multiplied by 60, of the central first difference of sixth order, at +1 to +3 steps; those at -1
/// to -3 steps have the opposite sign.
const SLOPE_WEIGHTS: [f64; 3] = [45.0, -9.0, 1.0];

/// Orbit of an element set in TEME axes; simulation time zero is the epoch of the element set.
///
/// Position and velocity are those of SGP4, as published. The velocity is not exactly the time derivative of
/// the position: for the published sets the difference is 2-9 cm/s on nearly circular orbits, 1.2 m/s at
/// eccentricity 0.19, up to 7 m/s at 0.8, and 18 m/s in the last revolutions before decay. The acceleration
/// is the second derivative of the position, by sixth-order central differences over ±90 s, accurate to 1e-7
/// m/s².
#[derive(Clone, Debug)]
pub struct Sgp4 {
    elements: MeanElements,
    model: EarthModel,
    propagator: Propagator,
    theory: Theory,
}

impl Sgp4 {
    /// Creates the orbit of an element set.
    pub fn new(elements: MeanElements, model: EarthModel) -> Self {
        let propagator = Propagator::new(&elements, model);
        Self { elements, model, propagator, theory: Theory::Native }
    }

    /// Returns the same orbit, but computed by `code`, the reference implementation, which is much slower.
    pub fn with_external(self, code: Arc<dyn ExternalSgp4>) -> Self {
        Self { theory: Theory::External(code), ..self }
    }

    fn at(&self, t: f64) -> Result<State, Sgp4Error> {
        self.theory.at(&self.propagator, t)
    }

    /// Returns the element set.
    pub fn elements(&self) -> &MeanElements {
        &self.elements
    }

    /// Returns the Earth model.
    pub fn earth_model(&self) -> EarthModel {
        self.model
    }

    /// Returns the period, s, that corresponds to the mean motion of the element set.
    pub fn period(&self) -> f64 {
        60.0 * TAU / self.elements.mean_motion
    }

    /// Returns the position (m) and velocity (m/s) in TEME axes, `t` s after the epoch of the elements, or an
    /// error if SGP4 has no state, if the position is below the surface, or if `t` is more than a hundred
    /// years from that epoch.
    fn above_surface(&self, t: f64) -> Result<(Vector3<f64>, Vector3<f64>), OrbitError> {
        if finite("time", t)?.abs() > LONGEST_TIME {
            return Err(OrbitError::TimeOutOfRange { time: t, epoch: 0.0, limit: LONGEST_TIME });
        }
        let at = self.at(t)?;
        if at.distance.is_nan() || at.distance < 1.0 {
            let radius = self.propagator.earth.radius_km * 1e3;
            return Err(Sgp4Error::Decayed { time: t, distance: at.distance * radius, radius }.into());
        }
        Ok((at.position * 1e3, at.velocity * 1e3))
    }

    /// Fills `rows` with states computed on the SIMD lanes of `S`. If SGP4 returns an error for an instant of
    /// a group, the instants of this group are evaluated individually.
    fn fill_in_lanes<S: Real>(&self, times: &[f64], rows: StateRows<'_>) -> Result<(), OrbitError> {
        fill_lanes::<S>(
            self,
            times,
            rows,
            #[inline(always)]
            |t| {
                if !(0..S::LANES).all(|lane| t.lane(lane).abs() <= LONGEST_TIME) {
                    return None;
                }
                let at = self.propagator.at_lanes(t)?;
                Some((at.position * S::of(1e3), at.velocity * S::of(1e3)))
            },
        )
    }

    /// Returns the first time derivative of the position at `t`, m/s, by finite differences with step `h`, s.
    fn rate(&self, t: f64, h: f64) -> Result<Vector3<f64>, Sgp4Error> {
        // ṙ ≈ Σ wₖ (r(t + k h) - r(t - k h))/(60 h)
        let mut sum = Vector3::zeros();
        for (k, weight) in SLOPE_WEIGHTS.iter().enumerate() {
            let away = (k + 1) as f64 * h;
            let (after, before) = (self.at(t + away)?, self.at(t - away)?);
            sum += (after.position - before.position) * (1e3 * weight);
        }
        Ok(sum / (60.0 * h))
    }

    /// Returns the second time derivative of the position at `t`, m/s², by finite differences with step `h`,
    /// s; `r` is the position at `t`, m.
    fn acceleration(&self, t: f64, r: &Vector3<f64>, h: f64) -> Result<Vector3<f64>, Sgp4Error> {
        // r̈ ≈ Σ wₖ (r(t + k h) + r(t - k h))/(180 h²)
        let mut sum = r * WEIGHTS[0];
        for (k, weight) in WEIGHTS.iter().enumerate().skip(1) {
            let away = k as f64 * h;
            let (after, before) = (self.at(t + away)?, self.at(t - away)?);
            sum += (after.position + before.position) * (1e3 * weight);
        }
        Ok(sum / (180.0 * h * h))
    }
}

impl Orbit for Sgp4 {
    fn mu(&self) -> Option<f64> {
        Some(self.model.mu())
    }

    fn axes(&self) -> Axes {
        Axes::Teme
    }

    fn epoch(&self) -> Option<crate::earth::Epoch> {
        Some(self.elements.epoch.instant())
    }

    fn velocity_source(&self) -> &'static str {
        match self.theory {
            Theory::Native => "SGP4's own velocity (not exactly the derivative of its position)",
            Theory::External(_) => {
                "SGP4's own velocity from the reference implementation (not exactly the derivative of its \
                 position)"
            }
        }
    }

    /// Returns the state in TEME axes, `t` s after the epoch.
    ///
    /// # Errors
    /// [`OrbitError::Sgp4`] if SGP4 has no state or the satellite is below the surface;
    /// [`OrbitError::NotFinite`], [`OrbitError::TooLarge`] and [`OrbitError::TimeOutOfRange`] for a `t` that
    /// is not finite or more than a hundred years from the epoch.
    fn state(&self, t: f64) -> Result<OrbitState, OrbitError> {
        let (position, velocity) = self.above_surface(t)?;
        // the step is 16 times shorter if the propagation fails within 90 s of `t`
        let acceleration = self
            .acceleration(t, &position, STEP)
            .or_else(|_| self.acceleration(t, &position, STEP / 16.0))?;
        Ok(OrbitState { position, velocity, acceleration })
    }

    fn rate_of_position(&self, t: f64, _state: &OrbitState) -> Result<Vector3<f64>, OrbitError> {
        Ok(self.rate(t, STEP).or_else(|_| self.rate(t, STEP / 16.0))?)
    }

    fn position_velocity(&self, t: f64) -> Result<(Vector3<f64>, Vector3<f64>), OrbitError> {
        self.above_surface(t)
    }

    fn fill(&self, times: &[f64], rows: StateRows<'_>) -> Result<(), OrbitError> {
        if matches!(self.theory, Theory::External(_)) || !self.propagator.has_lanes() {
            return fill_each(self, times, rows);
        }
        match InstructionSet::current() {
            InstructionSet::Baseline => fill_each(self, times, rows),
            InstructionSet::Fused => self.fill_in_lanes::<Lanes4>(times, rows),
            InstructionSet::Wide => self.fill_in_lanes::<Lanes8>(times, rows),
        }
    }
}
