//! Errors of controls.

use crate::model::closest;
use crate::number_text::{choice, count, exact, short, unlike};
use crate::reference::ReferenceError;
use thiserror::Error;

/// Errors of invalid controls and commands, and errors that occur in controls during a run.
#[derive(Debug, Error)]
#[allow(missing_docs)] // the messages explain the fields
pub enum ControlError {
    #[error("the list '{name}' has {got}; expected {expected}", got = count(*got, "number"))]
    WrongLength { name: &'static str, expected: String, got: usize },
    #[error(
        "{name} holds {value}; give finite numbers (only limits and tolerances may be infinite)",
        value = short(*value)
    )]
    NotFinite { name: &'static str, value: f64 },
    #[error(
        "{name} holds {value}; the magnitude must be at most {most} (SI units)",
        value = exact(*value), most = exact(*most)
    )]
    TooLarge { name: &'static str, value: f64, most: f64 },
    #[error("{name} is {value}; it must not be negative", value = short(*value))]
    Negative { name: &'static str, value: f64 },
    #[error("{name} is 0; it must be positive")]
    NotPositive { name: &'static str },
    #[error(
        "{name} is 0; its sign determines the direction of the motion, so give a positive or a negative number"
    )]
    Zero { name: &'static str },
    #[error(
        "control '{control}' grips with {force} N, which requires an effort of {effort} N from joint \
         '{joint}', whose effort limit is {limit} N; reduce the force to about {most} N, or raise the \
         limit",
        force = short(*force), effort = unlike(*effort, &[*limit]), limit = short(*limit),
        most = short(force * limit / effort)
    )]
    GripEffort { control: String, joint: String, force: f64, effort: f64, limit: f64 },
    #[error(
        "control '{control}' grips by contact forces, but no contact with a normal force involves a link that joint \
         '{joint}' moves; declare a contact between the links of its finger and the object"
    )]
    FingerWithoutContact { control: String, joint: String },
    #[error(
        "control '{control}': {who} not approach any other link of '{system}' that may touch the object, so \
         nothing opposes the grip force; check the signs of closing_rate, or declare a contact of the \
         opposite finger",
        who = match &fingers[..] {
            [finger] => format!("the link {finger} does"),
            fingers => format!("the links {} do", fingers.join(", ")),
        }
    )]
    NothingOpposes { control: String, system: String, fingers: Vec<String> },
    #[error(
        "control '{control}': the largest opening of the gripper is {opening} m, but the narrowest shape of \
         {object} is {width} m wide; use a wider gripper, or another part of the object",
        opening = short(*opening), width = short(*width)
    )]
    TooWide { control: String, opening: f64, object: String, width: f64 },
    #[error(
        "control '{control}' grips with a given force and has no reference, so '{option}' has no effect; omit it"
    )]
    GripOption { control: String, option: &'static str },
    #[error(
        "frame '{frame}' is moved by {joints}, but controlling its position and attitude requires at least 6 \
         joints between the frame and the base; control another frame, or control the joints instead",
        joints = count(*joints, "joint")
    )]
    TooFewJoints { frame: String, joints: usize },
    #[error(
        "control '{control}' returned {value} for joint '{joint}' at t = {time} s; it must return finite torques",
        time = short(*time), value = short(*value)
    )]
    UserTorque { control: String, joint: String, time: f64, value: f64 },
    #[error(
        "the torque of joint '{joint}' is {value} at t = {time} s; it must be finite; check the gains and the \
         reference of its control",
        time = short(*time), value = short(*value)
    )]
    Overflow { joint: String, time: f64, value: f64 },
    #[error(
        "control '{control}' commands an internal force in '{name}', which is not a loop that transmits \
         forces; {known}",
        known = match &known[..] {
            [] => "the robot has no such loop; omit the internal force".to_owned(),
            [only] => format!("the only such loop is '{only}'"),
            _ => format!("the loops that transmit forces are: {}", known.join(", ")),
        }
    )]
    NoSuchLoop { control: String, name: String, known: Vec<String> },
    #[error(
        "control '{control}' commands a {direction} {axis} in the loop '{name}', but the loop permits \
         motion in this direction and cannot transmit this component; set the component to 0"
    )]
    FreeDirection { control: String, name: String, direction: &'static str, axis: &'static str },
    #[error(
        "control '{control}' moves a load that its tool does not hold at t = {time} s; start the control after the \
         capture, end it before the release, and let the capturing frame and the frame of the load belong to the bodies \
         that the capture joins", time = short(*time)
    )]
    LoadNotHeld { control: String, time: f64 },
    #[error(
        "control '{control}' of the system '{system}' moves a load of the system '{other}', which the \
         controllers of '{system}' do not know; add '{other}' to 'knows' of '{system}'"
    )]
    UnknownLoad { control: String, system: String, other: String },
    #[error(
        "control '{control}' has {what}, which its controller does not use; omit {them}, or use a \
         computed-torque controller of {controlled}",
        what = if *is_load { "a load" } else { "internal forces" },
        them = if *is_load { "it" } else { "them" },
        controlled = if *is_load { "a tool" } else { "a tool or of joints" }
    )]
    UnusedLoad { control: String, is_load: bool },
    #[error("control '{control}' drives no joint; name at least one joint")]
    EmptyGroup { control: String },
    #[error(
        "control '{control}' drives joint {joint}, but the robot has {known}",
        known = choice(*count, "joint")
    )]
    NoSuchJoint { control: String, joint: usize, count: usize },
    #[error(
        "frame {frame} does not exist; the robot has {known}",
        known = choice(*count, "frame")
    )]
    NoSuchFrame { frame: usize, count: usize },
    #[error("control '{control}' names joint '{joint}' twice; name each joint once")]
    RepeatedJoint { control: String, joint: String },
    #[error(
        "controls '{first}' and '{second}' both drive joint '{joint}' at t = {time} s; give them groups \
         without a common joint, or times (start, end, after) at which only one of them is active",
        time = short(*time)
    )]
    Overlap { first: String, second: String, joint: String, time: f64 },
    #[error("two controls are named '{name}'; give each a different name")]
    RepeatedName { name: String },
    #[error(
        "control '{control}' starts after '{after}', which is neither a control nor an event of this run; give the \
         name of a control or an event"
    )]
    NoSuchControl { control: String, after: String },
    #[error(
        "control '{control}' waits for itself through 'after', directly or through other controls, so it \
         can never start; remove 'after' from one of these controls"
    )]
    AfterItself { control: String },
    #[error(
        "control '{control}' starts after '{after}', which has neither a goal nor an end; give '{after}' a \
         goal or an end"
    )]
    NeverEnds { control: String, after: String },
    #[error(
        "control '{control}' starts at {begin} s and ends at {end} s; the start must be finite and before \
         the end",
        begin = unlike(*begin, &[*end]), end = short(*end)
    )]
    EmptyWindow { control: String, begin: f64, end: f64 },
    #[error(
        "control '{control}' starts after another control or an event, but ends at {end} s; give an end \
         after 0 s, or omit it",
        end = short(*end)
    )]
    EndsBeforeStart { control: String, end: f64 },
    #[error(
        "control '{control}' has {joints} in its group between frame '{frame}' and the base, but controlling the \
         position and attitude of the frame requires at least 6; add joints to the group",
        joints = count(*joints, "joint")
    )]
    TooFewInGroup { control: String, frame: String, joints: usize },
    #[error(
        "the reference of control '{control}' has {got}, but its group has {expected}; give a reference with one \
         entry per joint of the group",
        got = count(*got, "joint")
    )]
    ReferenceLength { control: String, expected: usize, got: usize },
    #[error(
        "control '{control}' has a goal, or starts at the current configuration, but has no reference of \
         positions, rates or a frame; give it one, or omit 'goal' and 'starts_at_present'"
    )]
    NothingTracked { control: String },
    #[error(
        "{name} is not zero, but a control with the effort interface uses no gains, because its reference is the \
         effort; omit the gains"
    )]
    GainOfEffort { name: &'static str },
    #[error(
        "one of the controls '{first}' and '{second}' compensates the environment, but the other does not; set \
         compensate_environment to the same value for all computed-torque laws of a robot"
    )]
    MixedCompensation { first: String, second: String },
    #[error(
        "the checkpoint has {got}, but the simulation has {expected}, so it belongs to another scenario; resume \
         with the original scenario",
        got = count(*got, "control")
    )]
    OtherControls { got: usize, expected: usize },
    #[error(
        "the checkpoint has no state that fits control '{control}', so it belongs to another scenario; resume \
         with the original scenario"
    )]
    OtherMemory { control: String },
    #[error("timeout is {value} s; it must be positive and finite", value = short(*value))]
    Timeout { value: f64 },
    #[error(
        "on_timeout '{used_by}' requires {gain} > 0 for all joints; give kp and kd, such as kp=100, kd=20, \
         or use on_timeout 'zero'"
    )]
    TimeoutGain { gain: &'static str, used_by: &'static str },
    #[error(
        "control '{control}' follows external commands, so it has neither a goal nor a reference to shift; omit \
         'goal' and 'starts_at_present'"
    )]
    GoalOfExternal { control: String },
    #[error("no control '{name}' follows external commands{hint}", hint = named(known, name))]
    UnknownControl { name: String, known: Vec<String> },
    #[error("control '{control}' does not follow external commands{hint}", hint = externals(known))]
    NotExternal { control: String, known: Vec<String> },
    #[error(
        "control '{control}' has ended, so it accepts no commands; send the command to an active control"
    )]
    ControlEnded { control: String },
    #[error(
        "the list '{name}' of the command to control '{control}' must have {expected}, but it has {got}",
        got = count(*got, "number"),
        expected = if *points == 1 { format!("{}, one per joint of its group", count(*joints, "number")) }
            else { format!(
                "{}: {points} rows, one per time, of {}", count(points * joints, "number"), count(*joints, "number")
            ) }
    )]
    CommandLength { control: String, name: &'static str, points: usize, joints: usize, got: usize },
    #[error(
        "{name}{place} of the command to control '{control}' is {value}; it must be finite and within \
         ±1e60 (SI units)",
        place = if *name == "start" { String::new() } else { format!("[{index}]") }, value = exact(*value)
    )]
    CommandNumber { control: String, name: &'static str, index: usize, value: f64 },
    #[error(
        "the command to control '{control}' is empty; give a position, a velocity or an effort, or at \
         least one point of a trajectory"
    )]
    EmptyCommand { control: String },
    #[error(
        "the {what} for control '{control}' has accelerations without {lacks}; give {lacks} too",
        what = if *is_trajectory { "trajectory" } else { "command" },
        lacks = if *is_trajectory { "velocities" } else { "positions or velocities" }
    )]
    AccelerationAlone { control: String, is_trajectory: bool },
    #[error(
        "times[{index}] of the trajectory of '{control}' is {after} s; {least}",
        after = unlike(*after, &[*before]),
        least = if *index == 0 { "the first time must be at least 0 s".to_owned() }
            else { format!("times must increase, but the time before is {} s", short(*before)) }
    )]
    TimesNotIncreasing { control: String, index: usize, before: f64, after: f64 },
    #[error(
        "the trajectory of '{control}' ends at t = {end} s, before the current time, {now} s; give a later 'start'",
        end = unlike(*end, &[*now]), now = short(*now)
    )]
    PastTrajectory { control: String, end: f64, now: f64 },
    #[error(
        "control '{control}' has received {of}, which require {gain} > 0 for all of its joints; construct it with \
         gains, such as External(kp=100, kd=20), or send efforts"
    )]
    CommandGain { control: String, gain: &'static str, of: &'static str },
    #[error("control '{control}': {source}")]
    OfControl { control: String, source: Box<ControlError> },
    #[error("at t = {time} s: {source}", time = short(*time))]
    Reference { time: f64, source: ReferenceError },
    /// Error that a user-defined controller returned, passed on unchanged.
    #[error(transparent)]
    User(Box<dyn std::error::Error + Send + Sync>),
}

