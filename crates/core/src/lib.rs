//! Free-floating articulated dynamics for robots in orbit.
//!
//! Folders depend downwards only, in this order: `spatial`, `model`, `dynamics`, `earth`,
//! `gravity`, `orbit`, `environment`, `reference`, `control`, `simulation`, `batch`.

pub mod batch;
pub mod control;
pub mod dynamics;
pub mod earth;
pub mod environment;
pub mod gravity;
pub mod model;
pub mod number_text;
pub mod orbit;
pub mod reference;
pub mod simulation;
pub mod spatial;
pub mod text_file;

#[cfg(doctest)] // its examples run with those of the crate
#[doc = include_str!("../../../docs/api/rust.md")]
mod documentation {}
