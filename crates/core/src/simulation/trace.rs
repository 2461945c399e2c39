//! What a run leaves behind.

use super::certificate::PairChecks;
use crate::control::Outcome;
use crate::model::Model;
use std::borrow::Cow;

/// Columns of a run, one row per recorded step, row major; the first row is the initial state, the
/// last the end. W axes unless said; empty columns are those the run did not have.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    /// Time, s, `(T,)`.
    pub time: Vec<f64>,
    /// Configuration, `(T, nq)`.
    pub q: Vec<f64>,
    /// Velocity, `(T, nv)`.
    pub v: Vec<f64>,
    /// Joint torque held from this row's time to the next step, N m, `(T, n)`.
    pub tau: Vec<f64>,
    /// Share of `tau` that compensates Coulomb friction, N m, `(T, n)`; only where a law compensates it
    /// and our own equations of motion move the robot.
    pub friction_compensation: Vec<f64>,
    /// Acceleration just after this row's time, `(T, nv)`.
    pub acceleration: Vec<f64>,
    /// Linear momentum and angular momentum about the system's centre of mass, `(T, 6)`.
    pub momentum: Vec<f64>,
    /// Integral of the external forces and of their moments about the centre of mass, `(T, 6)`.
    pub impulse: Vec<f64>,
    /// Kinetic energy in W, J, `(T,)`.
    pub kinetic_energy: Vec<f64>,
    /// Work on the robot in W, J, `(T,)`: of motors and external wrenches, less `dissipated`.
    pub work: Vec<f64>,
    /// Energy that damping, friction and stops of the joints took, J, `(T,)`.
    pub dissipated: Vec<f64>,
    /// Centre of mass in W, m, `(T, 3)`.
    pub center_of_mass: Vec<f64>,
    /// Pose of the tool in W, `(T, 4, 4)`; only with a tool.
    pub tool_pose: Vec<f64>,
    /// Desired pose of the tool in W, `(T, 4, 4)`; only with a reference.
    pub reference_pose: Vec<f64>,
    /// Desired less actual position, m, `(T, 3)`; only with a reference.
    pub position_error: Vec<f64>,
    /// Rotation vector from actual to desired attitude, rad, `(T, 3)`; only with a reference.
    pub attitude_error: Vec<f64>,
    /// Position of the base's origin from the planet's centre, axes of I, m, `(T, 3)`; only with an orbit.
    pub position_eci: Vec<f64>,
    /// Its velocity, m/s, `(T, 3)`; only with an orbit.
    pub velocity_eci: Vec<f64>,
    /// Gravity that the reference does not follow and that was left out, `g - r̈_ref`, axes of I, m/s²,
    /// `(T, 3)`; only around a planet with the robot carried along.
    pub reference_residual: Vec<f64>,
    /// Tracking errors of several controls, each on its own: desired less actual, of a task 6 numbers (m and rad, in the
    /// axes of W, or of B where its reference is relative to the base), else one per joint of the group; zeros while the
    /// control does not run.
    pub tracking: Vec<NamedColumn>,
    /// Wrench of every effect on every body: force, N, and torque about the body's centre of mass, N m, `(T, bodies, 6)`;
    /// only on request.
    pub wrenches: Vec<NamedColumn>,
    /// What came of the goals of several controls.
    pub results: Vec<GoalResult>,
    /// When the robot had drifted so far that it was given a reference of its own to be integrated about, s, `(K,)`;
    /// its rows stay in W.
    pub rereferenced: Vec<f64>,
    /// Sum of the work of every step, whatever its sign, J: what rows far apart would miss.
    pub work_done: f64,
    /// Sum of what steps and halved steps differ by in attitude, rad (of an embedded pair: its two
    /// solutions): an estimate of its error at the end, but for what the motion amplifies.
    pub attitude_step_doubling: Option<f64>,
    /// Sums of what steps and halved steps differ by, of the base's origin, then of each joint; empty where an
    /// integrator adapts its steps, and of another engine.
    pub step_doubling: Vec<CoordinateDrift>,
    /// Checks that need every step, where rows are sparse: evaluated during the run.
    pub pair_checks: Option<PairChecks>,
    /// Whether every step of the run is a row.
    pub has_every_step: bool,
}

