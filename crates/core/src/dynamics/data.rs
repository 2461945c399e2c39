//! What the algorithms compute, allocated once per model.

use super::kinematics::place_inertia;
use crate::model::Model;
use crate::spatial::{ArticulatedInertia, Force, Mat3, Motion, Real, RigidInertia, SpatialInertia, Vec3};

/// Quantities of one body in base axes B, about the body's own origin, which lies on its joint's axis.
///
/// Moments about the base's origin would lose `(L/l)²` digits of a body of size `l` at a distance `L`.
#[derive(Clone, Copy, Debug)]
pub struct BodyData<S> {
    /// Takes the body's components to B. Set by [`positions`](super::positions).
    pub rot_bk: Mat3<S>,
    /// Its origin, from the base's. Set by [`positions`](super::positions), m.
    pub pos_b: Vec3<S>,
    /// Its origin, from the parent's. Set by [`positions`](super::positions), m.
    pub offset: Vec3<S>,
    /// Its mass, its centre of mass and its inertia about it. Set by [`positions`](super::positions).
    pub inertia: RigidInertia<S>,
    /// Its twist. Set by [`kinematics`](super::kinematics).
    pub velocity: Motion<S>,
    /// Wrench from outside. Set by [`apply_external`](super::apply_external) or the simulation;
    /// every recursion reads it.
    pub external: Force<S>,
    /// External wrenches on its subtree. Set by [`free_floating`](super::free_floating).
    pub outside: Force<S>,
    /// Spatial acceleration: velocity products alone, or all of it.
    pub acceleration: Motion<S>,
    /// What of it joints and base add to the velocity products. Set by ABA where a tree forks.
    pub response: Motion<S>,
    /// Force through its joint, or `I S`, or the bias of the articulated body (of a locked joint).
    pub force: Force<S>,
    /// Inertia of the subtree, rigid. Set by CRBA and `free_floating`.
    pub composite: SpatialInertia<S>,
    /// Inertia of the subtree, articulated. Set by ABA, of the base alone.
    pub articulated: ArticulatedInertia<S>,
    /// `U = IA S`, about the parent's origin. Set by ABA.
    pub reach: Force<S>,
    /// `1 / (Sᵀ U + rotor)`. Set by ABA.
    pub inverse_pivot: S,
    /// `τ − Sᵀ p`, of a locked joint the torque that holds it. Set by ABA.
    pub drive: S,
}

impl<S: Real> BodyData<S> {
    /// The joint's axis: z of the body's own axes.
    #[inline(always)]
    pub fn axis(&self) -> Vec3<S> {
        self.rot_bk.z
    }

    /// Centre of mass from the base's origin, m.
    #[inline(always)]
    pub fn com_b(&self) -> Vec3<S> {
        self.pos_b + self.inertia.com
    }

    /// Inertia about the base's origin.
    #[inline(always)]
    pub fn inertia_b(&self) -> SpatialInertia<S> {
        SpatialInertia::at_com(self.inertia.mass, self.com_b(), self.inertia.about_com)
    }
}

/// Workspace of all algorithms for one state (or one set of lanes).
#[derive(Clone, Debug)]
pub struct Data<S> {
    /// One entry per body, base first.
    pub bodies: Vec<BodyData<S>>,
    /// Sine and cosine of each joint's position. Set by [`positions`](super::positions).
    pub turns: Vec<(S, S)>,
    /// `L` below the diagonal and `D⁻¹` on it, `M = L D Lᵀ`, `(nv, nv)`, of robots that need it (see `dense.rs`).
    pub(super) factors: Vec<S>,
    /// Generalized forces, `(nv,)`, of the same robots.
    pub(super) efforts: Vec<S>,
}

impl<S: Real> Data<S> {
    /// Space for `model`.
    pub fn new(model: &Model) -> Self {
        let body = BodyData {
            rot_bk: Mat3::identity(),
            pos_b: Vec3::zero(),
            offset: Vec3::zero(),
            inertia: RigidInertia::default(),
            velocity: Motion::zero(),
            external: Force::zero(),
            outside: Force::zero(),
            acceleration: Motion::zero(),
            response: Motion::zero(),
            force: Force::zero(),
            composite: SpatialInertia::zero(),
            articulated: ArticulatedInertia::zero(),
            reach: Force::zero(),
            inverse_pivot: S::of(0.0),
            drive: S::of(0.0),
        };
        let (n, o) = (model.nodes().len(), S::of(0.0));
        let mut bodies = vec![body; n];
        for (node, body) in model.nodes().iter().zip(&mut bodies) {
            body.inertia.mass = S::of(node.mass);
        }
        place_inertia(&model.nodes()[0], &mut bodies[0]);
        let nv = if model.is_heavy_on_light() { model.nv() } else { 0 };
        Self { bodies, turns: vec![(o, o); n - 1], factors: vec![o; nv * nv], efforts: vec![o; nv] }
    }

    /// Takes all external wrenches away.
    #[inline(always)]
    pub fn clear_external(&mut self) {
        for body in &mut self.bodies {
            body.external = Force::zero();
        }
    }
}
