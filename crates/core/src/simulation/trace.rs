//! Trace of one system of a run.

use super::certificate::{PairChecks, RowChecks};
use super::columns::{CONTACTS, Column, LOOPS, TRACKING, WRENCHES};
use crate::control::Outcome;
use crate::model::{BASE_NQ, Model};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Declares the trace with a field for each row of the table of columns.
macro_rules! define_trace {
    ($($name:ident ($($axis:tt),+), $unit:literal, $frame:literal, $condition:ident, $parts:ident,
        $meaning:literal;)+) => {
        /// Recorded motion of one system of a run, with one row per recorded step. The first row is the
        /// initial state and the last row the final state. Columns are in row-major order; columns that do
        /// not apply to the run are empty.
        #[derive(Clone, Debug, Default)]
        pub struct Trace {
            $(
                #[doc = concat!($meaning, " Shape ", stringify!(($($axis),+)), ", unit ", $unit, ".")]
                pub $name: Vec<f64>,
            )+
            /// Tracking errors of the controls, m and rad or, for a grip force, N, one column per control;
            /// see [`TRACKING`].
            pub tracking: Vec<NamedColumn>,
            /// Wrenches on every body: one column per effect and, if a control follows external commands,
            /// one column for the commanded wrenches; see [`WRENCHES`].
            pub wrenches: Vec<NamedColumn>,
            /// Distances and forces of the contacts of which the system is the first side, one column per
            /// contact; see [`CONTACTS`].
            pub contacts: Vec<NamedColumn>,
            /// Forces of the closed loops of the system and of the captures by it that may close a loop, one
            /// column per loop; see [`LOOPS`].
            pub loops: Vec<NamedColumn>,
            /// Outcomes of the goals of the controls.
            pub results: Vec<GoalResult>,
            /// Times at which the run changed to a new reference orbit, s; see
            /// [`REREFERENCED`](super::columns::REREFERENCED).
            pub rereferenced: Vec<f64>,
            /// Sum of the magnitudes of the work done in each step, J. The sum is computed during the run,
            /// because sparse rows would miss work that changes sign.
            pub work_done: f64,
            /// Estimated attitude error at the end of the run, rad: the accumulated difference between steps
            /// and half steps or, for an embedded pair, between its two solutions. The amplification of
            /// errors by the motion is not included. `None` if errors of steps are not estimated.
            pub attitude_step_doubling: Option<f64>,
            /// Accumulated differences between steps and half steps: one entry for the base's origin, then
            /// one per joint. Empty for an adaptive integrator and for an external engine.
            pub step_doubling: Vec<CoordinateDrift>,
            /// Results of the checks that compare successive steps, evaluated during a fixed-step run if its
            /// rows are not sufficient; `None` otherwise.
            pub pair_checks: Option<PairChecks>,
            /// True if the rows are sufficient for the checks that compare successive steps: every step of a
            /// fixed-step run is recorded and, unless an external engine moves the system, its group has
            /// neither events nor contacts with friction. False once unchecked rows were removed.
            pub rows_suffice: bool,
            /// Checks of the rows that were removed during the run; `None` if no rows were removed, or if
            /// they were not checked.
            pub removed: Option<Box<RowChecks>>,
        }

        impl Trace {
            /// Returns all columns with their paths, including empty columns: first the fields, then the
            /// columns of the controls, the effects, the contacts and the loops.
            pub fn columns(&self) -> impl Iterator<Item = (Cow<'static, str>, &Vec<f64>)> {
                let tracking = self.tracking.iter().map(|column| (column.path(&TRACKING), &column.values));
                let wrenches = self.wrenches.iter().map(|column| (column.path(&WRENCHES), &column.values));
                let contacts = self.contacts.iter().map(|column| (column.path(&CONTACTS), &column.values));
                let loops = self.loops.iter().map(|column| (column.path(&LOOPS), &column.values));
                [$((Cow::Borrowed(stringify!($name)), &self.$name)),+]
                    .into_iter()
                    .chain(tracking)
                    .chain(wrenches)
                    .chain(contacts)
                    .chain(loops)
            }

            /// Returns the columns of [`Trace::columns`] as mutable references.
            pub fn columns_mut(&mut self) -> impl Iterator<Item = (Cow<'static, str>, &mut Vec<f64>)> {
                let tracking =
                    self.tracking.iter_mut().map(|column| (column.path(&TRACKING), &mut column.values));
                let wrenches =
                    self.wrenches.iter_mut().map(|column| (column.path(&WRENCHES), &mut column.values));
                let contacts =
                    self.contacts.iter_mut().map(|column| (column.path(&CONTACTS), &mut column.values));
                let loops = self.loops.iter_mut().map(|column| (column.path(&LOOPS), &mut column.values));
                [$((Cow::Borrowed(stringify!($name)), &mut self.$name)),+]
                    .into_iter()
                    .chain(tracking)
                    .chain(wrenches)
                    .chain(contacts)
                    .chain(loops)
            }
        }
    };
}

