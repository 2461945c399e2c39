//! Following every step of a run whose rows are sparse, for its certificate.

use super::certificate::{BaseMotion, MassMotion, PairChecks, Restore, Stream};
use super::checkpoint::CheckpointError;
use super::error::SimulationError;
use super::integrator::Stages;
use super::plant::Plant;
use super::recorder::{Extras, Recorder};
use super::run::Run;
use super::state::State;
use super::surroundings::Surroundings;
use crate::dynamics::center_of_mass;
use crate::model::Model;
use crate::spatial::{Quat, Scalar, Vec3};

/// Numbers of a checkpoint that describe the start of a step under way.
const STEP_UNDER_WAY: usize = 9 * 3 + 5;

/// One end of a step.
#[derive(Clone, Copy)]
struct End {
    base: BaseMotion,
    whole: MassMotion,
}

/// The certificate of a run that is under way.
pub(super) struct Follower {
    stream: Stream,
    /// Start of the step under way, and the last that is known of it: accelerations at its end.
    open: Option<End>,
    /// Rows of a step that is looked at closely.
    rows: Recorder,
}

impl Follower {
    pub(super) fn new(model: &Model) -> Result<Self, SimulationError> {
        let rows = Recorder::new(2, model, Extras::none(), &[], true)?;
        Ok(Self { stream: Stream::new(model), open: None, rows })
    }

    /// What the checks found so far.
    pub(super) fn checks(&self) -> PairChecks {
        self.stream.checks()
    }

    /// Ends the step under way at a settled state whose kinematics are in the plant.
    pub(super) fn close<S: Scalar>(&mut self, t: f64, state: &State<S>, plant: &Plant<'_, S, Surroundings>) {
        if let Some(open) = self.open.take().filter(|open| open.base.time < t) {
            let mut now = End::of(t, state, plant);
            // the accelerations at the end of the step were kept in those of its start
            now.base.change_before = open.base.change_before;
            now.base.changes = open.base.changes;
            now.whole.force_before = open.whole.force_before;
            self.stream.add((&open.base, &open.whole), (&now.base, &now.whole));
        }
    }

    /// Opens the step that `stages` took from the settled `state` at `t`.
    pub(super) fn open(&mut self, mut start: Started, stages: &Stages<impl Scalar>) {
        let sum = |x: &mut dyn Iterator<Item = f64>| x.sum::<f64>();
        let End { base, whole } = &mut start.0;
        let first = stages.first_acceleration();
        base.change_after = value(Vec3::from_slice(&first[3..]));
        let last = &stages.rate.a;
        base.change_before = value(Vec3::from_slice(&last[3..]));
        base.changes = sum(&mut last[3..].iter().map(|x| x.value().abs())) + base.rates * base.rates;
        whole.force_after = value(stages.first_force());
        whole.force_before = value(stages.rate.wrench.linear);
        self.open = Some(start.0);
    }

    /// Leaves out the step under way.
    pub(super) fn forget(&mut self) {
        self.open = None;
    }

    /// All numbers, as bits.
    pub(super) fn save(&self) -> Vec<u64> {
        let mut numbers = Vec::new();
        self.stream.save(&mut numbers);
        if let Some(End { base, whole }) = &self.open {
            let vectors = [
                base.attitude.v,
                base.rate,
                base.change_before,
                base.change_after,
                whole.center,
                whole.momentum,
                whole.impulse,
                whole.force_before,
                whole.force_after,
            ];
            numbers.extend(vectors.iter().flat_map(|v| [v.x, v.y, v.z]));
            numbers.extend([base.time, base.attitude.w, base.rates, base.changes, whole.mass]);
        }
        numbers.into_iter().map(f64::to_bits).collect()
    }

