//! Check that inertia resists every motion of a robot.

use super::error::ModelError;
use super::tree::{Axis, Model, Node};
use nalgebra::{Matrix3, Matrix6, Rotation3, Vector3};

/// A pivot of the mass matrix that is smaller than this fraction of its diagonal entry is treated as a
/// rounding error.
const PIVOT_SHARE: f64 = 1e-12;
/// A pivot that is smaller than this fraction of the largest inertia that moves with the joint is treated as
/// a rounding error. For a point mass on the joint axis, the diagonal entry itself is a rounding error.
const ROUNDING_SHARE: f64 = 1e-14;

/// Returns an error if the mass matrix is singular in every configuration.
///
/// When joints are eliminated from the leaves to the root, the pivots are the articulated inertias along the
/// joints. A pivot that vanishes in three fixed, arbitrary configurations is assumed to vanish in all.
pub(super) fn check_well_posed(model: &Model) -> Result<(), ModelError> {
    if model.mass() <= 0.0 {
        return Err(ModelError::NoMass);
    }
    let n = model.joint_count();
    let mut is_resisted = vec![false; n + 6];
    for round in 0..3 {
        let angle = |j: usize| f64::sin(1.7 * j as f64 + 2.3 * f64::from(round) + 0.4);
        eliminate(model, angle, &mut is_resisted);
    }
    match is_resisted.iter().rposition(|resisted| !resisted) {
        None => Ok(()),
        Some(i) if i < 6 => {
            let (link, joints) = (model.body_frame(0).name.clone(), massless_chain(model));
            Err(ModelError::SingularBase { link, joints })
        }
        Some(i) => Err(ModelError::MasslessSubtree {
            joint: model.joints[i - 6].name.clone(),
            link: model.body_frame(i - 5).name.clone(),
        }),
    }
}

/// Returns the names of the joints of the chain of bodies without inertia that begins with the base, such as
/// the dummy joints of a mobile robot on a fixed world.
///
/// The chain ends at the first body with inertia or with several children. The list is empty if the base
/// itself is such a body.
fn massless_chain(model: &Model) -> Vec<String> {
    let is_empty = |node: &&Node| node.mass == 0.0 && node.about_com.to_nalgebra().amax() == 0.0;
    let count = model.nodes.iter().take_while(is_empty).take_while(|node| !node.is_fork).count();
    model.joints.iter().take(count).map(|joint| joint.name.clone()).collect()
}

/// Marks in `is_resisted`, `(nv,)`, the motions whose pivot is larger than rounding error in the
/// configuration with the joint positions `angle(j)`, rad or m. The function uses dense 6 × 6 inertias in
/// body axes, to be independent of the dynamics algorithms.
fn eliminate(model: &Model, angle: impl Fn(usize) -> f64, is_resisted: &mut [bool]) {
    let mut composite: Vec<_> = model.nodes.iter().map(inertia_about_origin).collect();
    let mut articulated = composite.clone();
    for (i, node) in model.nodes.iter().enumerate().skip(1).rev() {
        let k = if node.axis == Axis::Revolute { 5 } else { 2 };
        let rotor = node.rotor_inertia;
        let (diagonal, pivot) = (composite[i][(k, k)] + rotor, articulated[i][(k, k)] + rotor);
        if is_more_than_rounding(pivot, diagonal, scale(&composite[i], k) + rotor) {
            is_resisted[i + 5] = true;
            // Iᵃ = I − I s (sᵀ I s)⁻¹ sᵀ I
            let u = articulated[i].column(k).into_owned();
            articulated[i] -= u * u.transpose() / pivot;
        }
        // the parent's inertia increases by Xᵀ I X, where X transforms motions of the parent to the body
        let x = motion_transform(node, angle(i - 1));
        let (whole, rest) = (x.transpose() * composite[i] * x, x.transpose() * articulated[i] * x);
        composite[node.parent] += whole;
        articulated[node.parent] += rest;
    }
    let mut m = articulated[0];
    for k in (0..6).rev() {
        let pivot = m[(k, k)];
        if is_more_than_rounding(pivot, composite[0][(k, k)], scale(&composite[0], k)) {
            is_resisted[k] = true;
            let u = m.column(k).into_owned();
            m -= u * u.transpose() / pivot;
        }
    }
}

fn is_more_than_rounding(pivot: f64, diagonal: f64, scale: f64) -> bool {
    pivot > PIVOT_SHARE * diagonal && pivot > ROUNDING_SHARE * scale
}

/// Returns the largest magnitude of the entries of the linear block, kg, for `k < 3`, or of the angular
/// block, kg m², for other `k`.
fn scale(inertia: &Matrix6<f64>, k: usize) -> f64 {
    let start = if k < 3 { 0 } else { 3 };
    inertia.fixed_view::<3, 3>(start, start).amax()
}

/// Returns `[[m 1, −m c×], [m c×, I − m c× c×]]`, linear before angular, with the mass `m`, centre of mass
/// `c` and inertia `I` about it of a body, in body axes.
fn inertia_about_origin(node: &Node) -> Matrix6<f64> {
    let c = node.com.to_nalgebra().cross_matrix();
    let about_origin = node.about_com.to_nalgebra() - c * c * node.mass;
    blocks(Matrix3::identity() * node.mass, c * -node.mass, c * node.mass, about_origin)
}

/// Returns the matrix that transforms a motion from the axes and origin of the parent to those of the body,
/// with the joint at `angle`, rad (m): `[[Rᵀ, −Rᵀ p×], [0, Rᵀ]]`, where `R` and `p` are the rotation and the
/// position of the body in the parent.
fn motion_transform(node: &Node, angle: f64) -> Matrix6<f64> {
    let (mut rot, mut pos) = (node.rot_pk.to_nalgebra(), node.pos_pk.to_nalgebra());
    match node.axis {
        Axis::Revolute => rot *= Rotation3::from_axis_angle(&Vector3::z_axis(), angle).into_inner(),
        Axis::Prismatic => pos += rot.column(2) * angle,
    }
    let r = rot.transpose();
    blocks(r, -r * pos.cross_matrix(), Matrix3::zeros(), r)
}

fn blocks(a: Matrix3<f64>, b: Matrix3<f64>, c: Matrix3<f64>, d: Matrix3<f64>) -> Matrix6<f64> {
    let mut m = Matrix6::zeros();
    m.fixed_view_mut::<3, 3>(0, 0).copy_from(&a);
    m.fixed_view_mut::<3, 3>(0, 3).copy_from(&b);
    m.fixed_view_mut::<3, 3>(3, 0).copy_from(&c);
    m.fixed_view_mut::<3, 3>(3, 3).copy_from(&d);
    m
}
