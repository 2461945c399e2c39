//! Broad phase: bounding spheres of frames and systems select the pairs of pieces that may touch within a
//! step.

use super::begin::{FAR, TRAVEL};
use super::frames::{FrameMotion, Frames};
use super::touching::Touching;
use crate::simulation::state::State;
use crate::simulation::tree::Tree;
use crate::spatial::{Real, Vec3};
use std::collections::BTreeMap;

/// Sphere in W, m, that contains all points that the pieces of a frame or of a system can reach within a
/// step.
#[derive(Clone, Copy, Debug)]
struct Sphere {
    center: Vec3<f64>,
    radius: f64,
}

impl Sphere {
    fn is_apart(&self, other: &Self) -> bool {
        (other.center - self.center).norm() > self.radius + other.radius
    }
}

/// Pairs of pieces, grouped by their frames, and pairs of frames, grouped by their systems.
#[derive(Clone, Debug, Default)]
pub(super) struct BroadPhase {
    /// Largest reach of the pieces of each frame, m.
    reaches: Vec<f64>,
    /// Indices of the frames of each system, in the list of the frames of all contacts.
    systems: Vec<Vec<usize>>,
    /// Pairs of systems with the pairs of their frames.
    blocks: Vec<([usize; 2], Vec<FramePair>)>,
    /// Spheres of the frames during the next step.
    spheres: Vec<Sphere>,
    /// Spheres of the systems during the next step.
    around: Vec<Sphere>,
}

/// Frames of the first and of the second side, and the indices of the pairs of their pieces.
#[derive(Clone, Debug)]
struct FramePair {
    frames: [usize; 2],
    pairs: Vec<usize>,
}

impl BroadPhase {
    /// Creates the broad phase for pairs of pieces whose frames have indices below `count`.
    pub(super) fn new(list: &[Touching], count: usize) -> Self {
        let mut new = Self { reaches: vec![0.0; count], ..Self::default() };
        let mut known: BTreeMap<[usize; 2], BTreeMap<[usize; 2], Vec<usize>>> = BTreeMap::new();
        for (number, touching) in list.iter().enumerate() {
            for side in &touching.sides {
                new.reaches[side.number] = new.reaches[side.number].max(side.reach);
                let system = side.declared.system;
                new.systems.resize(new.systems.len().max(system + 1), Vec::new());
                if !new.systems[system].contains(&side.number) {
                    new.systems[system].push(side.number);
                }
            }
            let [systems, frames] = [
                touching.sides.each_ref().map(|side| side.declared.system),
                touching.sides.each_ref().map(|side| side.number),
            ];
            known.entry(systems).or_default().entry(frames).or_default().push(number);
        }
        for (systems, frames) in known {
            let pairs = frames.into_iter().map(|(frames, pairs)| FramePair { frames, pairs });
            new.blocks.push((systems, pairs.collect()));
        }
        new
    }

    /// Adds to `found` the indices of at least those pairs that are not far apart during the next `h`, s, and
    /// sorts `found`. Requires the kinematics of `state` in `trees`.
    ///
    /// A pair is far apart if `|p_b − p_a| > r_a + r_b + FAR min(r_a, r_b) + TRAVEL h s`, with the origins
    /// `p` of the frames of its sides, the reaches `r`, and the speed `s` of at most
    /// `|v_b − v_a| + |ω_a| r_a + |ω_b| r_b` for the velocities `v` and angular velocities `ω` of the frames.
    /// With radii `(1 + FAR) r + TRAVEL h (|v − u| + |ω| r)` and any common velocity `u`, this holds for all
    /// pairs of pieces of two frames whose spheres do not meet. The excess `FAR max(r_a, r_b)` of these radii
    /// is larger than all rounding errors.
    pub(super) fn find<S: Real>(
        &mut self,
        frames: &mut Frames,
        trees: &[Tree<'_, S>],
        state: &State<S>,
        h: f64,
        found: &mut Vec<usize>,
    ) {
        let Self { reaches, systems, blocks, spheres, around } = self;
        let common = if reaches.is_empty() { return } else { frames.motion(0, trees, state).velocity };
        spheres.clear();
        spheres.extend(reaches.iter().enumerate().map(|(number, &reach)| {
            let FrameMotion { frame, velocity, angular_velocity } = frames.motion(number, trees, state);
            let turning = if reach.is_finite() { angular_velocity.norm() * reach } else { 0.0 };
            let speed = (*velocity - common).norm() + turning;
            Sphere { center: frame.pos, radius: (1.0 + FAR) * reach + TRAVEL * h * speed }
        }));
        around.clear();
        around.extend(systems.iter().map(|frames| sphere_around(frames, spheres)));
        let meeting = blocks.iter().filter(|([a, b], _)| !around[*a].is_apart(&around[*b]));
        let pairs = meeting.flat_map(|(_, pairs)| pairs);
        let meeting = pairs.filter(|FramePair { frames: [a, b], .. }| !spheres[*a].is_apart(&spheres[*b]));
        meeting.for_each(|pair| found.extend(&pair.pairs));
        found.sort_unstable();
    }
}

/// Returns a sphere that contains the spheres of some frames.
fn sphere_around(frames: &[usize], spheres: &[Sphere]) -> Sphere {
    let sum = frames.iter().fold(Vec3::zero(), |sum, &frame| sum + spheres[frame].center);
    let center = sum * (1.0 / frames.len().max(1) as f64);
    let reach = |&frame: &usize| (spheres[frame].center - center).norm() + spheres[frame].radius;
    Sphere { center, radius: frames.iter().map(reach).fold(0.0, f64::max) }
}
