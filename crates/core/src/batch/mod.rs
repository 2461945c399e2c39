//! Every kernel for one state or many: inputs and outputs are flat rows of `f64`.

mod evaluate;
mod input;
mod kepler_states;
mod kernel;
mod propagate;
mod rollout;
mod threads;

pub use evaluate::{Evaluator, Rows, RowsMut};
pub use input::InputError;
pub use kepler_states::kepler_states;
pub use kernel::Kernel;
pub use propagate::{Times, propagate};
pub use rollout::{Rollout, RolloutControl};
