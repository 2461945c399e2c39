//! Errors of checkpoints.

use crate::number_text::{count, short};
use thiserror::Error;

/// Reason why a run cannot resume from a checkpoint.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // the messages explain the fields
pub enum CheckpointError {
    #[error("the checkpoint is damaged: {reason}; run the scenario again")]
    Unreadable { reason: String },
    #[error(
        "the checkpoint was written by version {found} of onorbit_rs, but this is version {own}, which may round \
         differently; resume with version {found}, or run the scenario again"
    )]
    OtherVersion { found: String, own: String },
    #[error(
        "the checkpoint was written with the instruction set {found}, but this run uses {own}, which rounds \
         differently; set ONORBIT_INSTRUCTION_SET={found}, or run the scenario again"
    )]
    OtherInstructionSet { found: String, own: String },
    #[error(
        "the checkpoint was written after {expected}, but the given trace has {got}; pass exactly the rows recorded before the \
         checkpoint",
        expected = count(*expected, "row"), got = count(*got, "row")
    )]
    MissingRows { got: usize, expected: usize },
    #[error(
        "the checkpoint belongs to another scenario: it has {got} for '{name}', but this simulation has {expected}; \
         resume with the original scenario",
        got = count(*got, "entry")
    )]
    OtherSize { name: &'static str, got: usize, expected: usize },
    #[error("the checkpoint belongs to another scenario: {difference}; resume with the original scenario")]
    OtherColumns { difference: String },
    #[error(
        "the checkpoint belongs to another scenario: its column '{name}' has {got}, but this simulation \
         requires {expected}; resume with the original scenario",
        got = count(*got, "number")
    )]
    ColumnLength { name: String, got: usize, expected: usize },
    #[error(
        "the checkpoint belongs to another scenario, a run {duration} with steps of {step} s, from which this run differs \
         in {what}; resume with the original scenario",
        duration = duration.map_or("without a planned end".to_owned(), |end| format!("of {} s", short(end))),
        step = short(*step)
    )]
    OtherSchedule { duration: Option<f64>, step: f64, what: String },
}
