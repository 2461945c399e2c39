//! Motion of the joints of a gripper whose closed loops couple them with the joints of a control.

use super::driven_torques::DrivenTorques;
use crate::dynamics::{ClosedLoops, Data, IndependentJoints, add_leaders, length_joints};
use crate::model::{Closure, Constraint, Model};
use crate::spatial::Scalar;

/// Rates of all joints of a robot with closed loops per rate of the joints of a control.
///
/// With the columns `G_c` of `q̇ = G ẏ` ([`IndependentJoints`]) whose independent joints are driven, and its
/// rows `G_A` of the driven joints `A`, the rates are `G_c (G_Aᵀ G_A)⁻¹ G_Aᵀ`. They are the motion that the
/// loops and mimic joints impose while only the driven joints move.
#[derive(Debug)]
pub(crate) struct FingerLoops<S> {
    loops: ClosedLoops<S>,
    /// For each constraint row, and for each joint, true if its error or position is a length, m.
    is_length: [Vec<bool>; 2],
    /// 0 for mimic joints, 1 for all others.
    leader: Vec<u8>,
    class: Vec<u8>,
    /// Constraint Jacobian, `(m, n)`, and zeros, `(m,)`.
    constraints: [Vec<f64>; 2],
    joints: IndependentJoints,
    driven: DrivenTorques,
    along: Vec<f64>,
    rates: Vec<f64>,
}

impl<S: Scalar> FingerLoops<S> {
    /// Allocates the workspace; returns `None` for a model without closed loops. The fingers of a robot whose
    /// only constraints are those of mimic joints do not need it.
    pub(crate) fn new(model: &Model) -> Option<Self> {
        let is_loop = |closure: &Closure| matches!(closure.constraint, Constraint::Frames { .. });
        if !model.closures().iter().any(is_loop) {
            return None;
        }
        let loops = ClosedLoops::new(model, model.closures());
        let (n, m) = (model.joint_count(), loops.count());
        let mut leader = vec![0; n];
        add_leaders(model, &mut leader);
        Some(Self {
            is_length: [loops.length_rows(), length_joints(model)],
            constraints: [vec![0.0; m * n], vec![0.0; m]],
            class: leader.clone(),
            leader,
            loops,
            joints: IndependentJoints::default(),
            driven: DrivenTorques::default(),
            along: Vec::new(),
            rates: Vec::new(),
        })
    }

    /// Returns the rates, row major `(n, k)`, of all `n` joints per rate of the `k` joints `driven`. Requires
    /// the kinematics in `data`.
    pub(crate) fn rates(&mut self, model: &Model, data: &Data<S>, driven: &[usize]) -> &[f64] {
        let Self {
            loops, is_length: [rows, columns], leader, class, constraints, joints, along, rates, ..
        } = self;
        let [jacobian, zeros] = constraints;
        loops.joint_jacobian(model, data, jacobian);
        class.copy_from_slice(leader);
        driven.iter().for_each(|&j| class[j] += 2);
        joints.solve((jacobian, zeros), class, [rows, columns]);
        self.driven.set(joints, driven.iter().copied(), |j| driven.contains(&j));
        let (n, f, k) = (model.joint_count(), joints.count(), driven.len());
        rates.clear();
        rates.resize(n * k, 0.0);
        for (map, rates) in joints.map.chunks_exact(f.max(1)).zip(rates.chunks_exact_mut(k)) {
            along.clear();
            along.extend(self.driven.columns.iter().map(|&c| map[c]));
            self.driven.apply(along, |place, rate| rates[place] = rate);
        }
        rates
    }
}
