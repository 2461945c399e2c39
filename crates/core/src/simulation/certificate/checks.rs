//! The certificate, its checks and their gates.

/// Largest drift of momentum: rounding, summed over millions of steps.
pub(super) const MOMENTUM: f64 = 1e-11;
/// Largest error of the energy balance: that of a fourth-order integrator that resolves the motion.
pub(super) const ENERGY: f64 = 1e-6;
/// Largest distance of the centre of mass from the path that its momentum gives.
pub(super) const CENTER: f64 = 1e-7;
/// Largest attitude error, rad, estimated by step doubling.
pub(super) const STEP_DOUBLING: f64 = 1e-6;
/// Largest joint error estimated by step doubling: of an angle in rad, of a displacement over the robot's
/// size, of a rate over the joint's largest rate.
///
/// The target is 1e-3 of a joint's travel. A motion that is not chaotic may amplify the errors of its steps
/// tenfold by the end, and the probes may have missed half of them.
pub(super) const JOINT_STEP_DOUBLING: f64 = 5e-5;
/// Largest error of the base's origin estimated by step doubling, over the path of the centre of mass plus
/// the robot's size.
pub(super) const ORIGIN_STEP_DOUBLING: f64 = 1e-4;
/// Largest fraction of the commutator that may be missing from the attitude; without integration on the group
/// it is 1.
pub(super) const ATTITUDE: f64 = 0.1;

/// Errors of a trace with respect to the laws of mechanics, each relative to a scale that does not vanish.
///
/// An integrator that integrates momentum keeps the two momenta by construction; the other numbers are
/// independent checks. Checks that compare neighbouring steps are evaluated during the run where not every
/// step is a row. They are `None` with an adaptive integrator, whose rows are interpolated, and with sparse
/// rows of an external engine.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// `max |P − P₀ − ∫F dt|` over the peak of `Σ mₖ |vₖ − v_com|` (or of `|P|`, or of the spin
    /// where a single body moves).
    pub linear_momentum_drift_rel: f64,
    /// `max |L − L₀ − ∫T dt|` over the peak of `Σ |Lₖ|`, all about the system's centre of mass.
    pub angular_momentum_drift_rel: f64,
    /// `max |E − E₀ − W|` over `Σ |ΔW|` and the peak of the energy in the centre-of-mass frame. The scale is
    /// at least the energy of a motion by a millionth of the robot's size in the whole run.
    pub energy_balance_error_rel: f64,
    /// Distance of the centre of mass from the integral of `P/m`, over its path and the robot's size.
    pub center_of_mass_error_rel: Option<f64>,
    /// Base rows of inverse dynamics on differenced velocities minus the mean wrench, over the inertial
    /// forces of the bodies.
    pub base_rows_residual_rel: Option<f64>,
    /// Largest `base_rows_residual_rel` that passes: the truncation error of a central difference, `O(dt²)`.
    pub base_rows_gate: f64,
    /// Recorded rotations minus those that the recorded angular velocities imply, over the accumulated
    /// commutator: 1 for attitudes composed without the commutator, far below for integration on the group.
    pub attitude_consistency: Option<f64>,
    /// Difference between the attitudes of steps and of halved steps, summed over the run, rad.
    pub attitude_step_doubling_rad: Option<f64>,
    /// Difference between the positions and rates of a joint in steps and in halved steps, summed over the
    /// run, of the worst joint: positions in rad (of prismatic joints over the robot's size), rates over the
    /// joint's largest rate.
    pub joint_step_doubling_rel: Option<f64>,
    /// Step-doubling error of the base origin's position, over the path of the centre of mass plus the
    /// robot's size.
    pub position_step_doubling_rel: Option<f64>,
}

/// Checks that compare neighbouring steps, evaluated during the run: see [`Certificate`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairChecks {
    /// As [`Certificate::center_of_mass_error_rel`].
    pub center_of_mass_error_rel: f64,
    /// As [`Certificate::base_rows_residual_rel`].
    pub base_rows_residual_rel: f64,
    /// As [`Certificate::base_rows_gate`].
    pub base_rows_gate: f64,
    /// As [`Certificate::attitude_consistency`].
    pub attitude_consistency: f64,
}

/// One check of a certificate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Check {
    /// Name of the field of [`Certificate`].
    pub name: &'static str,
    /// Value of the field.
    pub value: f64,
    /// Largest value that passes.
    pub gate: f64,
}

impl Check {
    /// Returns true if the value is at most its gate; false for NaN.
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
