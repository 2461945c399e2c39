//! Contact forces between pieces with an impact law that rest on each other.
//!
//! The forces are constant during a step, in the axes of the first side. They are chosen such that the
//! velocities at the end of the step satisfy the conditions of the impact law without restitution. Trial
//! steps determine them: the velocities at the end of a step of length `h` are modelled as `u = b + h W F`,
//! with the forces `F` and the matrix `W` at the start of the step, and every trial step corrects `b`.

use super::Contacts;
use super::mode::Phase;
use super::responses::{ContactAt, Responses};
use super::rigid::RestingPoint;
use super::side::SideMotion;
use super::strike::unsolved;
use super::touching::Touching;
use crate::contact::{Block, ContactError, ImpactLaw, ImpulseProblem};
use crate::simulation::state::State;
use crate::simulation::tree::Tree;
use crate::spatial::Real;

/// Point at which pieces rest on each other during a step.
#[derive(Clone, Copy, Debug)]
struct HeldPoint {
    /// Index of the pair of pieces in the list of near pairs.
    near: usize,
    /// Index of the point in [`Rigid::points`](super::rigid::Rigid) of its pair.
    index: usize,
    law: ImpactLaw,
    /// Tangential components of the relative velocity at the start of the step, along the axes of the point,
    /// m/s.
    slip: [f64; 2],
    /// Normal velocity at the end of the last trial step, m/s.
    separation: f64,
}

/// Impulse problem from which the forces between resting pieces during one step are computed.
pub(in crate::simulation) struct Hold {
    points: Vec<HeldPoint>,
    problem: ImpulseProblem,
    /// Impulses in the step, N s.
    impulses: Vec<f64>,
    /// Length of the step, and time in which a gap or an overlap is corrected, s.
    times: [f64; 2],
    /// True before the first correction.
    is_first: bool,
}

impl Contacts {
    /// Returns true if any pieces with an impact law rest on each other.
    pub(in crate::simulation) fn has_resting(&self) -> bool {
        self.has_impact_laws() && self.near.iter().any(|&number| self.list[number].is_resting())
    }

