//! Detection of systems that start far from the reference orbit, where positions in W have a low resolution.

use super::settings::Simulation;
use crate::world::groups;

/// Largest acceptable spacing of adjacent `f64` positions, m, which is reached at a distance of 4500 km. It
/// is a tenth of the position error of a run over many revolutions at the tightest tolerance, and far below
/// the resolution of sensors of relative motion.
const FINEST: f64 = 1e-9;

/// System that starts far from the reference orbit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FarSystem {
    /// Index of the system in the world.
    pub system: usize,
    /// Distance of the origin of its base from the origin of W, which moves on the reference orbit, m.
    pub distance: f64,
    /// Spacing of adjacent `f64` positions at this distance, m.
    pub resolution: f64,
    /// True if the system starts beyond the distance at which a single system changes to a local reference
    /// orbit, but cannot do so because it may interact with other systems.
    pub keeps_reference: bool,
}

impl Simulation {
    /// Returns the systems that start so far from the reference orbit that adjacent `f64` positions differ by
    /// more than 1e-9 m, and the systems that start beyond [`Simulation::rereference_beyond`] but cannot
    /// change to a local reference orbit.
    pub fn far_systems(&self) -> Vec<FarSystem> {
        let groups = groups(self.systems.len(), &self.events, &self.links());
        let is_grouped =
            |system: usize| groups.iter().any(|group| group.len() > 1 && group.contains(&system));
        let far = self.systems.iter().enumerate().filter_map(|(system, declared)| {
            let distance = declared.q.iter().take(3).map(|x| x * x).sum::<f64>().sqrt();
            let resolution = distance * f64::EPSILON;
            let keeps_reference = is_grouped(system) && distance > self.rereference_beyond;
            let found = FarSystem { system, distance, resolution, keeps_reference };
            (keeps_reference || resolution > FINEST).then_some(found)
        });
        far.collect()
    }
}
