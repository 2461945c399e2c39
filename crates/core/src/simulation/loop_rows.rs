//! Rows of the closed loops: the forces of their constraints and their openings.

use super::equations::EquationsOfMotion;
use super::members::Place;
use super::run_state::RunState;
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::dynamics::base_rotation;
use crate::model::{Closure, Constraint, Model};
use crate::spatial::{Real, Scalar, Vec3};
use crate::world::{Action, Event};

impl<S: Real> Tree<'_, S> {
    /// Returns, for every closed loop at `state`, its name in the tree and its row in the order of the parts
    /// of [`LOOPS`](super::LOOPS). Requires the kinematics of `state`, the loads and the modes of the joints.
    pub(super) fn loop_rows(&mut self, state: &TreeState<S>) -> Vec<(String, [f64; 11])> {
        if self.loops.is_empty() {
            return Vec::new();
        }
        if let Some(clock) = state.clock {
            self.modes.accelerate_given(clock.lane(0));
        }
        self.update_joint_forces(&state.q, &state.v);
        let mut a = std::mem::take(&mut self.scratch);
        self.accelerate(&state.v, &mut a);
        self.scratch = a;
        self.loops.update_errors(&self.data, &state.q);
        let rot_wb = base_rotation(&state.q);
        let (loops, base) = (&self.loops, Vec3::from_slice(&state.q));
        let frames = |i: &usize| matches!(loops.closures()[*i].constraint, Constraint::Frames { .. });
        let row = |i: usize| {
            let (point, wrench) = loops.wrench(i, &self.data);
            let errors: Vec<f64> = loops.errors().iter().map(|x| x.lane(0)).collect();
            let mut row = [0.0; 11];
            for (part, vector) in [rot_wb * wrench.linear, rot_wb * wrench.angular, rot_wb * point + base]
                .into_iter()
                .enumerate()
            {
                vector.lane(0).write(&mut row[3 * part..]);
            }
            row[9..].copy_from_slice(&loops.magnitudes(i, &errors));
            (loops.closures()[i].name.clone(), row)
        };
        (0..loops.closures().len()).filter(frames).map(row).collect()
    }
}

impl<S: Scalar> RunState<'_, S> {
    /// Adds the forces and openings of the closed loops to the last rows of all systems. Requires the
    /// kinematics and loads of the state, or of the state in the row buffer if `is_within_step`, in the
    /// equations of motion.
    pub(super) fn record_loops(&mut self, is_within_step: bool) {
        if self.systems.iter().all(|run| run.recorder.trace.loops.is_empty()) {
            return;
        }
        let Self { equations: EquationsOfMotion { trees, members, .. }, state, row_buffers, .. } = self;
        let state = if is_within_step { &row_buffers.0 } else { &*state };
        let rows: Vec<_> =
            trees.iter_mut().zip(&state.trees).map(|(tree, state)| tree.loop_rows(state)).collect();
        let trees: Vec<usize> = members.places.iter().map(|&place| members.tree_at(place)).collect();
        for (number, tree) in trees.into_iter().enumerate() {
            let own: Vec<(String, [f64; 11])> = rows[tree]
                .iter()
                .filter_map(|(name, row)| Some((self.own_loop_name(number, name)?, *row)))
                .collect();
            self.systems[number].recorder.record_loops(&own);
        }
    }

    /// Returns the name of the column of a loop in the trace of a system from the name of the loop in a tree;
    /// `None` if the loop belongs to another system.
    pub(super) fn own_loop_name(&self, system: usize, name: &str) -> Option<String> {
        if let Place::Tree(_) = self.equations.members.places[system] {
            return Some(name.to_owned());
        }
        let prefix = format!("{}/", self.layout.systems()[system].name);
        let closed_by = || {
            let weld = self.connections.active.welds.iter().find(|weld| weld.loop_name() == name)?;
            (weld.by.system == system).then(|| self.events.list[weld.capture].name.clone())
        };
        name.strip_prefix(&prefix).map(str::to_owned).or_else(closed_by)
    }
}

/// Returns the names of the closed loops that the trace of a system records: those of its model, and the
/// captures by it that connect systems which other captures may also connect.
pub(super) fn recorded_loops(number: usize, model: &Model, events: &[Event]) -> Vec<String> {
    let is_loop = |closure: &&Closure| matches!(closure.constraint, Constraint::Frames { .. });
    let own = model.closures().iter().filter(is_loop).map(|closure| closure.name.clone());
    let closing = events.iter().enumerate().filter_map(|(i, event)| match event.action {
        Action::Capture { by, of, .. }
            if by.system == number && others_connect(events, i, [by.system, of.system]) =>
        {
            Some(event.name.clone())
        }
        _ => None,
    });
    own.chain(closing).collect()
}

/// Returns true if captures other than the event with index `number` may connect two systems, directly or
/// through other systems.
fn others_connect(events: &[Event], number: usize, [a, b]: [usize; 2]) -> bool {
    let mut reached = vec![a];
    let mut next = 0;
    while let Some(&system) = reached.get(next) {
        next += 1;
        for (_, event) in events.iter().enumerate().filter(|(i, _)| *i != number) {
            let Action::Capture { by, of, .. } = event.action else { continue };
            for (from, to) in [(by.system, of.system), (of.system, by.system)] {
                if from == system && !reached.contains(&to) {
                    reached.push(to);
                }
            }
        }
    }
    reached.contains(&b)
}
