//! The bodies of a robot side by side, on the lanes of the processor.

use super::surfaces::Push;
use super::{BodyState, EnvironmentError, Scene, Wrench};
use crate::spatial::{Fused, InstructionSet, Lanes4, Lanes8, Mat3, Real, Scalar, Sym3, Vec3};
use nalgebra::Vector3;

/// An effect whose equations are written for several bodies at once.
pub(super) trait OnLanes {
    /// As [`add_wrenches`](super::Effect::add_wrenches), as many bodies at once as `S` has lanes.
    fn add<S: Real>(&self, scene: &Scene<'_>, wrenches: &mut [Wrench]) -> Result<(), EnvironmentError>;

    /// The same in the widest arithmetic there is; around a point mass one by one, since the way onto the lanes costs
    /// more than what there is to work out.
    fn add_on_widest(&self, scene: &Scene<'_>, wrenches: &mut [Wrench]) -> Result<(), EnvironmentError> {
        match InstructionSet::current() {
            InstructionSet::Baseline => self.add::<f64>(scene, wrenches),
            _ if scene.is_around_point_mass() => self.add::<Fused>(scene, wrenches),
            InstructionSet::Fused => self.add::<Lanes4>(scene, wrenches),
            InstructionSet::Wide => self.add::<Lanes8>(scene, wrenches),
        }
    }
}

/// An effect whose equations differ from body to body.
pub(super) trait OneByOne {
    /// As [`add_wrenches`](super::Effect::add_wrenches).
    fn add<S: Scalar>(&self, scene: &Scene<'_>, wrenches: &mut [Wrench]) -> Result<(), EnvironmentError>;

    /// The same in the best arithmetic there is for one body.
    fn add_one_by_one(&self, scene: &Scene<'_>, wrenches: &mut [Wrench]) -> Result<(), EnvironmentError> {
        match InstructionSet::current() {
            InstructionSet::Baseline => self.add::<f64>(scene, wrenches),
            InstructionSet::Fused | InstructionSet::Wide => self.add::<Fused>(scene, wrenches),
        }
    }
}

/// As many bodies as there are lanes, or the rest of them: the last one then fills the lanes left over.
#[derive(Clone, Copy)]
pub(super) struct Group<'a> {
    /// Index of the first.
    pub(super) first: usize,
    pub(super) bodies: &'a [BodyState],
}

impl Group<'_> {
    #[inline(always)]
    fn body(&self, lane: usize) -> &BodyState {
        &self.bodies[lane.min(self.bodies.len() - 1)]
    }

    #[inline(always)]
    pub(super) fn masses<S: Real>(&self) -> S {
        S::from_lanes(|i| self.body(i).mass)
    }

    /// One vector of each.
    #[inline(always)]
    pub(super) fn vectors<S: Real>(&self, of: impl Fn(&BodyState) -> &Vector3<f64>) -> Vec3<S> {
        let component = |k: usize| S::from_lanes(|i| of(self.body(i))[k]);
        Vec3::new(component(0), component(1), component(2))
    }

    #[inline(always)]
    pub(super) fn rot_wk<S: Real>(&self) -> Mat3<S> {
        let entry = |row: usize, column: usize| S::from_lanes(|i| self.body(i).rot_wk[(row, column)]);
        let column = |j: usize| Vec3::new(entry(0, j), entry(1, j), entry(2, j));
        Mat3::from_columns(column(0), column(1), column(2))
    }

    #[inline(always)]
    pub(super) fn inertias<S: Real>(&self) -> Sym3<S> {
        let entry = |row: usize, column: usize| S::from_lanes(|i| self.body(i).inertia[(row, column)]);
        Sym3::new(entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2))
    }
}

/// Adds a force, N, to those of the bodies, `W` axes.
#[inline(always)]
pub(super) fn add_force<S: Real>(wrenches: &mut [Wrench], force: Vec3<S>) {
    for (i, wrench) in wrenches.iter_mut().enumerate() {
        add(&mut wrench.force, force, i);
    }
}

/// Adds a torque about each body's centre of mass, N m, `W` axes.
#[inline(always)]
pub(super) fn add_torque<S: Real>(wrenches: &mut [Wrench], torque: Vec3<S>) {
    for (i, wrench) in wrenches.iter_mut().enumerate() {
        add(&mut wrench.torque, torque, i);
    }
}

/// Adds a push on each body, `W` axes.
#[inline(always)]
pub(super) fn add_push<S: Real>(wrenches: &mut [Wrench], push: Push<S>) {
    add_force(wrenches, push.force);
    add_torque(wrenches, push.torque);
}

#[inline(always)]
fn add<S: Real>(to: &mut Vector3<f64>, vectors: Vec3<S>, lane: usize) {
    to.x += vectors.x.lane(lane);
    to.y += vectors.y.lane(lane);
    to.z += vectors.z.lane(lane);
}
