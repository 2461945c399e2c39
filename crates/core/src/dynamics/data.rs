//! Workspace of the algorithms, allocated once per model.

use crate::model::{Model, Node};
use crate::spatial::{
    ArticulatedInertia, Force, Mat3, Motion, Real, RigidInertia, SpatialInertia, Sym3, Vec3,
};

/// Quantities of one body in base axes B, about the origin of the body, which is a point on its joint axis.
/// `S` is the motion subspace of its joint.
///
/// If moments were taken about the origin of the base instead, rounding errors would be `(L/l)²` times larger
/// for a body of size `l` at a distance `L` from the base.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))] // one cache line, so that equal fields of all bodies are equally aligned
pub struct BodyData<S> {
    /// Rotation from body axes to B. Set by [`positions`](super::positions).
    pub rot_bk: Mat3<S>,
    /// Position of the body origin relative to the base origin, m. Set by [`positions`](super::positions).
    pub pos_b: Vec3<S>,
    /// Position of the body origin relative to the parent origin, m. Set by [`positions`](super::positions).
    pub offset: Vec3<S>,
    /// Mass, centre of mass and inertia about the centre of mass. [`Data::new`] sets the masses and all
    /// values of the base; [`positions`](super::positions) sets the rest.
    pub inertia: RigidInertia<S>,
    /// Twist of the body, m/s and rad/s. Set by [`kinematics`](super::kinematics).
    pub velocity: Motion<S>,
    /// External wrench on the body, N and N m. Set by [`apply_external`](super::apply_external) or by the
    /// simulation; every algorithm that computes forces or accelerations reads this wrench.
    pub external: Force<S>,
    /// Sum of the external wrenches on the subtrees of those children that do not follow this body directly
    /// in the numbering. Used by [`free_floating`](super::free_floating) at forks, which are bodies with such
    /// children.
    pub subtree_external: Force<S>,
    /// Spatial acceleration, m/s² and rad/s²: either its velocity-product part or the complete acceleration,
    /// depending on the algorithm that ran last.
    pub acceleration: Motion<S>,
    /// Difference between the acceleration and the bias acceleration for `q̈ = 0`, or for the given `q̈` of
    /// locked joints, m/s² and rad/s². Set by ABA for the base and at forks.
    pub delta_acceleration: Motion<S>,
    /// Force through the joint (RNEA), `I^c S` with the composite inertia `I^c` (CRBA and `free_floating`),
    /// or the articulated bias force `pA` of the base and of bodies with a locked joint (ABA).
    pub force: Force<S>,
    /// Sum of the rigid inertias of subtrees, stored by CRBA and `free_floating` at forks as in
    /// `subtree_external`. For the base, `free_floating` stores the inertia of the whole robot.
    pub composite: SpatialInertia<S>,
    /// Articulated-body inertia `IA`. Set by ABA for the base; at forks, the sum of the children's
    /// contributions, stored as in `subtree_external`.
    pub articulated: ArticulatedInertia<S>,
    /// `U = IA S`, about the origin of the parent. Set by ABA.
    pub u_force: Force<S>,
    /// `1/D = 1 / (Sᵀ U + rotor)`, zero for a locked joint. Set by ABA.
    pub d_inverse: S,
    /// `u = τ − Sᵀ pA`, the joint effort minus the component of the articulated bias force along the joint, N
    /// m or N. Set by ABA.
    pub joint_bias: S,
    /// Constraint torque (force) `λ` that keeps the acceleration of a locked joint at its given value, or at
    /// zero, N m (N). Set by forward dynamics for locked joints.
    pub holding_torque: S,
}

impl<S: Real> BodyData<S> {
    /// Returns the joint axis, which is the z axis of the body, in base axes.
    #[inline(always)]
    pub fn axis(&self) -> Vec3<S> {
        self.rot_bk.z
    }

    /// Returns the centre of mass relative to the base origin, m.
    #[inline(always)]
    pub fn com_b(&self) -> Vec3<S> {
        self.pos_b + self.inertia.com
    }

    /// Returns the inertia about the base origin, in base axes.
    #[inline(always)]
    pub fn inertia_b(&self) -> SpatialInertia<S> {
        SpatialInertia::at_com(self.inertia.mass, self.com_b(), self.inertia.about_com)
    }

    /// Sets the centre of mass and the inertia of the body in base axes from those in body axes. For the base
    /// itself both are constant.
    #[inline(always)]
    pub(super) fn rotate_inertia(&mut self, node: &Node) {
        self.inertia.com = self.rot_bk * Vec3::of(&node.com);
        self.inertia.about_com = Sym3::of(&node.about_com).rotate(&self.rot_bk);
    }
}

/// Workspace of all algorithms for one state, or for one group of SIMD lanes.
#[derive(Clone, Debug)]
pub struct Data<S> {
    /// One entry per body, base first.
    pub bodies: Vec<BodyData<S>>,
    /// Sine and cosine of each joint position. Set by [`positions`](super::positions).
    pub joint_sin_cos: Vec<(S, S)>,
    /// Factors of `M = L D Lᵀ`, `(nv, nv)`: `L` below the diagonal, `D⁻¹` on the diagonal. Allocated only for
    /// robots whose forward dynamics use the mass matrix (`dense.rs`).
    pub(super) factors: Vec<S>,
    /// Generalized forces, `(nv,)`, N and N m. Allocated for the same robots as `factors`.
    pub(super) forces: Vec<S>,
}

impl<S: Real> Data<S> {
    /// Allocates the workspace for `model`.
    pub fn new(model: &Model) -> Self {
        let body = BodyData {
            rot_bk: Mat3::identity(),
            pos_b: Vec3::zero(),
            offset: Vec3::zero(),
            inertia: RigidInertia::default(),
            velocity: Motion::zero(),
            external: Force::zero(),
            subtree_external: Force::zero(),
            acceleration: Motion::zero(),
            delta_acceleration: Motion::zero(),
            force: Force::zero(),
            composite: SpatialInertia::zero(),
            articulated: ArticulatedInertia::zero(),
            u_force: Force::zero(),
            d_inverse: S::of(0.0),
            joint_bias: S::of(0.0),
            holding_torque: S::of(0.0),
        };
        let (n, o) = (model.nodes().len(), S::of(0.0));
        let mut bodies = vec![body; n];
        for (node, body) in model.nodes().iter().zip(&mut bodies) {
            body.inertia.mass = S::of(node.mass);
        }
        bodies[0].rotate_inertia(&model.nodes()[0]);
        let nv = if model.is_heavy_on_light() { model.nv() } else { 0 };
        Self { bodies, joint_sin_cos: vec![(o, o); n - 1], factors: vec![o; nv * nv], forces: vec![o; nv] }
    }

    /// Copies the quantities of all bodies, and the sines and cosines of the joint positions, from another
    /// workspace of the same model, without allocating.
    pub(crate) fn copy_from(&mut self, from: &Self) {
        self.bodies.copy_from_slice(&from.bodies);
        self.joint_sin_cos.copy_from_slice(&from.joint_sin_cos);
    }

    /// Sets all external wrenches to zero.
    #[inline(always)]
    pub fn clear_external(&mut self) {
        for body in &mut self.bodies {
            body.external = Force::zero();
        }
    }
}
