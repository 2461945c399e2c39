//! Errors of the systems and events of a world.

use crate::model::ModelError;
use crate::number_text::{choice, exact, names, short};
use thiserror::Error;

/// Reason why a system or an event of a world is invalid.
#[derive(Debug, Error, PartialEq)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum WorldError {
    #[error("the world has no systems; give at least one system")]
    NoSystems,
    #[error(
        "'{name}' is not a valid name of a system; a name must start with a letter, contain only letters, digits, '_' \
         and '-', and differ from world, lvlh, base and path"
    )]
    SystemName { name: String },
    #[error("two systems have the name '{name}'; give each system a different name")]
    SystemTwice { name: String },
    #[error("two events have the name '{name}'; give each event a different name")]
    EventTwice { name: String },
    #[error(
        "both frames of the event '{event}' belong to the system '{system}', but a capture connects two systems; give \
         frames of two different systems, or connect the frames from the start of the run by a loop of kind 'weld'"
    )]
    OwnSystem { event: String, system: String },
    #[error(
        "a reference of the system '{system}' is given in a frame of the same system; give it in a frame of another \
         system, or in the frame 'base'"
    )]
    OwnReferenceFrame { system: String },
    #[error(
        "a reference of the system '{system}' is given in frame {frame} of system {other}, but there is no such \
         system or frame; give the index of another system and of one of its frames"
    )]
    ReferenceFrame { system: String, other: usize, frame: usize },
    #[error("the event '{event}' would connect two systems to form an invalid robot: {source}")]
    Merged { event: String, source: ModelError },
    #[error(
        "the event '{event}' refers to system {system}, but the world has {known}",
        known = choice(*count, "system")
    )]
    UnknownSystem { event: String, system: usize, count: usize },
    #[error(
        "the event '{event}' refers to frame {frame} of the system '{system}', which has {known}",
        known = choice(*count, "frame")
    )]
    UnknownFrame { event: String, system: String, frame: usize, count: usize },
    #[error("the event '{event}' refers to event {other}, which {reason}")]
    UnknownEvent { event: String, other: usize, reason: &'static str },
    #[error(
        "the event '{event}' waits for itself, so it can never happen; let it happen at a time or on command"
    )]
    AfterItself { event: String },
    #[error(
        "the events {names} wait for each other, so they can never happen; let one of them happen at a \
         time or on command"
    )]
    Circle { names: String },
    #[error(
        "{what} of the event '{event}' is {value}{space}{unit}; it must be {expected}",
        value = exact(*value), space = if unit.is_empty() { "" } else { " " }
    )]
    Number { event: String, what: &'static str, value: f64, unit: &'static str, expected: &'static str },
    #[error("the event '{event}' has a latch, but only a capture can have one; use at, after or on_command")]
    LatchWithoutCapture { event: String },
    #[error(
        "the latch of the event '{event}' closes only while the contact '{contact}' touches, but {why}",
        why = why(problem)
    )]
    LatchContact { event: String, contact: String, problem: LatchContact },
    #[error(
        "at t = {time} s the event '{event}' connects '{first}' and '{second}', which are already connected; such a \
         capture closes a loop and cannot seat its frames; remove its 'seat', or release the earlier capture first",
        time = short(*time)
    )]
    SeatInLoop { event: String, time: f64, first: String, second: String },
    #[error("two brakes of one system have the name '{name}'; give each brake a different name")]
    BrakeTwice { name: String },
    #[error(
        "the brake '{name}' is on joint {joint}, but the robot has {known}",
        known = choice(*count, "joint")
    )]
    BrakeJoint { name: String, joint: usize, count: usize },
    #[error(
        "the brakes '{other}' and '{name}' are both on the joint '{joint}'; give each joint at most one brake"
    )]
    JointWithTwoBrakes { name: String, other: String, joint: String },
    #[error(
        "the slip torque of the brake '{name}' is {value} N m (N for a prismatic joint); it must be positive, and may \
         be infinite",
        value = short(*value)
    )]
    SlipTorque { name: String, value: f64 },
    #[error(
        "the brake '{name}' holds the joint '{joint}' from the start, but the joint starts with the rate {rate} rad/s \
         (m/s for a prismatic joint); start with the rate 0, or engage the brake by an event",
        rate = short(*rate)
    )]
    HeldJointMoves { name: String, joint: String, rate: f64 },
    #[error(
        "the event '{event}' refers to brake {brake} of the system '{system}', which has {known}",
        known = choice(*count, "brake")
    )]
    UnknownBrake { event: String, system: String, brake: usize, count: usize },
    #[error("the world has no event '{name}'; {known}")]
    NoSuchEvent { name: String, known: String },
    #[error("the event '{name}' cannot be triggered, because {reason}")]
    NotTriggered { name: String, reason: &'static str },
}

/// Reason for which a latch cannot depend on a contact.
#[derive(Clone, Debug, PartialEq)]
pub enum LatchContact {
    /// There is no contact with this name.
    Unknown {
        /// Names of the contacts of the world.
        known: Vec<String>,
    },
    /// The contact has no compliant normal-force law.
    NoForce,
    /// The contact is not between the two systems of the capture.
    OtherSystems,
}

/// Returns the reason as the end of an error message, with the suggested fix.
fn why(problem: &LatchContact) -> String {
    match problem {
        LatchContact::Unknown { known } if known.is_empty() => {
            "the world has no contacts; declare one between the links that touch".to_owned()
        }
        LatchContact::Unknown { known } => {
            format!("there is no contact with this name; {}", names(known, "contact"))
        }
        LatchContact::NoForce => {
            "it has no compliant normal force, which a latch requires; give the contact one, such as HuntCrossley".to_owned()
        }
        LatchContact::OtherSystems => {
            "it is not between the two systems of the capture; give a contact between these two".to_owned()
        }
    }
}
