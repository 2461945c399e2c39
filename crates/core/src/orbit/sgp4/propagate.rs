//! SGP4 and SDP4 in one: secular effects, then periodic ones. Nothing is kept between calls.

use super::constants::{Earth, EarthModel, Mean};
use super::deep_space::DeepSpace;
use super::elements::MeanElements;
use super::error::Sgp4Error;
use super::near_earth::{Drifted, NearEarth, brouwer};
use super::periodics::{Flight, flight};
use std::f64::consts::TAU;

/// Least eccentricity that the periodic terms are given.
const ROUNDEST: f64 = 1e-6;

/// An element set made ready.
#[derive(Clone, Debug)]
pub(super) struct Propagator {
    pub(super) earth: Earth,
    near: NearEarth,
    deep: Option<DeepSpace>,
}

impl Propagator {
    pub(super) fn new(set: &MeanElements, model: EarthModel) -> Self {
        let earth = model.earth();
        let mean = brouwer(set, &earth);
        let is_deep = DeepSpace::is_needed(&mean);
        let near = NearEarth::new(mean, set.drag_term, &earth, is_deep);
        let deep = is_deep.then(|| DeepSpace::new(&near, set.epoch, &earth));
        Self { earth, near, deep }
    }

    /// Where the satellite is `time` seconds from the epoch, below the surface too.
    pub(super) fn at(&self, time: f64) -> Result<Flight, Sgp4Error> {
        let t = time / 60.0;
        let (mut mean, a) = self.secular(t, time)?;
        if let Some(deep) = &self.deep {
            deep.swing(t, &mut mean);
            if !(0.0..=1.0).contains(&mean.e) {
                return Err(Sgp4Error::PerturbedEccentricity { time, eccentricity: mean.e });
            }
        }
        flight(&mean, a, &self.earth).map_err(|p| Sgp4Error::SemiLatusRectum {
            time,
            semi_latus_rectum: p * self.earth.radius_km * 1e3,
        })
    }

    /// Mean elements without periodic terms, and their semi-major axis, Earth radii.
    fn secular(&self, t: f64, time: f64) -> Result<(Mean, f64), Sgp4Error> {
        let Drifted { mut mean, shrink, rounding, lead } = self.near.at(t);
        if let Some(deep) = &self.deep {
            deep.drift(t, &mut mean);
        }
        if mean.n.is_nan() || mean.n <= 0.0 {
            return Err(Sgp4Error::MeanMotion { time, mean_motion: mean.n * (1440.0 / TAU) });
        }
        // a = (kₑ/n)^{2/3} (1 - C₁ t - …)²,  n = kₑ/a^{3/2}
        let a = (self.earth.ke / mean.n).powf(2.0 / 3.0) * shrink * shrink;
        mean.n = self.earth.ke / a.powf(1.5);
        mean.e -= rounding;
        if !(-0.001..1.0).contains(&mean.e) {
            return Err(Sgp4Error::MeanEccentricity { time, eccentricity: mean.e });
        }
        mean.e = mean.e.max(ROUNDEST);
        mean.anomaly += self.near.epoch.n * lead;
        let longitude = (mean.anomaly + mean.perigee + mean.node) % TAU;
        mean.node %= TAU;
        mean.perigee %= TAU;
        mean.anomaly = (longitude - mean.perigee - mean.node) % TAU;
        Ok((mean, a))
    }
}
