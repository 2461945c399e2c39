//! Runs: the plant, its integrators, events, the trace and its certificate.

mod certificate;
mod driver;
mod error;
mod integrator;
mod plant;
mod probe;
mod recorder;
mod run;
mod schedule;
mod settings;
mod state;
mod surroundings;
mod trace;

pub use certificate::{Certificate, Check, certify};
pub use error::{RunFailure, SimulationError};
pub use integrator::Integrator;
pub(crate) use integrator::Stages;
pub(crate) use plant::{Nothing, Plant};
pub use run::Monitor;
pub use settings::Simulation;
pub(crate) use state::State;
pub use trace::{GoalResult, Trace, Tracking};
