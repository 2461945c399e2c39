//! Checks that references start near the initial poses of their frames, or near the initial joint positions.

use super::error::SimulationError;
use super::state_range::unit_of;
use crate::control::{Begin, Control, Interface};
use crate::dynamics::{Data, base_rotation, frame_pose, kinematics};
use crate::model::{BASE_NQ, Model};
use crate::reference::{TaskReference, joint_start_offset};
use crate::spatial::Vec3;

/// Checks that a reference starts within `tolerance`, m and rad, of the pose of the frame with index `frame`
/// at the configuration `q`.
pub(super) fn check_reference(
    model: &Model,
    q: &[f64],
    frame: usize,
    reference: &TaskReference,
    tolerance: [f64; 2],
) -> Result<(), SimulationError> {
    let mut data = Data::<f64>::new(model);
    kinematics(model, &mut data, q, &vec![0.0; model.nv()]);
    let pose = frame_pose(model, &data, q, frame);
    let (mut rot, mut pos) = (pose.rot_wf, pose.pos_w);
    if reference.is_relative_to_base() {
        let rot_bw = base_rotation(q).transpose();
        (rot, pos) = (rot_bw * rot, rot_bw * (pos - Vec3::from_slice(q)));
    }
    let offset = reference.start_offset(&rot, pos, 0.0);
    let (position, angle) = offset.map_err(|source| SimulationError::Reference { time: 0.0, source })?;
    if position > tolerance[0] || angle > tolerance[1] {
        let frame = model.frames()[frame].name.clone();
        return Err(SimulationError::ReferenceStartsAway { frame, position, angle, tolerance });
    }
    Ok(())
}

/// Checks the references of the controls that are active from the start of the run, except references that
/// are shifted to the pose or positions at that time. A reference of a frame must start within `tolerance`, m
/// and rad, of the frame. A reference of joint positions must start within the second entry of `tolerance`,
/// rad (m for prismatic joints), of the initial positions.
pub(super) fn check_control_references(
    model: &Model,
    q: &[f64],
    controls: &[Control],
    tolerance: [f64; 2],
) -> Result<(), SimulationError> {
    for control in controls.iter().filter(|c| c.begin == Begin::At(0.0) && !c.starts_at_present) {
        if let Some((frame, reference)) = control.law.task() {
            check_reference(model, q, frame, reference, tolerance)?;
        }
        if let Some(path) =
            control.law.joint_reference().filter(|_| control.law.interface() == Interface::Position)
        {
            let here: Vec<f64> = control.joints.iter().map(|&j| q[BASE_NQ + j]).collect();
            let (joint, offset) = joint_start_offset(&**path, &here);
            if offset > tolerance[1] {
                let (number, control, tolerance) =
                    (control.joints[joint], control.name.clone(), tolerance[1]);
                let (joint, unit) = (model.joints()[number].name.clone(), unit_of(model, number));
                return Err(SimulationError::JointsStartAway { control, joint, unit, offset, tolerance });
            }
        }
    }
    Ok(())
}
