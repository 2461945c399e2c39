//! Reduced model of a robot that is connected to other robots whose models its controllers use.
//!
//! The controllers treat the links beyond a grasp as links of their robot, connected by additional joints
//! that have no motors. Eliminating these joints yields a reduced model of the robot's own joints, which all
//! laws can use unchanged.

use super::looped_dynamics::Looped;
use super::pseudo_inverse::ROWS;
use crate::dynamics::{Data, FreeFloating, free_floating_frame, free_floating_recursion, kinematics};
use crate::model::{BASE_NQ, Model};
use crate::spatial::{Motion, Scalar, cholesky_factor, cholesky_solve, dot};

/// Kinematic tree of a robot and of the robots connected to it whose models its controllers use, rooted at
/// the robot's base.
#[derive(Debug)]
pub struct KnownTree {
    /// Model of the tree.
    pub model: Model,
    /// Kinematics and external wrenches of the tree.
    pub data: Data<f64>,
    /// Configuration of the tree, `(nq,)`, m and rad.
    pub q: Vec<f64>,
    /// Velocity of the tree, `(nv,)`, m/s and rad/s.
    pub v: Vec<f64>,
    /// For each joint of the robot, its index in the tree.
    own: Vec<usize>,
    /// Indices of all other joints of the tree, `(p,)`.
    others: Vec<usize>,
    /// For each frame of the robot, its index in the tree.
    frames: Vec<usize>,
    full: FreeFloating<f64>,
    /// Factor of `M_PP`, `(p, p)`, with the symbols of [`KnownTree::reduce`].
    factor: Vec<f64>,
    /// Transpose of `M_PP⁻¹ M_PO`: one row per joint of the robot, `(n, p)`.
    gain: Vec<f64>,
    /// `M_PP⁻¹ c_P`, `(p,)`, rad/s² (m/s²).
    bias: Vec<f64>,
    /// `M_PP⁻¹ Q_P`, `(p,)`, rad/s² (m/s²).
    external: Vec<f64>,
    /// Solver for the torques if the tree has closed loops; otherwise `None`.
    pub(super) looped: Option<Looped<f64>>,
}

impl KnownTree {
    /// Creates the tree from its model; `own` and `frames` are the indices, in the tree, of the joints and
    /// the frames of the robot. `loops` contains, for each closure of the tree, the name by which controls
    /// refer to it ([`InternalForce::closure`](super::InternalForce)), or `None` without such a name;
    /// `controls` is the number of controls.
    pub fn new(
        model: Model,
        own: Vec<usize>,
        frames: Vec<usize>,
        loops: Vec<Option<String>>,
        controls: usize,
    ) -> Self {
        let others: Vec<usize> = (0..model.joint_count()).filter(|joint| !own.contains(joint)).collect();
        let zeros = |count: usize| vec![0.0; count];
        let (n, p) = (own.len(), others.len());
        Self {
            data: Data::new(&model),
            q: zeros(model.nq()),
            v: zeros(model.nv()),
            looped: Looped::new(&model, own.clone(), loops, controls),
            full: FreeFloating::new(&model),
            factor: zeros(p * p),
            gain: zeros(n * p),
            bias: zeros(p),
            external: zeros(p),
            own,
            others,
            frames,
            model,
        }
    }

    /// Computes the kinematics of the tree and sets its external wrenches to zero.
    pub fn update_kinematics(&mut self) {
        kinematics(&self.model, &mut self.data, &self.q, &self.v);
        self.data.clear_external();
    }

