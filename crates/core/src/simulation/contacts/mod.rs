//! Contacts between the bodies of a run: compliant forces at the stages of a step, impacts and resting
//! contacts of pieces with an impact law, modes that change only between steps, and the length of steps while
//! bodies touch.

mod begin;
mod bound_gaps;
mod broad_phase;
mod external;
mod follow;
mod frames;
mod gaps;
mod hold;
mod mobility;
mod mode;
mod near;
mod normal_forces;
mod pressure;
mod record;
mod responses;
mod resting;
mod rigid;
mod side;
mod start;
mod step_length;
mod strike;
mod touches;
mod touching;

pub(super) use hold::Hold;
pub(super) use mode::Mode;
pub(super) use near::SavedContacts;
pub(super) use rigid::RestingPoint;
pub(super) use strike::Touched;
pub(super) use touches::Touch;

use super::contact_state::{ContactRate, ContactState};
use super::error::SimulationError;
use super::recording::EventRecord;
use super::state::State;
use super::tree::Tree;
use crate::contact::{Contact, ContactError, ContactSide, ContactSteps};
use crate::geometry::{BoundingSphere, Pose, Shape};
use crate::spatial::Real;
use crate::world::FrameIndex;
use broad_phase::BroadPhase;
use frames::Frames;
use gaps::Gaps;
use mode::Phase;
use rigid::Rigid;
use side::{Side, SideMotion};
use touches::Sample;
use touching::{Loading, Touching};

/// Number of pairs of pieces up to which bounding spheres cost more time than they save.
const FEW: usize = 16;

/// Contacts of a run. Each is evaluated for all pairs that consist of a convex piece of its first side and a
/// convex piece of its second side.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contacts {
    list: Vec<Touching>,
    /// Indices, in ascending order, of the pairs whose states the simulation integrates: all pairs that are
    /// not far apart or, if an external engine computes the forces, all pairs.
    near: Vec<usize>,
    /// Buffer for the indices of pairs that may be near.
    candidates: Vec<usize>,
    /// States of all pairs; those of near pairs are updated only at the start of a step and for rows.
    states: Vec<ContactState>,
    /// True for pairs whose state has been nonzero.
    has_touched: Vec<bool>,
    /// True for pairs whose pieces are rigidly connected to each other; empty until this is determined.
    is_rigid: Vec<bool>,
    /// Instant at which the modes were determined, s; NaN if they must be determined again.
    begun_at: f64,
    broad_phase: BroadPhase,
    gaps: Gaps,
    frames: Frames,
    /// States of the contacts for which [`Self::begin`] has computed the loadings; empty once the loadings
    /// have been used.
    begun: Vec<ContactState>,
    /// Names of the declared contacts.
    pub(super) names: Vec<String>,
    /// True for each declared contact with an impact law.
    rigid: Vec<bool>,
    steps: ContactSteps,
    /// Largest permitted energy error of the next step, J; infinite while no pieces whose forces may jump
    /// press on each other (see [`Touching::energy`]).
    pub(super) energy_error: f64,
    /// Work of the normal forces that is neither stored nor dissipated, J, at the start of the step and at
    /// the last call of [`Self::margin`].
    pub(super) open_energies: [f64; 2],
    /// True if changes between sticking and slipping do not end a step.
    pub(super) ignores_slip: bool,
    /// Present or last touch of each declared contact, with the totals of its touches.
    touches: Vec<Touch>,
    /// Sums over the pieces of each declared contact at the start of the step.
    samples: Vec<Sample>,
    /// Touch-downs and lift-offs that have not yet been moved to the events of the run. Indices of systems
    /// are those in the group.
    pub(super) happened: Vec<EventRecord>,
    /// True if an external engine computes the forces.
    has_engine: bool,
}

