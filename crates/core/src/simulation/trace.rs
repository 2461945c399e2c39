//! The trace of a run.

use super::certificate::PairChecks;
use super::columns::{Column, TRACKING, WRENCHES};
use crate::control::Outcome;
use crate::model::{BASE_NQ, Model};
use std::borrow::Cow;

/// Declares the trace with a field for each row of the table of columns.
macro_rules! define_trace {
    ($($name:ident ($($axis:tt),+), $unit:literal, $frame:literal, $condition:ident, $parts:ident,
        $meaning:literal;)+) => {
        /// Result of a run: one row per recorded step, row major; the first row is the initial state, the
        /// last the end. Columns that do not apply to the run are empty.
        #[derive(Clone, Debug, Default)]
        pub struct Trace {
            $(
                #[doc = concat!($meaning, " Shape ", stringify!(($($axis),+)), ", unit ", $unit, ".")]
                pub $name: Vec<f64>,
            )+
            /// Tracking errors of several controls, one column each; see [`TRACKING`].
            pub tracking: Vec<NamedColumn>,
            /// Wrenches of the effects on every body, one column each; see [`WRENCHES`].
            pub wrenches: Vec<NamedColumn>,
            /// Outcomes of the goals of several controls.
            pub results: Vec<GoalResult>,
            /// See [`REREFERENCED`](super::columns::REREFERENCED).
            pub rereferenced: Vec<f64>,
            /// Sum over all steps of the magnitude of the work of each, J. Sparse rows would miss work that
            /// changes sign.
            pub work_done: f64,
            /// Accumulated attitude difference between steps and halved steps, rad (of an embedded pair:
            /// between its two solutions): an estimate of the error at the end, apart from amplification by
            /// the motion.
            pub attitude_step_doubling: Option<f64>,
            /// Accumulated differences between steps and halved steps, of the base's origin, then of each
            /// joint; empty for an integrator that adapts its steps and for an external engine.
            pub step_doubling: Vec<CoordinateDrift>,
            /// Checks that need every step, evaluated during the run where rows are sparse.
            pub pair_checks: Option<PairChecks>,
            /// Whether every step of the run is a row.
            pub has_every_step: bool,
        }

        impl Trace {
            /// Returns every column with its path, including empty ones, then those of every control and
            /// every effect.
            pub fn columns(&self) -> impl Iterator<Item = (Cow<'static, str>, &Vec<f64>)> {
                let tracking = self.tracking.iter().map(|column| (column.path(&TRACKING), &column.values));
                let wrenches = self.wrenches.iter().map(|column| (column.path(&WRENCHES), &column.values));
                [$((Cow::Borrowed(stringify!($name)), &self.$name)),+]
                    .into_iter()
                    .chain(tracking)
                    .chain(wrenches)
            }

            /// Returns the same as [`Trace::columns`], mutable.
            pub fn columns_mut(&mut self) -> impl Iterator<Item = (Cow<'static, str>, &mut Vec<f64>)> {
                let tracking =
                    self.tracking.iter_mut().map(|column| (column.path(&TRACKING), &mut column.values));
                let wrenches =
                    self.wrenches.iter_mut().map(|column| (column.path(&WRENCHES), &mut column.values));
                [$((Cow::Borrowed(stringify!($name)), &mut self.$name)),+]
                    .into_iter()
                    .chain(tracking)
                    .chain(wrenches)
            }
        }
    };
}

crate::trace_columns!(define_trace);

/// Column of one control or of one effect.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedColumn {
    /// Name of the control or of the effect.
    pub name: String,
    /// Numbers per row.
    pub width: usize,
    /// The rows, `(T, width)`.
    pub values: Vec<f64>,
}

impl NamedColumn {
    /// Returns its path among all columns.
    fn path(&self, column: &Column) -> Cow<'static, str> {
        Cow::Owned(column.path_of(&self.name))
    }
}

/// Difference between steps and halved steps of a coordinate, summed over a run; m, or rad of a revolute
/// joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CoordinateDrift {
    /// Of its position.
    pub position: f64,
    /// Of its rate (of the base's origin: of the centre of mass).
    pub rate: f64,
    /// Largest magnitude of its rate.
    pub fastest: f64,
    /// `Σ (h |Δq̈|/6)^(5/4)`, with the jump `Δq̈` of a joint's acceleration from the end of a step of length
    /// `h` to the start of the next.
    pub jumps: f64,
}

/// Outcome of a goal.
#[derive(Clone, Debug, PartialEq)]
pub struct GoalResult {
    /// The control's name.
    pub name: String,
    /// The outcome.
    pub outcome: Outcome,
    /// The component whose error was too large: a joint, `position` or `attitude`.
    pub component: Option<String>,
}

impl Trace {
    /// Returns the number of rows, `T`.
    pub fn rows(&self) -> usize {
        self.time.len()
    }

    /// Returns the names of the joints that are beyond their position limits by more than rounding in some
    /// row.
    pub fn limits_exceeded<'m>(&self, model: &'m Model) -> Vec<&'m str> {
        const ROUNDING: f64 = 1e-9;
        let is_past = |j: usize, (lower, upper): (f64, f64)| {
            let mut values = self.q.chunks_exact(model.nq()).map(|q| q[BASE_NQ + j]);
            values.any(|q| q < lower - ROUNDING || q > upper + ROUNDING)
        };
        let joints = model.joints().iter().enumerate();
        joints
            .filter(|(j, joint)| joint.limits.position.is_some_and(|limits| is_past(*j, limits)))
            .map(|(_, joint)| joint.name.as_str())
            .collect()
    }

    /// Returns row `k` of a column with `width` numbers per row.
    pub(super) fn row(column: &[f64], k: usize, width: usize) -> &[f64] {
        &column[k * width..(k + 1) * width]
    }
}
