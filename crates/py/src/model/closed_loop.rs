//! Closed loops of a robot.

use super::attach::isometry;
use super::{Any, PyModel};
use crate::arrays::{list_of, text};
use crate::errors::{IntoPython, fields, raise};
use crate::pickling::{ConstructorCall, Reduced};
use nalgebra::Isometry3;
use onorbit_core::model::{Loop, LoopKind, Mimic};
use pyo3::prelude::*;
use pyo3::types::PyDict;

const KINDS: [(&str, LoopKind); 5] = [
    ("weld", LoopKind::Weld),
    ("revolute", LoopKind::Revolute),
    ("spherical", LoopKind::Spherical),
    ("prismatic", LoopKind::Prismatic),
    ("distance", LoopKind::Distance),
];

/// Joint between two frames of a robot that closes a kinematic loop.
///
/// The joint is a constraint and has no joint position. By default, it coincides with each of the two frames
/// when the loop is closed. Its axis is the z axis of its pose.
///
/// Parameters
/// ----------
/// name : str
///     Name, unique among the loops of the robot.
/// kind : {"weld", "revolute", "spherical", "prismatic", "distance"}
///     Type of the joint: ``weld`` permits no relative motion, ``revolute`` permits rotation about z,
///     ``spherical`` all rotations, and ``prismatic`` translation along z. ``distance`` keeps the distance
///     between the two origins constant, like a massless rod with ball joints.
/// frame_a, frame_b : str
///     Links or frames on two different bodies; in a :class:`World`, ``SYSTEM/FRAME``.
/// pose_a, pose_b : (4, 4) array, optional
///     Pose of the joint in ``frame_a`` and in ``frame_b``, m. Default: the identity.
/// length : float, optional
///     Distance between the origins, m; only with ``distance``. Default: the distance with all joint
///     positions zero.
/// project : bool
///     If True, a simulation starts in the nearest configuration that closes the loop. If False, a start that
///     does not close the loop is an error.
///
/// Raises
/// ------
/// ModelError
///     If the kind is unknown, a pose is invalid, or a length is given with a kind other than ``distance``.
/// InputError, ShapeError
///     If a pose is not finite or has the wrong shape.
#[pyclass(name = "Loop", frozen, module = "onorbit_rs", eq)]
#[derive(Clone, PartialEq)]
pub(crate) struct PyLoop {
    pub(crate) closing: Loop,
}

#[pymethods]
impl PyLoop {
    #[new]
    #[pyo3(signature = (name, kind, frame_a, frame_b, *, pose_a=None, pose_b=None, length=None, project=false))]
    fn new(
        py: Python<'_>,
        name: &str,
        kind: &str,
        frame_a: Any<'_, '_>,
        frame_b: Any<'_, '_>,
        pose_a: Option<Any<'_, '_>>,
        pose_b: Option<Any<'_, '_>>,
        length: Option<f64>,
        project: bool,
    ) -> PyResult<Self> {
        let refuse = |problem: &str| {
            let message = format!("loop '{name}' {problem}");
            raise(py, "ModelError", &message, &fields!(py,))
        };
        let Some((_, kind)) = KINDS.into_iter().find(|(known, _)| *known == kind) else {
            let known = KINDS.map(|(name, _)| name).join(", ");
            return Err(refuse(&format!("is of kind '{kind}'; the kinds are {known}")));
        };
        if length.is_some() && kind != LoopKind::Distance {
            return Err(refuse("has a length, which only the kind 'distance' has; omit the length"));
        }
        let read =
            |pose: Option<Any<'_, '_>>| Ok::<_, PyErr>(pose.map(isometry).transpose()?.unwrap_or_default());
        let frame = |frame, argument| text(frame, argument, "the name of a frame (str)");
        Ok(Self {
            closing: Loop {
                name: name.to_owned(),
                kind,
                frames: [frame(frame_a, "frame_a")?, frame(frame_b, "frame_b")?],
                poses: [read(pose_a)?, read(pose_b)?],
                length,
                project,
            },
        })
    }

    /// Name of the loop.
    #[getter]
    fn name(&self) -> &str {
        &self.closing.name
    }

