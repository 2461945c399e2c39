//! Rotations that align the z axis with the axis of a joint.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

/// Returns a rotation from joint axes, whose z axis is `axis`, to link axes. `axis` is a nonzero vector in
/// link axes.
///
/// The result is exact if `axis` has the direction +x, +y, +z or −z, so that joints about these axes add no
/// rounding error.
pub(super) fn rotation_to_axis(axis: &Vector3<f64>) -> Matrix3<f64> {
    let axis = axis.normalize();
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    if axis == z {
        Matrix3::identity()
    } else if axis == y {
        Matrix3::from_columns(&[z, x, y])
    } else if axis == x {
        Matrix3::from_columns(&[y, z, x])
    } else if axis.z < -0.9 {
        // half a turn about x first, which keeps the angle of the shortest rotation below away from half a
        // turn
        let flip = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
        flip * rotation_to_axis(&(flip * axis))
    } else {
        let turn = Unit::new_normalize(z.cross(&axis));
        let angle = z.cross(&axis).norm().atan2(axis.z);
        Rotation3::from_axis_angle(&turn, angle).into_inner()
    }
}

#[cfg(test)]
mod tests {
    use super::rotation_to_axis;
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn z_becomes_the_axis_and_the_matrix_stays_a_rotation() {
        let axes = [
            Vector3::x(),
            -Vector3::x(),
            Vector3::y(),
            -Vector3::y(),
            Vector3::z(),
            -Vector3::z(),
            Vector3::new(1e-9, 0.0, 1.0),
            Vector3::new(1e-9, 1e-9, -1.0),
            Vector3::new(0.3, -2.0, -0.5),
        ];
        for axis in axes {
            let r = rotation_to_axis(&axis);
            assert!((r * Vector3::z() - axis.normalize()).norm() < 1e-15, "{axis}");
            assert!((r.transpose() * r - Matrix3::identity()).norm() < 1e-15, "{axis}");
            assert!((r.determinant() - 1.0).abs() < 1e-15, "{axis}");
        }
    }
}