macro_rules! columns {
    ($($name:ident),* $(,)?) => {
        impl Trace {
            /// Every column with its name, empty ones too, then `tracking_<name>` of every control and
            /// `wrench_<name>` of every effect; row major.
            pub fn columns(&self) -> impl Iterator<Item = (Cow<'static, str>, &Vec<f64>)> {
                let tracking = self.tracking.iter().map(|column| (column.named("tracking"), &column.values));
                let wrenches = self.wrenches.iter().map(|column| (column.named("wrench"), &column.values));
                [$((Cow::Borrowed(stringify!($name)), &self.$name)),*]
                    .into_iter()
                    .chain(tracking)
                    .chain(wrenches)
            }

            /// As [`Trace::columns`], to fill.
            pub fn columns_mut(&mut self) -> impl Iterator<Item = (Cow<'static, str>, &mut Vec<f64>)> {
                let tracking =
                    self.tracking.iter_mut().map(|column| (column.named("tracking"), &mut column.values));
                let wrenches =
                    self.wrenches.iter_mut().map(|column| (column.named("wrench"), &mut column.values));
                [$((Cow::Borrowed(stringify!($name)), &mut self.$name)),*]
                    .into_iter()
                    .chain(tracking)
                    .chain(wrenches)
            }
        }
    };
}

columns!(
    time,
    q,
    v,
    tau,
    friction_compensation,
    acceleration,
    momentum,
    impulse,
    kinetic_energy,
    work,
    dissipated,
    center_of_mass,
    tool_pose,
    reference_pose,
    position_error,
    attitude_error,
    position_eci,
    velocity_eci,
    reference_residual,
);

/// A column that belongs to a control or to an effect.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedColumn {
    /// Whose it is.
    pub name: String,
    /// Numbers per row.
    pub width: usize,
    /// The rows, `(T, width)`.
    pub values: Vec<f64>,
}

impl NamedColumn {
    /// Name among all columns.
    fn named(&self, kind: &str) -> Cow<'static, str> {
        Cow::Owned(format!("{kind}_{}", self.name))
    }
}

/// What the steps of a coordinate and halved steps differ by, summed over a run; m, or rad of a joint that turns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CoordinateDrift {
    /// Of its position.
    pub position: f64,
    /// Of its rate (of the base's origin: of the centre of mass).
    pub rate: f64,
    /// Largest rate of it that was seen.
    pub fastest: f64,
    /// `Σ (h |Δq̈|/6)^(5/4)` with the jump of a joint's acceleration from the end of a step of `h` to the next step.
    pub jumps: f64,
}

/// What came of a goal.
#[derive(Clone, Debug, PartialEq)]
pub struct GoalResult {
    /// The control's name.
    pub name: String,
    /// The outcome.
    pub outcome: Outcome,
    /// Whose error was too large: a joint, `position` or `attitude`.
    pub component: Option<String>,
}

impl Trace {
    /// Number of rows, `T`.
    pub fn rows(&self) -> usize {
        self.time.len()
    }

    /// Names of the joints that some row sees more than rounding past their position limits.
    pub fn limits_exceeded<'m>(&self, model: &'m Model) -> Vec<&'m str> {
        const ROUNDING: f64 = 1e-9;
        let is_past = |j: usize, (lower, upper): (f64, f64)| {
            let mut values = self.q.chunks_exact(model.nq()).map(|q| q[7 + j]);
            values.any(|q| q < lower - ROUNDING || q > upper + ROUNDING)
        };
        let joints = model.joints().iter().enumerate();
        joints
            .filter(|(j, joint)| joint.limits.position.is_some_and(|limits| is_past(*j, limits)))
            .map(|(_, joint)| joint.name.as_str())
            .collect()
    }

    /// Row `k` of a column with `width` numbers per row.
    pub(super) fn row(column: &[f64], k: usize, width: usize) -> &[f64] {
        &column[k * width..(k + 1) * width]
    }
}