crate::trace_columns!(define_trace);

/// Column of one control, effect, contact or loop.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedColumn {
    /// Name of the control, effect, contact or loop.
    pub name: String,
    /// Number of values per row.
    pub width: usize,
    /// Values of all rows, `(T, width)`, in row-major order.
    pub values: Vec<f64>,
}

impl NamedColumn {
    /// Returns the path of the column, which contains the name of its control, effect, contact or loop.
    fn path(&self, column: &Column) -> Cow<'static, str> {
        Cow::Owned(column.path_of(&self.name))
    }
}

/// Error estimates of one coordinate over a run: sums of the differences between a step and two half steps,
/// the largest rate, and the sum of the jumps of the acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CoordinateDrift {
    /// Sum of the differences of the position, m or rad.
    pub position: f64,
    /// Sum of the differences of the rate, m/s or rad/s; for the base's origin, of the velocity of the centre
    /// of mass.
    pub rate: f64,
    /// Largest magnitude of the rate, m/s or rad/s.
    pub fastest: f64,
    /// Sum `Σ (h |Δq̈|/6)^(5/4)`, with the jump `Δq̈` of a joint's acceleration, rad/s² or m/s², from the end
    /// of a step of length `h`, s, to the start of the next step; zero for the base's origin.
    pub jumps: f64,
}

impl CoordinateDrift {
    /// Returns the error estimates over two successive intervals, of which `before` has those of the first
    /// and `self` those of the second.
    pub(super) fn after(&self, before: &Self) -> Self {
        Self {
            position: self.position + before.position,
            rate: self.rate + before.rate,
            fastest: self.fastest.max(before.fastest),
            jumps: self.jumps + before.jumps,
        }
    }
}

/// Outcome of the goal of a control.
#[derive(Clone, Debug, PartialEq)]
pub struct GoalResult {
    /// Name of the control.
    pub name: String,
    /// Whether the control has reached its goal, and when, or which error was too large.
    pub outcome: Outcome,
    /// Component whose error was too large: the name of a joint, `position`, `attitude` or `force`; `None` if
    /// no error was too large.
    pub component: Option<String>,
}

impl Trace {
    /// Returns the number of rows, `T`.
    pub fn rows(&self) -> usize {
        self.time.len()
    }

    /// Returns the number of rows, including those that were removed after they were checked.
    pub fn rows_recorded(&self) -> usize {
        self.rows() + self.removed.as_ref().map_or(0, |removed| removed.rows())
    }

    /// Returns true if the trace has rows and every column has the same number of values in each of them.
    pub fn has_all_values(&self) -> bool {
        let rows = self.rows();
        rows > 0 && self.columns().all(|(_, column)| column.len() % rows == 0)
    }

    /// Removes `excess` rows after the first one, given the number of values per row of each column.
    pub(super) fn remove(&mut self, excess: usize, widths: &[usize]) {
        for ((_, column), width) in self.columns_mut().zip(widths) {
            column.drain(*width..(1 + excess) * width);
        }
    }

    /// Returns the names of the joints whose positions exceed their limits by more than 1e-9 rad or m in any
    /// row.
    pub fn limits_exceeded<'m>(&self, model: &'m Model) -> Vec<&'m str> {
        const ROUNDING: f64 = 1e-9;
        let is_past = |j: usize, (lower, upper): (f64, f64)| {
            let removed = self.removed.iter().map(|removed| removed.joint_range(j));
            let values = self.q.chunks_exact(model.nq()).map(|q| (q[BASE_NQ + j], q[BASE_NQ + j]));
            let mut ranges = values.chain(removed);
            ranges.any(|(lowest, highest)| lowest < lower - ROUNDING || highest > upper + ROUNDING)
        };
        let joints = model.joints().iter().enumerate();
        joints
            .filter(|(j, joint)| joint.limits.position.is_some_and(|limits| is_past(*j, limits)))
            .map(|(_, joint)| joint.name.as_str())
            .collect()
    }

    /// Returns row `k` of a column with `width` values per row.
    pub(super) fn row(column: &[f64], k: usize, width: usize) -> &[f64] {
        &column[k * width..(k + 1) * width]
    }
}
