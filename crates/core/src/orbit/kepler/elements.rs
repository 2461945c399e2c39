//! Conversion between classical elements and orbits.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::Kepler;
use super::conic::{self, Conic, Shape};
use super::double::Double;
use super::from_state::phase_from_half_anomaly;
use crate::orbit::error::{finite, positive};
use crate::orbit::{MU_EARTH, OrbitError};

/// Size of a conic, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    /// Semi-major axis `a`: positive for an ellipse, negative for a hyperbola.
    SemiMajorAxis(f64),
    /// Semi-latus rectum `p = h²/μ`, defined for every conic and required for a parabola.
    SemiLatusRectum(f64),
}

/// Position of the body on the conic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// Mean anomaly at the epoch, rad: `n (t - t_p)` with `n = √(μ/|a|³)` and the time `t_p` of a periapsis
    /// passage; undefined for a parabola.
    MeanAnomaly(f64),
    /// True anomaly at the epoch, rad; for an open orbit, within the asymptotes.
    TrueAnomaly(f64),
    /// Simulation time of a periapsis passage, s; the epoch is not used.
    PeriapsisTime(f64),
}

/// Classical orbital elements; angles are in radians and refer to the axes of `I`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elements {
    /// Size of the conic, m.
    pub size: Size,
    /// Eccentricity, zero or greater.
    pub eccentricity: f64,
    /// Inclination, rad in [0, π].
    pub inclination: f64,
    /// Right ascension of the ascending node, rad; for an equatorial orbit, the node is on the x axis.
    pub raan: f64,
    /// Argument of periapsis from the ascending node, rad.
    pub argument_of_periapsis: f64,
    /// Position of the body on the conic.
    pub phase: Phase,
    /// Gravitational parameter, m³/s².
    pub mu: f64,
    /// Simulation time at which the anomaly in `phase` holds, s.
    pub epoch: f64,
}

impl Elements {
    /// Creates the elements of an orbit around the Earth with all angles and the epoch equal to zero.
    pub fn new(size: Size, eccentricity: f64) -> Self {
        Self {
            size,
            eccentricity,
            inclination: 0.0,
            raan: 0.0,
            argument_of_periapsis: 0.0,
            phase: Phase::TrueAnomaly(0.0),
            mu: MU_EARTH,
            epoch: 0.0,
        }
    }
}

/// Distance from `e = 1` within which [`Kepler::elements`] returns the semi-latus rectum and the time of
/// periapsis, because the errors of `a` and of the mean anomaly would grow by the factor `1/|1 - e|`.
const NEAR_PARABOLIC: f64 = 1e-2;

/// Largest eccentricity of a hyperbola. Beyond it the path differs from a straight line only by rounding, and
/// the anomalies overflow.
const LARGEST_ECCENTRICITY: f64 = 1e20;

/// Largest accepted anomaly on an ellipse, rad; there the spacing of adjacent `f64` numbers is 1/8 rad.
const LARGEST_ANGLE: f64 = 1e15;

impl Kepler {
    /// Creates the orbit with the given elements.
    ///
    /// # Errors
    /// [`OrbitError::NotFinite`], [`OrbitError::TooLarge`] and [`OrbitError::NotPositive`] for invalid
    /// numbers and for sizes beyond the range of `f64`; [`OrbitError::OutOfRange`] for an anomaly
    /// beyond 1e15 rad on an ellipse, or an eccentricity beyond 1e20;
    /// [`OrbitError::NegativeEccentricity`], [`OrbitError::AxisSign`], [`OrbitError::ParabolaHasNoAxis`],
    /// [`OrbitError::ParabolaHasNoMeanAnomaly`], [`OrbitError::Inclination`] and
    /// [`OrbitError::BeyondAsymptote`] for invalid or inconsistent elements.
    pub fn new(elements: &Elements) -> Result<Self, OrbitError> {
        let mu = positive("mu", elements.mu)?;
        let shape = shape(elements)?;
        let conic = Conic::new(&shape, mu)?;
        let (epoch, phase) = phase(elements, &shape, &conic)?;
        let inclination = finite("inclination", elements.inclination)?;
        if !(0.0..=PI).contains(&inclination) {
            return Err(OrbitError::Inclination { value: inclination });
        }
        // P and Q: unit vectors towards the periapsis and along the velocity there
        let (si, ci) = inclination.sin_cos();
        let (so, co) = finite("raan", elements.raan)?.sin_cos();
        let (sw, cw) = finite("argument of periapsis", elements.argument_of_periapsis)?.sin_cos();
        let p_i = Vector3::new(co * cw - so * sw * ci, so * cw + co * sw * ci, sw * si);
        let q_i = Vector3::new(-co * sw - so * cw * ci, -so * sw + co * cw * ci, cw * si);
        Ok(Self { mu, epoch, phase, shape, conic, p_i, q_i })
    }

