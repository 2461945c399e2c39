//! Buffers of a step, its first stage, and the moving frame of the step.

use crate::dynamics::base_rotation;
use crate::simulation::equations::EquationsOfMotion;
use crate::simulation::external_loads::ExternalLoads;
use crate::simulation::state::{Rate, State};
use crate::simulation::tree_state::{TreeRate, TreeState};
use crate::spatial::{Real, Vec3};

/// States and time derivatives at the stages of a step. The buffers are allocated at the start of a run, and
/// again when its trees change.
pub(crate) struct Stages<S> {
    /// State at the start of the step, with velocities relative to the frames of the step.
    pub(crate) start: State<S>,
    /// State at which the last stage was evaluated, with velocities relative to the frames of the step.
    pub(super) trial: State<S>,
    /// Time derivatives at the last stage.
    pub(crate) rate: Rate<S>,
    /// Weighted sum of the time derivatives at the stages of the step.
    pub(super) sum: Rate<S>,
    /// First stage of each tree.
    pub(crate) first: Vec<FirstStage<S>>,
}

/// Acceleration, external force and velocity of the moving frame of one tree at the first stage of a step,
/// relative to W.
pub(crate) struct FirstStage<S> {
    /// Acceleration at the start of the step, `(nv,)`, m/s² and rad/s².
    pub(crate) acceleration: Vec<S>,
    /// Sum of the external forces at the start of the step, W axes, N.
    pub(crate) force: Vec3<S>,
    /// Velocity of the base's origin at the start of the step, which is also the velocity of the step's
    /// frame, base axes, m/s.
    pub(super) frame_velocity_b: Vec3<S>,
}

/// State at the start of the last step of one tree, and time derivatives at the last stage of that step.
pub(crate) struct StepEnds<'a, S> {
    /// State at the start, with its velocity relative to the frame of the step.
    pub(crate) start: &'a TreeState<S>,
    pub(crate) first: &'a FirstStage<S>,
    /// Time derivatives at the last stage.
    pub(crate) last: &'a TreeRate<S>,
}

impl<S: Real> Stages<S> {
    pub(crate) fn new(state: &State<S>) -> Self {
        let rate = Rate::of(state);
        let first = |state: &TreeState<S>| FirstStage {
            acceleration: vec![S::of(0.0); state.v.len()],
            force: Vec3::zero(),
            frame_velocity_b: Vec3::zero(),
        };
        Self {
            start: state.clone(),
            trial: state.clone(),
            sum: rate.clone(),
            rate,
            first: state.trees.iter().map(first).collect(),
        }
    }

    /// Evaluates the first stage and changes to the moving frames of the step. Requires the kinematics and
    /// loads of `state` in `equations`.
    pub(crate) fn evaluate_first(
        &mut self,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &State<S>,
    ) {
        self.start.copy_from(state);
        for ((first, tree), start) in
            self.first.iter_mut().zip(&mut equations.trees).zip(&mut self.start.trees)
        {
            first.frame_velocity_b = Vec3::from_slice(&start.v);
            tree.enter_step_frame(&start.q, &mut start.v);
        }
        equations.rates(&self.start, &mut self.rate);
        for ((first, rate), start) in self.first.iter_mut().zip(&self.rate.trees).zip(&self.start.trees) {
            first.take(rate, &start.v);
        }
    }

    /// Completes the step that ended at `state`: refers its velocities to W instead of the moving frames of
    /// the step and, in a run with contacts, the angular impulses of the trees to their own centres of mass.
    pub(super) fn finish(
        &self,
        equations: &EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
    ) {
        equations.end_step(&self.start, state);
        Self::leave_step_frame(equations, state);
    }

    /// Transforms the velocities of `state` from the moving frames of the step to W: `v = v' + Rᵀ u` with the
    /// velocity `u` of the frame.
    pub(super) fn leave_step_frame(
        equations: &EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
    ) {
        for (tree, state) in equations.trees.iter().zip(&mut state.trees) {
            S::enter(
                #[inline(always)]
                || {
                    let frame_velocity_b = base_rotation(&state.q).transpose_mul(tree.frame_velocity());
                    (Vec3::from_slice(&state.v) + frame_velocity_b).write(&mut state.v);
                },
            );
        }
    }

    /// Returns both ends of the last step of each tree.
    pub(crate) fn ends(&self) -> impl Iterator<Item = StepEnds<'_, S>> {
        let parts = self.start.trees.iter().zip(&self.first).zip(&self.rate.trees);
        parts.map(|((start, first), last)| StepEnds { start, first, last })
    }

    /// Returns `q` and `v`, relative to W, of the tree with index `number` at the start of the last step, in
    /// the first lane.
    pub(crate) fn start_state(&self, number: usize) -> [Vec<f64>; 2] {
        let start = &self.start.trees[number];
        let mut v = start.v.clone();
        (Vec3::from_slice(&v) + self.first[number].frame_velocity_b).write(&mut v);
        [&start.q, &v].map(|x| x.iter().map(|x| x.lane(0)).collect())
    }

    /// Returns true if the state of the tree with index `number` in the last stage is finite.
    pub(crate) fn is_finite(&self, number: usize) -> bool {
        self.trial.trees[number].is_finite()
    }
}

impl<S: Real> FirstStage<S> {
    /// Stores the acceleration and the external force at the start of the step from `rate`; `v` is the
    /// velocity relative to the frame of the step.
    fn take(&mut self, rate: &TreeRate<S>, v: &[S]) {
        self.force = rate.wrench.linear;
        self.acceleration.copy_from_slice(&rate.a);
        // in base axes, the constant velocity u of the step's frame rotates: a = a' − (ω × u, 0)
        S::enter(
            #[inline(always)]
            || {
                let turning = Vec3::from_slice(&v[3..]).cross(self.frame_velocity_b);
                let linear = Vec3::from_slice(&self.acceleration) - turning;
                linear.write(&mut self.acceleration);
            },
        );
    }
}

/// Computes `sum = Σ w_i k_i` over the stages `k_i` with the weights `w_i`.
pub(super) fn combine<S: Real>(sum: &mut Rate<S>, stages: &[Rate<S>], weights: &[f64]) {
    sum.clear();
    for (k, &weight) in stages.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
        S::enter(
            #[inline(always)]
            || sum.accumulate(k, S::of(weight)),
        );
    }
}
