//! Conservation certificate of a run, which checks a trace against the laws of mechanics.

mod attitude;
mod balance;
mod base_rows;
mod center_of_mass;
mod certify;
mod checks;
mod error_measures;
mod loop_opening;
mod step_doubling;
mod stream;
mod trace_row;

pub use certify::certify;
pub use checks::{Certificate, Check, PairChecks};
pub(crate) use checks::{ENERGY, MOMENTUM};
pub(super) use stream::{Stream, Sums};
pub(super) use trace_row::{BaseMotion, MassMotion};
