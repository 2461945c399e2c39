//! Least distances between two sets of shapes, for many poses at once.

use crate::arrays::array_of;
use crate::errors::{IntoPython, fields, raise};
use crate::model::{PyModel, PyShape};
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use onorbit_core::geometry::{GeometryError, LeastDistance, Pose, Shape, ShapeSet};
use onorbit_core::spatial::{Mat3, Vec3};
use pyo3::prelude::*;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;
type Rows<'py> = PyReadonlyArrayDyn<'py, f64>;

/// Return the least distance between two sets of shapes for each of ``T`` poses.
///
/// Parameters
/// ----------
/// shapes_a : list of Shape or (Model, str)
///     Shapes of the first side; a model and the name of a link stand for the collision shape of the link.
/// poses_a : (T, n_a, 4, 4) array
///     Poses of these shapes in common axes, m.
/// shapes_b : list of Shape or (Model, str)
///     Shapes of the second side.
/// poses_b : (T, n_b, 4, 4) array
///     Poses of these shapes in common axes, m.
/// permitted : list of list of bool
///     Table (n_a, n_b) with True for each pair of shapes that is considered.
///
/// Returns
/// -------
/// gap, point_a, point_b, normal, pair : (T,), (T, 3), (T, 3), (T, 3) and (T, 2) arrays
///     Signed distance (m, negative if shapes overlap), nearest points of both sides (m), unit normal from
///     the first side to the second, and indices (as floats) of the nearest shapes in ``shapes_a`` and
///     ``shapes_b``. Points and normals are in the common axes.
///
/// Raises
/// ------
/// InputError
///     If no pair is permitted, or the distance of a pair is not available: between two half-spaces, and if
///     the middle circle of a torus intersects the other shape.
/// ModelError
///     If a link has no collision shape, or an invalid one.
/// FrameError
///     If there is no such link.
/// ConvergenceError
///     If the iterations for a distance do not converge.
#[pyfunction]
pub(crate) fn least_distances<'py>(
    py: Python<'py>,
    shapes_a: Vec<Bound<'py, PyAny>>,
    poses_a: Rows<'py>,
    shapes_b: Vec<Bound<'py, PyAny>>,
    poses_b: Rows<'py>,
    permitted: Vec<Vec<bool>>,
) -> PyResult<(Array<'py>, Array<'py>, Array<'py>, Array<'py>, Array<'py>)> {
    let (a, b) = (shape_set(&shapes_a)?, shape_set(&shapes_b)?);
    if !permitted.iter().flatten().any(|permitted| *permitted) {
        let message =
            "no pair of links can be compared, because all pairs are excluded; give two different links";
        return Err(raise(py, "InputError", message, &fields!(py,)));
    }
    let (rows_a, rows_b) = (poses_of(&poses_a)?, poses_of(&poses_b)?);
    let rows = rows_a.chunks(a.len().max(1)).zip(rows_b.chunks(b.len().max(1)));
    let permitted =
        |i: usize, j: usize| permitted.get(i).and_then(|row| row.get(j)).is_some_and(|permitted| *permitted);
    let found: Result<Vec<Option<LeastDistance>>, GeometryError> =
        py.detach(|| rows.map(|(own, others)| a.least_distance(own, &b, others, permitted)).collect());
    let found: Vec<LeastDistance> =
        found.map_err(|error| error.into_python(py))?.into_iter().flatten().collect();
    let vectors = |of: fn(&LeastDistance) -> Vec3<f64>| {
        let values: Vec<f64> = found.iter().map(of).flat_map(|v| [v.x, v.y, v.z]).collect();
        array_of(py, &[found.len(), 3], &values)
    };
    let gaps: Vec<f64> = found.iter().map(|least| least.proximity.distance).collect();
    let pairs: Vec<f64> = found.iter().flat_map(|least| least.pair.map(|i| i as f64)).collect();
    Ok((
        array_of(py, &[found.len()], &gaps),
        vectors(|least| least.proximity.point_a),
        vectors(|least| least.proximity.point_b),
        vectors(|least| least.proximity.normal),
        array_of(py, &[found.len(), 2], &pairs),
    ))
}

/// Reads the shapes of one side, each a `Shape` or a pair of a model and the name of a link.
fn shape_set(items: &[Bound<'_, PyAny>]) -> PyResult<ShapeSet> {
    let read = |item: &Bound<'_, PyAny>| -> PyResult<Shape> {
        if let Ok(shape) = item.cast::<PyShape>() {
            return Ok(shape.get().shape.clone());
        }
        let (model, link): (Bound<'_, PyModel>, Bound<'_, PyAny>) = item.extract()?;
        let model = model.get();
        model.collision_shape(item.py(), model.frame(&link)?)
    };
    Ok(ShapeSet::new(items.iter().map(read).collect::<PyResult<Vec<_>>>()?))
}

/// Reads poses from homogeneous matrices (..., 4, 4), with positions in m.
fn poses_of(values: &Rows<'_>) -> PyResult<Vec<Pose>> {
    let pose = |m: &[f64]| {
        let column = |j: usize| Vec3::new(m[j], m[4 + j], m[8 + j]);
        Pose { rot: Mat3::from_columns(column(0), column(1), column(2)), pos: column(3) }
    };
    Ok(values.as_slice()?.chunks_exact(16).map(pose).collect())
}
