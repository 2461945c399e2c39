//! Rigid impacts: one impulse problem for all points of a group that touch at an instant, and for all joint
//! stops that joints have reached.

use super::Contacts;
use super::responses::{ContactAt, Responses, StopAt};
use crate::contact::{Block, ContactError, ImpactLaw, ImpulseProblem, MOST_SWEEPS, Unsolved};
use crate::dynamics::{center_of_mass, kinetic_energy};
use crate::model::BASE_NV;
use crate::simulation::state::State;
use crate::simulation::tree::Tree;
use crate::spatial::{Real, Vec3};

/// Point at which pieces with an impact law touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct TouchedPoint {
    /// Index of the pair of pieces in the list of near pairs.
    pub(super) near: usize,
    /// Index of the pair of pieces in the list of all pairs.
    pub(super) number: usize,
    pub(super) place: ContactAt,
    pub(super) law: ImpactLaw,
    /// True if the pieces already rest on each other at this point, which then has no restitution.
    pub(super) is_known: bool,
    /// Velocity of the second side relative to the first, along the axes of the point, m/s; the normal
    /// component is positive while the sides separate.
    pub(super) velocity: [f64; 3],
}

/// Changes of the contacts with an impact law at an instant.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::simulation) struct Touched {
    /// True if touching pieces approach each other, or if a joint moves into its stop while pieces touch.
    pub(in crate::simulation) has_impact: bool,
    /// True if pieces begin to rest on each other.
    pub(in crate::simulation) is_new: bool,
}

impl Contacts {
    /// Returns true if a contact has an impact law.
    pub(in crate::simulation) fn has_impact_laws(&self) -> bool {
        self.rigid.contains(&true)
    }

