//! Free-floating articulated dynamics for robots in orbit.
//!
//! Folders depend downwards only, in this order: `spatial`, `model`, `dynamics`, `orbit`,
//! `environment`, `reference`, `control`, `simulation`, `batch`.

pub mod environment;
pub mod orbit;
