//! States of eight bodies as a structure of arrays.

use super::body_index::BodyIndex;
use super::soa::{Column8, WIDTH};
use crate::spatial::{Mat3, Real, Sym3, Vec3};
use nalgebra::{Matrix3, Vector3};

/// State of one body in `W`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Mass, kg.
    pub mass: f64,
    /// Inertia about the centre of mass in body axes, kg m².
    pub inertia: Matrix3<f64>,
    /// Centre of mass in `W`, m.
    pub com: Vector3<f64>,
    /// Rotation from body axes, which are those of the body's [`Node`](crate::model::Node), to `W`.
    pub rot_wk: Matrix3<f64>,
    /// Origin of the body axes in `W`, m.
    pub origin: Vector3<f64>,
    /// Velocity of the centre of mass in `W`, m/s; zero unless an effect [reads
    /// velocities](super::Effect::reads_velocities).
    pub velocity: Vector3<f64>,
    /// Angular velocity, `W` axes, rad/s; zero unless an effect reads velocities.
    pub angular_velocity: Vector3<f64>,
}

/// Pose and velocity of bodies in `W`: centres of mass, m, and rotations from body axes to `W`.
#[derive(Clone, Debug)]
pub(crate) struct BodyMotion<T> {
    pub(crate) com: Vec3<T>,
    pub(crate) rot_wk: Mat3<T>,
    /// Velocity of the centre of mass, m/s, and angular velocity, rad/s, in `W` axes.
    pub(crate) velocity: [Vec3<T>; 2],
}

/// States of eight bodies of one system. Unused rows repeat the last body with zero mass.
#[derive(Clone, Debug)]
pub(super) struct BodyBlock {
    pub(super) mass: Column8,
    pub(super) inertia: Sym3<Column8>,
    /// Centres of mass relative to the origins of the body axes, in body axes, m.
    pub(super) com_k: Vec3<Column8>,
    pub(super) motion: BodyMotion<Column8>,
}

impl BodyBlock {
    /// Creates a block from one to eight bodies.
    pub(super) fn new(bodies: &[BodyState]) -> Self {
        let body = |i: usize| &bodies[i.min(bodies.len() - 1)];
        let vectors = |of: fn(&BodyState) -> &Vector3<f64>| Column8::vectors(|i| (*of(body(i))).into());
        let rot = |j: usize| Column8::vectors(|i| body(i).rot_wk.column(j).into_owned().into());
        let inertia = |j: usize, k: usize| Column8::of(|i| body(i).inertia[(j, k)]);
        Self {
            mass: Column8::of(|i| bodies.get(i).map_or(0.0, |body| body.mass)),
            inertia: Sym3 {
                xx: inertia(0, 0),
                yy: inertia(1, 1),
                zz: inertia(2, 2),
                xy: inertia(0, 1),
                xz: inertia(0, 2),
                yz: inertia(1, 2),
            },
            com_k: Column8::vectors(|i| body(i).rot_wk.tr_mul(&(body(i).com - body(i).origin)).into()),
            motion: BodyMotion {
                com: vectors(|body| &body.com),
                rot_wk: Mat3 { x: rot(0), y: rot(1), z: rot(2) },
                velocity: [vectors(|body| &body.velocity), vectors(|body| &body.angular_velocity)],
            },
        }
    }
}

/// Group of bodies of one system, one per SIMD lane. Unused lanes repeat the last body with zero mass.
#[derive(Clone, Copy)]
pub(super) struct LaneGroup<'a> {
    /// Body in the first lane.
    pub(super) first: BodyIndex,
    /// Row of the first body.
    pub(super) row: usize,
    /// Number of lanes in use.
    pub(super) count: usize,
    pub(super) block: &'a BodyBlock,
}

impl LaneGroup<'_> {
    /// Returns the index of the body in lane `i`.
    pub(super) fn body(&self, i: usize) -> BodyIndex {
        BodyIndex { body: self.first.body + i, ..self.first }
    }

    /// Returns the row, within its block, of the first body.
    #[inline(always)]
    pub(super) fn offset(&self) -> usize {
        self.row % WIDTH
    }

    #[inline(always)]
    fn load<S: Real>(&self) -> impl Fn(&Column8) -> S {
        let offset = self.offset();
        move |column| column.load(offset)
    }

    #[inline(always)]
    pub(super) fn masses<S: Real>(&self) -> S {
        self.load()(&self.block.mass)
    }

    #[inline(always)]
    pub(super) fn inertias<S: Real>(&self) -> Sym3<S> {
        self.block.inertia.map(self.load())
    }

    /// Returns the centres of mass in `W`, m.
    #[inline(always)]
    pub(super) fn coms<S: Real>(&self) -> Vec3<S> {
        self.block.motion.com.map(self.load())
    }

    #[inline(always)]
    pub(super) fn rot_wk<S: Real>(&self) -> Mat3<S> {
        self.block.motion.rot_wk.map(self.load())
    }

    /// Returns the velocities of the centres of mass, m/s, and the angular velocities, rad/s, in `W` axes.
    #[inline(always)]
    pub(super) fn velocities<S: Real>(&self) -> [Vec3<S>; 2] {
        let [linear, angular] = &self.block.motion.velocity;
        [linear.map(self.load()), angular.map(self.load())]
    }
}
