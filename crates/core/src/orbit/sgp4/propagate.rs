//! Propagation by SGP4 and SDP4, which applies first the secular and then the periodic perturbations. No
//! state is kept between calls.

use super::constants::{Earth, EarthModel, Mean, wrap_angle};
use super::deep_space::DeepSpace;
use super::elements::MeanElements;
use super::error::Sgp4Error;
use super::near_earth::{NearEarth, SecularElements, brouwer};
use super::periodics::{OsculatingState, osculating_state};
use crate::spatial::Real;
use std::f64::consts::TAU;

/// Smallest eccentricity passed to the periodic terms.
const MIN_ECCENTRICITY: f64 = 1e-6;
/// Range of mean eccentricities for which the theory is defined.
const ECCENTRICITIES: std::ops::Range<f64> = -0.001..1.0;

/// Propagator of an element set, with precomputed constants.
#[derive(Clone, Debug)]
pub(super) struct Propagator {
    pub(super) earth: Earth,
    near: NearEarth,
    /// Semi-major axis at the epoch, Earth radii.
    a: f64,
    /// Sine and cosine of the inclination at the epoch.
    inclination_sin_cos: (f64, f64),
    deep: Option<DeepSpace>,
}

impl Propagator {
    pub(super) fn new(set: &MeanElements, model: EarthModel) -> Self {
        let earth = model.earth();
        let mean = brouwer(set, &earth);
        let is_deep = DeepSpace::is_needed(&mean);
        let near = NearEarth::new(mean, set.drag_term, &earth, is_deep);
        let deep = is_deep.then(|| DeepSpace::new(&near, set.epoch, &earth));
        Self {
            earth,
            near,
            a: (earth.ke / mean.n).powf(2.0 / 3.0),
            inclination_sin_cos: mean.i.sin_cos(),
            deep,
        }
    }

    /// Returns the state `time` seconds after the epoch, even if it is below the surface.
    pub(super) fn at(&self, time: f64) -> Result<OsculatingState<f64>, Sgp4Error> {
        let t = time / 60.0;
        let SecularElements { mut mean, axis_factor, eccentricity_loss, longitude_gain } = self.near.at(t);
        let (mut a, mut inclination_sin_cos) = (self.a, self.inclination_sin_cos);
        if let Some(deep) = &self.deep {
            deep.add_secular(t, &mut mean);
            if mean.n.is_nan() || mean.n <= 0.0 {
                return Err(Sgp4Error::MeanMotion { time, mean_motion: mean.n * (1440.0 / TAU) });
            }
            a = (self.earth.ke / mean.n).powf(2.0 / 3.0);
        }
        a = self.secular(&mut mean, a, axis_factor, eccentricity_loss, longitude_gain);
        let eccentricity = mean.e;
        if !ECCENTRICITIES.contains(&eccentricity) {
            return Err(Sgp4Error::MeanEccentricity { time, eccentricity });
        }
        mean.e = eccentricity.max(MIN_ECCENTRICITY);
        if let Some(deep) = &self.deep {
            deep.add_periodic(t, &mut mean);
            if !(0.0..=1.0).contains(&mean.e) {
                return Err(Sgp4Error::PerturbedEccentricity { time, eccentricity: mean.e });
            }
            inclination_sin_cos = mean.i.sin_cos();
        }
        let state = osculating_state(&mean, a, inclination_sin_cos, &self.earth);
        if state.p.is_nan() || state.p < 0.0 {
            let semi_latus_rectum = state.p * self.earth.radius_km * 1e3;
            return Err(Sgp4Error::SemiLatusRectum { time, semi_latus_rectum });
        }
        Ok(state)
    }

    /// Returns true if [`Propagator::at_lanes`] can be used, which requires an orbit without perturbations by
    /// Sun and Moon.
    pub(super) fn has_lanes(&self) -> bool {
        self.deep.is_none()
    }

    /// Returns the states `time` seconds after the epoch, one per lane; `None` if SGP4 has no state at one of
    /// these times, or if a state is below the surface.
    #[inline(always)]
    pub(super) fn at_lanes<S: Real>(&self, time: S) -> Option<OsculatingState<S>> {
        let SecularElements { mut mean, axis_factor, eccentricity_loss, longitude_gain } =
            self.near.at(time / S::of(60.0));
        let a = self.secular(&mut mean, S::of(self.a), axis_factor, eccentricity_loss, longitude_gain);
        let e = mean.e;
        mean.e = S::select(S::less(e, S::of(MIN_ECCENTRICITY)), S::of(MIN_ECCENTRICITY), e);
        let state = osculating_state(
            &mean,
            a,
            (S::of(self.inclination_sin_cos.0), S::of(self.inclination_sin_cos.1)),
            &self.earth,
        );
        let is_regular = |lane: usize| {
            ECCENTRICITIES.contains(&e.lane(lane))
                && state.p.lane(lane) >= 0.0
                && state.distance.lane(lane) >= 1.0
        };
        (0..S::LANES).all(is_regular).then_some(state)
    }

    /// Applies the secular effects of drag to `mean` and returns the resulting semi-major axis, Earth radii.
    ///
    /// `a` is the semi-major axis before drag, which corresponds to the initial value of `mean.n`.
    #[inline(always)]
    fn secular<S: Real>(
        &self,
        mean: &mut Mean<S>,
        a: S,
        axis_factor: S,
        eccentricity_loss: S,
        longitude_gain: S,
    ) -> S {
        // a = (kₑ/n)^{2/3} (1 - C₁ t - …)²,  n = kₑ/a^{3/2}
        let a = a * axis_factor * axis_factor;
        mean.n = S::of(self.earth.ke) / (a * a.sqrt());
        mean.e -= eccentricity_loss;
        mean.anomaly += S::of(self.near.epoch.n) * longitude_gain;
        let longitude = wrap_angle(mean.anomaly + mean.perigee + mean.node);
        mean.node = wrap_angle(mean.node);
        mean.perigee = wrap_angle(mean.perigee);
        mean.anomaly = wrap_angle(longitude - mean.perigee - mean.node);
        a
    }
}
