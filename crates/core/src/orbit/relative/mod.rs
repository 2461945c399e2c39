//! Relative motion of two satellites: linear motion, local coordinates, relative elements, and states in W.

mod elements;
mod hill;
mod local;
mod world;

pub use elements::{deputy_state, deputy_states, relative_elements, relative_elements_rows};
pub use hill::{hill_transition, hill_transitions, intercept_velocity};
pub use local::{LocalFrame, from_local, from_local_rows, to_local, to_local_rows};
pub use world::to_world;

use super::OrbitError;
use nalgebra::Vector3;

/// Returns an error if an array has the wrong length; `arrays` holds names, expected and actual lengths.
fn check(arrays: &[(&'static str, usize, usize)]) -> Result<(), OrbitError> {
    match arrays.iter().find(|(_, expected, got)| expected != got) {
        Some(&(name, expected, got)) => Err(OrbitError::WrongLength { name, expected, got }),
        None => Ok(()),
    }
}

/// Returns row `index` of an (N, 3) array as a vector.
fn row(rows: &[f64], index: usize) -> Vector3<f64> {
    Vector3::from_column_slice(&rows[3 * index..][..3])
}
