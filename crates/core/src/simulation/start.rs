//! Whether a reference starts where the robot is.

use super::error::SimulationError;
use crate::dynamics::{Data, base_rotation, frame_pose, kinematics};
use crate::model::Model;
use crate::reference::TaskReference;
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
