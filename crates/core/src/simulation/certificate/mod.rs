//! Conservation certificate of a run, which checks a trace against the laws of mechanics.

mod attitude;
mod balance;
mod base_rows;
mod center_of_mass;
mod certify;
mod checks;
mod error_measures;
mod loop_opening;
mod removed_rows;
mod row_checks;
mod row_reader;
mod step_doubling;
mod stream;
mod trace_row;

pub use certify::certify;
pub use checks::{Certificate, Check, PairChecks};
pub(crate) use checks::{ENERGY, MOMENTUM};
pub use removed_rows::drop_checked_rows;
pub(super) use removed_rows::remove_checked;
pub use row_checks::RowChecks;
pub(super) use stream::{Stream, Sums};
pub(super) use trace_row::{BaseMotion, MassMotion};
