//! States of the bodies of all systems, in blocks of eight.

use super::body_block::{BodyBlock, BodyMotion, BodyState, LaneGroup};
use super::body_index::{BlockLayout, BodyIndex, SystemRows};
use super::soa::{Column8, WIDTH, store};
use crate::spatial::{Real, Vec3};
use nalgebra::Vector3;

/// States of the bodies of all systems of a run.
#[derive(Clone, Debug)]
pub struct Bodies {
    pub(super) layout: BlockLayout,
    blocks: Vec<BodyBlock>,
}

impl Bodies {
    /// Stores the states of the bodies of `systems` in blocks. The first body of each system is its base.
    pub fn new(systems: &[Vec<BodyState>]) -> Self {
        Self::of(systems, 0..systems.len())
    }

    /// Stores the states of the bodies of `systems` in blocks. The first body of each system is its base;
    /// `numbers` are the numbers of the systems in the world.
    pub(crate) fn of(systems: &[Vec<BodyState>], numbers: impl Iterator<Item = usize>) -> Self {
        let layout = BlockLayout::of(numbers.zip(systems.iter().map(Vec::len)));
        let blocks = systems.iter().flat_map(|bodies| bodies.chunks(WIDTH)).map(BodyBlock::new).collect();
        Self { layout, blocks }
    }

    /// Stores the motion of all bodies of the system with index `system` in the run; velocities are stored
    /// only if `with_velocity` is true. `motion(first)` returns the motion of the bodies from body `first`
    /// on, one per lane of `S`.
    #[inline(always)]
    pub(crate) fn store_motion<S: Real>(
        &mut self,
        system: usize,
        with_velocity: bool,
        motion: impl Fn(usize) -> BodyMotion<S>,
    ) {
        let SystemRows { first: start, count, .. } = self.layout.systems()[system];
        for first in (0..count).step_by(S::LANES) {
            let row = start + first;
            let (to, offset) = (&mut self.blocks[row / WIDTH].motion, row % WIDTH);
            let BodyMotion { com, rot_wk, velocity: [linear, angular] } = motion(first);
            store(&mut to.com, offset, com);
            store(&mut to.rot_wk.x, offset, rot_wk.x);
            store(&mut to.rot_wk.y, offset, rot_wk.y);
            store(&mut to.rot_wk.z, offset, rot_wk.z);
            if with_velocity {
                store(&mut to.velocity[0], offset, linear);
                store(&mut to.velocity[1], offset, angular);
            }
        }
    }

    /// Returns the number of bodies of all systems together.
    pub fn len(&self) -> usize {
        self.layout.body_count()
    }

    /// Returns true if no system has a body.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the state of a body, or `None` if it does not exist. A plain number selects a body of the
    /// first system.
    pub fn get(&self, body: impl Into<BodyIndex>) -> Option<BodyState> {
        let row = self.layout.row(body.into())?;
        let (block, i) = (&self.blocks[row / WIDTH], row % WIDTH);
        let vector = |columns: &Vec3<Column8>| columns.map(|column| column.get(i)).to_nalgebra();
        let BodyMotion { com, rot_wk, velocity: [velocity, angular_velocity], .. } = &block.motion;
        let (com, rot_wk) = (vector(com), rot_wk.map(|column| column.get(i)).to_nalgebra());
        Some(BodyState {
            mass: block.mass.get(i),
            inertia: block.inertia.map(|column| column.get(i)).to_nalgebra(),
            com,
            rot_wk,
            origin: com - rot_wk * vector(&block.com_k),
            velocity: vector(velocity),
            angular_velocity: vector(angular_velocity),
        })
    }

    /// Returns the clause of an error message that states which bodies a system has.
    pub(crate) fn known(&self, system: usize) -> String {
        self.layout.known(system)
    }

    /// Returns the indices and states of all bodies, system by system; the first body of a system is its
    /// base.
    pub fn iter(&self) -> impl Iterator<Item = (BodyIndex, BodyState)> {
        self.layout.bodies().filter_map(|index| self.get(index).map(|body| (index, body)))
    }

    /// Returns, for each system of the run, the rows of its bodies.
    pub(super) fn systems(&self) -> &[SystemRows] {
        self.layout.systems()
    }

    /// Returns the centre of mass of the base of a system in `W`, m. The system must have a body.
    pub(super) fn base_com(&self, system: &SystemRows) -> Vector3<f64> {
        let first = |block: &BodyBlock| block.motion.com.map(|column| column.get(0)).to_nalgebra();
        self.blocks.get(system.first / WIDTH).map_or_else(Vector3::zeros, first)
    }

    /// Returns the centre of mass of all bodies in `W`, m.
    pub(super) fn center_of_mass(&self) -> Vec3<f64> {
        // c = Σ mₖ cₖ / Σ mₖ
        let (mut moment, mut mass) = (Vec3::zero(), 0.0);
        for BodyBlock { mass: masses, motion, .. } in &self.blocks {
            moment += motion.com.map(|column| column.dot(masses));
            mass += masses.dot(&Column8::of(|_| 1.0));
        }
        moment * (1.0 / mass)
    }

    /// Returns the bodies of a system in groups that have one body per lane of `S`.
    #[inline(always)]
    pub(super) fn groups<S: Real>(&self, system: SystemRows) -> impl Iterator<Item = LaneGroup<'_>> {
        let SystemRows { number, first, count } = system;
        let group = move |body| LaneGroup {
            first: BodyIndex { system: number, body },
            row: first + body,
            count: (count - body).min(S::LANES),
            block: &self.blocks[(first + body) / WIDTH],
        };
        (0..count).step_by(S::LANES).map(group)
    }
}

impl FromIterator<BodyState> for Bodies {
    /// Collects the bodies of one system.
    fn from_iter<I: IntoIterator<Item = BodyState>>(bodies: I) -> Self {
        Self::new(&[bodies.into_iter().collect()])
    }
}
