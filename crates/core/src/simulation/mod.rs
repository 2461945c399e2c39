//! Runs: the plant, its integrators, events, the trace and its certificate.

mod certificate;
mod checkpoint;
mod contacts;
mod driver;
mod error;
mod exchange;
mod integrator;
mod launch;
mod pair;
mod plant;
mod probe;
mod recorder;
mod rereference;
mod rows;
mod run;
mod schedule;
mod settings;
mod start;
mod state;
mod stepping;
mod stick;
mod surroundings;
mod tableau;
mod tolerance;
mod trace;

pub use certificate::{Certificate, Check, certify};
pub use checkpoint::{Checkpoint, CheckpointError};
pub use error::{RunFailure, SimulationError};
pub use integrator::Integrator;
pub(crate) use plant::{Nothing, Plant};
pub use run::{Moment, Monitor};
pub use settings::Simulation;
pub(crate) use state::State;
pub(crate) use stepping::{Stepper, Stepping};
pub use trace::{GoalResult, NamedColumn, Trace};
