//! What a run leaves behind.

use crate::control::Outcome;

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
    /// Acceleration just after this row's time, `(T, nv)`.
    pub acceleration: Vec<f64>,
    /// Linear momentum and angular momentum about the system's centre of mass, `(T, 6)`.
    pub momentum: Vec<f64>,
    /// Integral of the external forces and of their moments about the centre of mass, `(T, 6)`.
    pub impulse: Vec<f64>,
    /// Kinetic energy in W, J, `(T,)`.
    pub kinetic_energy: Vec<f64>,
    /// Work of joint torques and external wrenches in W, J, `(T,)`.
    pub work: Vec<f64>,
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
    /// Tracking errors of several controls, each on its own.
    pub tracking: Vec<Tracking>,
    /// What came of the goals of several controls.
    pub results: Vec<GoalResult>,
    /// Sum of the work of every step, whatever its sign, J: what rows far apart would miss.
    pub work_done: f64,
    /// Sum of what steps and halved steps differ by in attitude, rad: an estimate of its error at the
    /// end, but for what the motion amplifies.
    pub attitude_step_doubling: Option<f64>,
    /// Whether every step of the run is a row.
    pub has_every_step: bool,
}

/// How well one control followed its reference.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tracking {
    /// The control's name.
    pub name: String,
    /// Numbers per row: 6 for a task (m and rad, in the axes of W, or of B where its reference is relative to
    /// the base), one per joint of the group otherwise.
    pub width: usize,
    /// Desired less actual, `(T, width)`; zeros while the control does not run.
    pub error: Vec<f64>,
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

    /// Row `k` of a column with `width` numbers per row.
    pub(super) fn row(column: &[f64], k: usize, width: usize) -> &[f64] {
        &column[k * width..(k + 1) * width]
    }
}
