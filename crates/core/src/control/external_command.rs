//! External commands to joints.

use super::error::ControlError;
use crate::reference::JointSample;
use crate::spatial::KnotInterval;
use serde::{Deserialize, Serialize};

/// Largest accepted magnitude of a number in a command, SI units.
const LARGEST: f64 = 1e60;

/// Command to the joints of an [`External`](super::External) law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ExternalCommand {
    /// Values that are held until the next command or the timeout.
    Setpoint(Setpoint),
    /// Motion through points at given times.
    Trajectory(JointTrajectory),
}

/// Constant command. Each entry is `(k,)`, with one number per joint of the group, or `None` if the quantity
/// is not commanded.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Setpoint {
    /// Positions, rad or m.
    pub position: Option<Vec<f64>>,
    /// Rates, rad/s or m/s.
    pub velocity: Option<Vec<f64>>,
    /// Accelerations, rad/s² or m/s².
    pub acceleration: Option<Vec<f64>>,
    /// Efforts, N m or N.
    pub effort: Option<Vec<f64>>,
}

/// Motion of the `k` joints of a group through `K` points, like the `JointTrajectory` message of ROS.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointTrajectory {
    /// Simulation time of the start, s.
    pub start: f64,
    /// Times of the points relative to the start, `(K,)`, s.
    pub times: Vec<f64>,
    /// Positions, `(K, k)`, rad or m.
    pub positions: Vec<f64>,
    /// Rates, `(K, k)`, rad/s or m/s; `None` for linear interpolation between the positions.
    pub velocities: Option<Vec<f64>>,
    /// Accelerations, `(K, k)`, rad/s² or m/s²; `None` if they are not given. They require rates.
    pub accelerations: Option<Vec<f64>>,
}

impl ExternalCommand {
    /// Checks a command for the `count` joints of control `control` that is received at `now`, s.
    pub(super) fn check(&self, control: &str, count: usize, now: f64) -> Result<(), ControlError> {
        match self {
            Self::Setpoint(setpoint) => setpoint.check(control, count),
            Self::Trajectory(trajectory) => trajectory.check(control, count, now),
        }
    }

    /// Returns true if the command is valid for `count` joints, regardless of the time at which it is sent.
    pub(super) fn check_sizes(&self, control: &str, count: usize) -> bool {
        self.check(control, count, f64::NEG_INFINITY).is_ok()
    }

    /// Returns the time, s, at which a command that is sent at `sent`, s, takes effect.
    pub(super) fn begin(&self, sent: f64) -> f64 {
        match self {
            Self::Setpoint(_) => sent,
            Self::Trajectory(trajectory) => sent.max(trajectory.start),
        }
    }

    /// Returns the time, s, at which the timeout of a command sent at `sent`, s, starts to run: `sent` or, if
    /// it is later, the time of the last point of a trajectory.
    pub(super) fn end(&self, sent: f64) -> f64 {
        match self {
            Self::Setpoint(_) => sent,
            Self::Trajectory(trajectory) => sent.max(trajectory.end()),
        }
    }

    /// Returns true if the command has neither positions nor rates, so that its efforts are the joint
    /// torques.
    pub(super) fn is_effort(&self) -> bool {
        matches!(self, Self::Setpoint(Setpoint { position: None, velocity: None, .. }))
    }

    /// Returns the positions that the joints are to hold after the command, `(k,)`, rad or m; `None` if the
    /// command has no positions.
    pub(super) fn last_position(&self) -> Option<&[f64]> {
        match self {
            Self::Setpoint(setpoint) => setpoint.position.as_deref(),
            Self::Trajectory(trajectory) => {
                let count = trajectory.positions.len() / trajectory.times.len();
                Some(&trajectory.positions[trajectory.positions.len() - count..])
            }
        }
    }

    /// Computes the desired motion at simulation time `t`, s. On entry `out` holds the current positions and
    /// rates. For a setpoint, positions that are not commanded do not change. Rates that are not commanded
    /// are zero if positions are commanded, and otherwise do not change; accelerations that are not commanded
    /// are zero. A trajectory sets all three quantities by interpolation.
    pub(super) fn sample(&self, t: f64, out: &mut JointSample) {
        match self {
            Self::Setpoint(setpoint) => setpoint.sample(out),
            Self::Trajectory(trajectory) => trajectory.sample(t, out),
        }
    }
}

impl Setpoint {
    /// Creates a command to hold positions, `(k,)`, rad or m.
    pub fn position(position: Vec<f64>) -> Self {
        Self { position: Some(position), ..Self::default() }
    }

    /// Creates a command of rates, `(k,)`, rad/s or m/s.
    pub fn velocity(velocity: Vec<f64>) -> Self {
        Self { velocity: Some(velocity), ..Self::default() }
    }

    /// Creates a command of efforts, `(k,)`, N m or N.
    pub fn effort(effort: Vec<f64>) -> Self {
        Self { effort: Some(effort), ..Self::default() }
    }

    fn check(&self, control: &str, count: usize) -> Result<(), ControlError> {
        let Self { position, velocity, acceleration, effort } = self;
        let given = [
            ("position", position),
            ("velocity", velocity),
            ("acceleration", acceleration),
            ("effort", effort),
        ];
        for (name, values) in given {
            values.as_deref().map_or(Ok(()), |values| check_rows(control, name, values, 1, count))?;
        }
        if position.is_none() && velocity.is_none() {
            let control = control.to_owned();
            match (acceleration, effort) {
                (None, None) => return Err(ControlError::EmptyCommand { control }),
                (Some(_), _) => {
                    return Err(ControlError::AccelerationAlone { control, is_trajectory: false });
                }
                (None, Some(_)) => {}
            }
        }
        Ok(())
    }

