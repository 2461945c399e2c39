//! The bodies of a robot as effects see them, side by side.

use super::eight::{Eight, WIDTH, store};
use super::eight_bodies::{BodyMotion, EightBodies, Group};
use crate::spatial::{Real, Vec3};
use nalgebra::{Matrix3, Vector3};

/// One body of the robot, in `W`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Mass, kg.
    pub mass: f64,
    /// Inertia about the centre of mass in the body's own axes, kg m².
    pub inertia: Matrix3<f64>,
    /// Centre of mass, m.
    pub com: Vector3<f64>,
    /// Takes components in the body's own axes (those of its [`Node`](crate::model::Node)) to `W`.
    pub rot_wk: Matrix3<f64>,
    /// Origin of the body's axes, m.
    pub origin: Vector3<f64>,
    /// Velocity of the centre of mass, m/s; zero unless an effect [reads it](super::Effect::reads_velocities).
    pub velocity: Vector3<f64>,
    /// Angular velocity, `W` axes, rad/s; likewise.
    pub angular_velocity: Vector3<f64>,
}

/// The bodies of a robot, base first.
#[derive(Clone, Debug)]
pub struct Bodies {
    count: usize,
    blocks: Vec<EightBodies>,
}

impl Bodies {
    /// Puts bodies where `motion` says: as many at once as `S` has lanes, from body number `first` on.
    #[inline(always)]
    pub(crate) fn put<S: Real>(&mut self, moves: bool, motion: impl Fn(usize) -> BodyMotion<S>) {
        for first in (0..self.count).step_by(S::LANES) {
            let (to, offset) = (&mut self.blocks[first / WIDTH].motion, first % WIDTH);
            let BodyMotion { com, rot_wk, velocity: [linear, angular] } = motion(first);
            store(&mut to.com, offset, com);
            store(&mut to.rot_wk.x, offset, rot_wk.x);
            store(&mut to.rot_wk.y, offset, rot_wk.y);
            store(&mut to.rot_wk.z, offset, rot_wk.z);
            if moves {
                store(&mut to.velocity[0], offset, linear);
                store(&mut to.velocity[1], offset, angular);
            }
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// One of them, base first.
    pub fn get(&self, body: usize) -> Option<BodyState> {
        let (block, i) = (self.blocks.get(body / WIDTH).filter(|_| body < self.count)?, body % WIDTH);
        let vector = |rows: &Vec3<Eight>| rows.map(|row| row.get(i)).to_nalgebra();
        let BodyMotion { com, rot_wk, velocity: [velocity, angular_velocity], .. } = &block.motion;
        let (com, rot_wk) = (vector(com), rot_wk.map(|row| row.get(i)).to_nalgebra());
        Some(BodyState {
            mass: block.mass.get(i),
            inertia: block.inertia.map(|row| row.get(i)).to_nalgebra(),
            com,
            rot_wk,
            origin: com - rot_wk * vector(&block.com_k),
            velocity: vector(velocity),
            angular_velocity: vector(angular_velocity),
        })
    }

    /// All of them, base first.
    pub fn iter(&self) -> impl Iterator<Item = BodyState> {
        (0..self.count).filter_map(|body| self.get(body))
    }

    /// Centre of mass of the base; the origin where there is none.
    pub(super) fn com_of_base(&self) -> Vector3<f64> {
        let first = |block: &EightBodies| block.motion.com.map(|row| row.get(0)).to_nalgebra();
        self.blocks.first().map_or_else(Vector3::zeros, first)
    }

    /// Centre of mass of a robot in `W`, m: `c = Σ mₖ cₖ / Σ mₖ`.
    pub(super) fn center_of_mass(&self) -> Vec3<f64> {
        let (mut moment, mut mass) = (Vec3::zero(), 0.0);
        for EightBodies { mass: masses, motion, .. } in &self.blocks {
            moment += motion.com.map(|row| row.dot(masses));
            mass += masses.dot(&Eight::of(|_| 1.0));
        }
        moment * (1.0 / mass)
    }

    /// Groups of as many as `S` has lanes.
    #[inline(always)]
    pub(super) fn groups<S: Real>(&self) -> impl Iterator<Item = Group<'_>> {
        let group = |first| Group {
            first,
            count: (self.count - first).min(S::LANES),
            block: &self.blocks[first / WIDTH],
        };
        (0..self.count).step_by(S::LANES).map(group)
    }
}

impl FromIterator<BodyState> for Bodies {
    fn from_iter<I: IntoIterator<Item = BodyState>>(bodies: I) -> Self {
        let bodies: Vec<_> = bodies.into_iter().collect();
        Self { count: bodies.len(), blocks: bodies.chunks(WIDTH).map(EightBodies::new).collect() }
    }
}
