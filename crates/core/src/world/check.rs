//! Checks of the systems, brakes and events of a world before a run.

use super::brake::Brake;
use super::error::WorldError;
use super::event::{Action, BrakeIndex, Event, FrameIndex, RigidPose, Seat, When};
use super::system::System;
use crate::model::{BASE_NV, Model, Mount};
use crate::reference::TimeLaw;

/// Names that no system may have, because references use them for frames or paths.
const RESERVED: [&str; 4] = ["world", "lvlh", "base", "path"];

/// Largest accepted deviation of the norm of a quaternion from 1.
const UNIT_NORM: f64 = 1e-9;

/// Longest accepted duration of a seating motion, s.
const LONGEST: f64 = 1e9;

/// Largest accepted distance of a nominal pose from the capturing frame, m: more than the size of any
/// spacecraft.
const FARTHEST: f64 = 1e3;

/// Checks the names of the systems of a world. If there is only one system, it may have any name.
///
/// # Errors
/// [`WorldError::NoSystems`] for an empty world, [`WorldError::SystemName`] for an invalid name, and
/// [`WorldError::SystemTwice`] for a name given twice.
pub fn check_names(systems: &[System]) -> Result<(), WorldError> {
    if systems.is_empty() {
        return Err(WorldError::NoSystems);
    }
    if systems.len() == 1 {
        return Ok(());
    }
    for (i, System { name, .. }) in systems.iter().enumerate() {
        let is_allowed = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        let starts_well = name.starts_with(|c: char| c.is_ascii_alphabetic());
        if !starts_well || !name.chars().all(is_allowed) || RESERVED.contains(&name.as_str()) {
            return Err(WorldError::SystemName { name: name.clone() });
        }
        if systems[..i].iter().any(|before| before.name == *name) {
            return Err(WorldError::SystemTwice { name: name.clone() });
        }
    }
    Ok(())
}

/// Checks the events of a world.
///
/// # Errors
/// [`WorldError`] for the first invalid event: a name given twice, unknown systems, frames, brakes or events,
/// a capture within one system, a capture that would produce an invalid tree, a latch without a capture, a
/// value outside its range, or events that wait for themselves or each other.
pub fn check_events(systems: &[System], events: &[Event]) -> Result<(), WorldError> {
    for (i, event) in events.iter().enumerate() {
        if events[..i].iter().any(|before| before.name == event.name) {
            return Err(WorldError::EventTwice { name: event.name.clone() });
        }
        check_action(systems, events, event)?;
        check_when(events, event)?;
    }
    check_circles(events)?;
    events.iter().try_for_each(|event| check_merged(systems, event))
}

/// Checks that a capture of two systems produces a valid model. Its validity does not depend on the pose
/// at the capture.
fn check_merged(systems: &[System], event: &Event) -> Result<(), WorldError> {
    let Action::Capture { by, of, .. } = event.action else { return Ok(()) };
    let [near, far] = [by, of].map(|place| &systems[place.system].model);
    let name = |model: &Model, frame: usize| model.frames()[frame].name.clone();
    let mount =
        Mount { frame: Some(name(far, of.frame)), prefix: "captured/".to_owned(), ..Mount::default() };
    let merged = near.attach(&name(near, by.frame), far, &mount);
    merged.map(|_| ()).map_err(|source| WorldError::Merged { event: event.name.clone(), source })
}

fn check_action(systems: &[System], events: &[Event], event: &Event) -> Result<(), WorldError> {
    let name = || event.name.clone();
    match &event.action {
        Action::Capture { by, of, seat } => {
            for FrameIndex { system, frame } in [by, of] {
                let count = systems.len();
                let owner = systems.get(*system);
                let owner =
                    owner.ok_or(WorldError::UnknownSystem { event: name(), system: *system, count })?;
                let count = owner.model.frames().len();
                if *frame >= count {
                    let (system, frame) = (owner.name.clone(), *frame);
                    return Err(WorldError::UnknownFrame { event: name(), system, frame, count });
                }
            }
            if by.system == of.system {
                return Err(WorldError::OwnSystem { event: name(), system: systems[by.system].name.clone() });
            }
            seat.as_ref().map_or(Ok(()), |seat| check_seat(event, seat))
        }
        Action::Release { capture, impulse } => {
            let reason = match events.get(*capture).map(|event| &event.action) {
                Some(Action::Capture { .. }) => "",
                Some(_) => "is not a capture; give the index of a capture",
                None => "does not exist; give the index of a capture",
            };
            if !reason.is_empty() {
                return Err(WorldError::UnknownEvent { event: name(), other: *capture, reason });
            }
            let wrong = |(index, &value): (usize, &f64)| {
                let (what, unit) = [("the impulse", "N s"), ("the angular impulse", "N m s")][index / 3];
                WorldError::Number { event: name(), what, value, unit, expected: "finite" }
            };
            let value = impulse.iter().enumerate().find(|(_, x)| !x.is_finite());
            value.map_or(Ok(()), |value| Err(wrong(value)))
        }
        Action::Engage(BrakeIndex { system, brake }) | Action::Disengage(BrakeIndex { system, brake }) => {
            let count = systems.len();
            let owner = systems.get(*system);
            let owner = owner.ok_or(WorldError::UnknownSystem { event: name(), system: *system, count })?;
            let (brake, count, system) = (*brake, owner.brakes.len(), owner.name.clone());
            match brake < count {
                true => Ok(()),
                false => Err(WorldError::UnknownBrake { event: name(), system, brake, count }),
            }
        }
    }
}