impl Contacts {
    /// Creates the contacts of a run before its first step. [`Self::place`] must then set the places of their
    /// frames if systems are not separate trees.
    pub(super) fn new(declared: &[Contact], steps: ContactSteps) -> Self {
        let mut list = Vec::new();
        for (contact, own) in declared.iter().enumerate() {
            let Contact { name, sides, law, impact, may_start_overlapping } = own;
            let order = |side: &ContactSide| (side.frame.system, side.frame.frame);
            let [first, second] = [0, 1].map(|i| on_both(&sides[i], &sides[1 - i]));
            for (i, a) in sides[0].iter().enumerate() {
                for (j, b) in sides[1].iter().enumerate().filter(|(_, b)| b.frame != a.frame) {
                    if first[i] && second[j] && order(b) < order(a) {
                        continue; // the same pair also occurs with its pieces on the other sides
                    }
                    let sides = [(i, a), (j, b)].map(|(piece, side)| Side {
                        piece,
                        declared: side.frame,
                        place: (side.frame.system, side.frame.frame),
                        number: 0,
                        reach: reach(&side.shape, &side.pose),
                        shape: side.shape.clone(),
                        pose: side.pose,
                    });
                    let name = name.clone();
                    let (law, may_start_overlapping) = (*law, *may_start_overlapping);
                    let (mode, deepest, last) = (Mode::START, 0.0, None);
                    let is_held = false;
                    let rigid = impact.map(|law| Rigid { law, points: None });
                    list.push(Touching {
                        contact,
                        name,
                        sides,
                        law,
                        rigid,
                        may_start_overlapping,
                        is_conservative: steps.is_conservative,
                        mode,
                        clearance: 0.0,
                        is_held,
                        deepest,
                        last,
                    });
                }
            }
        }
        let names = declared.iter().map(|contact| contact.name.clone()).collect();
        let (touches, samples) = (vec![Touch::NONE; declared.len()], vec![Sample::FAR; declared.len()]);
        let energy_error = f64::INFINITY;
        let (near, states) = ((0..list.len()).collect(), vec![ContactState::ZERO; list.len()]);
        let (has_touched, gaps) = (vec![false; list.len()], Gaps::new(&list, declared.len()));
        let begun_at = f64::NAN;
        let steps = ContactSteps { has_broad_phase: steps.has_broad_phase && list.len() > FEW, ..steps };
        let mut contacts = Self {
            list,
            near,
            states,
            has_touched,
            begun_at,
            gaps,
            names,
            rigid: declared.iter().map(|contact| contact.impact.is_some()).collect(),
            steps,
            energy_error,
            touches,
            samples,
            ..Self::default()
        };
        contacts.number_frames();
        contacts
    }

    pub(super) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Returns the states of the contacts before the first step.
    pub(super) fn states(&self) -> Vec<ContactState> {
        vec![ContactState::ZERO; self.list.len()]
    }

    /// Returns the number of pairs of pieces.
    pub(super) fn pairs(&self) -> usize {
        self.list.len()
    }

    /// Sets, for every frame, the index of its tree and its index in the model of the tree, as returned by
    /// `place`.
    pub(super) fn place(&mut self, place: impl Fn(FrameIndex) -> (usize, usize)) {
        self.write_instant();
        for side in self.list.iter_mut().flat_map(|touching| &mut touching.sides) {
            side.place = place(side.declared);
        }
        self.number_frames();
        self.list.iter_mut().for_each(|touching| touching.mode.mobility = [0.0; 3]);
    }

    fn number_frames(&mut self) {
        (self.frames, self.begun) = (Frames::default(), Vec::new());
        for side in self.list.iter_mut().flat_map(|touching| &mut touching.sides) {
            side.number = self.frames.number(side.place);
        }
        self.broad_phase = BroadPhase::new(&self.list, self.frames.len());
        self.is_rigid = Vec::new();
    }

    /// Returns the loadings (geometry, motions and forces) of the near pairs that were computed last, so that
    /// they can be restored after a trial step.
    pub(super) fn loadings(&self) -> Vec<Option<Loading>> {
        self.near.iter().map(|&number| self.list[number].last).collect()
    }

