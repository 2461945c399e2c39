//! Eight bodies side by side.

use super::bodies::BodyState;
use super::eight::{Eight, WIDTH};
use crate::spatial::{Mat3, Real, Sym3, Vec3};
use nalgebra::Vector3;

/// Eight bodies; where there are fewer, the last one again, without mass.
#[derive(Clone, Debug)]
pub(super) struct EightBodies {
    pub(super) mass: Eight,
    pub(super) inertia: Sym3<Eight>,
    /// Centres of mass from the origins of the bodies' axes, body axes, m.
    pub(super) com_k: Vec3<Eight>,
    pub(super) motion: BodyMotion<Eight>,
}

/// Where bodies are and how they move, `W`.
#[derive(Clone, Debug)]
pub(crate) struct BodyMotion<T> {
    pub(crate) com: Vec3<T>,
    pub(crate) rot_wk: Mat3<T>,
    /// Linear, of the centre of mass, and angular.
    pub(crate) velocity: [Vec3<T>; 2],
}

impl EightBodies {
    /// At most eight bodies of a robot.
    pub(super) fn new(bodies: &[BodyState]) -> Self {
        let body = |i: usize| &bodies[i.min(bodies.len() - 1)];
        let vectors = |of: fn(&BodyState) -> &Vector3<f64>| Eight::vectors(|i| (*of(body(i))).into());
        let rot = |j: usize| Eight::vectors(|i| body(i).rot_wk.column(j).into_owned().into());
        let inertia = |j: usize, k: usize| Eight::of(|i| body(i).inertia[(j, k)]);
        Self {
            mass: Eight::of(|i| bodies.get(i).map_or(0.0, |body| body.mass)),
            inertia: Sym3 {
                xx: inertia(0, 0),
                yy: inertia(1, 1),
                zz: inertia(2, 2),
                xy: inertia(0, 1),
                xz: inertia(0, 2),
                yz: inertia(1, 2),
            },
            com_k: Eight::vectors(|i| body(i).rot_wk.tr_mul(&(body(i).com - body(i).origin)).into()),
            motion: BodyMotion {
                com: vectors(|body| &body.com),
                rot_wk: Mat3 { x: rot(0), y: rot(1), z: rot(2) },
                velocity: [vectors(|body| &body.velocity), vectors(|body| &body.angular_velocity)],
            },
        }
    }
}

/// As many bodies as there are lanes, or the rest of them: the last one then fills the lanes left over.
#[derive(Clone, Copy)]
pub(super) struct Group<'a> {
    /// Index of the first.
    pub(super) first: usize,
    /// How many there are.
    pub(super) count: usize,
    pub(super) block: &'a EightBodies,
}

impl Group<'_> {
    /// Where it stands in its block.
    #[inline(always)]
    pub(super) fn offset(&self) -> usize {
        self.first % WIDTH
    }

    #[inline(always)]
    fn load<S: Real>(&self) -> impl Fn(&Eight) -> S {
        let offset = self.offset();
        move |row| row.load(offset)
    }

    #[inline(always)]
    pub(super) fn masses<S: Real>(&self) -> S {
        self.load()(&self.block.mass)
    }

    #[inline(always)]
    pub(super) fn inertias<S: Real>(&self) -> Sym3<S> {
        self.block.inertia.map(self.load())
    }

    /// Centres of mass.
    #[inline(always)]
    pub(super) fn coms<S: Real>(&self) -> Vec3<S> {
        self.block.motion.com.map(self.load())
    }

    #[inline(always)]
    pub(super) fn rot_wk<S: Real>(&self) -> Mat3<S> {
        self.block.motion.rot_wk.map(self.load())
    }

    /// Velocities of the centres of mass, and angular velocities.
    #[inline(always)]
    pub(super) fn velocities<S: Real>(&self) -> [Vec3<S>; 2] {
        let [linear, angular] = &self.block.motion.velocity;
        [linear.map(self.load()), angular.map(self.load())]
    }
}