    /// Takes up what [`Follower::save`] gave.
    pub(super) fn load(&mut self, bits: &[u64]) -> Result<(), CheckpointError> {
        let mut own = Vec::new();
        self.stream.save(&mut own);
        let (name, got) = ("numbers of the certificate", bits.len());
        let expected = own.len() + if got > own.len() { STEP_UNDER_WAY } else { 0 };
        if got != expected {
            return Err(CheckpointError::OtherSize { name, got, expected });
        }
        let numbers: Vec<f64> = bits.iter().map(|bits| f64::from_bits(*bits)).collect();
        let mut from = Restore::new(&numbers);
        self.stream.restore(&mut from);
        if !from.is_complete() {
            let mut vectors = [Vec3::zero(); 9];
            vectors.iter_mut().for_each(|v| *v = from.vector());
            let [v, rate, change_before, change_after, center, momentum, impulse, force_before, force_after] =
                vectors;
            let [time, w, rates, changes, mass] = std::array::from_fn(|_| from.next());
            let attitude = Quat { v, w };
            let base = BaseMotion {
                time,
                attitude,
                rate,
                change_before,
                change_after,
                rates,
                changes,
                is_cut: false,
            };
            let whole = MassMotion { time, mass, center, momentum, impulse, force_before, force_after };
            self.open = Some(End { base, whole });
        }
        debug_assert!(from.is_complete());
        Ok(())
    }
}

/// The start of a step, before it is taken.
pub(super) struct Started(End);

impl Started {
    /// At a settled state whose kinematics are in the plant.
    pub(super) fn at<S: Scalar>(t: f64, state: &State<S>, plant: &Plant<'_, S, Surroundings>) -> Self {
        Self(End::of(t, state, plant))
    }
}

impl End {
    /// All but accelerations and forces.
    fn of<S: Scalar>(time: f64, state: &State<S>, plant: &Plant<'_, S, Surroundings>) -> Self {
        let attitude = Quat { v: value(Vec3::from_slice(&state.q[3..])), w: state.q[6].value() };
        let rate = value(Vec3::from_slice(&state.v[3..]));
        let rates: f64 = state.v[3..].iter().map(|x| x.value().abs()).sum();
        let zero = Vec3::zero();
        let base = BaseMotion {
            time,
            attitude,
            rate,
            change_before: zero,
            change_after: zero,
            rates,
            changes: rates * rates,
            is_cut: false,
        };
        let whole = MassMotion {
            time,
            mass: plant.model.mass(),
            center: value(center_of_mass(&plant.data, &state.q)),
            momentum: value(state.momentum().linear),
            impulse: value(state.impulse.linear),
            force_before: zero,
            force_after: zero,
        };
        Self { base, whole }
    }
}

fn value<S: Scalar>(v: Vec3<S>) -> Vec3<f64> {
    Vec3::new(v.x.value(), v.y.value(), v.z.value())
}

impl<S: Scalar> Run<'_, S> {
    /// The row at the start of a step that is looked at closely. Needs kinematics and wrenches there.
    pub(super) fn open_window(&mut self, t: f64) -> Result<(), SimulationError> {
        let Self { state, plant, follower, .. } = self;
        let Some(Follower { rows, .. }) = follower.as_deref_mut() else { return Ok(()) };
        rows.clear();
        rows.row(t, state, plant, None, None);
        rows.felt(plant, t)
    }

    /// The row at its end, and what the two say. The plant is left at the end of the step.
    pub(super) fn close_window(&mut self, start: f64, t: f64) -> Result<(), SimulationError> {
        let Self { state, plant, stepper, follower, between: (end, stages), .. } = self;
        let Some(Follower { rows, stream, .. }) = follower.as_deref_mut() else { return Ok(()) };
        rows.accelerated(plant.model, stepper.stages.first_acceleration());
        if !state.is_finite() {
            return Ok(());
        }
        end.copy_from(state);
        plant.settle(end);
        plant.surround(t, (start, t), &end.q)?;
        rows.row(t, end, plant, None, None);
        rows.felt(plant, t)?;
        stages.accelerate(plant, end);
        rows.accelerated(plant.model, stages.first_acceleration());
        stream.look_closely(plant.model, &rows.trace);
        Ok(())
    }
}