    /// Determines whether pieces with an impact law strike each other, or begin to rest on each other, at
    /// `state`. Requires the kinematics of `state`, relative to W, in the trees.
    pub(in crate::simulation) fn touched<S: Real>(
        &mut self,
        trees: &[Tree<'_, S>],
        state: &State<S>,
    ) -> Result<Touched, ContactError> {
        let points = self.touched_points(trees, state)?;
        let strikes_stop = || {
            let mut pairs = trees.iter().zip(&state.trees);
            pairs.any(|(tree, state)| tree.modes.is_active() && tree.first_impact(state).is_some())
        };
        let is_new = |point: &TouchedPoint| {
            point.velocity[0] <= ImpactLaw::REST_SPEED && !self.list[point.number].is_resting()
        };
        let strikes = points.iter().any(|point| point.velocity[0] < -ImpactLaw::REST_SPEED);
        let has_impact = strikes || (!points.is_empty() && strikes_stop());
        Ok(Touched { has_impact, is_new: points.iter().any(is_new) })
    }

    /// Returns all points at which pieces with an impact law touch.
    pub(super) fn touched_points<S: Real>(
        &mut self,
        trees: &[Tree<'_, S>],
        state: &State<S>,
    ) -> Result<Vec<TouchedPoint>, ContactError> {
        let Self { list, near, frames, .. } = self;
        frames.forget();
        let mut found = Vec::new();
        for (index, &number) in near.iter().enumerate() {
            let touching = &list[number];
            let Some(rigid) = touching.rigid.as_ref().filter(|_| !touching.is_rigid(trees)) else { continue };
            let motions = touching.motions(frames, trees, state);
            if touching.is_far(&motions, 0.0) {
                continue;
            }
            let [a, b] = &motions;
            for (place, _) in touching.rigid_points(&motions)? {
                let relative = b.velocity_at(place.at) - a.velocity_at(place.at);
                let velocity = place.axes.map(|axis| axis.dot(relative));
                let is_known = touching.rests_near(a.frame.to_shape(place.at));
                let law = rigid.law;
                found.push(TouchedPoint { near: index, number, place, law, is_known, velocity });
            }
        }
        Ok(found)
    }

    /// Applies the impulses of all impacts at `t`, s, and determines which pieces rest on each other
    /// afterwards. If `t` is `None`, only the impulses are applied, and no touches are recorded. If
    /// `is_endless` is true, the impacts have no restitution. Requires the kinematics of `state`, relative to
    /// W, in the trees, and updates them.
    pub(in crate::simulation) fn strike<S: Real>(
        &mut self,
        t: Option<f64>,
        trees: &mut [Tree<'_, S>],
        state: &mut State<S>,
        is_endless: bool,
    ) -> Result<(), ContactError> {
        let Touched { has_impact, is_new } = self.touched(trees, state)?;
        if !has_impact && !is_new {
            return Ok(());
        }
        let mut points = self.touched_points(trees, state)?;
        self.keep(&state.contacts);
        if let Some(t) = t {
            self.begin_touches(t, &points);
        }
        if has_impact {
            self.apply_impulses(trees, state, &mut points, is_endless)?;
            self.keep(&state.contacts);
        }
        if let Some(t) = t {
            self.rest(&points);
            self.end_touches(t, &points);
        }
        Ok(())
    }

    /// Solves for the impulses at `points` and at joint stops, and applies them. Replaces the velocities of
    /// the points by those after the impact.
    fn apply_impulses<S: Real>(
        &self,
        trees: &mut [Tree<'_, S>],
        state: &mut State<S>,
        points: &mut [TouchedPoint],
        is_endless: bool,
    ) -> Result<(), ContactError> {
        let places: Vec<ContactAt> = points.iter().map(|point| point.place).collect();
        let stops: Vec<(StopAt, f64)> = trees.iter().zip(&state.trees).enumerate().fold(
            Vec::new(),
            |mut all, (number, (tree, state))| {
                let own = tree.stops_reached(state).into_iter();
                all.extend(own.map(|(joint, away)| {
                    let rate = away * state.v[BASE_NV + joint].lane(0);
                    (StopAt { tree: number, joint, away }, rate)
                }));
                all
            },
        );
        let at: Vec<StopAt> = stops.iter().map(|(stop, _)| *stop).collect();
        let locked = |tree: usize| trees[tree].modes.kept_in_impacts();
        let responses = Responses::new(trees, &state.trees, &places, &at, locked);
        let rebound = |restitution: f64, speed: f64, least: f64| {
            let leaving = -restitution * speed;
            if leaving > least && !is_endless { leaving } else { 0.0 }
        };
        let mut problem = ImpulseProblem { matrix: responses.matrix(), ..ImpulseProblem::default() };
        for point in points.iter() {
            let ImpactLaw { restitution, friction } = point.law;
            let restitution = if point.is_known { 0.0 } else { restitution };
            let target = rebound(restitution, point.velocity[0], ImpactLaw::REST_SPEED);
            problem.blocks.push(Block::Point { friction, target });
            problem.free.extend(point.velocity);
        }
        for (stop, rate) in &stops {
            let restitution = trees[stop.tree].stop_restitution(stop.joint);
            problem.blocks.push(Block::Stop { target: rebound(restitution, *rate, 0.0) });
            problem.free.push(*rate);
        }
        let solved = problem.impact();
        let (p, factor) = solved.map_err(|error| {
            unsolved(error, points.iter().map(|point| self.list[point.number].name.as_str()))
        })?;
        let u = problem.velocities(&p);
        self.add_momenta(trees, state, points, &p);
        let changes = responses.changes(trees.len(), &p);
        let moved = trees.iter_mut().zip(&mut state.trees).zip(&changes).enumerate();
        for (number, ((tree, state), change)) in moved {
            if change.is_empty() {
                continue;
            }
            let before = kinetic_energy(&tree.model, &tree.data, &state.v);
            state.v.iter_mut().zip(change).for_each(|(v, change)| *v += S::of(*change));
            for (row, (stop, rate)) in (3 * points.len()..).zip(&stops) {
                if stop.tree == number && p[row] > 0.0 {
                    let restitution = tree.stop_restitution(stop.joint);
                    let leaving = factor * rebound(restitution, *rate, 0.0);
                    state.v[BASE_NV + stop.joint] = S::of(stop.away * leaving);
                }
            }
            tree.project_momentum(state);
            state.work += kinetic_energy(&tree.model, &tree.data, &state.v) - before;
        }
        // energy lost at each row: −½ p (u⁻ + u⁺)
        let lost = |row: usize| -0.5 * p[row] * (problem.free[row] + u[row]);
        for (row, (stop, _)) in (3 * points.len()..).zip(&stops) {
            trees[stop.tree].add_stop_loss(stop.joint, lost(row), &mut state.trees[stop.tree]);
        }
        for (point, row) in points.iter_mut().zip((0..).step_by(3)) {
            point.velocity = [u[row], u[row + 1], u[row + 2]];
            let own = &mut state.contacts[point.near];
            let impulse = impulse_of(point, &p[row..row + 3]);
            let center = self.touches[self.list[point.number].contact].center;
            own.impulse += impulse;
            own.angular_impulse += (point.place.at - center).cross(impulse);
            own.normal_work += (row..row + 3).map(lost).sum::<f64>();
        }
        Ok(())
    }

    /// Adds the impulses `p` at `points` to the momenta of the trees: the impulse on the second side, and the
    /// opposite one on the first, at the same point.
    fn add_momenta<S: Real>(
        &self,
        trees: &[Tree<'_, S>],
        state: &mut State<S>,
        points: &[TouchedPoint],
        p: &[f64],
    ) {
        let center = |(tree, state): (&Tree<'_, S>, _)| center_of_mass(&tree.data, state);
        let pairs = trees.iter().zip(state.trees.iter().map(|state| &state.q[..]));
        let centers: Vec<Vec3<f64>> = pairs.map(|pair| center(pair).lane(0)).collect();
        for (point, p) in points.iter().zip(p.chunks_exact(3)) {
            let [(first, _), (second, _)] = point.place.places;
            if first == second {
                continue; // the momentum of a tree does not change by its internal impulses
            }
            let impulse = impulse_of(point, p);
            for (tree, impulse) in [(first, -impulse), (second, impulse)] {
                let moment = (point.place.at - centers[tree]).cross(impulse);
                let own = &mut state.trees[tree].impulse;
                own.linear += Vec3::of(&impulse);
                own.angular += Vec3::of(&moment);
            }
            state.orbital += Vec3::of(&(centers[second] - centers[first]).cross(impulse));
        }
    }

    /// Marks the pieces with a point that does not separate as resting on each other, and all other pieces in
    /// `points` as apart.
    fn rest(&mut self, points: &[TouchedPoint]) {
        for group in points.chunk_by(|a, b| a.number == b.number) {
            let slowest = group.iter().fold(f64::INFINITY, |least, point| least.min(point.velocity[0]));
            let is_resting = slowest <= ImpactLaw::REST_SPEED;
            if let Some(rigid) = &mut self.list[group[0].number].rigid {
                match (&rigid.points, is_resting) {
                    (None, true) => rigid.points = Some(Vec::new()),
                    (Some(_), false) => rigid.points = None,
                    _ => {}
                }
            }
        }
    }
}

/// Returns the impulse on the second side, N s, in W axes, from its components `p` along the axes of the
/// point.
fn impulse_of(point: &TouchedPoint, p: &[f64]) -> Vec3<f64> {
    let [n, s, t] = point.place.axes;
    n * p[0] + s * p[1] + t * p[2]
}

/// Returns the error for impulses that do not converge. `names` has the name of the contact of each point.
pub(super) fn unsolved<'a>(unsolved: Unsolved, names: impl Iterator<Item = &'a str>) -> ContactError {
    let mut names: Vec<String> = names.map(|name| format!("'{name}'")).collect();
    let points = names.len();
    names.sort_unstable();
    names.dedup();
    let noun = if names.len() == 1 { "contact" } else { "contacts" };
    let contacts = format!("{noun} {}", names.join(", "));
    ContactError::Unsolved { contacts, points, sweeps: MOST_SWEEPS, change: unsolved.change }
}
