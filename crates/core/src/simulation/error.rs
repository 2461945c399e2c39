//! What can stop a run.

use super::checkpoint::CheckpointError;
use super::trace::Trace;
use crate::control::ControlError;
use crate::earth::EarthError;
use crate::environment::EnvironmentError;
use crate::gravity::GravityError;
use crate::number_text::{count, short, unlike};
use crate::orbit::OrbitError;
use crate::reference::ReferenceError;
use thiserror::Error;

/// A simulation that cannot start, or that had to stop.
#[derive(Debug, Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum SimulationError {
    #[error("{name} has {got}, expected {expected} for this robot", got = count(*got, "number"))]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error("{name}[{index}] is {value}, it must be finite", value = short(*value))]
    NotFinite { name: &'static str, index: usize, value: f64 },
    #[error("{name} is {value} s, it must be positive and finite", value = short(*value))]
    NotPositive { name: &'static str, value: f64 },
    #[error(
        "the quaternion q[3:7] has norm {norm}, at most 1e-6 off 1 is accepted; it is x, y, z, w: normalise it first",
        norm = unlike(*norm, &[1.0])
    )]
    QuaternionNorm { norm: f64 },
    #[error("time_step is {value} s, steps of 1e-12 s to 1e9 s are accepted", value = short(*value))]
    TimeStep { value: f64 },
    #[error(
        "{name}[{index}], {what}, is {value} {unit}, it must lie between -{limit} and {limit} {unit}{reason}",
        value = short(*value), limit = short(*limit),
        reason = if *unit == "m/s" { ", the speed of light" } else { "" }
    )]
    OutOfRange { name: &'static str, index: usize, what: String, value: f64, unit: &'static str, limit: f64 },
    #[error("tolerance is {value}, it must be in 1e-13..0.1", value = short(*value))]
    Tolerance { value: f64 },
    #[error(
        "rereference_beyond is {value} m, it must be at least 1 m; infinity for never",
        value = short(*value)
    )]
    RereferenceBeyond { value: f64 },
    #[error("restitution is {value}, it must be in 0..1", value = short(*value))]
    Restitution { value: f64 },
    #[error(
        "joint '{joint}' starts at {value}, its limits are {lower} to {upper}: start within, or do not enforce limits",
        value = unlike(*value, &[*lower, *upper]), lower = short(*lower), upper = short(*upper)
    )]
    OutsideLimits { joint: String, value: f64, lower: f64, upper: f64 },
    #[error(
        "at t = {time} s no step keeps the tolerance, not even one of {step} s: loosen tolerance, or soften what acts there",
        time = short(*time), step = short(*step)
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
        "the reference starts {position} m and {angle} rad from the tool, at most {tolerance_m} m and {tolerance_rad} rad are \
         accepted: start it at the tool, or raise reference_start_tolerance",
        position = unlike(without_noise(*position), &[tolerance[0]]), angle = unlike(without_noise(*angle), &[tolerance[1]]),
        tolerance_m = short(tolerance[0]), tolerance_rad = short(tolerance[1])
    )]
    ReferenceStartsAway { position: f64, angle: f64, tolerance: [f64; 2] },
    #[error(
        "the reference of control '{control}' starts {offset} rad (m) from where the joints are, at most {tolerance} is accepted: \
         start it there (starts_at_present), or raise reference_start_tolerance",
        offset = unlike(*offset, &[*tolerance]), tolerance = short(*tolerance)
    )]
    JointsStartAway { control: String, offset: f64, tolerance: f64 },
    #[error("{rows} recorded rows do not fit in memory; record fewer with record_every")]
    TooManyRows { rows: usize },
    #[error(
        "the run diverged at t = {time} s: the state is no longer finite; shorten time_step, lower the initial rates, or soften gains and joint \
         damping \
         (the last finite state is in the error's q and v)",
        time = short(*time)
    )]
    Diverged { time: f64, q: Vec<f64>, v: Vec<f64> },
    #[error("the run was interrupted at t = {time} s", time = short(*time))]
    Interrupted { time: f64 },
    #[error("at t = {time} s: {source}", time = short(*time))]
    Orbit { time: f64, source: OrbitError },
    #[error("at t = {time} s: {source}", time = short(*time))]
    Environment { time: f64, source: EnvironmentError },
    #[error("at t = {time} s: {source}", time = short(*time))]
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
         normalise it at the end of each step",
        time = short(*time), length = unlike(*length, &[1.0])
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

/// To the nanometre (the nanoradian), which is far below any tolerance.
fn without_noise(offset: f64) -> f64 {
    (offset * 1e9).round() / 1e9
}
