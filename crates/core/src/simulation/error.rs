//! What can stop a run.

use super::checkpoint::CheckpointError;
use super::trace::Trace;
use crate::control::ControlError;
use crate::earth::EarthError;
use crate::environment::EnvironmentError;
use crate::gravity::GravityError;
use crate::orbit::OrbitError;
use crate::reference::ReferenceError;
use thiserror::Error;

/// A simulation that cannot start, or that had to stop.
#[derive(Debug, Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum SimulationError {
    #[error("{name} has {got} numbers, expected {expected} for this robot")]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error("{name}[{index}] is {value}, it must be finite")]
    NotFinite { name: &'static str, index: usize, value: f64 },
    #[error("{name} is {value} s, it must be positive and finite")]
    NotPositive { name: &'static str, value: f64 },
    #[error(
        "the quaternion q[3:7] has norm {norm}, at most 1e-6 off 1 is accepted; it is x, y, z, w: normalise it first"
    )]
    QuaternionNorm { norm: f64 },
    #[error("tolerance is {value}, it must be in 1e-13..0.1")]
    Tolerance { value: f64 },
    #[error("rereference_beyond is {value} m, it must be at least 1 m; infinity for never")]
    RereferenceBeyond { value: f64 },
    #[error("restitution is {value}, it must be in 0..1")]
    Restitution { value: f64 },
    #[error(
        "joint '{joint}' starts at {value}, its limits are {lower} to {upper}: start within, or do not enforce limits"
    )]
    OutsideLimits { joint: String, value: f64, lower: f64, upper: f64 },
    #[error(
        "at t = {time} s no step keeps the tolerance, not even one of {step} s: loosen tolerance, or soften what acts there"
    )]
    StepTooSmall { time: f64, step: f64 },
    #[error(transparent)]
    Earth(#[from] EarthError),
    #[error("record_every is 0, it must be at least 1 step")]
    RecordEvery,
    #[error("{effect} needs an orbit around a planet: give the simulation one, or give the path its mu")]
    NeedsOrbit { effect: String },
    #[error(
        "{effect} is given twice for body '{body}' and would count twice: give it once, or each of the two to other bodies"
    )]
    EffectTwice { effect: String, body: String },
    #[error("the controller tracks a frame but the simulation has no reference to track: give it one")]
    NeedsReference,
    #[error(
        "the controller tracks frame '{controller}' but the tool of the run is '{tool}': name the same frame"
    )]
    OtherTool { controller: String, tool: String },
    #[error("a reference is given but no tool frame it is for: name the tool")]
    NeedsTool,
    #[error("frame {frame} is asked for, the robot has frames 0 to {last}", last = count.saturating_sub(1))]
    UnknownFrame { frame: usize, count: usize },
    #[error(
        "the reference starts {position:.4} m and {angle:.4} rad from the tool, at most {tolerance_m} m and {tolerance_rad} rad are \
         accepted: start it at the tool, or raise reference_start_tolerance",
        tolerance_m = tolerance[0],
        tolerance_rad = tolerance[1]
    )]
    ReferenceStartsAway { position: f64, angle: f64, tolerance: [f64; 2] },
    #[error(
        "the reference of control '{control}' starts {offset} rad (m) from where the joints are, at most {tolerance} is accepted: \
         start it there (starts_at_present), or raise reference_start_tolerance"
    )]
    JointsStartAway { control: String, offset: f64, tolerance: f64 },
    #[error("{rows} recorded rows do not fit in memory; record fewer with record_every")]
    TooManyRows { rows: usize },
    #[error(
        "the run diverged at t = {time} s: the state is no longer finite; shorten time_step, or soften gains and joint damping \
         (the last finite state is in the error's q and v)"
    )]
    Diverged { time: f64, q: Vec<f64>, v: Vec<f64> },
    #[error("the run was interrupted at t = {time} s")]
    Interrupted { time: f64 },
    #[error("at t = {time} s: {source}")]
    Orbit { time: f64, source: OrbitError },
    #[error("at t = {time} s: {source}")]
    Environment { time: f64, source: EnvironmentError },
    #[error("at t = {time} s: {source}")]
    Reference { time: f64, source: ReferenceError },
    #[error(transparent)]
    Gravity(#[from] GravityError),
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// What another engine raised, handed back untouched.
    #[error(transparent)]
    Engine(Box<dyn std::error::Error + Send + Sync>),
    #[error(
        "the plant left an attitude q[3:7] of length {length} after the step from t = {time} s, a quaternion has length 1: \
         normalise it at the end of each step"
    )]
    EngineAttitude { time: f64, length: f64 },
    #[error(transparent)]
    Control(#[from] ControlError),
}

/// A run that stopped early, with what it had recorded until then.
#[derive(Error)]
#[error("{error}")]
pub struct RunFailure {
    /// Why it stopped.
    #[source]
    pub error: SimulationError,
    /// Rows up to the last finite state.
    pub trace: Box<Trace>,
}

impl std::fmt::Debug for RunFailure {
    /// The error and how many rows there are: the rows themselves can be millions.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RunFailure").field("error", &self.error).field("rows", &self.trace.rows()).finish()
    }
}
