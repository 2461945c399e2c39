//! Kernels, rollouts and propagation of orbits, for one or many states. Inputs and outputs are flat arrays of
//! `f64` rows.

mod call;
mod closed_starts;
mod evaluate;
mod gather_scatter;
mod input;
mod kepler_states;
mod kernels;
mod looped_torque;
mod propagate;
mod rollout;
mod rollout_lanes;
mod rollout_settings;
mod threads;
mod workspace;

pub use call::{Rows, RowsMut, Wrenches};
pub use evaluate::Evaluator;
pub use input::InputError;
pub use kepler_states::kepler_states;
pub use kernels::Kernel;
pub use propagate::{Times, propagate};
pub use rollout_settings::{Rollout, RolloutControl};
pub use threads::Threads;
