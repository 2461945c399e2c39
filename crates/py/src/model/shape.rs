//! Shapes for contacts, distances and keep-out zones.

use super::{Any, convex_pieces};
use crate::arrays::fixed;
use crate::errors::{fields, raise};
use crate::pickling::{ConstructorCall, Reduced};
use onorbit_core::geometry::{Pose, Shape, shape_of};
use onorbit_core::model::Geometry;
use onorbit_core::number_text::short;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Shape for contacts, distances and keep-out zones.
///
/// Spheres, boxes, cylinders, capsules, cones and tori are centred at the origin of the shape's axes. Shapes
/// of revolution have their axis along z. There is one constructor per kind, such as ``Shape.sphere(0.1)``.
#[pyclass(name = "Shape", frozen, module = "onorbit_rs")]
pub(crate) struct PyShape {
    /// One geometry, or one for each convex piece of a mesh.
    pub(super) geometries: Vec<Geometry>,
    pub(crate) shape: Shape,
    call: ConstructorCall,
}

#[pymethods]
impl PyShape {
    /// Return a sphere centred at the origin.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Radius, m.
    ///
    /// Returns
    /// -------
    /// Shape
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If a length is not positive and finite.
    #[staticmethod]
    fn sphere(py: Python<'_>, radius: f64) -> PyResult<Self> {
        let keywords = lengths(py, "sphere", &[("radius", radius)])?;
        Self::new(py, "sphere", keywords, Geometry::Sphere { radius })
    }

    /// Return a box with edges along x, y and z, centred at the origin.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float
    ///     Lengths of the edges, m.
    ///
    /// Returns
    /// -------
    /// Shape
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If a length is not positive and finite.
    #[staticmethod]
    fn r#box(py: Python<'_>, x: f64, y: f64, z: f64) -> PyResult<Self> {
        let keywords = lengths(py, "box", &[("x", x), ("y", y), ("z", z)])?;
        Self::new(py, "box", keywords, Geometry::Box([x, y, z]))
    }

    /// Return a cylinder along z, centred at the origin.
    ///
    /// Parameters
    /// ----------
    /// radius, length : float
    ///     Radius and length, m.
    ///
    /// Returns
    /// -------
    /// Shape
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If a length is not positive and finite.
    #[staticmethod]
    fn cylinder(py: Python<'_>, radius: f64, length: f64) -> PyResult<Self> {
        let keywords = lengths(py, "cylinder", &[("radius", radius), ("length", length)])?;
        Self::new(py, "cylinder", keywords, Geometry::Cylinder { radius, length })
    }

    /// Return a capsule along z, centred at the origin.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Radius, m.
    /// length : float
    ///     Distance between the centres of the caps, m.
    ///
    /// Returns
    /// -------
    /// Shape
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If a length is not positive and finite.
    #[staticmethod]
    fn capsule(py: Python<'_>, radius: f64, length: f64) -> PyResult<Self> {
        let keywords = lengths(py, "capsule", &[("radius", radius), ("length", length)])?;
        Self::new(py, "capsule", keywords, Geometry::Capsule { radius, length })
    }

    /// Return a cone with its base at ``z = -height/2`` and its apex at ``z = height/2``.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Radius of the base, m.
    /// height : float
    ///     Height, m.
    ///
    /// Returns
    /// -------
    /// Shape
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If a length is not positive and finite.
    #[staticmethod]
    fn cone(py: Python<'_>, radius: f64, height: f64) -> PyResult<Self> {
        let keywords = lengths(py, "cone", &[("radius", radius), ("height", height)])?;
        Self::new(py, "cone", keywords, Geometry::Cone { radius, length: height })
    }

    /// Return a torus about the z axis, centred at the origin.
    ///
    /// Parameters
    /// ----------
    /// major_radius : float
    ///     Radius of the circle along which the tube runs, measured to the middle of the tube, m.
    /// minor_radius : float
    ///     Radius of the tube, m.
    ///
    /// Returns
    /// -------
    /// Shape
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If a length is not positive and finite, or ``minor_radius`` is not less than ``major_radius``.
    #[staticmethod]
    fn torus(py: Python<'_>, major_radius: f64, minor_radius: f64) -> PyResult<Self> {
        let keywords =
            lengths(py, "torus", &[("major_radius", major_radius), ("minor_radius", minor_radius)])?;
        if minor_radius >= major_radius {
            let (minor, major) = (short(minor_radius), short(major_radius));
            let message = format!(
                "the minor_radius of a torus is {minor} m; it must be less than the major_radius, {major} m"
            );
            let fields = fields!(py, "name": "minor_radius", "got": minor_radius);
            return Err(raise(py, "InputError", &message, &fields));
        }
        Self::new(py, "torus", keywords, Geometry::Torus { major_radius, minor_radius })
    }

    /// Return a half-space: all points with ``z <= 0``.
    ///
    /// Returns
    /// -------
    /// Shape
    #[staticmethod]
    fn half_space(py: Python<'_>) -> PyResult<Self> {
        Self::new(py, "half_space", PyDict::new(py), Geometry::HalfSpace)
    }

    /// Return the convex hull of a mesh, or its convex pieces.
    ///
    /// Unlike the hull, convex pieces do not fill notches and holes. The tool CoACD computes the pieces,
    /// which takes seconds to minutes; they are stored in the user's cache folder. A convex mesh is one
    /// piece.
    ///
    /// Parameters
    /// ----------
    /// path : path
    ///     Path of an STL or OBJ file with coordinates in m.
    /// scale : (3,) array, optional
    ///     Factors by which the coordinates of the mesh are multiplied; default: 1.
    /// pieces : int, optional
    ///     Largest number of convex pieces, for which the mesh must be closed. Default: the convex hull is
    ///     used.
    ///
    /// Returns
    /// -------
    /// Shape
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If ``pieces`` is below 1 or above 1000.
    /// ModelError
    ///     If the file does not exist or is not a mesh with a volume. With ``pieces``, also if the mesh is
    ///     open, or if CoACD fails or is not installed (``pip install 'onorbit-rs[meshes]'``).
    #[staticmethod]
    #[pyo3(signature = (path, *, scale=None, pieces=None))]
    fn mesh(
        py: Python<'_>,
        path: PathBuf,
        scale: Option<Any<'_, '_>>,
        pieces: Option<Any<'_, '_>>,
    ) -> PyResult<Self> {
        let scale = scale.map(|scale| fixed::<3>(scale, "scale", &[3])).transpose()?.unwrap_or([1.0; 3]);
        let filename = crate::pickling::absolute(&path).to_string_lossy().into_owned();
        let keywords = PyDict::new(py);
        keywords.set_item("path", &filename)?;
        keywords.set_item("scale", scale)?;
        let Some(pieces) = pieces else {
            return Self::new(py, "mesh", keywords, Geometry::Mesh { filename, scale });
        };
        let count = convex_pieces::count(pieces)?;
        keywords.set_item("pieces", count)?;
        let geometries = convex_pieces::of_mesh(py, &filename, scale, count)?;
        Self::of_all(py, "mesh", &keywords, geometries)
    }

    /// Type of the shape: ``box``, ``cylinder``, ``capsule``, ``sphere``, ``cone``, ``torus``, ``half_space``
    /// or ``mesh``.
    #[getter]
    fn kind(&self) -> &'static str {
        match &self.geometries[0] {
            Geometry::Box(_) => "box",
            Geometry::Cylinder { .. } => "cylinder",
            Geometry::Capsule { .. } => "capsule",
            Geometry::Sphere { .. } => "sphere",
            Geometry::Cone { .. } => "cone",
            Geometry::Torus { .. } => "torus",
            Geometry::HalfSpace => "half_space",
            Geometry::Mesh { .. } | Geometry::Hull { .. } => "mesh",
        }
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.call.reduce(py)
    }

    fn __repr__(&self) -> String {
        format!("<Shape: {}>", self.kind())
    }
}

