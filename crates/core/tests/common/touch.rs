//! Bodies and contacts for tests of contacts.

use nalgebra::Matrix3;
use onorbit_core::contact::{Contact, ContactLaw, ContactSide};
use onorbit_core::geometry::{Pose, Shape};
use onorbit_core::model::Model;
use onorbit_core::world::{FrameIndex, System};
use std::sync::Arc;

/// Returns a rigid body with isotropic inertia at `position` that moves along x at `speed`.
pub fn body(name: &str, mass: f64, inertia: f64, position: [f64; 3], speed: f64) -> System {
    let model = Arc::new(Model::rigid_body(mass, Matrix3::identity() * inertia).unwrap());
    let [x, y, z] = position;
    System::new(name, model, vec![x, y, z, 0.0, 0.0, 0.0, 1.0], vec![speed, 0.0, 0.0, 0.0, 0.0, 0.0])
}

/// Returns a shape about the origin of a frame.
pub fn side(system: usize, frame: usize, shape: Shape) -> ContactSide {
    ContactSide { frame: FrameIndex { system, frame }, shape, pose: Pose::identity() }
}

/// Returns the contact of one shape on each side.
pub fn contact(name: &str, sides: [ContactSide; 2], law: ContactLaw) -> Contact {
    let sides = sides.map(|side| vec![side]);
    Contact { name: name.to_owned(), sides, law: Some(law), impact: None, may_start_overlapping: true }
}
