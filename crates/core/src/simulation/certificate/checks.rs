//! Certificate, its checks, and the gates of the checks: the largest values that pass.

use serde::{Deserialize, Serialize};

/// Largest relative drift of momentum that passes the check. It allows for the rounding errors of millions of
/// steps.
pub(crate) const MOMENTUM: f64 = 1e-11;
/// Largest relative error of the energy balance that passes the check. A fourth-order integrator that
/// resolves the motion stays below it.
pub(crate) const ENERGY: f64 = 1e-6;
/// Largest value of [`Certificate::center_of_mass_error_rel`] that passes the check.
pub(super) const CENTER: f64 = 1e-7;
/// Largest value of [`Certificate::attitude_step_doubling_rad`] that passes the check, rad.
pub(super) const STEP_DOUBLING: f64 = 1e-6;
/// Largest value of [`Certificate::joint_step_doubling_rel`] that passes the check. Errors of angles are in
/// rad, errors of displacements are relative to the robot's size, and errors of rates are relative to the
/// largest rate of the joint.
///
/// The aim is an error of at most 1e-3 of a joint's travel. Even a motion that is not chaotic may amplify the
/// errors of steps by a factor of ten by the end of the run, and the probes may miss half of the errors.
pub(super) const JOINT_STEP_DOUBLING: f64 = 5e-5;
/// Largest value of [`Certificate::position_step_doubling_rel`] that passes the check.
pub(super) const ORIGIN_STEP_DOUBLING: f64 = 1e-4;
/// Largest value of [`Certificate::loop_opening`] that passes the check, m or rad.
pub(super) const OPENING: f64 = 1e-11;
/// Largest value of [`Certificate::attitude_consistency`] that passes the check. The value is 1 for an
/// integrator that does not integrate on the rotation group.
pub(super) const ATTITUDE: f64 = 0.1;

/// Errors of a trace, measured by the laws of mechanics. Each error is relative to a nonzero scale, unless a
/// unit is stated.
///
/// An integrator that integrates momentum conserves both momenta by construction; the other values are
/// independent checks. Checks that compare successive steps are computed from the rows or, if only some steps
/// are recorded or the group of the system has events or contacts with friction, during the run. They are
/// `None` for an adaptive integrator, whose rows are interpolated, for an external engine if not every step
/// is recorded, and if rows from which they would be computed were removed without being checked. Without
/// external forces, however, the check of the centre of mass does not depend on the spacing of the rows and
/// is always available.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// Drift of linear momentum: `max |P − P₀ − ∫F dt|` with the external force `F`, relative to the largest
    /// value of `Σ mₖ |vₖ − v_com|`, with the masses `mₖ` and velocities `vₖ` of the bodies and the velocity
    /// `v_com` of the centre of mass (for a single body, of the momentum scale of its rotation) or, if
    /// larger, of `|P|`.
    pub linear_momentum_drift_rel: f64,
    /// Drift of angular momentum: `max |L − L₀ − ∫T dt|`, relative to the largest value of `Σ |Lₖ|` or, if
    /// larger, to a fraction of the moments of the linear momenta. All are about the system's centre of mass,
    /// with the external moment `T` and the angular momenta `Lₖ` of the bodies.
    pub angular_momentum_drift_rel: f64,
    /// Error of the energy balance: `max |E − E₀ − W|`, with the kinetic energy `E` and the work `W`,
    /// relative to the sum of `Σ |ΔW|`, the largest energy in the centre-of-mass frame and a thousandth of
    /// the largest energy in W. The scale is at least the energy of a motion that covers a millionth of the
    /// robot's size in the duration of the run.
    pub energy_balance_error_rel: f64,
    /// Largest distance between the centre of mass and the integral of `P/m`, with the linear momentum `P`
    /// and the mass `m`, relative to the length of the path of the centre of mass plus the robot's size.
    pub center_of_mass_error_rel: Option<f64>,
    /// Largest difference between the base rows of inverse dynamics, with accelerations computed from
    /// differences of the recorded velocities, and the mean external wrench of a step, relative to the
    /// inertial forces of the bodies.
    pub base_rows_residual_rel: Option<f64>,
    /// Largest value of `base_rows_residual_rel` that passes the check: 1e-6 plus the truncation error of a
    /// central difference, `O(dt²)`, and at most 0.1; `dt` is the length of a step. Zero if the check does
    /// not apply.
    pub base_rows_gate: f64,
    /// Difference between the recorded rotations and those computed from the recorded angular velocities,
    /// relative to the sum of the accumulated commutator of successive angular velocities and the
    /// interpolation error of the rates. The value is 1 for attitudes composed without the commutator, and
    /// far smaller for attitudes integrated on the rotation group.
    pub attitude_consistency: Option<f64>,
    /// Difference between the attitudes after a step and after two half steps, summed over the run, rad; for
    /// an adaptive integrator, the sum of the error estimates of its steps. `None` if the errors of steps are
    /// not estimated.
    pub attitude_step_doubling_rad: Option<f64>,
    /// Difference between the positions and rates after a step and after two half steps, summed over the run,
    /// for the joint with the largest value. Angles are in rad, displacements relative to the robot's size,
    /// and rates relative to the joint's largest rate. The rate error estimated from the jumps of the
    /// joint's acceleration between steps is used instead if it is larger. `None` without step doubling or
    /// without joints.
    pub joint_step_doubling_rel: Option<f64>,
    /// Step-doubling error of the position of the base's origin, relative to the path of the centre of mass
    /// plus the robot's size. `None` without step doubling.
    pub position_step_doubling_rel: Option<f64>,
    /// Largest distance, m, or angle, rad, by which a closed loop is open or a mimic joint deviates from the
    /// position that its leader prescribes; `None` without loops and mimic joints.
    pub loop_opening: Option<f64>,
}

