//! Distances between links.

use crate::arrays::{array_of, text, type_name};
use crate::errors::{IntoPython, fields, raise};
use crate::model::PyModel;
use crate::world::PyWorld;
use numpy::{PyArrayDyn, PyArrayMethods};
use onorbit_core::geometry::{Pose, Proximity, Shape, closest};
use onorbit_core::number_text::short;
use onorbit_core::spatial::{Mat3, Vec3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Signed distance between two links, with the nearest points and the normal, as returned by
/// :func:`distance`.
#[pyclass(name = "Distance", frozen, module = "onorbit_rs")]
pub(crate) struct PyDistance(Proximity);

#[pymethods]
impl PyDistance {
    /// Signed distance, m. If the links overlap, it is minus the length of the shortest translation that
    /// separates them.
    #[getter]
    fn distance(&self) -> f64 {
        self.0.distance
    }

    /// Point on the surface of the first link that is nearest to the second link or, if they overlap, deepest
    /// in it: (3,), in W, m.
    #[getter]
    fn point_a<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        vector(py, self.0.point_a)
    }

    /// Corresponding point on the surface of the second link, ``point_a + distance * normal``: (3,), in W, m.
    #[getter]
    fn point_b<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        vector(py, self.0.point_b)
    }

    /// Unit vector from the first link to the second, axes of W, (3,).
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        vector(py, self.0.normal)
    }

    fn __repr__(&self) -> String {
        let Vec3 { x, y, z } = self.0.normal;
        let [x, y, z] = [x, y, z].map(short);
        format!("<Distance {} m along [{x}, {y}, {z}]>", short(self.0.distance))
    }
}

fn vector(py: Python<'_>, v: Vec3<f64>) -> Bound<'_, PyArrayDyn<f64>> {
    array_of(py, &[3], &[v.x, v.y, v.z])
}

/// Return the signed distance between the collision shapes of two links.
///
/// The shapes are those of the ``<collision>`` elements (boxes, cylinders, spheres, capsules, and the convex
/// hulls of STL and OBJ meshes) and those added with :meth:`Model.with_collision`. If a link has several
/// shapes, the smallest distance counts.
///
/// Parameters
/// ----------
/// model_or_world : Model or World
///     Robot, or world of several systems.
/// q : (nq,) array or dict of str to (nq,) array
///     Configuration, m and rad; for a world, a dict with the configuration of each system that ``a`` and
///     ``b`` name.
/// a, b : str
///     Names of two links; in a world, ``"SYSTEM/LINK"``.
///
/// Returns
/// -------
/// Distance
///     ``distance`` (m, negative if the links overlap), ``point_a``, ``point_b`` (m) and ``normal``, in W.
///
/// Raises
/// ------
/// FrameError
///     If there is no such link.
/// WorldError
///     If there is no such system, or a name is not ``"SYSTEM/LINK"``.
/// ModelError
///     If a link has no collision shape, or an invalid one, such as a mesh file that does not exist.
/// InputError
///     If ``a`` and ``b`` are the same link, the configuration of a system is missing or invalid, or the
///     distance is not available: between two half-spaces, and if the middle circle of a torus intersects
///     the other shape.
/// ShapeError, DtypeError
///     If a configuration has the wrong shape, or an argument has the wrong type.
/// ConvergenceError
///     If the iterations for the distance do not converge.
#[pyfunction]
pub(crate) fn distance(
    model_or_world: Any<'_, '_>,
    q: Any<'_, '_>,
    a: Any<'_, '_>,
    b: Any<'_, '_>,
) -> PyResult<PyDistance> {
    let py = q.py();
    let names = [name_of(a, "a")?, name_of(b, "b")?];
    if names[0] == names[1] {
        let message = format!("a and b are both '{}'; give the names of two different links", names[0]);
        return Err(raise(py, "InputError", &message, &fields!(py, "name": "b", "got": &names[1])));
    }
    let [(shape_a, pose_a), (shape_b, pose_b)] = if let Ok(model) = model_or_world.cast::<PyModel>() {
        [posed(model, q, &names[0])?, posed(model, q, &names[1])?]
    } else if let Ok(world) = model_or_world.cast::<PyWorld>() {
        [in_world(world.get(), q, &names[0])?, in_world(world.get(), q, &names[1])?]
    } else {
        let got = type_name(model_or_world);
        let message = format!("model_or_world is of type {got}; expected a Model or a World");
        return Err(raise(
            py,
            "DtypeError",
            &message,
            &fields!(py, "name": "model_or_world", "got": got, "expected": "Model or World"),
        ));
    };
    closest(&shape_a, &pose_a, &shape_b, &pose_b).map(PyDistance).map_err(|error| error.into_python(py))
}

fn name_of(value: Any<'_, '_>, name: &str) -> PyResult<String> {
    text(value, name, "the name of a link (str)")
}

/// Returns the collision shape of a link and its pose in W.
fn posed(model: &Bound<'_, PyModel>, q: Any<'_, '_>, link: &str) -> PyResult<(Shape, Pose)> {
    let (py, model) = (q.py(), model.get());
    let frame = model.model.frame(link).map_err(|error| error.into_python(py))?;
    let shape = model.collision_shape(py, frame)?;
    let rows = model.pose_rows(q, frame)?;
    let rows = rows.readonly();
    let rows = rows.as_slice()?;
    let column = |j: usize| Vec3::new(rows[j], rows[4 + j], rows[8 + j]);
    let rot = Mat3::from_columns(column(0), column(1), column(2));
    Ok((shape, Pose { rot, pos: column(3) }))
}

/// Returns the collision shape of the link `SYSTEM/LINK` of a world, and its pose in W.
fn in_world(world: &PyWorld, q: Any<'_, '_>, path: &str) -> PyResult<(Shape, Pose)> {
    let py = q.py();
    let Some((system, link)) = path.split_once('/') else {
        let message =
            format!("'{path}' does not name a link of a world; write SYSTEM/LINK, such as 'chaser/gripper'");
        return Err(raise(py, "WorldError", &message, &fields!(py, "name": path, "got": path)));
    };
    let model = world.model_of(py, system)?;
    let Ok(configurations) = q.cast::<PyDict>() else {
        let got = type_name(q);
        let message = format!("q is of type {got}; expected a dict from names of systems to configurations");
        return Err(raise(
            py,
            "DtypeError",
            &message,
            &fields!(py, "name": "q", "got": got, "expected": "dict"),
        ));
    };
    let Some(q) = configurations.get_item(system)? else {
        let message = format!("q has no configuration of the system '{system}'; add q['{system}']");
        return Err(raise(py, "InputError", &message, &fields!(py, "name": "q", "expected": system)));
    };
    posed(&model, &q, link)
}
