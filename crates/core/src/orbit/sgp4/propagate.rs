//! SGP4 and SDP4 in one: secular effects, then periodic ones. Nothing is kept between calls.

use super::constants::{Earth, EarthModel, Mean, turns_off};
use super::deep_space::DeepSpace;
use super::elements::MeanElements;
use super::error::Sgp4Error;
use super::near_earth::{Drifted, NearEarth, brouwer};
use super::periodics::{Flight, flight};
use crate::spatial::Real;
use std::f64::consts::TAU;

/// Least eccentricity that the periodic terms are given.
const ROUNDEST: f64 = 1e-6;
/// Mean eccentricities that the theory takes.
const ECCENTRICITIES: std::ops::Range<f64> = -0.001..1.0;

/// An element set made ready.
#[derive(Clone, Debug)]
pub(super) struct Propagator {
    pub(super) earth: Earth,
    near: NearEarth,
    /// Semi-major axis at the epoch, Earth radii; sine and cosine of the inclination there.
    a: f64,
    tilt: (f64, f64),
    deep: Option<DeepSpace>,
}

impl Propagator {
    pub(super) fn new(set: &MeanElements, model: EarthModel) -> Self {
        let earth = model.earth();
        let mean = brouwer(set, &earth);
        let is_deep = DeepSpace::is_needed(&mean);
        let near = NearEarth::new(mean, set.drag_term, &earth, is_deep);
        let deep = is_deep.then(|| DeepSpace::new(&near, set.epoch, &earth));
        Self { earth, near, a: (earth.ke / mean.n).powf(2.0 / 3.0), tilt: mean.i.sin_cos(), deep }
    }

    /// Where the satellite is `time` seconds from the epoch, below the surface too.
    pub(super) fn at(&self, time: f64) -> Result<Flight<f64>, Sgp4Error> {
        let t = time / 60.0;
        let Drifted { mut mean, shrink, rounding, lead } = self.near.at(t);
        let (mut a, mut tilt) = (self.a, self.tilt);
        if let Some(deep) = &self.deep {
            deep.drift(t, &mut mean);
            if mean.n.is_nan() || mean.n <= 0.0 {
                return Err(Sgp4Error::MeanMotion { time, mean_motion: mean.n * (1440.0 / TAU) });
            }
            a = (self.earth.ke / mean.n).powf(2.0 / 3.0);
        }
        a = self.secular(&mut mean, a, shrink, rounding, lead);
        let eccentricity = mean.e;
        if !ECCENTRICITIES.contains(&eccentricity) {
            return Err(Sgp4Error::MeanEccentricity { time, eccentricity });
        }
        mean.e = eccentricity.max(ROUNDEST);
        if let Some(deep) = &self.deep {
            deep.swing(t, &mut mean);
            if !(0.0..=1.0).contains(&mean.e) {
                return Err(Sgp4Error::PerturbedEccentricity { time, eccentricity: mean.e });
            }
            tilt = mean.i.sin_cos();
        }
        let flight = flight(&mean, a, tilt, &self.earth);
        if flight.p.is_nan() || flight.p < 0.0 {
            let semi_latus_rectum = flight.p * self.earth.radius_km * 1e3;
            return Err(Sgp4Error::SemiLatusRectum { time, semi_latus_rectum });
        }
        Ok(flight)
    }

    /// Whether [`Propagator::several`] serves: no pull of Sun and Moon, which is worked out one time after another.
    pub(super) fn goes_side_by_side(&self) -> bool {
        self.deep.is_none()
    }

    /// Where the satellite is at several times; `None` if one of them has no state or lies below the surface.
    #[inline(always)]
    pub(super) fn several<S: Real>(&self, time: S) -> Option<Flight<S>> {
        let Drifted { mut mean, shrink, rounding, lead } = self.near.at(time / S::of(60.0));
        let a = self.secular(&mut mean, S::of(self.a), shrink, rounding, lead);
        let e = mean.e;
        mean.e = S::select(S::less(e, S::of(ROUNDEST)), S::of(ROUNDEST), e);
        let flight = flight(&mean, a, (S::of(self.tilt.0), S::of(self.tilt.1)), &self.earth);
        let is_regular = |lane: usize| {
            ECCENTRICITIES.contains(&e.lane(lane))
                && flight.p.lane(lane) >= 0.0
                && flight.distance.lane(lane) >= 1.0
        };
        (0..S::LANES).all(is_regular).then_some(flight)
    }

    /// Puts what has grown since the epoch into `mean`; returns the semi-major axis, `a` being that of its mean motion.
    #[inline(always)]
    fn secular<S: Real>(&self, mean: &mut Mean<S>, a: S, shrink: S, rounding: S, lead: S) -> S {
        // a = (kₑ/n)^{2/3} (1 - C₁ t - …)²,  n = kₑ/a^{3/2}
        let a = a * shrink * shrink;
        mean.n = S::of(self.earth.ke) / (a * a.sqrt());
        mean.e -= rounding;
        mean.anomaly += S::of(self.near.epoch.n) * lead;
        let longitude = turns_off(mean.anomaly + mean.perigee + mean.node);
        mean.node = turns_off(mean.node);
        mean.perigee = turns_off(mean.perigee);
        mean.anomaly = turns_off(longitude - mean.perigee - mean.node);
        a
    }
}
