//! Every kernel for one state or many: inputs and outputs are flat rows of `f64`.

mod evaluate;
mod input;
mod kernel;
mod rollout;
mod threads;

pub use evaluate::{Evaluator, Rows, RowsMut};
pub use input::InputError;
pub use kernel::Kernel;
pub use rollout::{Rollout, RolloutControl};