impl ControlError {
    /// Adds the name of the control to an error that does not contain it.
    pub(super) fn of_control(self, control: &str) -> Self {
        match self {
            Self::WrongLength { .. }
            | Self::NotFinite { .. }
            | Self::TooLarge { .. }
            | Self::Negative { .. }
            | Self::NotPositive { .. }
            | Self::Zero { .. }
            | Self::TooFewJoints { .. }
            | Self::NoSuchFrame { .. }
            | Self::GainOfEffort { .. }
            | Self::Timeout { .. }
            | Self::TimeoutGain { .. } => {
                Self::OfControl { control: control.to_owned(), source: Box::new(self) }
            }
            other => other,
        }
    }
}

/// Returns the hint for an unknown control: the most similar name of a control that follows commands, or the
/// hint of [`externals`] if no name is similar.
fn named(known: &[String], name: &str) -> String {
    closest(known, name).map_or_else(|| externals(known), |meant| format!("; did you mean '{meant}'?"))
}

/// Returns the hint for a control that does not follow commands: the names of the controls that do or,
/// without such controls, the advice to declare one.
fn externals(known: &[String]) -> String {
    match known {
        [] => "; use an External controller for the joints to be commanded".to_owned(),
        [only] => format!("; the only control that follows them is '{only}'"),
        _ => format!("; the controls that follow them are: {}", known.join(", ")),
    }
}
