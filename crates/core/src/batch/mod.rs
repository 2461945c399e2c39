//! Every kernel for one state or many: inputs and outputs are flat rows of `f64`.

mod evaluate;
mod input;
mod kepler_states;
mod kernel;
mod propagate;
mod rollout;
mod side_by_side;
mod space;
mod threads;
mod work;

pub use evaluate::Evaluator;
pub use input::{InputError, Wrenches};
pub use kepler_states::kepler_states;
pub use kernel::Kernel;
pub use propagate::{Times, propagate};
pub use rollout::{Rollout, RolloutControl};
pub use space::{Rows, RowsMut};
pub use threads::Threads;
