//! Two-body motion on any conic: ellipse, parabola, hyperbola.
//!
//! `r̈ = -μ r/|r|³`, solved by Kepler's equation. [`Kepler::state`] uses no angles, so circular and
//! equatorial orbits are not singular. Source: Battin, An Introduction to the Mathematics and Methods of
//! Astrodynamics, AIAA 1999, chapters 3 and 4.

mod anomaly;
mod conic;
mod double;
mod elements;
mod ellipse_state;
mod from_state;
mod secular;

use nalgebra::Vector3;

use super::error::finite;
use super::lanes::fill_lanes;
use super::reference_orbit::fill_each;
use super::{Orbit, OrbitError, OrbitState, StateRows};
use crate::gravity::point_mass;
use crate::spatial::{Fused, InstructionSet, Lanes4, Lanes8, Real, Vec3};
use conic::{Conic, PerifocalState, Shape};
pub use elements::{Elements, Phase, Size};
pub(crate) use ellipse_state::ellipse_state;
pub use secular::SecularJ2;

/// Unperturbed orbit around a point mass.
///
/// The phase of an ellipse is accurate over 2²⁶ revolutions, and the phase of an open orbit over 1e18 s.
/// [`Orbit::state`] returns an error for times farther from the epoch, where `f64` seconds are too coarse to
/// determine the position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kepler {
    mu: f64,
    epoch: f64,
    /// Mean anomaly at the epoch, rad, for an ellipse; time from periapsis to the epoch, s, for an open
    /// orbit.
    phase: f64,
    shape: Shape,
    conic: Conic,
    /// Unit vector towards the periapsis, in `I`.
    p_i: Vector3<f64>,
    /// Unit vector along the velocity at the periapsis, in `I`.
    q_i: Vector3<f64>,
}

impl Kepler {
    /// Returns the semi-major axis, m; negative for a hyperbola, infinite for a parabola.
    pub fn semi_major_axis(&self) -> f64 {
        match self.conic {
            Conic::Ellipse { a, .. } => a,
            Conic::Parabola { .. } => f64::INFINITY,
            Conic::Hyperbola { a, .. } => -a,
        }
    }

    /// Returns the eccentricity.
    pub fn eccentricity(&self) -> f64 {
        self.shape.e
    }

    /// Returns the distance of the periapsis from the planet's centre, m.
    pub fn periapsis_distance(&self) -> f64 {
        self.shape.periapsis
    }

    /// Returns the semi-latus rectum `p = q (1 + e)`, m.
    pub fn semi_latus_rectum(&self) -> f64 {
        self.shape.periapsis * (1.0 + self.shape.e)
    }

    /// Returns the mean anomaly at the epoch, rad; `None` for an open orbit.
    pub fn mean_anomaly(&self) -> Option<f64> {
        matches!(self.conic, Conic::Ellipse { .. }).then_some(self.phase)
    }

    /// Returns the period of revolution, s; `None` for an open orbit.
    pub fn period(&self) -> Option<f64> {
        match self.conic {
            Conic::Ellipse { period, .. } => Some(period.seconds),
            _ => None,
        }
    }
}

impl Orbit for Kepler {
    fn mu(&self) -> Option<f64> {
        Some(self.mu)
    }

    fn state(&self, t: f64) -> Result<OrbitState, OrbitError> {
        let dt = t - self.epoch;
        let limit = self.conic.longest_time();
        if dt.is_nan() || dt.abs() > limit {
            finite("time", t)?;
            return Err(OrbitError::TimeOutOfRange { time: t, epoch: self.epoch, limit });
        }
        let s = self.perifocal_state_fused(dt);
        let s =
            s.unwrap_or_else(|| self.conic.perifocal_state(&self.shape, self.conic.advance(self.phase, dt)));
        Ok(self.inertial_state(&s))
    }

    fn two_states(&self, t: [f64; 2]) -> Option<[OrbitState; 2]> {
        let (dt, limit) = (t.map(|t| t - self.epoch), self.conic.longest_time());
        let is_in_range =
            InstructionSet::current() > InstructionSet::Baseline && dt.iter().all(|dt| dt.abs() <= limit);
        let s = is_in_range.then(|| self.two_perifocal_states(dt)).flatten()?;
        Some([0, 1].map(|i| {
            self.inertial_state(&PerifocalState {
                x: s.x.lane(i),
                y: s.y.lane(i),
                vx: s.vx.lane(i),
                vy: s.vy.lane(i),
            })
        }))
    }

    fn fill(&self, times: &[f64], rows: StateRows<'_>) -> Result<(), OrbitError> {
        match (InstructionSet::current(), self.conic) {
            (InstructionSet::Fused, Conic::Ellipse { .. }) => self.fill_in_lanes::<Lanes4>(times, rows),
            (InstructionSet::Wide, Conic::Ellipse { .. }) => self.fill_in_lanes::<Lanes8>(times, rows),
            _ => fill_each(self, times, rows),
        }
    }
}

impl Kepler {
    fn inertial_state(&self, s: &PerifocalState) -> OrbitState {
        let position = self.p_i * s.x + self.q_i * s.y;
        let velocity = self.p_i * s.vx + self.q_i * s.vy;
        OrbitState { position, velocity, acceleration: point_mass(self.mu, &position) }
    }

    /// Returns the states on an ellipse in perifocal axes at two times since the epoch, s, in the first two
    /// lanes; `None` for an open orbit.
    fn two_perifocal_states(&self, [first, second]: [f64; 2]) -> Option<PerifocalState<Lanes4>> {
        Lanes4::enter(
            #[inline(always)]
            || {
                let dt = Lanes4::from_lanes(|i| if i == 0 { first } else { second });
                self.conic.ellipse_state_at(&self.shape, self.phase, dt)
            },
        )
    }

    /// Returns the state on an ellipse in perifocal axes, `dt` s after the epoch; `None` for an open orbit,
    /// or if the current instruction set has no fused multiply-add.
    fn perifocal_state_fused(&self, dt: f64) -> Option<PerifocalState> {
        if InstructionSet::current() == InstructionSet::Baseline {
            return None;
        }
        let s = Fused::enter(
            #[inline(always)]
            || self.conic.ellipse_state_at(&self.shape, self.phase, Fused(dt)),
        )?;
        Some(PerifocalState { x: s.x.0, y: s.y.0, vx: s.vx.0, vy: s.vy.0 })
    }

    /// Fills `rows` with states computed on the SIMD lanes of `S`. The instants of a group that contains an
    /// invalid time are evaluated individually.
    fn fill_in_lanes<S: Real>(&self, times: &[f64], rows: StateRows<'_>) -> Result<(), OrbitError> {
        let (p, q, longest) = (self.p_i.into(), self.q_i.into(), self.conic.longest_time());
        let (p, q) = (Vec3::<S>::of(&p), Vec3::<S>::of(&q));
        fill_lanes::<S>(
            self,
            times,
            rows,
            #[inline(always)]
            |t| {
                let dt = t - S::of(self.epoch);
                if !(0..S::LANES).all(|lane| dt.lane(lane).abs() <= longest) {
                    return None;
                }
                let s = self.conic.ellipse_state_at(&self.shape, self.phase, dt)?;
                Some((p * s.x + q * s.y, p * s.vx + q * s.vy))
            },
        )
    }
}
