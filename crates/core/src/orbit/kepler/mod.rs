//! Two-body motion on any conic: ellipse, parabola, hyperbola.
//!
//! `r̈ = -μ r/|r|³`, solved in closed form; no angle enters [`Kepler::state`], so circular
//! and equatorial orbits are nothing special. Source: Battin, An Introduction to the
//! Mathematics and Methods of Astrodynamics, AIAA 1999, chapters 3 and 4.

mod anomaly;
mod conic;
mod double;
mod elements;
mod from_state;
mod secular;
mod side_by_side;

use nalgebra::Vector3;

use super::error::finite;
use super::rows::{in_lanes, one_by_one};
use super::{Orbit, OrbitError, OrbitState, StateRows};
use crate::gravity::point_mass;
use crate::spatial::{Fused, InstructionSet, Lanes4, Lanes8, Real, Vec3};
use conic::{Conic, InPlane, Shape};
pub use elements::{Elements, Phase, Size};
pub use secular::SecularJ2;
pub(crate) use side_by_side::ellipse_state;

/// An unperturbed orbit around a point mass.
///
/// An ellipse keeps its phase over 2²⁶ revolutions and an open orbit over 1e18 s; further
/// from its epoch [`Orbit::state`] refuses, since `f64` seconds no longer tell metres apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kepler {
    mu: f64,
    epoch: f64,
    /// Mean anomaly (ellipse, rad) or time since periapsis (open orbits, s) at the epoch.
    phase: f64,
    shape: Shape,
    conic: Conic,
    /// Perifocal axes in `I`: towards the periapsis, and along the velocity there.
    p_i: Vector3<f64>,
    q_i: Vector3<f64>,
}

impl Kepler {
    /// Semi-major axis, m; negative on a hyperbola, infinite on a parabola.
    pub fn semi_major_axis(&self) -> f64 {
        match self.conic {
            Conic::Ellipse { a, .. } => a,
            Conic::Parabola { .. } => f64::INFINITY,
            Conic::Hyperbola { a, .. } => -a,
        }
    }

    /// Eccentricity.
    pub fn eccentricity(&self) -> f64 {
        self.shape.e
    }

    /// Distance of the periapsis from the planet's centre, m.
    pub fn periapsis_distance(&self) -> f64 {
        self.shape.periapsis
    }

    /// Semi-latus rectum `p = q (1 + e)`, m.
    pub fn semi_latus_rectum(&self) -> f64 {
        self.shape.periapsis * (1.0 + self.shape.e)
    }

    /// Mean anomaly at the epoch, rad; `None` on an open orbit.
    pub fn mean_anomaly(&self) -> Option<f64> {
        matches!(self.conic, Conic::Ellipse { .. }).then_some(self.phase)
    }

    /// Period of revolution, s; `None` on an open orbit.
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
        let s = self.fused(dt);
        let s = s.unwrap_or_else(|| self.conic.in_plane(&self.shape, self.conic.advance(self.phase, dt)));
        Ok(self.out_of_plane(&s))
    }

    fn two_states(&self, t: [f64; 2]) -> Option<[OrbitState; 2]> {
        let (dt, limit) = (t.map(|t| t - self.epoch), self.conic.longest_time());
        let is_there =
            InstructionSet::current() > InstructionSet::Baseline && dt.iter().all(|dt| dt.abs() <= limit);
        let s = is_there.then(|| self.two(dt)).flatten()?;
        Some([0, 1].map(|i| {
            self.out_of_plane(&InPlane { x: s.x.lane(i), y: s.y.lane(i), vx: s.vx.lane(i), vy: s.vy.lane(i) })
        }))
    }

    fn fill(&self, times: &[f64], rows: StateRows<'_>) -> Result<(), OrbitError> {
        match (InstructionSet::current(), self.conic) {
            (InstructionSet::Fused, Conic::Ellipse { .. }) => self.side_by_side::<Lanes4>(times, rows),
            (InstructionSet::Wide, Conic::Ellipse { .. }) => self.side_by_side::<Lanes8>(times, rows),
            _ => one_by_one(self, times, rows),
        }
    }
}

impl Kepler {
    fn out_of_plane(&self, s: &InPlane) -> OrbitState {
        let position = self.p_i * s.x + self.q_i * s.y;
        let velocity = self.p_i * s.vx + self.q_i * s.vy;
        OrbitState { position, velocity, acceleration: point_mass(self.mu, &position) }
    }

    /// Two states in the plane of an ellipse, side by side.
    fn two(&self, [first, second]: [f64; 2]) -> Option<InPlane<Lanes4>> {
        Lanes4::enter(
            #[inline(always)]
            || {
                let dt = Lanes4::from_lanes(|i| if i == 0 { first } else { second });
                self.conic.several(&self.shape, self.phase, dt)
            },
        )
    }

    /// State in the plane of an ellipse, `dt` s after the epoch, on a processor with fused multiply-add.
    fn fused(&self, dt: f64) -> Option<InPlane> {
        if InstructionSet::current() == InstructionSet::Baseline {
            return None;
        }
        let s = Fused::enter(
            #[inline(always)]
            || self.conic.several(&self.shape, self.phase, Fused(dt)),
        )?;
        Some(InPlane { x: s.x.0, y: s.y.0, vx: s.vx.0, vy: s.vy.0 })
    }

    /// As many times at once as `S` has lanes; one by one where one of them is refused.
    fn side_by_side<S: Real>(&self, times: &[f64], rows: StateRows<'_>) -> Result<(), OrbitError> {
        let (p, q, longest) = (self.p_i.into(), self.q_i.into(), self.conic.longest_time());
        let (p, q) = (Vec3::<S>::of(&p), Vec3::<S>::of(&q));
        in_lanes::<S>(
            self,
            times,
            rows,
            #[inline(always)]
            |t| {
                let dt = t - S::of(self.epoch);
                if !(0..S::LANES).all(|lane| dt.lane(lane).abs() <= longest) {
                    return None;
                }
                let s = self.conic.several(&self.shape, self.phase, dt)?;
                Some((p * s.x + q * s.y, p * s.vx + q * s.vy))
            },
        )
    }
}
