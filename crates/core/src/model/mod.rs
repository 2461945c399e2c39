//! Robot models: immutable trees of bodies with a free-floating base.

mod align;
mod attach;
mod builder;
mod close;
mod closed_loop;
mod closure;
mod collision;
mod compile;
mod compile_closures;
mod configuration;
mod coordinates;
mod description;
mod error;
mod frame;
mod inertia_check;
mod joint_change;
mod joint_spring;
mod link_change;
mod load_ratio;
mod lookup;
mod reroot;
mod tree;
pub mod urdf;
mod well_posed;

use align::rotation_to_axis;

pub use attach::Mount;
pub use builder::ModelBuilder;
pub use closed_loop::{Loop, LoopKind, Mimic};
pub use closure::{Closure, Constraint};
pub use configuration::{difference, integrate, neutral};
pub use coordinates::{ANGULAR, BASE_NQ, BASE_NV, QUATERNION};
pub use description::{Description, Geometry, Inertial, Joint, JointKind, Limits, Link, Visual};
pub use error::{ModelError, ModelWarning};
pub(crate) use error::{closest, nearest};
pub use frame::Frame;
pub use joint_change::JointChange;
pub use joint_spring::JointSpring;
pub use link_change::LinkChange;
pub use tree::{Axis, JointProperties, Model, Node};