    /// Returns the classical elements of this orbit, from which [`Kepler::new`] rebuilds the orbit.
    ///
    /// The node and the argument of periapsis are in [0, 2π). The mean anomaly of an ellipse is in [-π, π],
    /// which keeps its digits near the periapsis. For a circular orbit the periapsis, and for an equatorial
    /// orbit the node, depend on rounding errors, but their sums with the phase are accurate. Near a
    /// parabola, the size is the semi-latus rectum and the phase is the time of periapsis.
    pub fn elements(&self) -> Elements {
        let w_i = self.p_i.cross(&self.q_i);
        let tilt = w_i.x.hypot(w_i.y);
        let node = if tilt > 0.0 { Vector3::new(-w_i.y / tilt, w_i.x / tilt, 0.0) } else { Vector3::x() };
        let argument = -self.q_i.dot(&node);
        let near_parabolic = self.shape.one_minus_e.abs() < NEAR_PARABOLIC;
        let phase = match self.conic {
            Conic::Parabola { .. } => Phase::PeriapsisTime(self.epoch - self.phase),
            Conic::Ellipse { n, .. } if near_parabolic => Phase::PeriapsisTime(self.epoch - self.phase / n),
            Conic::Ellipse { .. } => Phase::MeanAnomaly(self.phase),
            Conic::Hyperbola { .. } if near_parabolic => Phase::PeriapsisTime(self.epoch - self.phase),
            Conic::Hyperbola { n, .. } => Phase::MeanAnomaly(n * self.phase),
        };
        Elements {
            size: if near_parabolic {
                Size::SemiLatusRectum(self.semi_latus_rectum())
            } else {
                Size::SemiMajorAxis(self.semi_major_axis())
            },
            eccentricity: self.shape.e,
            inclination: tilt.atan2(w_i.z),
            raan: positive_turn(node.y.atan2(node.x)),
            argument_of_periapsis: positive_turn(argument.atan2(self.p_i.dot(&node))),
            phase,
            mu: self.mu,
            epoch: self.epoch,
        }
    }
}

/// Computes the size and shape of a conic; returns an error if size and eccentricity contradict each other.
fn shape(elements: &Elements) -> Result<Shape, OrbitError> {
    let e = finite("eccentricity", elements.eccentricity)?;
    if e < 0.0 {
        return Err(OrbitError::NegativeEccentricity { value: e });
    }
    if e > LARGEST_ECCENTRICITY {
        let expected = "at most 1e20 (beyond this value, the path is a straight line within rounding)";
        return Err(OrbitError::OutOfRange { name: "eccentricity", value: e, expected });
    }
    let (one, one_minus_e) = (Double::from(1.0), Double::from(1.0) - Double::from(e));
    match elements.size {
        Size::SemiMajorAxis(a) => {
            finite("semi-major axis", a)?;
            if one_minus_e.hi == 0.0 {
                return Err(OrbitError::ParabolaHasNoAxis { semi_major_axis: a });
            }
            if a == 0.0 || (a > 0.0) != (one_minus_e.hi > 0.0) {
                return Err(OrbitError::AxisSign { semi_major_axis: a, eccentricity: e });
            }
            // q = a (1 - e)
            let inverse_axis = one / Double::from(a);
            Ok(Shape { e, one_minus_e: one_minus_e.hi, periapsis: a * one_minus_e.hi, inverse_axis })
        }
        Size::SemiLatusRectum(p) => {
            positive("semi-latus rectum", p)?;
            // q = p/(1 + e), 1/a = (1 - e)(1 + e)/p
            let inverse_axis = one_minus_e * (one + Double::from(e)) / Double::from(p);
            Ok(Shape { e, one_minus_e: one_minus_e.hi, periapsis: p / (1.0 + e), inverse_axis })
        }
    }
}

/// Returns an instant, s, and the phase there as defined by [`Conic::advance`]: the time of periapsis with
/// phase 0 if it is given, otherwise the epoch.
fn phase(elements: &Elements, shape: &Shape, conic: &Conic) -> Result<(f64, f64), OrbitError> {
    let epoch = finite("epoch", elements.epoch)?;
    match (elements.phase, conic) {
        (Phase::PeriapsisTime(t), _) => Ok((finite("time of periapsis", t)?, 0.0)),
        (Phase::MeanAnomaly(m), _) => match conic {
            Conic::Ellipse { .. } => Ok((epoch, conic::subtract_turns(angle("mean anomaly", m)?))),
            Conic::Hyperbola { n, .. } => Ok((epoch, finite("mean anomaly", m)? / n)),
            Conic::Parabola { .. } => Err(OrbitError::ParabolaHasNoMeanAnomaly { value: m }),
        },
        (Phase::TrueAnomaly(nu), Conic::Ellipse { .. }) => {
            let nu = conic::subtract_turns(angle("true anomaly", nu)?);
            Ok((epoch, phase_from_half_anomaly(shape, conic, (0.5 * nu).sin_cos())))
        }
        (Phase::TrueAnomaly(nu), _) => {
            let value = finite("true anomaly", nu)?;
            // cos ν > -1/e
            let limit = (-1.0 / shape.e).acos();
            if value.abs() >= limit {
                return Err(OrbitError::BeyondAsymptote { value, eccentricity: shape.e, limit });
            }
            Ok((epoch, phase_from_half_anomaly(shape, conic, (0.5 * nu).sin_cos())))
        }
    }
}

/// Returns an anomaly on an ellipse, or an error if it is so large that no digits would remain after the
/// subtraction of whole turns.
fn angle(name: &'static str, value: f64) -> Result<f64, OrbitError> {
    if finite(name, value)?.abs() > LARGEST_ANGLE {
        let expected = "a magnitude of at most 1e15 rad (above it, adjacent floating-point numbers are at \
                        least 1/8 rad apart)";
        return Err(OrbitError::OutOfRange { name, value, expected });
    }
    Ok(value)
}

/// Converts an angle in [-π, π] to [0, 2π).
fn positive_turn(angle: f64) -> f64 {
    if angle >= 0.0 {
        angle + 0.0 // converts -0 to 0
    } else if angle + TAU < TAU {
        angle + TAU
    } else {
        0.0
    }
}
