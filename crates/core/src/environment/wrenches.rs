//! Forces and torques on the bodies of all systems, in blocks of eight.

use super::bodies::Bodies;
use super::body_index::{BlockLayout, BodyIndex, SystemRows};
use super::error::EnvironmentError;
use super::soa::{Column8, WIDTH, store};
use crate::spatial::{Mat3, Real, Vec3};
use nalgebra::Vector3;
use std::ops::{Add, Mul};

/// Force through the centre of mass of a body, and torque about the centre of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force, `W` axes, N.
    pub force: Vector3<f64>,
    /// Torque about the centre of mass, `W` axes, N m.
    pub torque: Vector3<f64>,
}

/// Wrenches on all bodies of all systems, one per body.
#[derive(Clone, Debug)]
pub struct Wrenches {
    pub(super) layout: BlockLayout,
    blocks: Vec<WrenchLanes<Column8>>,
}

/// Forces through the centres of mass of several bodies, N, and torques about the centres of mass, N m, one
/// body per lane.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WrenchLanes<T> {
    pub(crate) force: Vec3<T>,
    pub(crate) torque: Vec3<T>,
}

impl Wrenches {
    /// Creates zero wrenches; `counts` holds the number of bodies of each system.
    pub fn new(counts: &[usize]) -> Self {
        Self::with(BlockLayout::new(counts))
    }

    /// Creates zero wrenches on `bodies`.
    pub(crate) fn on(bodies: &Bodies) -> Self {
        Self::with(bodies.layout.clone())
    }

    fn with(layout: BlockLayout) -> Self {
        Self { blocks: vec![WrenchLanes::default(); layout.block_count()], layout }
    }

    /// Returns the number of bodies of all systems together.
    pub fn len(&self) -> usize {
        self.layout.body_count()
    }

    /// Returns true if no system has a body.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Sets all wrenches to zero.
    pub fn clear(&mut self) {
        self.blocks.fill(WrenchLanes::default());
    }

    /// Returns the wrench on a body, or `None` if the body does not exist. A plain number selects a body of
    /// the first system.
    pub fn get(&self, body: impl Into<BodyIndex>) -> Option<Wrench> {
        let row = self.layout.row(body.into())?;
        let (block, i) = (&self.blocks[row / WIDTH], row % WIDTH);
        let vector = |columns: &Vec3<Column8>| columns.map(|column| column.get(i)).to_nalgebra();
        Some(Wrench { force: vector(&block.force), torque: vector(&block.torque) })
    }

    /// Returns the wrenches on all bodies, system by system; the first body of a system is its base.
    pub fn iter(&self) -> impl Iterator<Item = Wrench> {
        self.layout.bodies().filter_map(|body| self.get(body))
    }

    /// Returns the wrenches on the bodies of the system with index `system` in the run, beginning with its
    /// base.
    pub(crate) fn of_system(&self, system: usize) -> impl Iterator<Item = Wrench> {
        let SystemRows { number, count, .. } = self.layout.systems()[system];
        (0..count).filter_map(move |body| self.get(BodyIndex { system: number, body }))
    }

    /// Adds `wrench` to the present wrench on a body. A plain number selects a body of the first system.
    ///
    /// # Errors
    /// [`EnvironmentError::UnknownBody`] if the body does not exist.
    pub fn add(&mut self, body: impl Into<BodyIndex>, wrench: Wrench) -> Result<(), EnvironmentError> {
        let body = body.into();
        let unknown = || EnvironmentError::UnknownBody { body, known: self.layout.known(body.system) };
        let row = self.layout.row(body).ok_or_else(unknown)?;
        let Wrench { force, torque } = wrench;
        self.add_lanes(row, WrenchLanes::<f64> { force: force.into(), torque: torque.into() });
        Ok(())
    }

    /// Adds `wrenches` to those on consecutive bodies, one per lane of `S`, starting at row `row`.
    #[inline(always)]
    pub(super) fn add_lanes<S: Real>(&mut self, row: usize, wrenches: WrenchLanes<S>) {
        let (to, offset) = (&mut self.blocks[row / WIDTH], row % WIDTH);
        let sum = to.load(offset) + wrenches;
        store(&mut to.force, offset, sum.force);
        store(&mut to.torque, offset, sum.torque);
    }

    /// Returns the wrenches on consecutive bodies of the system with index `system` in the run, one per lane
    /// of `S`, starting with body `first`.
    #[inline(always)]
    pub(crate) fn lanes<S: Real>(&self, system: usize, first: usize) -> WrenchLanes<S> {
        let row = self.layout.systems()[system].first + first;
        self.blocks[row / WIDTH].load(row % WIDTH)
    }
}

impl WrenchLanes<Column8> {
    #[inline(always)]
    fn load<S: Real>(&self, offset: usize) -> WrenchLanes<S> {
        WrenchLanes {
            force: self.force.map(|column| column.load(offset)),
            torque: self.torque.map(|column| column.load(offset)),
        }
    }
}

impl<S: Real> WrenchLanes<S> {
    #[inline(always)]
    pub(super) fn zero() -> Self {
        Self { force: Vec3::zero(), torque: Vec3::zero() }
    }

    /// Returns the wrenches in other axes: the forces `R f` and torques `R τ` with the rotation matrix `rot`,
    /// `R`.
    #[inline(always)]
    pub(crate) fn rotated(self, rot: &Mat3<S>) -> Self {
        Self { force: *rot * self.force, torque: *rot * self.torque }
    }
}

impl<S: Real> Add for WrenchLanes<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }
}

impl<S: Real> Mul<S> for WrenchLanes<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: S) -> Self {
        Self { force: self.force * s, torque: self.torque * s }
    }
}
