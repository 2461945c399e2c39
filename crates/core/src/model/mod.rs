//! The robot: an immutable tree of bodies on one free base.

mod align;
mod builder;
mod compile;
mod configuration;
mod description;
mod error;
mod inertia_check;
mod load_ratio;
mod lookup;
mod tree;
pub mod urdf;
mod well_posed;

use align::rotation_to_axis;

pub use builder::ModelBuilder;
pub use configuration::{difference, integrate, neutral};
pub use description::{Geometry, Inertial, Joint, JointKind, Limits, Link, Visual};
pub use error::{ModelError, ModelWarning};
pub use tree::{Axis, Frame, JointProperties, Model, Node};