    /// Restores the loadings that [`Self::loadings`] returned.
    pub(super) fn set_loadings(&mut self, loadings: Vec<Option<Loading>>) {
        self.begun.clear();
        self.near.iter().zip(loadings).for_each(|(&number, loading)| self.list[number].last = loading);
    }

    /// Computes the forces of all near pairs that touch, and adds them to the external wrenches on the bodies
    /// of `trees`. Requires the kinematics of `state` in the trees.
    pub(super) fn add_forces<S: Real>(
        &mut self,
        trees: &mut [Tree<'_, S>],
        state: &State<S>,
    ) -> Result<(), ContactError> {
        let Self { list, near, frames, begun, .. } = self;
        if near.is_empty() {
            return Ok(());
        }
        // the first stage of a step begins at the state for which its modes were determined
        let is_begun = *begun == state.contacts && frames.are_of(trees, state);
        begun.clear();
        if !is_begun {
            frames.forget();
        }
        for (&number, own) in near.iter().zip(&state.contacts) {
            let touching = &mut list[number];
            if !touching.has_touched() {
                touching.last = touching.last.take().filter(|_| is_begun);
                continue;
            }
            if !is_begun || touching.last.is_none() {
                let motions = touching.motions(frames, trees, state);
                let geometry = touching.geometry(touching.mode.phase, &motions)?;
                touching.last = Some(touching.loading(touching.mode.phase, &geometry, &motions, own));
            }
            let Some(loading) = &touching.last else { continue };
            if loading.force.norm() > 0.0 || loading.moment.norm() > 0.0 {
                let [a, b] = &touching.sides;
                let moment = loading.total_moment();
                a.add_wrench(trees, &state.trees, [-loading.force, -moment], loading.point);
                b.add_wrench(trees, &state.trees, [loading.force, moment], loading.point);
            }
        }
        Ok(())
    }

    /// Writes the time derivatives of the states of the near pairs for the loadings computed last to `rates`.
    pub(super) fn rates(&self, rates: &mut Vec<ContactRate>) {
        rates.clear();
        rates.extend(self.near.iter().map(|&number| {
            let touching = &self.list[number];
            let center = self.touches[touching.contact].center;
            let loading = touching.last.as_ref().filter(|_| touching.has_touched());
            loading.map_or(ContactState::ZERO, |loading| loading.rates(center))
        }));
    }

    /// Determines the modes for the step from `t` to `end`, s, and returns the end of the step, which may be
    /// earlier than `end` while bodies touch or approach each other. The function reduces the contact states
    /// in `state` to those of the near pairs. Requires the kinematics of `state` in the trees.
    #[inline(never)]
    pub(super) fn begin<S: Real>(
        &mut self,
        (t, end): (f64, f64),
        trees: &[Tree<'_, S>],
        state: &mut State<S>,
    ) -> Result<f64, ContactError> {
        let (mut longest, mut energy, mut open) = (f64::INFINITY, 0.0, 0.0);
        self.samples.fill(Sample::FAR);
        self.frames.forget();
        self.keep(&state.contacts);
        self.find_rigid(trees);
        self.find_candidates((t, end), trees, state);
        self.begun_at = t;
        self.near.clear();
        let Self { list, near, candidates, states, frames, steps, samples, has_engine, .. } = self;
        for &number in candidates.iter() {
            let (touching, own) = (&mut list[number], &states[number]);
            let motions = touching.motions(frames, trees, state);
            touching.find_resting_points(&motions)?;
            let mobility = |sides: &_, loading: &_| mobility::mobility(sides, trees, &state.trees, loading);
            let Some(loading) = touching.begin((t, end), &motions, own, mobility)? else { continue };
            near.push(number);
            if *has_engine {
                touching.prepare_for_engine(trees, &state.trees, &loading);
            }
            longest = longest.min(touching.longest_step(*steps, &motions, &loading, *has_engine));
            energy += touching.energy();
            open += touching.open_energy(&loading, own);
            samples[touching.contact].add(touching, &motions, &loading);
            touching.last = Some(loading);
        }
        if self.has_engine {
            self.near.clear();
            self.near.extend(0..self.list.len()); // the engine changes the states of any pair
        }
        state.contacts.clear();
        state.contacts.extend(self.near.iter().map(|&number| self.states[number]));
        if !self.has_engine {
            self.begun.clone_from(&state.contacts);
        }
        self.energy_error = if energy > 0.0 { self.steps.energy_error * energy } else { f64::INFINITY };
        self.open_energies = [open; 2];
        self.update_touches(t);
        if longest >= end - t {
            return Ok(end);
        }
        // equal steps, so that the last is not very short
        let count = ((end - t) / longest).ceil().max(1.0);
        Ok(t + (end - t) / count)
    }

    /// Returns the smallest margin of any pair to its next change of mode; it is negative beyond the change.
    /// Requires the kinematics of `state`, relative to W, in the trees.
    pub(super) fn margin<S: Real>(
        &mut self,
        trees: &[Tree<'_, S>],
        state: &State<S>,
    ) -> Result<f64, ContactError> {
        let (mut least, mut open) = (f64::INFINITY, 0.0);
        let Self { list, near, frames, ignores_slip, .. } = self;
        frames.forget();
        for (&number, own) in near.iter().zip(&state.contacts) {
            let touching = &list[number];
            if touching.mode.phase == Phase::Far || (touching.law.is_none() && touching.rigid.is_none()) {
                continue;
            }
            let loading = touching.evaluate(&touching.motions(frames, trees, state), own)?;
            open += touching.open_energy(&loading, own);
            let [depth, normal, friction] = touching.margins(&loading);
            let slack = touching.mode.slack;
            let friction = if *ignores_slip { f64::INFINITY } else { friction + slack[2] };
            least = least.min(depth + slack[0]).min(normal + slack[1]).min(friction);
        }
        self.open_energies[1] = open;
        Ok(least)
    }
}

impl Touching {
    #[inline]
    fn motions<S: Real>(
        &self,
        frames: &mut Frames,
        trees: &[Tree<'_, S>],
        state: &State<S>,
    ) -> [SideMotion; 2] {
        [0, 1].map(|i| self.sides[i].motion(frames.motion(self.sides[i].number, trees, state)))
    }

    /// Returns the quoted names of the links of both sides, joined by "and", for error messages.
    fn links<S: Real>(&self, trees: &[Tree<'_, S>]) -> String {
        let frame = |side: &Side| &trees[side.place.0].model.frames()[side.place.1].name;
        let [a, b] = [&self.sides[0], &self.sides[1]].map(frame);
        format!("'{a}' and '{b}'")
    }

    /// Returns true if both sides are fixed to the same body, or if a connection of an external engine holds
    /// both sides together, as after a capture.
    fn is_rigid<S: Real>(&self, trees: &[Tree<'_, S>]) -> bool {
        let [a, b] = [0, 1].map(|i| self.sides[i].place);
        let body = |(tree, frame): (usize, usize)| trees[tree].model.frames()[frame].body;
        self.is_held || (a.0 == b.0 && body(a) == body(b))
    }
}

/// Returns, for each piece of a side, whether the other side contains the same piece.
fn on_both(pieces: &[ContactSide], others: &[ContactSide]) -> Vec<bool> {
    let key =
        |piece: &ContactSide| (piece.frame, piece.pose, piece.shape.bounding_sphere(), piece.shape.name());
    let others: Vec<_> = others.iter().map(key).collect();
    pieces.iter().map(|piece| others.contains(&key(piece))).collect()
}

/// Returns the distance from the origin of a frame to the farthest point of a shape at `pose` in the frame,
/// m; infinity for a half-space.
fn reach(shape: &Shape, pose: &Pose) -> f64 {
    let BoundingSphere { center, radius } = shape.bounding_sphere();
    if radius.is_finite() { pose.to_common(center).norm() + radius } else { f64::INFINITY }
}

/// Returns a function that converts an error of a contact at `t`, s, to an error of the run.
pub(super) fn at_time(t: f64) -> impl Fn(ContactError) -> SimulationError {
    move |source| SimulationError::Contact { time: t, source }
}