fn check_seat(event: &Event, seat: &Seat) -> Result<(), WorldError> {
    let wrong = |what, value, unit, expected| {
        Err(WorldError::Number { event: event.name.clone(), what, value, unit, expected })
    };
    if TimeLaw::quintic(seat.duration).is_err() || seat.duration > LONGEST {
        return wrong("the duration of the seating", seat.duration, "s", "between 1e-12 s and 1e9 s");
    }
    let RigidPose { rotation, position } = &seat.pose;
    if let Some(value) = position.iter().copied().find(|x| !x.is_finite()) {
        return wrong("the position of the pose", value, "m", "finite");
    }
    let distance = position.iter().fold(0.0, |sum: f64, x| sum.hypot(*x));
    if distance > FARTHEST {
        let expected = "at most 1000 m; give the position of the captured frame in the capturing frame, in m";
        return wrong("the distance of the nominal pose", distance, "m", expected);
    }
    let norm = rotation.iter().map(|x| x * x).sum::<f64>().sqrt();
    if (norm - 1.0).abs() > UNIT_NORM || norm.is_nan() {
        let expected = "1 within 1e-9; normalise the quaternion";
        return wrong("the norm of the quaternion of the pose", norm, "", expected);
    }
    Ok(())
}

fn check_when(events: &[Event], event: &Event) -> Result<(), WorldError> {
    let name = || event.name.clone();
    let check = |what, value: f64, unit, expected, is_valid: bool| match is_valid {
        true => Ok(()),
        false => Err(WorldError::Number { event: name(), what, value, unit, expected }),
    };
    let is_time = |t: f64| t.is_finite() && t >= 0.0;
    const LATER: &str = "finite and at least 0 s";
    match &event.when {
        &When::At(t) => check("the time", t, "s", LATER, is_time(t)),
        &When::After { event: other, delay } => {
            if other >= events.len() {
                let reason = "does not exist; give the index of an event of the world";
                return Err(WorldError::UnknownEvent { event: name(), other, reason });
            }
            check("the delay", delay, "s", LATER, is_time(delay))
        }
        When::OnCommand => Ok(()),
        When::Latch(envelope) => {
            if !matches!(event.action, Action::Capture { .. }) {
                return Err(WorldError::LatchWithoutCapture { event: name() });
            }
            let bounds = [envelope.within, envelope.slower_than].concat();
            let units = ["m", "rad", "m/s", "rad/s"];
            for (bound, unit) in bounds.into_iter().zip(units) {
                check("a value of 'within' or 'slower_than'", bound, unit, "positive", bound > 0.0)?;
            }
            check("held_for", envelope.held_for, "s", LATER, is_time(envelope.held_for))
        }
    }
}

/// Checks that no event waits, directly or through other events, for itself.
fn check_circles(events: &[Event]) -> Result<(), WorldError> {
    for start in 0..events.len() {
        let (mut at, mut path) = (start, Vec::new());
        while let When::After { event, .. } = events[at].when {
            path.push(events[at].name.as_str());
            if event == start && path.len() == 1 {
                return Err(WorldError::AfterItself { event: events[start].name.clone() });
            }
            if event == start {
                return Err(WorldError::Circle { names: path.join(", ") });
            }
            if path.len() > events.len() {
                break; // a cycle that does not contain `start`
            }
            at = event;
        }
    }
    Ok(())
}

/// Checks the brakes of a system.
///
/// # Errors
/// [`WorldError`] for a name given twice, a joint that does not exist or has two brakes, a slip torque that
/// is not positive, and a joint that moves at the start although a brake holds it rigidly.
pub fn check_brakes(system: &System) -> Result<(), WorldError> {
    let (brakes, joints) = (&system.brakes, system.model.joints());
    for (i, Brake { name, joint, slip_torque, is_engaged }) in brakes.iter().enumerate() {
        let name = || name.clone();
        if brakes[..i].iter().any(|before| before.name == brakes[i].name) {
            return Err(WorldError::BrakeTwice { name: name() });
        }
        let Some(held) = joints.get(*joint).map(|joint| joint.name.clone()) else {
            return Err(WorldError::BrakeJoint { name: name(), joint: *joint, count: joints.len() });
        };
        if let Some(before) = brakes[..i].iter().find(|before| before.joint == *joint) {
            return Err(WorldError::JointWithTwoBrakes {
                name: name(),
                other: before.name.clone(),
                joint: held,
            });
        }
        if slip_torque.is_nan() || *slip_torque <= 0.0 {
            return Err(WorldError::SlipTorque { name: name(), value: *slip_torque });
        }
        let rate = system.v.get(BASE_NV + joint).copied().unwrap_or(0.0);
        if *is_engaged && slip_torque.is_infinite() && rate != 0.0 {
            return Err(WorldError::HeldJointMoves { name: name(), joint: held, rate });
        }
    }
    Ok(())
}
