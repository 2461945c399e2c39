//! State of a robot in the coordinates of another model of the same links.

use super::data::Data;
use super::kinematics::{frame_pose, frame_velocity, kinematics};
use crate::model::{BASE_NQ, BASE_NV, Model, ModelError};
use crate::spatial::{Quat, Vec3};

/// Returns the configuration `(nq,)` and the velocity `(nv,)` with which the links of the model `to` have the
/// same poses and twists as the links of the model `from` at `q` and `v`. The model `to` is either that of
/// the same robot with another root ([`Model::rerooted`]) or that of a part of the robot.
///
/// # Errors
/// [`ModelError::UnknownName`] for a joint or a base of `to` that `from` does not have.
pub fn transfer_state(
    from: &Model,
    q: &[f64],
    v: &[f64],
    to: &Model,
) -> Result<(Vec<f64>, Vec<f64>), ModelError> {
    let base = from.frame(&to.body_frame(0).name)?;
    let mut data = Data::new(from);
    kinematics(from, &mut data, q, v);
    let (pose, velocity) = (frame_pose(from, &data, q, base), frame_velocity(from, &data, q, base));
    let to_base = |vector: Vec3<f64>| pose.rot_wf.transpose_mul(vector);
    let (mut to_q, mut to_v) = (vec![0.0; to.nq()], vec![0.0; to.nv()]);
    pose.pos_w.write(&mut to_q);
    Quat::from_matrix(&pose.rot_wf).write_xyzw(&mut to_q[3..]);
    to_base(velocity.linear).write(&mut to_v);
    to_base(velocity.angular).write(&mut to_v[3..]);
    for (j, name) in to.joint_names().enumerate() {
        let joint = from.joint(name)?;
        (to_q[BASE_NQ + j], to_v[BASE_NV + j]) = (q[BASE_NQ + joint], v[BASE_NV + joint]);
    }
    Ok((to_q, to_v))
}
