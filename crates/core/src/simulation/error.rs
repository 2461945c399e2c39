//! Errors of simulations.

use super::checkpoint_error::CheckpointError;
use super::recording::Recording;
use crate::contact::ContactError;
use crate::control::ControlError;
use crate::dynamics::UnsatisfiedConstraints;
use crate::earth::EarthError;
use crate::environment::EnvironmentError;
use crate::gravity::GravityError;
use crate::model::ModelError;
use crate::number_text::{choice, count, exact, short, unlike};
use crate::orbit::OrbitError;
use crate::reference::ReferenceError;
use crate::world::WorldError;
use thiserror::Error;

/// Error that prevents the start of a run or ends it early.
#[derive(Debug, Error)]
#[allow(missing_docs)] // the messages explain the fields
pub enum SimulationError {
    #[error(
        "the initial {state} opens the loop '{name}'{by}; correct {it}, or set 'project: true' on the loop to start at \
         the nearest {state} that closes it",
        state = if *is_moving { "velocity" } else { "configuration" },
        by = format_args!(" by {by}"),
        it = if *is_moving { "the initial joint rates" } else { "the initial joint positions or the poses of the loop" }
    )]
    OpenLoop { name: String, by: String, is_moving: bool },
    #[error(
        "the initial {state} of the mimic joint '{joint}' differs by {by} from the {state} that its leader prescribes; \
         correct the initial {state}, or omit it so that the joint follows its leader",
        state = if *is_moving { "rate" } else { "position" }
    )]
    OpenMimic { joint: String, by: String, is_moving: bool },
    #[error(transparent)]
    CannotClose(#[from] UnsatisfiedConstraints),
    #[error("the array '{name}' has {got}; expected {expected} for this robot", got = count(*got, "number"))]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error("system '{system}': {source}")]
    OfSystem { system: String, source: Box<SimulationError> },
    #[error("t is {t} s; it must be finite")]
    TimeNotFinite { t: f64 },
    #[error("{name}[{index}] is {value}; it must be finite", value = short(*value))]
    NotFinite { name: &'static str, index: usize, value: f64 },
    #[error("{name} is {value} s; it must be positive and finite", value = exact(*value))]
    NotPositive { name: &'static str, value: f64 },
    #[error(
        "the quaternion q[3:7] (x, y, z, w) has norm {norm}; it must be 1 within 1e-6; normalise it",
        norm = unlike(*norm, &[1.0])
    )]
    QuaternionNorm { norm: f64 },
    #[error("time_step is {value} s; it must be between 1e-12 and 1e9 s", value = exact(*value))]
    TimeStep { value: f64 },
    #[error(
        "{name}[{index}], {what}, is {value} {unit}; its magnitude must be below {limit} {unit}{reason}",
        value = exact(*value), limit = exact(*limit),
        reason = if *unit == "m/s" { ", the speed of light" } else { "" }
    )]
    OutOfRange { name: &'static str, index: usize, what: String, value: f64, unit: &'static str, limit: f64 },
    #[error("tolerance is {value}; it must be between 1e-13 and 0.1", value = exact(*value))]
    Tolerance { value: f64 },
    #[error(
        "rereference_beyond is {value} m; it must be at least 1 m, or infinity to keep the reference orbit",
        value = exact(*value)
    )]
    RereferenceBeyond { value: f64 },
    #[error("restitution is {value}; it must be between 0 and 1", value = exact(*value))]
    Restitution { value: f64 },
    #[error(
        "joint '{joint}' starts at {value} {unit}; start it within its limits, {lower} to {upper} {unit}, or \
         set enforce_limits to false",
        value = unlike(*value, &[*lower, *upper]), lower = short(*lower), upper = short(*upper)
    )]
    OutsideLimits { joint: String, value: f64, unit: &'static str, lower: f64, upper: f64 },
    #[error(
        "at t = {time} s, the error of a step exceeds the tolerance even with a step of {step} s; increase \
         the tolerance, or reduce gains or the stiffness of effects",
        time = short(*time), step = short(*step)
    )]
    StepTooSmall { time: f64, step: f64 },
    #[error(
        "at t = {time} s, the motion is so fast that the tolerance requires steps of {step} s, far shorter than the control \
         period of {period} s; reduce gains or the control period, or end controls that cannot reach their references",
        time = short(*time), step = short(*step), period = short(*period)
    )]
    StepsTooShort { time: f64, step: f64, period: f64 },
    #[error(transparent)]
    Earth(#[from] EarthError),
    #[error("record_every is 0; it must be at least 1 step")]
    RecordEvery,
    #[error(
        "{effect} requires an orbit around a planet; set orbit, or give the path of the run its planet's \
         mu (m³/s²)"
    )]
    NeedsOrbit { effect: String },
    #[error(
        "the effect '{effect}' is given twice for body '{body}', so its force would count twice{orbit}; \
         remove one of the two, or assign one to other bodies",
        orbit = if effect == "gravity" { " (an orbit around a planet adds its gravity)" } else { "" }
    )]
    EffectTwice { effect: String, body: String },
    #[error(
        "the effect '{effect}' acts on none of the systems of the run, which has {known}",
        known = choice(*count, "system")
    )]
    EffectOnNoSystem { effect: String, count: usize },
    #[error(
        "the controller tracks frame '{controller}', but the tool of the system is '{tool}'; use the same \
         frame for both"
    )]
    OtherTool { controller: String, tool: String },
    #[error(
        "a reference for a frame is given, but the system has no tool; set tool to the frame that follows the reference"
    )]
    NeedsTool,
    #[error(
        "frame {frame} does not exist; the robot has {known}",
        known = choice(*count, "frame")
    )]
    UnknownFrame { frame: usize, count: usize },
    #[error(
        "the reference of frame '{frame}' starts {position} m and {angle} rad from the frame; it must start within \
         {tolerance_m} m and {tolerance_rad} rad; start it at the pose of the frame, or increase \
         reference_start_tolerance",
        position = offset_text(*position, tolerance[0]), angle = offset_text(*angle, tolerance[1]),
        tolerance_m = short(tolerance[0]), tolerance_rad = short(tolerance[1])
    )]
    ReferenceStartsAway { frame: String, position: f64, angle: f64, tolerance: [f64; 2] },
    #[error(
        "the reference of control '{control}' starts {offset} {unit} from the position of joint '{joint}'; it must \
         start within {tolerance} {unit}; start it at this position (with starts_at_present), or increase \
         reference_start_tolerance",
        offset = unlike(*offset, &[*tolerance]), tolerance = short(*tolerance)
    )]
    JointsStartAway { control: String, joint: String, unit: &'static str, offset: f64, tolerance: f64 },
    #[error("{rows} recorded rows do not fit in memory; increase record_every to record fewer rows")]
    TooManyRows { rows: usize },
    #[error(
        "the run diverged at t = {time} s: the state or a torque of {systems} is not finite; reduce time_step, initial \
         rates, gains or joint damping (the attributes q and v of the error hold the last finite state)",
        time = short(*time)
    )]
    Diverged { time: f64, systems: String, q: Vec<f64>, v: Vec<f64> },
    #[error(
        "t is {t} s, which is before the current time, {time} s; give this time or a later one",
        t = unlike(*t, &[*time]), time = short(*time)
    )]
    PastTime { t: f64, time: f64 },
    #[error(
        "t is {t} s, but the planned end of the run is {end} s; start the run with a longer duration, or without \
         a planned end",
        t = unlike(*t, &[*end]), end = short(*end)
    )]
    AfterEnd { t: f64, end: f64 },
    #[error("the run has ended and cannot be continued; start a new run")]
    Ended,
    #[error(
        "joint '{joint}' is driven by control '{control}', which is active; command other joints, or end \
         that control first"
    )]
    CommandedJoint { joint: String, control: String },
    #[error("at t = {time} s: {source}", time = short(*time))]
    Orbit { time: f64, source: OrbitError },
    #[error("at t = {time} s: {source}", time = short(*time))]
    Environment { time: f64, source: EnvironmentError },
    #[error("at t = {time} s: {source}", time = short(*time))]
    Reference { time: f64, source: ReferenceError },
    #[error("at t = {time} s: {source}", time = short(*time))]
    Contact { time: f64, source: ContactError },
    #[error(transparent)]
    Contacts(#[from] ContactError),
    #[error(transparent)]
    Gravity(#[from] GravityError),
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// Error that an external engine reported.
    #[error(transparent)]
    Engine(Box<dyn std::error::Error + Send + Sync>),
    #[error(
        "after the step from t = {time} s, the quaternion q[3:7] that the engine returned for '{system}' has norm \
         {length}; it must be 1 within 1e-9; normalise it at the end of each step",
        time = short(*time), length = unlike(*length, &[1.0])
    )]
    EngineAttitude { time: f64, system: String, length: f64 },
    #[error(transparent)]
    Control(ControlError),
    #[error(transparent)]
    World(#[from] WorldError),
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error("an external engine does not support {what} ('{name}'); {remedy}, or use the native engine")]
    EngineOfWorld {
        /// Name of the event, system, contact, loop, mimic joint or brake.
        name: String,
        /// Setting that only the native engine supports.
        what: &'static str,
        /// Change of the settings that avoids the error.
        remedy: &'static str,
    },
}

