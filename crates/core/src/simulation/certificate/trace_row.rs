//! Row of a trace, with forces and scales computed from the equations of motion.

use crate::dynamics::Momentum;
use crate::spatial::{Quat, Vec3};
use serde::{Deserialize, Serialize};

/// Rotational motion of the base at one end of an interval. Angular velocities and accelerations are in base
/// axes, rad/s and rad/s².
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct BaseMotion {
    pub(crate) time: f64,
    pub(crate) attitude: Quat<f64>,
    pub(crate) rate: Vec3<f64>,
    /// Angular acceleration just before `time`.
    pub(crate) change_before: Vec3<f64>,
    /// Angular acceleration just after `time`.
    pub(crate) change_after: Vec3<f64>,
    /// Sum of the magnitudes of the rates of base and joints, rad/s or m/s, which is the scale of their
    /// rounding errors.
    pub(crate) rates: f64,
    /// Sum of the magnitudes of the time derivatives of these rates, rad/s² or m/s², plus the square of
    /// `rates`.
    pub(crate) changes: f64,
    /// True if a joint starts or stops at this instant, so that `change_before` is unknown.
    pub(crate) is_cut: bool,
}

impl BaseMotion {
    /// Computes the motion of the base from configuration, velocity, the acceleration just after the instant,
    /// and the angular acceleration just before it.
    #[inline]
    pub(crate) fn new(time: f64, q: &[f64], v: &[f64], a: &[f64], change_before: Vec3<f64>) -> Self {
        let (rate, change_after) = (Vec3::from_slice(&v[3..]), Vec3::from_slice(&a[3..]));
        let sum = |x: &[f64]| x[3..].iter().map(|x| x.abs()).sum::<f64>();
        let rates = sum(v);
        let changes = sum(a) + rates * rates;
        let attitude = Quat::from_xyzw(&q[3..]);
        Self { time, attitude, rate, change_before, change_after, rates, changes, is_cut: false }
    }
}

/// Motion of the centre of mass at one end of an interval, W axes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct MassMotion {
    pub(crate) time: f64,
    pub(crate) mass: f64,
    /// Position of the centre of mass, m.
    pub(crate) center: Vec3<f64>,
    /// Linear momentum, kg m/s.
    pub(crate) momentum: Vec3<f64>,
    /// Time integral of the external forces since the start of the run, N s.
    pub(crate) impulse: Vec3<f64>,
    /// External force, N, just before this instant or, if that is not known, just after it.
    pub(crate) force_before: Vec3<f64>,
    /// External force just after this instant, N.
    pub(crate) force_after: Vec3<f64>,
}

/// Row of a trace. Vectors are in W axes unless stated otherwise.
pub(super) struct TraceRow<'a> {
    pub(super) time: f64,
    pub(super) base: BaseMotion,
    pub(super) q: &'a [f64],
    pub(super) v: &'a [f64],
    pub(super) a: &'a [f64],
    pub(super) momentum: Momentum<f64>,
    pub(super) impulse: Momentum<f64>,
    pub(super) kinetic_energy: f64,
    pub(super) work: f64,
    pub(super) center_of_mass: Vec3<f64>,
    /// External force just after this row, computed from the base rows of inverse dynamics, N.
    pub(super) force: Vec3<f64>,
    pub(super) mass: f64,
    /// Sum of the magnitudes of the momenta of the bodies relative to the centre of mass, `Σ mₖ |vₖ − v_com|`,
    /// kg m/s.
    pub(super) relative_momentum: f64,
    /// Momentum scale of the rotations, `Σ mₖ ρₖ |ωₖ|` with the radius of gyration `ρₖ` of each body, kg m/s.
    pub(super) spin: f64,
    /// Sum of the magnitudes of the angular momenta of the bodies, `Σ |Lₖ|`, about the system's centre of
    /// mass, kg m²/s.
    pub(super) angular: f64,
    /// Radius of gyration of the whole robot, m.
    pub(super) size: f64,
}

impl TraceRow<'_> {
    /// Returns the motion of the centre of mass.
    pub(super) fn mass_motion(&self) -> MassMotion {
        MassMotion {
            time: self.time,
            mass: self.mass,
            center: self.center_of_mass,
            momentum: self.momentum.linear,
            impulse: self.impulse.linear,
            force_before: self.force,
            force_after: self.force,
        }
    }
}
