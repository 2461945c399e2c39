//! Perturbations of orbits with periods of 225 minutes or more: Sun, Moon and resonance.

use super::constants::{Earth, Mean};
use super::epoch::Epoch;
use super::lunar_solar::{Five, ThirdBody, sun_and_moon};
use super::near_earth::NearEarth;
use super::resonance::{EARTH_RATE, Rates, Resonance};
use std::f64::consts::{PI, TAU};

/// Shortest period of deep-space orbits, min.
const SHORTEST_PERIOD: f64 = 225.0;
/// Inclination, rad, below which the drift of the node caused by Sun and Moon is neglected; the same holds
/// above π minus this value.
const EQUATORIAL: f64 = 5.235_987_7e-2;
/// Inclination, rad, below which Lyddane's variables are used instead of node and perigee.
const LYDDANE: f64 = 0.2;

/// Perturbations of one deep-space orbit, as constants that depend only on the elements at the epoch.
#[derive(Clone, Debug)]
pub(super) struct DeepSpace {
    bodies: [ThirdBody; 2],
    /// Rates of eccentricity, 1/min, inclination, mean anomaly, perigee and node, rad/min, caused by Sun and
    /// Moon.
    rates: Five,
    resonance: Option<Resonance>,
    /// Sidereal time at the epoch, rad.
    sidereal: f64,
}

impl DeepSpace {
    pub(super) fn is_needed(mean: &Mean) -> bool {
        TAU / mean.n >= SHORTEST_PERIOD
    }

    pub(super) fn new(near: &NearEarth, epoch: Epoch, earth: &Earth) -> Self {
        let mean = near.epoch;
        let bodies = sun_and_moon(epoch.julian_day() - 2_415_020.0, &mean);
        let (sin, cos) = mean.i.sin_cos();
        let [sun, moon] = [&bodies[0], &bodies[1]].map(|body| {
            let [e, i, l, gh, h] = body.rates;
            let has_node = (EQUATORIAL..=PI - EQUATORIAL).contains(&mean.i);
            let node = if has_node { h / sin } else { 0.0 };
            [e, i, l, gh - cos * node, node]
        });
        let rates: Five = std::array::from_fn(|k| sun[k] + moon[k]);
        let sidereal = epoch.sidereal_time();
        let angles = Rates {
            anomaly: [near.anomaly_rate, rates[2]],
            perigee: [near.perigee_rate, rates[3]],
            node: [near.node_rate, rates[4]],
        };
        let resonance = Resonance::new(&mean, &angles, sidereal, earth);
        Self { bodies, rates, resonance, sidereal }
    }

    /// Adds to `mean` the secular perturbations by Sun, Moon and resonance, `t` minutes after the epoch.
    pub(super) fn add_secular(&self, t: f64, mean: &mut Mean) {
        let [e, i, anomaly, perigee, node] = self.rates;
        mean.e += e * t;
        mean.i += i * t;
        mean.perigee += perigee * t;
        mean.node += node * t;
        mean.anomaly += anomaly * t;
        if let Some(resonance) = &self.resonance {
            resonance.apply(t, (self.sidereal + t * EARTH_RATE) % TAU, mean);
        }
    }

    /// Adds to `mean` the periodic perturbations caused by Sun and Moon, `t` minutes after the epoch.
    pub(super) fn add_periodic(&self, t: f64, mean: &mut Mean) {
        let [sun, moon] = [&self.bodies[0], &self.bodies[1]].map(|body| body.waves(t));
        let [de, di, dl, gh, h]: Five = std::array::from_fn(|k| sun[k] + moon[k]);
        mean.e += de;
        mean.i += di;
        let (sin, cos) = mean.i.sin_cos();
        if mean.i >= LYDDANE {
            let node = h / sin;
            mean.perigee += gh - cos * node;
            mean.node += node;
            mean.anomaly += dl;
        } else {
            // Lyddane's variables: α = sin i sin Ω, β = sin i cos Ω and l = M + ω + Ω cos i are regular at i
            // = 0
            let (sin_node, cos_node) = mean.node.sin_cos();
            let alpha = sin * sin_node + (h * cos_node + di * cos * sin_node);
            let beta = sin * cos_node + (-h * sin_node + di * cos * cos_node);
            let before = mean.node % TAU;
            let l = mean.anomaly + mean.perigee + cos * before + (dl + gh - di * before * sin);
            mean.node = alpha.atan2(beta);
            if (before - mean.node).abs() > PI {
                mean.node += TAU.copysign(before - mean.node);
            }
            mean.anomaly += dl;
            mean.perigee = l - mean.anomaly - cos * mean.node;
        }
        if mean.i < 0.0 {
            mean.i = -mean.i;
            mean.node += PI;
            mean.perigee -= PI;
        }
    }
}
