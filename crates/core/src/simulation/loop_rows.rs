//! Rows of the closed loops: the forces of their constraints and their openings.

use super::equations::EquationsOfMotion;
use super::loop_row::LoopRow;
use super::members::Place;
use super::run_state::RunState;
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::dynamics::base_rotation;
use crate::model::{Closure, Constraint, Model};
use crate::spatial::{Real, Scalar, Vec3};
use crate::world::{Action, Event};

impl<S: Real> Tree<'_, S> {
    /// Adds the force, moment, point and opening of every closed loop at `state` to `rows`; `tree` is the
    /// index of this tree. Requires the kinematics of `state`, the loads and the modes of the joints.
    fn add_loop_rows(&mut self, tree: usize, state: &TreeState<S>, rows: &mut Vec<LoopRow>) {
        if self.loops.is_empty() {
            return;
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
        let row = |closure: usize| {
            let (point, wrench) = loops.wrench(closure, &self.data);
            let mut values = [0.0; 11];
            for (part, vector) in [rot_wb * wrench.linear, rot_wb * wrench.angular, rot_wb * point + base]
                .into_iter()
                .enumerate()
            {
                vector.lane(0).write(&mut values[3 * part..]);
            }
            values[9..].copy_from_slice(&loops.magnitudes(closure, loops.errors()));
            LoopRow { tree, closure, values }
        };
        rows.extend((0..loops.closures().len()).filter(frames).map(row));
    }
}

impl<S: Scalar> RunState<'_, S> {
    /// Adds the forces and openings of the closed loops to the last rows of all systems. Requires the
    /// kinematics and loads of the state, or of the state in the row buffer if `is_within_step`, in the
    /// equations of motion.
    #[inline(never)]
    pub(super) fn record_loops(&mut self, is_within_step: bool) {
        let mut rows = std::mem::take(&mut self.loop_rows);
        rows.clear();
        let state = if is_within_step { &self.row_buffers.0 } else { &self.state };
        for (number, (tree, state)) in self.equations.trees.iter_mut().zip(&state.trees).enumerate() {
            tree.add_loop_rows(number, state, &mut rows);
        }
        for number in 0..self.systems.len() {
            for column in 0..self.systems[number].recorder.trace.loops.len() {
                let values = self.values_of_loop(number, column, &rows);
                self.systems[number].recorder.trace.loops[column].values.extend_from_slice(&values);
            }
        }
        self.loop_rows = rows;
    }

    /// Returns the values of the loop that a column of a system records; zeros if this loop is not closed.
    /// `column` is the index among the columns of loops, and `rows` contains the values of all loops.
    fn values_of_loop(&self, system: usize, column: usize, rows: &[LoopRow]) -> [f64; 11] {
        let EquationsOfMotion { trees, members, .. } = &self.equations;
        let tree = members.tree_at(members.places[system]);
        let column = &self.systems[system].recorder.trace.loops[column];
        let is_own = |row: &&LoopRow| {
            let name = &trees[tree].loops.closures()[row.closure].name;
            self.own_loop_name(system, name).is_some_and(|name| name == column.name)
        };
        let found = rows.iter().filter(|row| row.tree == tree).find(is_own);
        found.map_or([0.0; 11], |row| row.values)
    }

    /// Returns the name of the column of a loop in the trace of a system from the name of the loop in a tree;
    /// `None` if the loop belongs to another system.
    pub(super) fn own_loop_name<'n>(&'n self, system: usize, name: &'n str) -> Option<&'n str> {
        if let Place::Tree(_) = self.equations.members.places[system] {
            return Some(name);
        }
        let closed_by = || {
            let weld = self.connections.active.welds.iter().find(|weld| weld.loop_name() == name)?;
            (weld.by.system == system).then(|| &*self.events.list[weld.capture].name)
        };
        let own = name.strip_prefix(&*self.layout.systems()[system].name);
        own.and_then(|name| name.strip_prefix('/')).or_else(closed_by)
    }
}

/// Returns the names of the closed loops that the trace of a system records: the loops of its model, and the
/// captures by the system that may close a loop because other captures may connect the same two systems.
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