impl PyShape {
    fn new(py: Python<'_>, kind: &str, keywords: Bound<'_, PyDict>, geometry: Geometry) -> PyResult<Self> {
        Self::of_all(py, kind, &keywords, vec![geometry])
    }

    /// Creates the shape that is the union of `geometries`.
    fn of_all(
        py: Python<'_>,
        kind: &str,
        keywords: &Bound<'_, PyDict>,
        geometries: Vec<Geometry>,
    ) -> PyResult<Self> {
        let mut warnings = Vec::new();
        let shapes = geometries.iter().map(|geometry| shape_of(geometry, "a shape", &mut warnings));
        let shapes: Result<Vec<Shape>, String> = shapes.collect();
        let shapes = shapes.map_err(|cause| raise(py, "ModelError", &cause, &fields!(py,)))?;
        for warning in warnings {
            convex_pieces::warn(py, warning)?;
        }
        let shape = match &shapes[..] {
            [shape] => shape.clone(),
            _ => Shape::Compound(shapes.into_iter().map(|shape| (shape, Pose::identity())).collect()),
        };
        let call = ConstructorCall::with_keywords(&format!("Shape.{kind}"), keywords)?;
        Ok(Self { geometries, shape, call })
    }
}

/// Returns the lengths of a shape, m, as keyword arguments. A length that is not positive and finite is an
/// error.
fn lengths<'py>(py: Python<'py>, kind: &str, given: &[(&str, f64)]) -> PyResult<Bound<'py, PyDict>> {
    let keywords = PyDict::new(py);
    for &(name, got) in given {
        if !(got > 0.0 && got.is_finite()) {
            let got_text = short(got);
            let message = format!("the {name} of a {kind} is {got_text} m; it must be positive and finite");
            return Err(raise(py, "InputError", &message, &fields!(py, "name": name, "got": got)));
        }
        keywords.set_item(name, got)?;
    }
    Ok(keywords)
}
