//! Runs: the plant, its integrators, events, the trace and its certificate.

mod certificate;
mod checkpoint;
mod driver;
mod error;
mod integrator;
mod plant;
mod probe;
mod recorder;
mod run;
mod schedule;
mod settings;
mod start;
mod state;
mod surroundings;
mod trace;

pub use certificate::{Certificate, Check, certify};
pub use checkpoint::{Checkpoint, CheckpointError};
pub use error::{RunFailure, SimulationError};
pub use integrator::Integrator;
pub(crate) use integrator::Stages;
pub(crate) use plant::{Nothing, Plant};
pub use run::{Moment, Monitor};
pub use settings::Simulation;
pub(crate) use state::State;
pub use trace::Trace;
