//! Division of collision meshes into convex pieces.

use super::Any;
use crate::arrays::{array_of, whole};
use crate::errors::{fields, raise};
use crate::pickling::absolute;
use numpy::{PyArrayDyn, PyArrayMethods};
use onorbit_core::geometry::{Hull, Solid};
use onorbit_core::model::Geometry;
use onorbit_core::spatial::Vec3;
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use std::ffi::CString;
use std::path::Path;

/// Largest accepted number of pieces per mesh.
const MOST: i64 = 1000;
/// Ratio of the excess volume of the pieces to the volume of the mesh above which a warning is issued.
const EXCESS: f64 = 0.1;

/// Reads the argument `pieces`: the largest number of convex pieces per mesh, from 1 to [`MOST`].
pub(super) fn count(value: Any<'_, '_>) -> PyResult<i64> {
    let count = whole(value, "pieces")?;
    if (1..=MOST).contains(&count) {
        return Ok(count);
    }
    let (py, expected) = (value.py(), format!("from 1 to {MOST}"));
    let message =
        format!("pieces is {count}; the largest number of convex pieces must be {expected}, such as 16");
    Err(raise(py, "InputError", &message, &fields!(py, "name": "pieces", "got": count, "expected": expected)))
}

/// Reads a mesh, multiplies its coordinates by `scale`, and returns at most `count` convex pieces. A convex
/// mesh is one piece.
pub(super) fn of_mesh(
    py: Python<'_>,
    filename: &str,
    scale: [f64; 3],
    count: i64,
) -> PyResult<Vec<Geometry>> {
    let failed = |cause: String| raise(py, "ModelError", &cause, &fields!(py, "path": filename));
    let filename = &absolute(Path::new(filename)).to_string_lossy().into_owned();
    let solid = py.detach(|| Solid::read(filename, scale)).map_err(failed)?;
    if let Some(warning) = &solid.warning {
        warn(py, warning.clone())?;
    }
    if count == 1 || solid.is_convex() {
        return Ok(vec![solid.hull.geometry()]);
    }
    let hulls = divided(py, &solid, count, filename)?;
    let excess = solid.excess(&hulls);
    if excess > EXCESS {
        let subject = match hulls.len() {
            1 => format!("the convex piece of the mesh '{filename}' has"),
            several => format!("the {several} convex pieces of the mesh '{filename}' have"),
        };
        let message = format!(
            "{subject} {:.0} % more volume than the mesh, which is filled in part where it is concave; for a closer \
             approximation, increase 'pieces', which is {count}",
            100.0 * excess
        );
        warn(py, message)?;
    }
    Ok(hulls.iter().map(Hull::geometry).collect())
}

/// Divides a solid that is not convex into at most `count` pieces, and returns their convex hulls.
fn divided(py: Python<'_>, solid: &Solid, count: i64, filename: &str) -> PyResult<Vec<Hull>> {
    let mesh = &solid.mesh;
    let vertices: Vec<f64> = mesh.vertices.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let vertices = array_of(py, &[mesh.vertices.len(), 3], &vertices);
    let module = py.import("onorbit_rs.convex_pieces.divide")?;
    let pieces = module.call_method1("pieces_of", (vertices, &mesh.triangles, count, filename))?;
    let pieces: Vec<Bound<'_, PyArrayDyn<f64>>> = pieces.extract()?;
    let mut hulls = Vec::new();
    for piece in pieces {
        let rows = piece.readonly();
        let points: Vec<_> = rows.as_slice()?.chunks_exact(3).map(Vec3::from_slice).collect();
        hulls.extend(Hull::new(&points)); // a piece without volume is left out
    }
    Ok(hulls)
}

pub(super) fn warn(py: Python<'_>, warning: String) -> PyResult<()> {
    PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(warning)?, 1)
}
