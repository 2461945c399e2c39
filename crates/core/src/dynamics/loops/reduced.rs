//! Reduced model of a free-floating robot with closed loops, in terms of independent joints.

use super::independent::IndependentJoints;
use super::{ClosedLoops, rows};
use crate::dynamics::data::Data;
use crate::dynamics::external::FrameWrench;
use crate::dynamics::free_floating::{FreeFloating, free_floating};
use crate::model::{Axis, Closure, Constraint, Model};

/// Reduced equations of a robot with closed loops, `M ÿ + c = Gᵀ τ + Q`, and task acceleration `ẍ = J ÿ + d`
/// of one frame, in terms of the accelerations `ÿ` of independent joints.
///
/// `q̇ = G ẏ`, `q̈ = G ÿ + g`, `M = Gᵀ M* G`, `c = Gᵀ (c* + M* g)`, `Q = Gᵀ Q*`, `J = Jg G`, `d = d* + Jg g`,
/// with the symbols of [`FreeFloating`], whose drift is `d*`.
#[derive(Clone, Debug)]
pub struct ConstrainedFreeFloating {
    /// Independent joints with `G` and `g`.
    pub joints: IndependentJoints,
    /// `M`, row major `(f, f)`, in kg, kg m and kg m².
    pub inertia: Vec<f64>,
    /// `c`, `(f,)`, N m (N).
    pub bias: Vec<f64>,
    /// `Q`, `(f,)`, N m (N).
    pub external: Vec<f64>,
    /// `J`, row major `(6, f)`, rows in W axes, linear first.
    pub jacobian: Vec<f64>,
    /// `d`, `(6,)`, m/s² and rad/s², in W axes.
    pub drift: [f64; 6],
}

/// Computes the reduced model [`ConstrainedFreeFloating`] with one frame (index) as the task. The
/// configuration `q`, `(nq,)`, must close the loops, and the velocity `v`, `(nv,)`, must satisfy their
/// constraints.
///
/// The independent joints are chosen among those in `preferred` (indices) as far as these are independent.
/// The others are chosen among all joints, preferably those that do not mimic another joint.
///
/// Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, sections 3.2 and 8.8.
pub fn constrained_free_floating(
    model: &Model,
    (q, v): (&[f64], &[f64]),
    frame: usize,
    external: &[FrameWrench<f64>],
    preferred: &[usize],
) -> ConstrainedFreeFloating {
    let (mut data, mut tree) = (Data::new(model), FreeFloating::new(model));
    let mut loops = ClosedLoops::new(model, model.closures());
    free_floating(model, &mut data, q, v, frame, external, &mut tree);
    let (n, m) = (model.joint_count(), loops.count());
    let (mut jacobian, mut right) = (vec![0.0; m * n], vec![0.0; m]);
    loops.joint_constraints(model, &data, &mut jacobian, &mut right);
    let mut class: Vec<u8> = (0..n).map(|j| 2 * u8::from(preferred.contains(&j))).collect();
    add_leaders(model, &mut class);
    let mut joints = IndependentJoints::default();
    joints.solve((&jacobian, &right), &class, [&loops.length_rows(), &length_joints(model)]);

    let f = joints.count();
    let mut out = ConstrainedFreeFloating {
        inertia: Vec::new(),
        bias: vec![0.0; f],
        external: vec![0.0; f],
        jacobian: vec![0.0; 6 * f],
        drift: [0.0; 6],
        joints,
    };
    out.joints.reduce_matrix(&tree.inertia, &mut out.inertia);
    out.joints.reduce_rows(&tree.jacobian, &mut out.jacobian);
    let apply = |rows: &[f64], i: usize| -> f64 {
        rows[i * n..(i + 1) * n].iter().zip(&out.joints.drift).map(|(x, g)| x * g).sum()
    };
    let load: Vec<f64> = (0..n).map(|j| tree.bias[j] + apply(&tree.inertia, j)).collect();
    tree.drift.write(&mut out.drift);
    out.drift.iter_mut().enumerate().for_each(|(i, drift)| *drift += apply(&tree.jacobian, i));
    for column in 0..f {
        out.bias[column] = out.joints.reduced_effort(column, |j| load[j]);
        out.external[column] = out.joints.reduced_effort(column, |j| tree.external[j]);
    }
    out
}

/// Adds one to the class of every joint that does not mimic another, so that mimic joints become dependent
/// first.
pub(crate) fn add_leaders(model: &Model, class: &mut [u8]) {
    class.iter_mut().for_each(|class| *class += 1);
    for closure in model.closures() {
        if let Constraint::Mimic { joint, .. } = closure.constraint {
            class[joint] -= 1;
        }
    }
}

/// Returns for each joint, `(n,)`, whether its position is a length, m.
pub(crate) fn length_joints(model: &Model) -> Vec<bool> {
    model.nodes()[1..].iter().map(|node| node.axis == Axis::Prismatic).collect()
}

impl<S> ClosedLoops<S> {
    /// Returns for each constraint, `(m,)`, whether it is treated as a length, m. The constraints of mimic
    /// joints are not, even if these joints are prismatic.
    pub fn length_rows(&self) -> Vec<bool> {
        let is_length = |closure: &Closure, row: usize| !rows::is_angular(closure, row);
        let rows = |closure| (0..Closure::rows(closure)).map(move |row| is_length(closure, row));
        self.closures.iter().flat_map(rows).collect()
    }
}
