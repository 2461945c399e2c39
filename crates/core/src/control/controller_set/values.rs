//! Conversion of vectors of a scalar type to `f64`.

use crate::spatial::{Mat3, Motion, Scalar, Vec3};

pub(super) fn vector<S: Scalar>(v: Vec3<S>) -> Vec3<f64> {
    Vec3::new(v.x.value(), v.y.value(), v.z.value())
}

pub(super) fn matrix<S: Scalar>(m: &Mat3<S>) -> Mat3<f64> {
    Mat3::from_columns(vector(m.x), vector(m.y), vector(m.z))
}

pub(super) fn motion<S: Scalar>(m: Motion<S>) -> Motion<f64> {
    Motion::new(vector(m.linear), vector(m.angular))
}
