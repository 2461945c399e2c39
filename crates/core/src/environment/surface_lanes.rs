//! Addition of wrenches to the bodies that have surfaces, one body per lane.

use super::body_block::LaneGroup;
use super::body_index::SystemRows;
use super::error::EnvironmentError;
use super::scene::Scene;
use super::surfaces::{SurfaceBlock, Surfaces};
use super::wrenches::{WrenchLanes, Wrenches};
use crate::spatial::Real;

impl Surfaces {
    /// Returns the systems of a scene that have surfaces.
    pub(super) fn systems_of<'s>(&'s self, scene: &'s Scene<'_>) -> impl Iterator<Item = &'s SystemRows> {
        scene.bodies.systems().iter().filter(|rows| self.covers_system(rows.number))
    }

    /// Adds to `wrenches` the wrenches that `wrench_of` returns for the surfaces of each group of bodies of a
    /// system.
    ///
    /// # Errors
    /// [`EnvironmentError::OtherBodies`] if `wrenches` belongs to different bodies; the errors of
    /// `wrench_of`.
    #[inline(always)]
    pub(super) fn add_lanes<'a, S: Real>(
        &self,
        scene: &Scene<'a>,
        system: &SystemRows,
        wrenches: &mut Wrenches,
        wrench_of: impl Fn(&SurfaceBlock, &LaneGroup<'a>) -> Result<WrenchLanes<S>, EnvironmentError>,
    ) -> Result<(), EnvironmentError> {
        scene.add_lanes_to(
            std::slice::from_ref(system),
            wrenches,
            #[inline(always)]
            |group| match self.block(group.first) {
                Some(surfaces) => wrench_of(surfaces, group),
                None => Ok(WrenchLanes::zero()),
            },
        )
    }
}