    /// Returns the impulse problem that determines the forces between resting pieces in a step of length `h`,
    /// s, that starts at `state`; gaps and overlaps are corrected within the time `correction`, s. Requires
    /// the kinematics of `state`, relative to W, in the trees.
    pub(in crate::simulation) fn hold<S: Real>(
        &mut self,
        [h, correction]: [f64; 2],
        trees: &[Tree<'_, S>],
        state: &State<S>,
    ) -> Hold {
        let Self { list, near, frames, .. } = self;
        frames.forget();
        let (mut points, mut places, mut impulses) = (Vec::new(), Vec::new(), Vec::new());
        let mut blocks = Vec::new();
        for (number, touching) in near.iter().map(|&number| &list[number]).enumerate() {
            let Some(rigid) = &touching.rigid else { continue };
            let Some(own) = &rigid.points else { continue };
            let [a, b] = touching.motions(frames, trees, state);
            let law = rigid.law;
            for (index, point) in own.iter().enumerate() {
                let at = a.frame.to_common(point.at);
                let axes = point.axes.map(|axis| a.frame.rot * axis);
                let relative = b.velocity_at(at) - a.velocity_at(at);
                let slip = [axes[1].dot(relative), axes[2].dot(relative)];
                points.push(HeldPoint { near: number, index, law, slip, separation: 0.0 });
                places.push(ContactAt { places: [0, 1].map(|i: usize| touching.sides[i].place), at, axes });
                impulses.extend(point.force.map(|force| h * force));
                blocks.push(Block::Point { friction: law.friction, target: -point.gap / correction });
            }
        }
        let locked = |tree: usize| {
            let modes = &trees[tree].modes;
            modes.locked().map_or_else(|| modes.kept_in_impacts(), <[bool]>::to_vec)
        };
        let matrix = Responses::new(trees, &state.trees, &places, &[], locked).matrix();
        let free = vec![0.0; impulses.len()];
        let problem = ImpulseProblem { matrix, free, blocks };
        Hold { points, problem, impulses, times: [h, correction], is_first: true }
    }

    /// Corrects the forces according to the velocities at `state`, which is the end of a trial step with the
    /// present forces. Returns the largest change of a velocity that the correction causes, m/s. Requires the
    /// kinematics of `state`, relative to W, in the trees.
    ///
    /// # Errors
    /// [`ContactError::Painleve`] if a sliding point needs a force, but friction would push its pieces into
    /// each other at least as fast as the normal force separates them: `W_nn − μ W_nt d ≤ 0` for the
    /// direction `d` of sliding; [`ContactError::Unsolved`] if the impulses do not converge;
    /// [`ContactError::Geometry`] if a distance cannot be computed.
    pub(in crate::simulation) fn correct<S: Real>(
        &mut self,
        hold: &mut Hold,
        trees: &[Tree<'_, S>],
        state: &State<S>,
    ) -> Result<f64, ContactError> {
        let Self { list, near, frames, .. } = self;
        frames.forget();
        let mut reached = Vec::new();
        for point in &mut hold.points {
            let touching = &list[near[point.near]];
            let motions = touching.motions(frames, trees, state);
            let velocity = touching.velocity_at_end(point.index, &motions)?;
            point.separation = velocity[0];
            reached.extend(velocity);
        }
        let n = reached.len();
        let pushed = |row: usize| {
            let row = &hold.problem.matrix[row * n..(row + 1) * n];
            row.iter().zip(&hold.impulses).map(|(w, p)| w * p).sum::<f64>()
        };
        let free: Vec<f64> = reached.iter().enumerate().map(|(row, u)| u - pushed(row)).collect();
        hold.problem.free = free;
        if std::mem::take(&mut hold.is_first) {
            for (number, point) in hold.points.iter().enumerate() {
                if let Some(limit) = hold.painleve(number, &reached) {
                    let touching = &list[near[point.near]];
                    let (contact, links) = (touching.name.clone(), touching.links(trees));
                    let friction = point.law.friction;
                    return Err(ContactError::Painleve { contact, links, friction, limit });
                }
            }
        }
        let before = hold.impulses.clone();
        let solved = hold.problem.solve(&mut hold.impulses);
        let name = |point: &HeldPoint| list[near[point.near]].name.as_str();
        solved.map_err(|error| unsolved(error, hold.points.iter().map(name)))?;
        let change = (0..n).map(|i| hold.problem.matrix[i * n + i] * (hold.impulses[i] - before[i]).abs());
        let change = change.fold(0.0, f64::max);
        for (point, p) in hold.points.iter().zip(hold.impulses.chunks_exact(3)) {
            let rigid = list[near[point.near]].rigid.as_mut();
            if let Some(own) = rigid.and_then(|rigid| rigid.points.as_mut()) {
                own[point.index].force = [0, 1, 2].map(|i: usize| p[i] / hold.times[0]);
            }
        }
        self.begun.clear();
        Ok(change)
    }

    /// Finishes the computation of the forces for the step that starts at `t`, s. Pieces without a force that
    /// separate faster than [`ImpactLaw::REST_SPEED`] no longer rest on each other. Returns true if there are
    /// such pieces.
    pub(in crate::simulation) fn end_hold(&mut self, t: f64, hold: &Hold) -> bool {
        let mut has_separated = false;
        let points = hold.points.iter().zip(hold.impulses.chunks_exact(3)).collect::<Vec<_>>();
        for own in points.chunk_by(|a, b| a.0.near == b.0.near) {
            let separates =
                |(point, p): &(&HeldPoint, &[f64])| p[0] == 0.0 && point.separation > ImpactLaw::REST_SPEED;
            if own.iter().all(separates) {
                let touching = &mut self.list[self.near[own[0].0.near]];
                touching.separate();
                self.samples[touching.contact].remove_piece();
                has_separated = true;
            }
        }
        if has_separated {
            self.begun.clear();
            self.update_touches(t);
        }
        has_separated
    }
}

impl Hold {
    /// Returns the smallest coefficient of friction with which no force can keep the pieces apart at the
    /// point with index `number`, if the point slides, needs a force and has a coefficient that is at least
    /// as large; otherwise `None`. `reached` has the velocities at the end of a trial step, m/s.
    fn painleve(&self, number: usize, reached: &[f64]) -> Option<f64> {
        let (HeldPoint { law, slip, .. }, n, row) = (&self.points[number], reached.len(), 3 * number);
        let speed = slip[0].hypot(slip[1]);
        let w = |j: usize| self.problem.matrix[row * n + row + j];
        let own: f64 = (0..3).map(|j| w(j) * self.impulses[row + j]).sum();
        let Block::Point { target, .. } = self.problem.blocks[number] else { return None };
        if speed <= ImpactLaw::REST_SPEED || reached[row] - own >= target {
            return None;
        }
        // N = −a_n/(W_nn − μ W_nt d)
        let coupling = (w(1) * slip[0] + w(2) * slip[1]) / speed;
        (w(0) <= law.friction * coupling).then(|| w(0) / coupling)
    }
}

impl Touching {
    /// Finds the points at which the pieces rest on each other at the start of a step. If the number of
    /// points has not changed, they keep the forces of the last step. If no point touches, the pieces no
    /// longer rest on each other.
    pub(super) fn find_resting_points(&mut self, motions: &[SideMotion; 2]) -> Result<(), ContactError> {
        if !self.is_resting() {
            return Ok(());
        }
        let (found, [a, _]) = (self.rigid_points(motions)?, motions);
        let Some(rigid) = &mut self.rigid else { return Ok(()) };
        let before = rigid.points.take().unwrap_or_default();
        let point = |(index, (place, gap)): (usize, (ContactAt, f64))| {
            let known = before.get(index).filter(|_| before.len() == found.len());
            RestingPoint {
                at: a.frame.to_shape(place.at),
                axes: place.axes.map(|axis| a.frame.rot.transpose_mul(axis)),
                force: known.map_or([0.0; 3], |point| point.force),
                gap,
            }
        };
        let points: Vec<_> = found.iter().copied().enumerate().map(point).collect();
        rigid.points = (!points.is_empty()).then_some(points);
        Ok(())
    }

    /// Returns the velocity of the second side relative to the first at the end of a step, along the axes of
    /// the point with index `index`, m/s. The normal component is along the normal at the end, at the present
    /// contact point that is closest to the point.
    fn velocity_at_end(&self, index: usize, motions: &[SideMotion; 2]) -> Result<[f64; 3], ContactError> {
        let points = self.rigid.as_ref().and_then(|rigid| rigid.points.as_ref());
        let Some(point) = points.and_then(|points| points.get(index)) else { return Ok([0.0; 3]) };
        let (proximity, found) = self.geometry(self.mode.phase, motions)?;
        let [a, b] = motions;
        let at = point.present(&found.list(&proximity), a);
        let relative = b.velocity_at(at) - a.velocity_at(at);
        let across = [point.axes[1], point.axes[2]].map(|axis| (a.frame.rot * axis).dot(relative));
        Ok([proximity.normal.dot(relative), across[0], across[1]])
    }

    /// Marks the pieces, which have rested on each other, as separated at the start of a step.
    fn separate(&mut self) {
        if let Some(rigid) = &mut self.rigid {
            rigid.points = None;
        }
        if let (Some(last), true) = (&self.last, self.mode.phase != Phase::Far) {
            let margin = self.rigid_margin(last.depth);
            self.mode.slack[0] = if margin > 0.0 { 0.0 } else { f64::MIN_POSITIVE - 2.0 * margin };
        }
    }
}
