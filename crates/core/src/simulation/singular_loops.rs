//! Search for closed loops that have been in a singular configuration during a run.

use super::run_state::RunState;
use super::singularity_watch::SingularLoop;
use super::tree::Tree;
use crate::spatial::{Real, Scalar};

impl<S: Real> Tree<'_, S> {
    /// Returns the names of the loops and mimic joints whose constraints have become linearly dependent, each
    /// with the time at which this happened, s. Requires that the state at `t`, s, was the last one to be
    /// projected onto the momentum and the loops.
    fn find_singular(&mut self, t: f64) -> Vec<(String, f64)> {
        if self.loops.is_empty() {
            return Vec::new();
        }
        let found = self.singularities.update(t, self.loops.pivots(), &self.kept);
        let name = |row: usize| {
            let count = self.loops.closures().len();
            let closure = (0..count).find(|i| self.loops.range_of(*i).contains(&row))?;
            Some(self.loops.closures()[closure].name.clone())
        };
        found.into_iter().filter_map(|(row, time)| Some((name(row)?, time))).collect()
    }
}

impl<S: Scalar> RunState<'_, S> {
    /// Finds the loops that have become singular. Requires that the current state is that at `t`, s, after
    /// its projection onto the momentum and the loops.
    #[inline(never)]
    pub(super) fn find_singular_loops(&mut self, t: f64) {
        if self.mover.is_external() {
            return; // an external engine solves its own constraints
        }
        let mut found = Vec::new(); // allocates only if a loop is found
        for (number, tree) in self.equations.trees.iter_mut().enumerate() {
            found.extend(tree.find_singular(t).into_iter().map(|(name, time)| (number, name, time)));
        }
        if found.is_empty() {
            return;
        }
        for number in 0..self.systems.len() {
            let members = &self.equations.members;
            let own = members.tree_at(members.places[number]);
            for (_, name, time) in found.iter().filter(|(tree, ..)| *tree == own) {
                let Some(name) = self.own_loop_name(number, name).map(str::to_owned) else { continue };
                let system = self.layout.systems()[number].name.clone();
                let is_known = |known: &SingularLoop| (&known.system, &known.name) == (&system, &name);
                if !self.singular_loops.iter().any(is_known) {
                    self.singular_loops.push(SingularLoop { system, name, time: *time });
                }
            }
        }
    }
}
