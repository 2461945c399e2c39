//! Distances between collision shapes: closed forms for spheres, pairs of capsules and half-spaces, and GJK and EPA for
//! the other pairs of convex shapes.
//!
//! | Equation | Function |
//! |-|-|
//! | signed distance from a point to a shape, its closest point and normal | [`signed_distance`] |
//! | signed distance of two shapes, `max over n of min bᵀn − max aᵀn` for convex ones | [`closest`] |

mod boundary;
mod bounding_sphere;
mod closest;
mod convex;
mod epa;
mod error;
mod gjk;
mod hull;
mod polytope;
mod pose;
mod profile;
mod proximity;
mod segment;
mod shape;
mod simplex;
mod support;

pub use boundary::{BoundaryPoint, signed_distance};
pub use bounding_sphere::BoundingSphere;
pub use closest::closest;
pub use error::{GeometryError, PosedPair};
pub use hull::{Face, Hull};
pub use pose::Pose;
pub use proximity::Proximity;
pub use shape::Shape;
