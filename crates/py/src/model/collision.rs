//! Changes to the collision shapes of links.

use super::attach::isometry;
use super::shape::PyShape;
use super::{Any, PyModel, convex_pieces};
use crate::errors::{IntoPython, fields, raise};
use crate::pickling::{ConstructorCall, deep_copy};
use nalgebra::Isometry3;
use onorbit_core::model::{Geometry, Visual};
use pyo3::prelude::*;

/// Returns a copy of the robot with an additional collision shape on a link. `pose` is the pose of the shape
/// in link axes, (4, 4), m (default: the identity).
pub(super) fn with_collision(
    model: &Bound<'_, PyModel>,
    link: &str,
    shape: &Bound<'_, PyShape>,
    pose: Option<Any<'_, '_>>,
) -> PyResult<PyModel> {
    let py = model.py();
    let at = pose.map(isometry).transpose()?.unwrap_or_default();
    let added = shape.get().geometries.iter().map(|geometry| visual(at, geometry.clone()));
    let old = &model.get().model;
    let mut shapes = old.collisions_of(link).map_err(|error| error.into_python(py))?.to_vec();
    shapes.extend(added);
    let new = old.with_collisions(link, shapes).map_err(|error| error.into_python(py))?;
    let keywords = fields!(py, "pose": deep_copy(pose)?);
    let call = ConstructorCall::new("Model.with_collision", (model, link, shape), &keywords)?;
    PyModel::wrap(py, new, Some(call), old.warnings())
}

/// Returns a copy of the robot in which each collision mesh of a link is replaced by at most `pieces` convex
/// pieces. A link without a collision mesh is an error.
pub(super) fn with_convex_pieces(
    model: &Bound<'_, PyModel>,
    link: &str,
    pieces: Any<'_, '_>,
) -> PyResult<PyModel> {
    let (py, count) = (model.py(), convex_pieces::count(pieces)?);
    let old = &model.get().model;
    let given = old.collisions_of(link).map_err(|error| error.into_python(py))?;
    let failed = |cause: String| {
        let message =
            format!("the collision shapes of link '{link}' cannot be divided into convex pieces: {cause}");
        raise(py, "ModelError", &message, &fields!(py, "name": link))
    };
    let frame = old.frame(link).map_err(|error| error.into_python(py))?;
    if let Some(cause) = old.skipped_collisions(frame).first() {
        return Err(failed(cause.clone()));
    }
    let (mut shapes, mut has_mesh) = (Vec::new(), false);
    for shape in given {
        match &shape.geometry {
            Geometry::Mesh { filename, scale } => {
                let parts = convex_pieces::of_mesh(py, filename, *scale, count)?;
                shapes.extend(parts.into_iter().map(|part| visual(shape.pose, part)));
                has_mesh = true;
            }
            _ => shapes.push(shape.clone()),
        }
    }
    if !has_mesh {
        let fault = if shapes.is_empty() { "the link has none" } else { "none of them is a mesh" };
        return Err(failed(format!("{fault}; choose a link with a collision mesh, or omit the division")));
    }
    let new = old.with_collisions(link, shapes).map_err(|error| error.into_python(py))?;
    let call = ConstructorCall::new("Model.with_convex_pieces", (model, link, count), &fields!(py,))?;
    PyModel::wrap(py, new, Some(call), old.warnings())
}

fn visual(pose: Isometry3<f64>, geometry: Geometry) -> Visual {
    Visual { pose, geometry, rgba: None }
}
