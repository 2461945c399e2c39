//! Forces and torques on the bodies of a robot, side by side.

use super::EnvironmentError;
use super::eight::{Eight, WIDTH, store};
use crate::spatial::{Mat3, Real, Vec3};
use nalgebra::Vector3;
use std::ops::{Add, Mul};

/// Force through a body's centre of mass and torque about it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force, `W` axes, N.
    pub force: Vector3<f64>,
    /// Torque about the centre of mass, `W` axes, N m.
    pub torque: Vector3<f64>,
}

/// One wrench on each body of a robot, base first.
#[derive(Clone, Debug)]
pub struct Wrenches {
    count: usize,
    blocks: Vec<Push<Eight>>,
}

/// A force through the centre of mass and a torque about it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Push<T> {
    pub(crate) force: Vec3<T>,
    pub(crate) torque: Vec3<T>,
}

impl Wrenches {
    /// None on any of `count` bodies.
    pub fn new(count: usize) -> Self {
        Self { count, blocks: vec![Push::default(); count.div_ceil(WIDTH)] }
    }

    /// How many bodies there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are no bodies.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// None any more.
    pub fn clear(&mut self) {
        self.blocks.fill(Push::default());
    }

    /// That on one body; none where there is no such body.
    pub fn get(&self, body: usize) -> Option<Wrench> {
        let (push, i) = (self.blocks.get(body / WIDTH).filter(|_| body < self.count)?, body % WIDTH);
        let vector = |rows: &Vec3<Eight>| rows.map(|row| row.get(i)).to_nalgebra();
        Some(Wrench { force: vector(&push.force), torque: vector(&push.torque) })
    }

    /// All of them, base first.
    pub fn iter(&self) -> impl Iterator<Item = Wrench> {
        (0..self.count).filter_map(|body| self.get(body))
    }

    /// Adds one to what is on a body.
    ///
    /// # Errors
    /// [`EnvironmentError::UnknownBody`].
    pub fn add(&mut self, body: usize, wrench: Wrench) -> Result<(), EnvironmentError> {
        if body >= self.count {
            return Err(EnvironmentError::UnknownBody { body, count: self.count });
        }
        let Wrench { force, torque } = wrench;
        self.add_lanes(body, Push::<f64> { force: force.into(), torque: torque.into() });
        Ok(())
    }

    /// Adds pushes to those on as many bodies as `S` has lanes, from `first` on.
    #[inline(always)]
    pub(super) fn add_lanes<S: Real>(&mut self, first: usize, push: Push<S>) {
        let (to, offset) = (&mut self.blocks[first / WIDTH], first % WIDTH);
        let sum = to.load(offset) + push;
        store(&mut to.force, offset, sum.force);
        store(&mut to.torque, offset, sum.torque);
    }

    /// Those on as many bodies as `S` has lanes, from `first` on.
    #[inline(always)]
    pub(crate) fn lanes<S: Real>(&self, first: usize) -> Push<S> {
        self.blocks[first / WIDTH].load(first % WIDTH)
    }
}

impl Push<Eight> {
    #[inline(always)]
    fn load<S: Real>(&self, offset: usize) -> Push<S> {
        Push {
            force: self.force.map(|row| row.load(offset)),
            torque: self.torque.map(|row| row.load(offset)),
        }
    }
}

impl<S: Real> Push<S> {
    #[inline(always)]
    pub(super) fn nothing() -> Self {
        Self { force: Vec3::zero(), torque: Vec3::zero() }
    }

    /// In the axes that `rot` leads to.
    #[inline(always)]
    pub(crate) fn turned(self, rot: &Mat3<S>) -> Self {
        Self { force: *rot * self.force, torque: *rot * self.torque }
    }
}

impl<S: Real> Add for Push<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }
}

impl<S: Real> Mul<S> for Push<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: S) -> Self {
        Self { force: self.force * s, torque: self.torque * s }
    }
}