impl From<ControlError> for SimulationError {
    fn from(error: ControlError) -> Self {
        match error {
            ControlError::Reference { time, source } => Self::Reference { time, source },
            other => Self::Control(other),
        }
    }
}

/// Failure of a run, with the rows recorded before it.
#[derive(Error)]
#[error("{error}")]
pub struct RunFailure {
    /// Error that ended the run.
    #[source]
    pub error: SimulationError,
    /// Rows and events recorded before the error.
    pub recording: Box<Recording>,
}

impl SimulationError {
    /// Checks that a time is positive and finite.
    ///
    /// # Errors
    /// [`SimulationError::NotPositive`] for any other value.
    pub fn check_positive(name: &'static str, value: f64) -> Result<(), Self> {
        if value.is_finite() && value > 0.0 { Ok(()) } else { Err(Self::NotPositive { name, value }) }
    }
}

impl RunFailure {
    /// Creates the failure of a run that could not start and therefore has no rows.
    pub(super) fn at_start(error: SimulationError) -> Self {
        Self { error, recording: Box::default() }
    }
}

impl std::fmt::Debug for RunFailure {
    /// Writes the error and the number of recorded rows. The rows are omitted, because there may be millions.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RunFailure")
            .field("error", &self.error)
            .field("rows", &self.recording.rows())
            .finish()
    }
}

/// Formats an offset without the digits below 1e-9 m or rad, unless only these digits exceed the tolerance.
fn offset_text(offset: f64, tolerance: f64) -> String {
    let rounded = (offset * 1e9).round() / 1e9;
    if (rounded > tolerance) == (offset > tolerance) { unlike(rounded, &[tolerance]) } else { exact(offset) }
}
