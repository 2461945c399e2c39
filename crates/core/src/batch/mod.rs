//! Kernels, rollouts and orbits for one or many states. Inputs and outputs are flat arrays of `f64` rows.

mod call;
mod evaluate;
mod gather_scatter;
mod input;
mod kepler_states;
mod kernels;
mod propagate;
mod rollout;
mod threads;
mod workspace;

pub use call::{Rows, RowsMut, Wrenches};
pub use evaluate::Evaluator;
pub use input::InputError;
pub use kepler_states::kepler_states;
pub use kernels::Kernel;
pub use propagate::{Times, propagate};
pub use rollout::{Rollout, RolloutControl};
pub use threads::Threads;
