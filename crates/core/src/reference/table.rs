//! References and poses as rows of numbers.

use super::{Hold, JointPath, JointSample, ReferenceError, TaskReference};
use nalgebra::{Matrix4, Vector4};

impl Hold {
    /// Poses from row-major `(4, 4)` matrices, one after the other.
    ///
    /// # Errors
    /// [`ReferenceError::LastRow`] for a last row other than 0, 0, 0, 1; as [`Hold::new`].
    pub fn from_rows(rows: &[f64]) -> Result<Vec<Self>, ReferenceError> {
        let pose = |rows: &[f64]| {
            let pose = Matrix4::from_row_slice(rows);
            let last = pose.row(3).transpose();
            if last != Vector4::w() {
                return Err(ReferenceError::LastRow { row: last.into() });
            }
            Self::new(pose.fixed_view::<3, 3>(0, 0).into(), pose.fixed_view::<3, 1>(0, 3).into())
        };
        rows.chunks_exact(16).map(pose).collect()
    }
}

/// Samples at many `times` (T,), s: poses (T, 4, 4), velocities and accelerations (T, 6), in W axes, or in
/// those of the path's own frame where `in_own_frame`.
///
/// # Errors
/// As [`TaskReference::sample`]; rows before it are written.
pub fn task_table(
    reference: &TaskReference,
    in_own_frame: bool,
    times: &[f64],
    [poses, velocities, accelerations]: [&mut [f64]; 3],
) -> Result<(), ReferenceError> {
    let rows = poses.chunks_exact_mut(16).zip(velocities.chunks_exact_mut(6));
    for (&t, ((pose, velocity), acceleration)) in
        times.iter().zip(rows.zip(accelerations.chunks_exact_mut(6)))
    {
        let now = if in_own_frame { reference.path.sample(t) } else { reference.sample(t, 0.0)? };
        pose.copy_from_slice(&now.pose_rows());
        now.velocity.write(velocity);
        now.acceleration.write(acceleration);
    }
    Ok(())
}

/// Samples at many `times` (T,), s: positions, rates and accelerations (T, n).
pub fn joint_table(path: &dyn JointPath, times: &[f64], [q, v, a]: [&mut [f64]; 3]) {
    let n = path.count();
    let mut now = JointSample::new(n);
    for (row, &t) in times.iter().enumerate() {
        path.sample(t, &mut now);
        for (out, values) in [(&mut *q, &now.q), (&mut *v, &now.v), (&mut *a, &now.a)] {
            out[row * n..(row + 1) * n].copy_from_slice(values);
        }
    }
}
