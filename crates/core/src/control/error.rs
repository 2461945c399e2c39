//! What can be wrong with a controller.

use crate::number_text::{count, short, unlike};
use crate::reference::ReferenceError;
use thiserror::Error;

/// A controller that cannot work, or that failed while it ran.
#[derive(Debug, Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum ControlError {
    #[error("{name} has {got}, expected {expected}", got = count(*got, "number"))]
    WrongLength { name: &'static str, expected: String, got: usize },
    #[error("{name} holds {value}, it must be finite", value = short(*value))]
    NotFinite { name: &'static str, value: f64 },
    #[error(
        "{name} holds {value}, numbers between -{most} and {most} are accepted",
        value = short(*value), most = short(*most)
    )]
    TooLarge { name: &'static str, value: f64, most: f64 },
    #[error("{name} is {value}, it must not be negative", value = short(*value))]
    Negative { name: &'static str, value: f64 },
    #[error(
        "frame '{frame}' is moved by {joints}: a position and an attitude need at least 6 between it and the base",
        joints = count(*joints, "joint")
    )]
    TooFewJoints { frame: String, joints: usize },
    #[error(
        "the controller returned {value} for joint {joint} at t = {time} s, a torque must be finite",
        time = short(*time), value = short(*value)
    )]
    TorqueNotFinite { joint: usize, time: f64, value: f64 },
    #[error(
        "control '{control}' returned {value} for joint '{joint}' at t = {time} s, a torque must be finite",
        time = short(*time), value = short(*value)
    )]
    UserTorque { control: String, joint: String, time: f64, value: f64 },
    #[error("control '{control}' drives no joint: name at least one")]
    EmptyGroup { control: String },
    #[error("control '{control}' drives joint {joint}, the robot has joints 0 to {last}", last = count.saturating_sub(1))]
    NoSuchJoint { control: String, joint: usize, count: usize },
    #[error("frame {frame} is to be controlled, the robot has frames 0 to {last}", last = count.saturating_sub(1))]
    NoSuchFrame { frame: usize, count: usize },
    #[error("control '{control}' names joint '{joint}' twice")]
    RepeatedJoint { control: String, joint: String },
    #[error(
        "controls '{first}' and '{second}' both drive joint '{joint}' at t = {time} s: give them groups without a common joint, \
         or times (start, end, after) at which only one of them runs",
        time = short(*time)
    )]
    Overlap { first: String, second: String, joint: String, time: f64 },
    #[error("two controls are named '{name}': give each its own name")]
    RepeatedName { name: String },
    #[error("control '{control}' starts after '{after}', which is no control of this run")]
    NoSuchControl { control: String, after: String },
    #[error("control '{control}' waits for itself: no control of its chain of 'after' can start")]
    AfterItself { control: String },
    #[error("control '{control}' starts after '{after}', which has neither a goal nor an end: give it one")]
    NeverEnds { control: String, after: String },
    #[error(
        "control '{control}' starts at {begin} s and ends at {end} s: the start must be finite and before the end",
        begin = unlike(*begin, &[*end]), end = short(*end)
    )]
    EmptyWindow { control: String, begin: f64, end: f64 },
    #[error(
        "control '{control}' tracks frame '{frame}' with {joints} between it and the base: a position and an attitude \
         need at least 6 of its group",
        joints = count(*joints, "joint")
    )]
    TooFewInGroup { control: String, frame: String, joints: usize },
    #[error("the reference of control '{control}' has {got}, its group has {expected}", got = count(*got, "joint"))]
    ReferenceLength { control: String, expected: usize, got: usize },
    #[error(
        "control '{control}' has a goal, or starts at the present, but tracks nothing: give it a reference of positions or rates"
    )]
    NothingTracked { control: String },
    #[error(
        "{name} is not zero, but an effort is commanded as it is: leave the gains of the effort interface out"
    )]
    GainOfEffort { name: &'static str },
    #[error(
        "of controls '{first}' and '{second}' one compensates the environment and one does not: computed torques side by side \
         need one answer"
    )]
    MixedCompensation { first: String, second: String },
    #[error("the state of a control does not fit these controls: it holds {got} numbers too {what}")]
    WrongSave { what: &'static str, got: usize },
    #[error("at t = {time} s: {source}", time = short(*time))]
    Reference { time: f64, source: ReferenceError },
    /// What a user's controller raised, handed back untouched.
    #[error(transparent)]
    User(Box<dyn std::error::Error + Send + Sync>),
}
