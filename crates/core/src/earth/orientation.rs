//! Orientation of the Earth: Earth rotation angle, celestial pole, polar motion.

use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

use super::axes::Axes;
use super::chebyshev::PiecewiseChebyshev;
use super::epoch::{DAY, Epoch};
use super::error::EarthError;
use super::parameters::{EarthParameters, Parameters};
use super::precession::{pole, polynomial};
use super::rotation::{ROTATION_RATE, r3};

/// Length of the intervals of the pole's Chebyshev series, s.
const INTERVAL: f64 = 4.0 * DAY;

/// Orientation of the Earth according to IAU 2006 (precession) and 2000A (nutation).
#[derive(Clone, Debug)]
pub(super) struct Orientation {
    epoch: Epoch,
    axes: Axes,
    /// Earth rotation angle at time zero if UT1 were equal to TAI, rad.
    angle: f64,
    parameters: Parameters,
    poles: PiecewiseChebyshev<10>,
}

impl Orientation {
    /// Creates the orientation for a run whose time zero is `epoch`. The pole is interpolated between the two
    /// simulation times `span`, s.
    pub(super) fn new(
        epoch: Epoch,
        axes: Axes,
        parameters: &EarthParameters,
        span: (f64, f64),
    ) -> Result<Self, EarthError> {
        Ok(Self::with(epoch, axes, Parameters::new(parameters, epoch)?, span))
    }

    fn with(epoch: Epoch, axes: Axes, parameters: Parameters, span: (f64, f64)) -> Self {
        // θ = 2π (0.779 057 273 264 0 + 1.002 737 811 911 354 48 Tu) less whole turns, with Tu in days of UT1
        // from J2000.0 (IERS Conventions 2010, eq. 5.15)
        let (days, part) = epoch.tai_days();
        let turns = 0.779_057_273_264 + part + 0.002_737_811_911_354_48 * (days + part);
        let angle = turns.fract() * TAU;
        Self { epoch, axes, angle, parameters, poles: PiecewiseChebyshev::new(span.0, span.1, INTERVAL) }
    }

    /// Creates an orientation with UT1 = UTC and no polar motion, which is used only to define inertial axes.
    pub(super) fn of_axes(epoch: Epoch, span: (f64, f64)) -> Self {
        let ut1_minus_tai = epoch.utc_minus_tai();
        let parameters = Parameters::Constant { ut1_minus_tai, polar_motion: [0.0; 2] };
        Self::with(epoch, Axes::Gcrf, parameters, span)
    }

    /// Returns the same orientation relative to the inertial axes `axes`.
    pub(super) fn in_axes(&self, axes: Axes) -> Self {
        Self { axes, ..self.clone() }
    }

    pub(super) fn axes(&self) -> Axes {
        self.axes
    }

    pub(super) fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Returns the coordinates `X, Y` of the pole and the locator `s` of the celestial intermediate origin
    /// (CIO) at `t`, s, from precession and nutation, rad.
    fn pole_at(&self, t: f64) -> Vector3<f64> {
        pole(self.epoch.centuries(t))
    }

    /// Returns the Earth rotation angle `θ`, rad, and its rate, rad/s, at `t`, s.
    fn rotation_angle(&self, t: f64) -> (f64, f64) {
        let (ut1_minus_tai, rate) = self.parameters.ut1_minus_tai(t);
        (self.angle + ROTATION_RATE * (t + ut1_minus_tai), ROTATION_RATE * (1.0 + rate))
    }

    /// Returns the rotation from components in `I` to components in `F` at `t`, s: `W R₃(θ - s) Mᵀ` from
    /// GCRF, `W R₃(θ₈₂)` from TEME.
    ///
    /// `W` is the polar motion, `θ` the Earth rotation angle and `s` the CIO locator; `R₃` rotates the axes
    /// about z. The rows of `R₃(-s) Mᵀ` are the celestial intermediate axes, with the pole `X, Y`. `θ₈₂` is
    /// the mean sidereal time of 1982.
    ///
    /// Source: IERS Conventions (2010), eq. 5.1 and 5.10; Vallado and others, AIAA 2006-6753, for TEME.
    pub(super) fn rot_fi(&self, t: f64) -> Matrix3<f64> {
        let (angle, _) = self.rotation_angle(t);
        let wobble = self.polar_motion(t);
        match self.axes {
            Axes::Teme => wobble * r3(angle + self.sidereal_excess(t)),
            Axes::Gcrf => {
                let p = self.poles.value(t, |t| self.pole_at(t));
                wobble * r3(angle - p.z) * equator(p.x, p.y)
            }
        }
    }