/// Results of the checks that compare successive steps, evaluated during the run; see [`Certificate`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PairChecks {
    /// Value of [`Certificate::center_of_mass_error_rel`].
    pub center_of_mass_error_rel: f64,
    /// Value of [`Certificate::base_rows_residual_rel`].
    pub base_rows_residual_rel: f64,
    /// Value of [`Certificate::base_rows_gate`].
    pub base_rows_gate: f64,
    /// Value of [`Certificate::attitude_consistency`].
    pub attitude_consistency: f64,
}

impl PairChecks {
    /// Returns, for each check, the larger of the errors of two intervals. For the base rows, this is the
    /// error that is larger relative to its gate, together with that gate.
    pub(crate) fn worse(&self, other: &Self) -> Self {
        let ratio = |checks: &Self| checks.base_rows_residual_rel * (1.0 / checks.base_rows_gate);
        let rows = if ratio(self) >= ratio(other) { self } else { other };
        Self {
            center_of_mass_error_rel: self.center_of_mass_error_rel.max(other.center_of_mass_error_rel),
            attitude_consistency: self.attitude_consistency.max(other.attitude_consistency),
            ..*rows
        }
    }
}

/// Check of a certificate, of an event or of the balance of a group: a value, and the largest value that
/// passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Check {
    /// Name of the checked quantity; for a certificate, that of its field.
    pub name: &'static str,
    /// Value of the quantity.
    pub value: f64,
    /// Largest value that passes the check.
    pub gate: f64,
}

impl Check {
    /// Returns true if the value does not exceed its gate; NaN fails.
    pub fn passed(&self) -> bool {
        self.value <= self.gate
    }
}

impl Certificate {
    /// Returns the checks that apply to the run.
    pub fn checks(&self) -> Vec<Check> {
        let lines = [
            ("linear_momentum_drift_rel", Some(self.linear_momentum_drift_rel), MOMENTUM),
            ("angular_momentum_drift_rel", Some(self.angular_momentum_drift_rel), MOMENTUM),
            ("energy_balance_error_rel", Some(self.energy_balance_error_rel), ENERGY),
            ("center_of_mass_error_rel", self.center_of_mass_error_rel, CENTER),
            ("base_rows_residual_rel", self.base_rows_residual_rel, self.base_rows_gate),
            ("attitude_consistency", self.attitude_consistency, ATTITUDE),
            ("attitude_step_doubling_rad", self.attitude_step_doubling_rad, STEP_DOUBLING),
            ("joint_step_doubling_rel", self.joint_step_doubling_rel, JOINT_STEP_DOUBLING),
            ("position_step_doubling_rel", self.position_step_doubling_rel, ORIGIN_STEP_DOUBLING),
            ("loop_opening", self.loop_opening, OPENING),
        ];
        lines
            .into_iter()
            .filter_map(|(name, value, gate)| value.map(|value| Check { name, value, gate }))
            .collect()
    }

    /// Returns true if every check passes.
    pub fn passed(&self) -> bool {
        self.checks().iter().all(Check::passed)
    }
}
