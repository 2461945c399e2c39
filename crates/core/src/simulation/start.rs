//! Whether a reference starts where the robot is.

use super::error::SimulationError;
use crate::control::{Begin, Control};
use crate::dynamics::{Data, base_rotation, frame_pose, kinematics};
use crate::model::Model;
use crate::reference::{TaskReference, joint_start_offset};
use crate::spatial::Vec3;

/// Refuses a reference that begins further than `tolerance` (m, rad) from its frame at `q`, time zero.
pub(super) fn check_start(
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
        return Err(SimulationError::ReferenceStartsAway { position, angle, tolerance });
    }
    Ok(())
}

/// Refuses references of controls that begin away from the robot at time zero: of tools by more than
/// `tolerance` (m, rad), of joints by more than its second.
pub(super) fn check_control_starts(
    model: &Model,
    q: &[f64],
    controls: &[Control],
    tolerance: [f64; 2],
) -> Result<(), SimulationError> {
    for control in controls.iter().filter(|c| c.begin == Begin::At(0.0) && !c.starts_at_present) {
        if let Some((frame, reference)) = control.task() {
            check_start(model, q, frame, reference, tolerance)?;
        }
        if let Some(path) = control.joint_reference().filter(|_| control.tracks_positions()) {
            let here: Vec<f64> = control.joints.iter().map(|&j| q[7 + j]).collect();
            let offset = joint_start_offset(&**path, &here);
            if offset > tolerance[1] {
                let (control, tolerance) = (control.name.clone(), tolerance[1]);
                return Err(SimulationError::JointsStartAway { control, offset, tolerance });
            }
        }
    }
    Ok(())
}
