//! Distances between collision shapes: closed forms for spheres, pairs of capsules and half-spaces, a search
//! along the middle circle for tori, and GJK and EPA for the other pairs of convex shapes.
//!
//! | Equation | Function |
//! |-|-|
//! | signed distance from a point to a shape, its closest point and normal | [`signed_distance`] |
//! | signed distance between two shapes, `max over n of min bᵀn − max aᵀn` for convex ones | [`closest()`] |
//! | contact points, `w_i ∝ a_i g(s_i)` | [`manifold()`] |
//!
//! `n` is a unit vector; `a` and `b` are points of the first and of the second shape.

mod boundary;
mod bounding_sphere;
mod closest;
mod contact_point;
mod convex;
mod dual;
mod epa;
mod error;
mod facets;
mod feature;
mod gjk;
mod gradient;
mod hull;
mod least;
mod link_shape;
mod manifold;
mod mesh;
mod mesh_file;
mod patch;
mod polygon;
mod polytope;
mod pose;
mod profile;
mod projection;
mod proximity;
mod segment;
mod shape;
mod simplex;
mod solid;
mod support;
mod torus;

pub use boundary::{BoundaryPoint, signed_distance};
pub use bounding_sphere::BoundingSphere;
pub use closest::closest;
pub(crate) use closest::closest_of_valid;
pub use contact_point::ContactPoint;
pub use error::{GeometryError, PosedPair};
pub use hull::{Face, Hull};
pub use least::{LeastDistance, ShapeSet};
pub use link_shape::{LinkShape, link_shape, shape_of};
pub use manifold::{Manifold, manifold};
pub(crate) use manifold::{Points, touching_points};
pub use mesh::{Mesh, MeshDefect};
pub use pose::Pose;
pub use proximity::Proximity;
pub use shape::Shape;
pub use solid::Solid;