    /// Returns the polar motion `W = R₁(-y_p) R₂(-x_p)` at `t`, s, to second order in the coordinates
    /// `x_p, y_p` of the pole. The locator `s'` of the terrestrial origin (0.05 mas) is neglected.
    fn polar_motion(&self, t: f64) -> Matrix3<f64> {
        let [x, y] = self.parameters.polar_motion(t);
        let (cx, cy) = (1.0 - 0.5 * x * x, 1.0 - 0.5 * y * y);
        Matrix3::new(cx, 0.0, x, x * y, cy, -cx * y, -cy * x, y, cx * cy)
    }

    /// Returns the mean sidereal time of 1982 minus the Earth rotation angle at `t`, s, in rad.
    ///
    /// Source: Aoki and others, Astronomy and Astrophysics 105, 1982, eq. 14.
    fn sidereal_excess(&self, t: f64) -> f64 {
        // θ₈₂ = 67 310.548 41 s + (876 600 h + 8 640 184.812 866 s) T + 0.093 104 s T² - 6.2e-6 s T³ with T
        // of UT1
        const TURNS: [f64; 4] = [
            67_310.548_41 / DAY - 0.779_057_273_264,
            8_640_184.812_866 / DAY - 0.002_737_811_911_354_48 * 36_525.0,
            0.093_104 / DAY,
            -6.2e-6 / DAY,
        ];
        let (days, part) = self.epoch.tai_days();
        let ut1 = days + part + (t + self.parameters.ut1_minus_tai(t).0) / DAY;
        polynomial(&TURNS, ut1 / 36_525.0) * TAU
    }

    /// Returns the rotation from GCRF components to components in `I` at `t`, s.
    pub(super) fn rot_ig(&self, t: f64) -> Matrix3<f64> {
        match self.axes {
            Axes::Gcrf => Matrix3::identity(),
            Axes::Teme => {
                // R₃(θ₈₂) r_TEME = R₃(θ - s) Mᵀ r_GCRF
                let p = self.poles.value(t, |t| self.pole_at(t));
                r3(-p.z - self.sidereal_excess(t)) * equator(p.x, p.y)
            }
        }
    }

    /// Returns the angular velocity of the Earth relative to `I` at `t`, s, axes of `I`, rad/s.
    ///
    /// `ω = θ̇ p + p × ṗ` with the pole `p`, about which the celestial intermediate origin does not rotate.
    /// The rate of polar motion, below 1e-12 rad/s, is neglected.
    pub(super) fn angular_velocity(&self, t: f64) -> Vector3<f64> {
        let (_, rate) = self.rotation_angle(t);
        match self.axes {
            Axes::Teme => Vector3::z() * rate, // θ̇₈₂ exceeds θ̇ by 7e-12 rad/s
            Axes::Gcrf => {
                let (p, dp) = self.poles.with_rate(t, |t| self.pole_at(t));
                let z = (1.0 - p.x * p.x - p.y * p.y).sqrt();
                let pole = Vector3::new(p.x, p.y, z);
                let slope = Vector3::new(dp.x, dp.y, -(p.x * dp.x + p.y * dp.y) / z);
                pole * rate + pole.cross(&slope)
            }
        }
    }
}

impl PartialEq for Orientation {
    fn eq(&self, other: &Self) -> bool {
        // the other fields follow from these
        (self.epoch, self.axes, &self.parameters) == (other.epoch, other.axes, &other.parameters)
    }
}

/// Returns the rotation from GCRF to the axes whose z axis is the pole `X, Y` and whose x and y axes lie
/// in the equator: `Mᵀ` of the IERS Conventions (2010), eq. 5.10, with `a = 1/(1 + Z)`.
fn equator(x: f64, y: f64) -> Matrix3<f64> {
    let z = (1.0 - x * x - y * y).sqrt();
    let a = 1.0 / (1.0 + z);
    Matrix3::new(1.0 - a * x * x, -a * x * y, -x, -a * x * y, 1.0 - a * y * y, -y, x, y, z)
}