    /// Writes the inertia, bias and external forces of the reduced model of the robot's own joints `O` to
    /// `out`. The other joints `P` have no motor torques, so that their accelerations are
    /// `q̈_P = M_PP⁻¹ (Q_P − c_P − M_PO q̈_O)`. `M`, `c` and `Q` denote `M*`, `c*` and `Q*` of the tree
    /// ([`FreeFloating`]); `Q_P` includes the torques of the springs of the joints `P`; those of the joints
    /// `O` are not included.
    ///
    /// `M' = M_OO − M_OP M_PP⁻¹ M_PO`,  `c' = c_O − M_OP M_PP⁻¹ c_P`,  `Q' = Q_O − M_OP M_PP⁻¹ Q_P`
    pub(super) fn reduce<S: Scalar>(&mut self, out: &mut FreeFloating<S>) {
        let Self { model, data, q, v, full, own, others, factor, gain, bias, external, looped, .. } = self;
        free_floating_recursion(model, data, q, v, 0, full);
        for (j, spring) in model.springs().filter(|(j, _)| others.contains(j)) {
            full.external[j] += spring.torque(q[BASE_NQ + j]);
        }
        if let Some(looped) = looped {
            looped.update(model, data, full);
        }
        let (all, n, p) = (model.joint_count(), own.len(), others.len());
        for (row, &i) in others.iter().enumerate() {
            others.iter().enumerate().for_each(|(k, &j)| factor[row * p + k] = full.inertia[i * all + j]);
            (bias[row], external[row]) = (full.bias[i], full.external[i]);
        }
        cholesky_factor(factor, p);
        cholesky_solve(factor, p, bias);
        cholesky_solve(factor, p, external);
        for (row, &i) in own.iter().enumerate() {
            let gain = &mut gain[row * p..(row + 1) * p];
            gain.iter_mut().zip(&*others).for_each(|(g, &j)| *g = full.inertia[i * all + j]);
            out.bias[row] = S::of(full.bias[i] - dot(gain, bias));
            out.external[row] = S::of(full.external[i] - dot(gain, external));
            cholesky_solve(factor, p, gain);
        }
        for (row, &i) in own.iter().enumerate() {
            for (column, &j) in own.iter().enumerate() {
                let coupling: f64 =
                    others.iter().zip(&gain[column * p..]).map(|(&k, g)| full.inertia[i * all + k] * g).sum();
                out.inertia[row * n + column] = S::of(full.inertia[i * all + j] - coupling);
            }
        }
    }

    /// Computes the pose, the twist, the Jacobian `J'` and the drift `d'` of a frame (index in the robot) in
    /// W. Requires the results of [`KnownTree::reduce`] in `out`.
    ///
    /// `J' = J_O − J_P M_PP⁻¹ M_PO`, `d' = d + J_P M_PP⁻¹ (Q_P − c_P)`, with the generalized Jacobian `J` and
    /// the drift `d` of the tree.
    pub(super) fn reduce_frame<S: Scalar>(&mut self, frame: usize, out: &mut FreeFloating<S>) {
        let Self { model, data, q, v, full, own, others, frames, gain, bias, external, .. } = self;
        free_floating_frame(model, data, q, v, frames[frame], full);
        let (all, n, p) = (model.joint_count(), own.len(), others.len());
        let mut drift = [0.0; 6];
        full.drift.write(&mut drift);
        for (i, row) in full.jacobian.chunks_exact(all).enumerate() {
            for (column, &j) in own.iter().enumerate() {
                let reaction: f64 = others.iter().zip(&gain[column * p..]).map(|(&k, g)| row[k] * g).sum();
                out.jacobian[i * n + column] = S::of(row[j] - reaction);
            }
            drift[i] +=
                others.iter().enumerate().map(|(k, &j)| row[j] * (external[k] - bias[k])).sum::<f64>();
        }
        out.drift = lift(Motion::from_slice(&drift));
        out.velocity = lift(full.velocity);
        out.pose.rot_wf = full.pose.rot_wf.map(|x| S::of(*x));
        out.pose.pos_w = full.pose.pos_w.map(|x| S::of(*x));
    }

    /// Returns the drift `d`, m/s² and rad/s² in W axes, that the frame of the last
    /// [`KnownTree::reduce_frame`] would have if the loops of the tree were open.
    pub(super) fn drift(&self) -> Motion<f64> {
        self.full.drift
    }

    /// Adds a task of the frame of the last [`KnownTree::reduce_frame`] to the solver for closed loops, with
    /// the acceleration `p̈r − d`, m/s² and rad/s², and the damping threshold `λ₀`.
    pub(super) fn add_task(&mut self, acceleration: [f64; ROWS], damping: f64) {
        if let Some(looped) = &mut self.looped {
            looped.dynamics.add_task(&self.full.jacobian, acceleration, damping);
        }
    }

    /// Computes the Jacobian of the frame of the last [`KnownTree::reduce_frame`] with respect to the
    /// `driven` joints (indices in the robot) while the loops of the tree are closed; see
    /// [`LoopedDynamics::driven_jacobian`](super::looped_dynamics::LoopedDynamics::driven_jacobian).
    pub(super) fn driven_jacobian(&mut self, driven: &[usize], out: &mut [f64]) {
        if let Some(looped) = &mut self.looped {
            looped.dynamics.driven_jacobian(&self.full.jacobian, driven, out);
        }
    }
}

fn lift<S: Scalar>(motion: Motion<f64>) -> Motion<S> {
    Motion::new(motion.linear.map(|x| S::of(*x)), motion.angular.map(|x| S::of(*x)))
}