    /// Type of the joint: ``weld``, ``revolute``, ``spherical``, ``prismatic`` or ``distance``.
    #[getter]
    fn kind(&self) -> &'static str {
        KINDS.into_iter().find(|(_, kind)| *kind == self.closing.kind).map_or("", |(name, _)| name)
    }

    /// Name of the first frame.
    #[getter]
    fn frame_a(&self) -> &str {
        &self.closing.frames[0]
    }

    /// Name of the second frame.
    #[getter]
    fn frame_b(&self) -> &str {
        &self.closing.frames[1]
    }

    /// Pose of the joint in the first frame: (4, 4), m.
    #[getter]
    fn pose_a(&self) -> [[f64; 4]; 4] {
        rows(&self.closing.poses[0])
    }

    /// Pose of the joint in the second frame: (4, 4), m.
    #[getter]
    fn pose_b(&self) -> [[f64; 4]; 4] {
        rows(&self.closing.poses[1])
    }

    /// Distance between the origins, m; None for the distance with all joint positions zero, and for other
    /// kinds.
    #[getter]
    fn length(&self) -> Option<f64> {
        self.closing.length
    }

    /// True if a simulation starts in the nearest configuration that closes the loop; False if an initial
    /// state that does not close the loop is an error.
    #[getter]
    fn project(&self) -> bool {
        self.closing.project
    }

    /// Number of scalar constraints: 6 for ``weld``, 5 for ``revolute`` and ``prismatic``, 3 for
    /// ``spherical``, 1 for ``distance``.
    #[getter]
    fn rows(&self) -> usize {
        self.closing.kind.rows()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(py);
        keywords.set_item("pose_a", self.pose_a())?;
        keywords.set_item("pose_b", self.pose_b())?;
        keywords.set_item("length", self.closing.length)?;
        keywords.set_item("project", self.closing.project)?;
        let arguments = (self.name(), self.kind(), self.frame_a(), self.frame_b());
        ConstructorCall::new("Loop", arguments, &keywords)?.reduce(py)
    }

    fn __repr__(&self) -> String {
        format!("<Loop '{}': {} of {} and {}>", self.name(), self.kind(), self.frame_a(), self.frame_b())
    }
}

/// Returns the rows of the homogeneous transform `[[R, p], [0, 1]]` with rotation `R` and position `p`, m.
fn rows(pose: &Isometry3<f64>) -> [[f64; 4]; 4] {
    let matrix = pose.to_homogeneous();
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]))
}

/// Reads a list of loops.
pub(crate) fn loops_in(loops: Any<'_, '_>) -> PyResult<Vec<Loop>> {
    let loops = list_of::<PyLoop>(loops, "loops", "loops, such as [oo.Loop(…)]")?;
    Ok(loops.into_iter().map(|closing| closing.get().closing.clone()).collect())
}

/// Returns a copy of the robot with additional closed loops.
pub(crate) fn with_loops(model: &Bound<'_, PyModel>, loops: Vec<Loop>) -> PyResult<PyModel> {
    let py = model.py();
    let old = &model.get().model;
    let new = old.closed(&loops).map_err(|error| error.into_python(py))?;
    let loops: Vec<PyLoop> = loops.into_iter().map(|closing| PyLoop { closing }).collect();
    let call = ConstructorCall::new("Model.with_loops", (model, loops), &PyDict::new(py))?;
    PyModel::wrap(py, new, Some(call), old.warnings())
}

/// Reads the argument `mimic`: the name of the leading joint, or a tuple of this name, ratio and offset (rad
/// or m).
pub(super) fn mimic_in(mimic: Any<'_, '_>) -> PyResult<Mimic> {
    let read = mimic.extract().map(|leader| (leader, 1.0, 0.0)).or_else(|_| mimic.extract());
    let (leader, ratio, offset) = read.map_err(|_| {
        let py = mimic.py();
        let expected =
            "the name of the leading joint, or (name, ratio, offset), such as (\"left_finger\", -1.0, 0.0)";
        let message = format!(
            "mimic is {}; expected {expected}",
            mimic.repr().map_or_else(|_| String::new(), |text| text.to_string())
        );
        raise(py, "DtypeError", &message, &fields!(py, "name": "mimic", "expected": expected))
    })?;
    Ok(Mimic { leader, ratio, offset })
}
