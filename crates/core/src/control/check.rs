//! Validation of the controls before a run.

use super::control::{Begin, Control};
use super::control_law::JointCommand;
use super::error::ControlError;
use crate::model::Model;

/// Checks that each control applies to the robot and that no two controls conflict.
///
/// # Errors
/// [`ControlError`] for
/// - two controls with the same name;
/// - a group of joints that is empty although the robot has joints, that contains a joint twice or that
///   contains a joint that does not exist;
/// - two groups that share a joint while both controls are active, if the times of both controls are known
///   before the run;
/// - gains, goals or references that are invalid or do not fit the group;
/// - a tracked frame that does not exist or that too few joints of the group move;
/// - a goal, or a shift of the reference to the present state, of a control that has no tracking error or
///   follows external commands;
/// - a shift of the reference, or a path tolerance, of a grip-force law;
/// - a grip force that exceeds the effort limits of the joints;
/// - a load, or internal forces, of a law that does not use them;
/// - a time window that is empty or begins at a time that is not finite;
/// - a start after a control that does not exist, that never ends or that waits for this control itself;
/// - computed-torque laws of which only some compensate the environment.
pub fn check_controls(controls: &[Control], model: &Model) -> Result<(), ControlError> {
    for (i, control) in controls.iter().enumerate() {
        if controls[..i].iter().any(|other| other.name == control.name) {
            return Err(ControlError::RepeatedName { name: control.name.clone() });
        }
        check_group(control, model)?;
        let fits =
            control.law.check(&control.name, &control.joints, model).and_then(|()| check_goal(control));
        fits.map_err(|error| error.of_control(&control.name))?;
        let command = control.law.control_law().joint_command();
        let is_load = control.load.is_some() && command != JointCommand::Task;
        if is_load || !control.internal_forces.is_empty() && command == JointCommand::Effort {
            return Err(ControlError::UnusedLoad { control: control.name.clone(), is_load });
        }
        check_window(i, controls)?;
        for earlier in 0..i {
            check_pair(earlier, i, controls, model)?;
        }
    }
    Ok(())
}

fn check_group(control: &Control, model: &Model) -> Result<(), ControlError> {
    let (name, count) = (&control.name, model.joint_count());
    if control.joints.is_empty() && count > 0 {
        return Err(ControlError::EmptyGroup { control: name.clone() });
    }
    for (place, &joint) in control.joints.iter().enumerate() {
        if joint >= count {
            return Err(ControlError::NoSuchJoint { control: name.clone(), joint, count });
        }
        if control.joints[..place].contains(&joint) {
            let joint = model.joints()[joint].name.clone();
            return Err(ControlError::RepeatedJoint { control: name.clone(), joint });
        }
    }
    Ok(())
}

fn check_goal(control: &Control) -> Result<(), ControlError> {
    if control.law.external().is_some() && (control.starts_at_present || control.goal.is_some()) {
        return Err(ControlError::GoalOfExternal { control: control.name.clone() });
    }
    if control.law.grip().is_some() {
        let has_path = control.goal.as_ref().is_some_and(|goal| goal.path.is_some());
        for (option, is_given) in
            [("starts_at_present", control.starts_at_present), ("path_tolerance", has_path)]
        {
            if is_given {
                return Err(ControlError::GripOption { control: control.name.clone(), option });
            }
        }
    }
    let width = control.width();
    if width == 0 && (control.starts_at_present || control.goal.is_some()) {
        return Err(ControlError::NothingTracked { control: control.name.clone() });
    }
    let components = if control.law.task().is_some() { 2 } else { width };
    control.goal.as_ref().map_or(Ok(()), |goal| goal.check(components))
}

fn check_window(i: usize, controls: &[Control]) -> Result<(), ControlError> {
    let control = &controls[i];
    let name = || control.name.clone();
    let begin = match control.begin {
        Begin::At(start) => start,
        Begin::AfterEvent(_) => 0.0,
        Begin::After(other) if other >= controls.len() => {
            return Err(ControlError::NoSuchControl { control: name(), after: other.to_string() });
        }
        Begin::After(other) => {
            let mut before = other;
            for _ in controls {
                match controls[before].begin {
                    Begin::After(next) if next < controls.len() && before != i => before = next,
                    _ => break,
                }
            }
            if before == i {
                return Err(ControlError::AfterItself { control: name() });
            }
            let other = &controls[other];
            if other.goal.is_none() && other.end == f64::INFINITY {
                return Err(ControlError::NeverEnds { control: name(), after: other.name.clone() });
            }
            0.0
        }
    };
    let is_window = begin.is_finite() && !control.end.is_nan() && begin < control.end;
    if is_window {
        Ok(())
    } else if !matches!(control.begin, Begin::At(_)) {
        Err(ControlError::EndsBeforeStart { control: name(), end: control.end })
    } else {
        Err(ControlError::EmptyWindow { control: name(), begin, end: control.end })
    }
}

fn check_pair(i: usize, k: usize, controls: &[Control], model: &Model) -> Result<(), ControlError> {
    let (a, b) = (&controls[i], &controls[k]);
    if let (Some(one), Some(other)) =
        (a.law.control_law().compensates_environment(), b.law.control_law().compensates_environment())
        && one != other
    {
        return Err(ControlError::MixedCompensation { first: a.name.clone(), second: b.name.clone() });
    }
    // if a control starts after another one or is stopped by one, the time is known only during the run
    let has_successor = |index| controls.iter().any(|other| other.begin == Begin::After(index));
    if let (Begin::At(start_a), Begin::At(start_b)) = (a.begin, b.begin) {
        let time = start_a.max(start_b).max(0.0);
        if time < a.end.min(b.end) && !(has_successor(i) || has_successor(k)) {
            check_disjoint(a, b, model, time)?;
        }
    }
    Ok(())
}

/// Checks that two controls that are both active at `time`, s, have no joint in common.
pub(super) fn check_disjoint(a: &Control, b: &Control, model: &Model, time: f64) -> Result<(), ControlError> {
    match a.joints.iter().find(|joint| b.joints.contains(joint)) {
        Some(&joint) => Err(ControlError::Overlap {
            first: a.name.clone(),
            second: b.name.clone(),
            joint: model.joints()[joint].name.clone(),
            time,
        }),
        None => Ok(()),
    }
}
