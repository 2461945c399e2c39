//! Proof that every motion of a robot is resisted by some inertia.

use super::error::ModelError;
use super::tree::{Axis, Model};
use nalgebra::{DMatrix, Matrix3, Matrix6, Rotation3, Vector3};

/// A pivot of the mass matrix below this share of its diagonal entry is rounding.
const PIVOT_SHARE: f64 = 1e-12;

/// Refuses a robot whose mass matrix is singular wherever its joints stand.
///
/// Eliminating joints from the leaves inward leaves, as pivots, the articulated inertia that each
/// joint feels. A pivot that vanishes in several configurations drawn once vanishes in all.
pub(super) fn check_well_posed(model: &Model) -> Result<(), ModelError> {
    if model.mass() <= 0.0 {
        return Err(ModelError::NoMass);
    }
    let n = model.joint_count();
    let mut is_resisted = vec![false; n + 6];
    for round in 0..3 {
        let angles: Vec<f64> =
            (0..n).map(|j| f64::sin(1.7 * j as f64 + 2.3 * f64::from(round) + 0.4)).collect();
        let mut m = mass_matrix(model, &angles);
        for i in (0..n + 6).rev() {
            let diagonal = m[(i, i)];
            let mut pivot = diagonal;
            for k in i + 1..n + 6 {
                pivot -= m[(k, i)] * m[(k, i)] * m[(k, k)];
            }
            is_resisted[i] |= pivot > PIVOT_SHARE * diagonal;
            m[(i, i)] = if pivot > PIVOT_SHARE * diagonal { 1.0 / pivot } else { 0.0 };
            for j in 0..i {
                let mut sum = m[(i, j)];
                for k in i + 1..n + 6 {
                    sum -= m[(k, i)] * m[(k, j)] * m[(k, k)];
                }
                m[(i, j)] = sum;
            }
        }
    }
    match is_resisted.iter().rposition(|resisted| !resisted) {
        None => Ok(()),
        Some(i) if i < 6 => Err(ModelError::SingularBase { link: model.body_frame(0).name.clone() }),
        Some(i) => Err(ModelError::MasslessSubtree {
            joint: model.joints[i - 6].name.clone(),
            link: model.body_frame(i - 5).name.clone(),
        }),
    }
}

/// Lower triangle of `M = Σ Jᵀ I J` plus rotors, from dense 6 × 6 inertias: slow, plain, and
/// independent of the kernels.
fn mass_matrix(model: &Model, angles: &[f64]) -> DMatrix<f64> {
    let n = angles.len();
    let mut rot = vec![Matrix3::identity(); n + 1];
    let mut pos = vec![Vector3::zeros(); n + 1];
    let mut columns = vec![nalgebra::Vector6::zeros(); n + 1];
    let mut composite = vec![Matrix6::zeros(); n + 1];
    for (i, node) in model.nodes.iter().enumerate() {
        if i > 0 {
            let (p, tree) = (node.parent, node.rot_pk.to_nalgebra());
            pos[i] = pos[p] + rot[p] * node.pos_pk.to_nalgebra();
            rot[i] = rot[p] * tree;
            let z: Vector3<f64> = rot[i].column(2).into();
            let (linear, angular) = match node.axis {
                Axis::Revolute => {
                    rot[i] *= Rotation3::from_axis_angle(&Vector3::z_axis(), angles[i - 1]).into_inner();
                    (pos[i].cross(&z), z)
                }
                Axis::Prismatic => {
                    pos[i] += z * angles[i - 1];
                    (z, Vector3::zeros())
                }
            };
            columns[i] = nalgebra::Vector6::from_iterator(linear.iter().chain(angular.iter()).copied());
        }
        let c = (pos[i] + rot[i] * node.com.to_nalgebra()).cross_matrix();
        let about_com = rot[i] * node.about_com.to_nalgebra() * rot[i].transpose();
        let mut inertia = Matrix6::zeros();
        inertia.fixed_view_mut::<3, 3>(0, 0).copy_from(&(Matrix3::identity() * node.mass));
        inertia.fixed_view_mut::<3, 3>(0, 3).copy_from(&(-c * node.mass));
        inertia.fixed_view_mut::<3, 3>(3, 0).copy_from(&(c * node.mass));
        inertia.fixed_view_mut::<3, 3>(3, 3).copy_from(&(about_com - c * c * node.mass));
        composite[i] = inertia;
    }
    let mut m = DMatrix::zeros(n + 6, n + 6);
    for i in (1..=n).rev() {
        let parent = model.nodes[i].parent;
        let add = composite[i];
        composite[parent] += add;
        let f = composite[i] * columns[i];
        m[(i + 5, i + 5)] = columns[i].dot(&f) + model.nodes[i].rotor_inertia;
        let mut j = parent;
        while j > 0 {
            m[(i + 5, j + 5)] = columns[j].dot(&f);
            j = model.nodes[j].parent;
        }
        for k in 0..6 {
            m[(i + 5, k)] = f[k];
        }
    }
    m.view_mut((0, 0), (6, 6)).copy_from(&composite[0]);
    m
}
