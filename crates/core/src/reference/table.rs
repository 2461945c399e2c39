//! Samples of references at many times, and poses from arrays.

use super::{Hold, JointPath, JointSample, ReferenceError, TaskReference};
use nalgebra::{Matrix4, Vector4};

impl Hold {
    /// Creates a constant pose from each row-major homogeneous `(4, 4)` matrix, with the position in m.
    ///
    /// # Errors
    /// [`ReferenceError::LastRow`] for a last row that differs from 0, 0, 0, 1, and the errors of
    /// [`Hold::new`].
    pub fn from_rows(rows: &[[f64; 16]]) -> Result<Vec<Self>, ReferenceError> {
        let pose = |row: &[f64; 16]| {
            let pose = Matrix4::from_row_slice(row);
            let last = pose.row(3).transpose();
            if last != Vector4::w() {
                return Err(ReferenceError::LastRow { row: last.into() });
            }
            Self::new(pose.fixed_view::<3, 3>(0, 0).into(), pose.fixed_view::<3, 1>(0, 3).into())
        };
        rows.iter().map(pose).collect()
    }
}

/// Samples a reference at many `times` (T,), s: poses (T, 4, 4), velocities and accelerations (T, 6), in the
/// units of [`TaskSample`](super::TaskSample). They are those of the path in the frame of the reference if
/// `in_own_frame` is true, otherwise those that [`TaskReference::sample`] returns.
///
/// # Errors
/// [`ReferenceError::WrongLength`] for outputs of the wrong length, and the errors of
/// [`TaskReference::sample`]. The rows of the instants before that error have then been written.
pub fn task_table(
    reference: &TaskReference,
    in_own_frame: bool,
    times: &[f64],
    [poses, velocities, accelerations]: [&mut [f64]; 3],
) -> Result<(), ReferenceError> {
    for (name, width, out) in
        [("poses", 16, &poses), ("velocities", 6, &velocities), ("accelerations", 6, &accelerations)]
    {
        check_room(name, width * times.len(), out)?;
    }
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

/// Samples a joint path at many `times` (T,), s: positions, rates and accelerations (T, n), in the units of
/// [`JointSample`].
///
/// # Errors
/// [`ReferenceError::WrongLength`] for outputs of the wrong length.
pub fn joint_table(
    path: &dyn JointPath,
    times: &[f64],
    [q, v, a]: [&mut [f64]; 3],
) -> Result<(), ReferenceError> {
    let n = path.count();
    for (name, out) in [("positions", &q), ("rates", &v), ("accelerations", &a)] {
        check_room(name, n * times.len(), out)?;
    }
    let mut now = JointSample::new(n);
    for (row, &t) in times.iter().enumerate() {
        path.sample(t, &mut now);
        for (out, values) in [(&mut *q, &now.q), (&mut *v, &now.v), (&mut *a, &now.a)] {
            out[row * n..(row + 1) * n].copy_from_slice(values);
        }
    }
    Ok(())
}

/// Returns an error if an output has the wrong length.
fn check_room(name: &'static str, expected: usize, out: &[f64]) -> Result<(), ReferenceError> {
    let got = out.len();
    if got == expected { Ok(()) } else { Err(ReferenceError::WrongLength { name, expected, got }) }
}