    fn sample(&self, out: &mut JointSample) {
        let Self { position, velocity, acceleration, .. } = self;
        if let Some(position) = position {
            out.q.copy_from_slice(position);
            out.v.fill(0.0);
        }
        if let Some(velocity) = velocity {
            out.v.copy_from_slice(velocity);
        }
        match acceleration {
            Some(acceleration) => out.a.copy_from_slice(acceleration),
            None => out.a.fill(0.0),
        }
    }
}

impl JointTrajectory {
    /// Returns the simulation time of the last point, s.
    fn end(&self) -> f64 {
        self.start + self.times.last().copied().unwrap_or(0.0)
    }

    fn check(&self, control: &str, count: usize, now: f64) -> Result<(), ControlError> {
        let (Self { start, times, positions, velocities, accelerations }, points) = (self, self.times.len());
        let name = || control.to_owned();
        if points == 0 {
            return Err(ControlError::EmptyCommand { control: name() });
        }
        check_rows(control, "start", &[*start], 1, 1)?;
        check_rows(control, "times", times, points, 1)?;
        let before = |k: usize| if k == 0 { 0.0 } else { times[k - 1] };
        let is_late = |k: &usize| if *k == 0 { times[0] >= 0.0 } else { times[*k] > before(*k) };
        if let Some(index) = (0..points).find(|k| !is_late(k)) {
            let (before, after) = (before(index), times[index]);
            return Err(ControlError::TimesNotIncreasing { control: name(), index, before, after });
        }
        check_rows(control, "positions", positions, points, count)?;
        for (what, rows) in [("velocities", velocities), ("accelerations", accelerations)] {
            rows.as_deref().map_or(Ok(()), |rows| check_rows(control, what, rows, points, count))?;
        }
        if velocities.is_none() && accelerations.is_some() {
            return Err(ControlError::AccelerationAlone { control: name(), is_trajectory: true });
        }
        if self.end() < now {
            return Err(ControlError::PastTrajectory { control: name(), end: self.end(), now });
        }
        Ok(())
    }

    /// Inserts the state of the group at simulation time `t`, s, as the first point if all points are later
    /// than `t`.
    pub(super) fn start_from(&mut self, t: f64, state: &JointSample) {
        let first = t - self.start;
        if self.times[0] <= first {
            return;
        }
        self.times.insert(0, first);
        self.positions.splice(0..0, state.q.iter().copied());
        if let Some(velocities) = &mut self.velocities {
            velocities.splice(0..0, state.v.iter().copied());
        }
        if let Some(accelerations) = &mut self.accelerations {
            accelerations.splice(0..0, state.a.iter().copied());
        }
    }

    /// Interpolates at simulation time `t`, s: by quintic polynomials if the points have velocities and
    /// accelerations, by cubic polynomials if they have only velocities, and otherwise linearly. Before the
    /// first point, the result is that at the first point; after the last point, its positions are held at
    /// rest.
    fn sample(&self, t: f64, out: &mut JointSample) {
        let Self { start, times, positions, velocities, accelerations } = self;
        let (n, last) = (out.q.len(), times.len() - 1);
        let t = (t - start).max(times[0]);
        if t >= times[last] {
            out.q.copy_from_slice(&positions[last * n..]);
            out.v.fill(0.0);
            out.a.fill(0.0);
            return;
        }
        let at = KnotInterval::of(times, t);
        let (k, h) = (at.segment, times[at.segment + 1] - times[at.segment]);
        for j in 0..n {
            let (i, next) = (k * n + j, (k + 1) * n + j);
            let (p, p1) = (positions[i], positions[next]);
            let slope = (p1 - p) / h;
            let [start, end] = match (velocities, accelerations) {
                (Some(v), Some(a)) => [[p, v[i], a[i]], [p1, v[next], a[next]]],
                (Some(v), None) => {
                    // curvatures of the cubic: (6Δ − 4v − 2v₁)/h and (−6Δ + 4v₁ + 2v)/h
                    let (v, v1) = (v[i], v[next]);
                    let a = (6.0 * slope - 4.0 * v - 2.0 * v1) / h;
                    [[p, v, a], [p1, v1, (4.0 * v1 + 2.0 * v - 6.0 * slope) / h]]
                }
                (None, _) => [[p, slope, 0.0], [p1, slope, 0.0]],
            };
            [out.q[j], out.v[j], out.a[j]] = at.interpolate(start, end);
        }
    }
}

/// Checks that the part `name` of a command has `points` rows of `count` finite numbers, none above
/// [`LARGEST`] in magnitude.
fn check_rows(
    control: &str,
    name: &'static str,
    values: &[f64],
    points: usize,
    count: usize,
) -> Result<(), ControlError> {
    let control = || control.to_owned();
    let (expected, got) = (points * count, values.len());
    if got != expected {
        return Err(ControlError::CommandLength { control: control(), name, points, joints: count, got });
    }
    match values.iter().position(|x| !x.is_finite() || x.abs() > LARGEST) {
        Some(index) => {
            Err(ControlError::CommandNumber { control: control(), name, index, value: values[index] })
        }
        None => Ok(()),
    }
}
