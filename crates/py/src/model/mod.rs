//! The class `Model`. Its methods are in one file per topic: `construction`, `properties`, `kinematics`,
//! `dynamics`, `momentum`, `free_floating`, `loop_dynamics` and `constrained_free_floating`.

pub(crate) mod attach;
mod builder;
pub(crate) mod closed_loop;
mod collision;
mod constrained_free_floating;
mod construction;
mod convex_pieces;
mod description;
mod dynamics;
mod file;
mod free_floating;
mod joint_change;
mod kinematics;
mod link_change;
mod loop_dynamics;
mod merged_call;
mod momentum;
mod part;
mod properties;
mod reroot;
mod shape;
mod xacro;

use crate::arrays::{Threads, type_name, wrong_shape};
use crate::dynamics::evaluate;
use crate::errors::{IntoPython, fields, raise};
use crate::pickling::ConstructorCall;
use description::{PyBody, PyFrame, PyJoint, PyVisual};
use numpy::{PyArrayDyn, PyUntypedArrayMethods};
use onorbit_core::batch::{Evaluator, Kernel};
use onorbit_core::geometry::{LinkShape, Shape, link_shape};
use onorbit_core::model::{Model, ModelWarning};
use pyo3::prelude::*;
use pyo3::types::PyString;
pub(crate) use shape::PyShape;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;
type Any<'a, 'py> = &'a Bound<'py, PyAny>;
type External<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyModel>()?;
    m.add_class::<part::PyRobotPart>()?;
    m.add_class::<PyVisual>()?;
    m.add_class::<PyShape>()?;
    m.add_class::<PyJoint>()?;
    m.add_class::<PyBody>()?;
    m.add_class::<PyFrame>()?;
    m.add_class::<builder::PyModelBuilder>()?;
    m.add_class::<closed_loop::PyLoop>()?;
    m.add_class::<constrained_free_floating::PyConstrainedFreeFloating>()?;
    m.add_function(wrap_pyfunction!(attach::attach, m)?)
}

/// Model of a free-floating robot: an immutable tree of bodies.
///
/// Configurations are ``q = [p(3), quat_xyzw(4), joints(n)]`` in m and rad: position of the base in W,
/// rotation from base axes to W axes, and positions of the ``n`` joints. Velocities are ``v = [v_body(3),
/// w_body(3), rates(n)]`` in m/s and rad/s: linear and angular velocity of the base in base axes, then joint
/// rates. So ``nq = 7 + n`` and ``nv = 6 + n``. W is the world frame of the simulation. Methods whose
/// arguments have the shape ``(nq,) or (B, nq)`` accept one state or a batch of ``B`` states and return
/// arrays of the corresponding shape.
///
/// Most of these methods have two keyword arguments in common. ``threads`` is the number of threads for a
/// batch (default: all cores). ``out`` is the object in which the result is stored and which is returned; it
/// avoids the allocation of large arrays. It is a contiguous float64 array, a tuple of three arrays for the
/// derivatives of the dynamics, or an earlier result of the same class. Other threads must not access it
/// during the call, and its contents are undefined after an error.
///
/// The methods raise ``ShapeError``, ``DtypeError`` or ``InputError`` for invalid arrays, ``FrameError`` for
/// an unknown frame, and ``ConvergenceError`` if the mass matrix is numerically singular.
#[pyclass(name = "Model", frozen, module = "onorbit_rs")]
pub(crate) struct PyModel {
    pub(crate) model: Arc<Model>,
    pub(crate) evaluator: Mutex<Evaluator>,
    constructor_call: Option<ConstructorCall>,
    /// Collision shapes that were used before, by the index of the link's frame.
    collision_shapes: Mutex<HashMap<usize, Shape>>,
}

impl PyModel {
    /// Wraps a model and issues its warnings, except those listed in `known`.
    pub(crate) fn wrap(
        py: Python<'_>,
        model: Model,
        constructor_call: Option<ConstructorCall>,
        known: &[ModelWarning],
    ) -> PyResult<Self> {
        let warnings = py.import("warnings")?;
        for warning in model.warnings().iter().filter(|warning| !known.contains(warning)) {
            warnings.call_method1("warn", (warning.to_string(),))?;
        }
        let evaluator = Mutex::new(Evaluator::new(&model));
        Ok(Self { model: Arc::new(model), evaluator, constructor_call, collision_shapes: Mutex::default() })
    }

    /// Creates another Python object for a model whose warnings have already been issued.
    pub(crate) fn of(model: Arc<Model>) -> Self {
        let evaluator = Mutex::new(Evaluator::new(&model));
        Self { model, evaluator, constructor_call: None, collision_shapes: Mutex::default() }
    }

    /// Returns the index of the frame `name`.
    pub(crate) fn frame(&self, name: &Bound<'_, PyAny>) -> PyResult<usize> {
        let py = name.py();
        let Ok(text) = name.cast::<PyString>() else {
            let got = type_name(name);
            let message = format!("frame is of type {got}; expected the name of a frame (str)");
            let fields = fields!(py, "name": "frame", "expected": "str", "got": got);
            return Err(raise(py, "DtypeError", &message, &fields));
        };
        self.model.frame(&text.to_cow()?).map_err(|error| error.into_python(py))
    }

    /// Returns the collision shape of the link whose frame has this index. Meshes are read once; their
    /// defects cause warnings.
    pub(crate) fn collision_shape(&self, py: Python<'_>, frame: usize) -> PyResult<Shape> {
        let known = |shapes: &Mutex<HashMap<usize, Shape>>| {
            shapes.lock().unwrap_or_else(PoisonError::into_inner).get(&frame).cloned()
        };
        if let Some(shape) = known(&self.collision_shapes) {
            return Ok(shape);
        }
        let LinkShape { shape, warnings } =
            py.detach(|| link_shape(&self.model, frame)).map_err(|error| error.into_python(py))?;
        let module = py.import("warnings")?;
        for warning in warnings {
            module.call_method1("warn", (warning,))?;
        }
        let mut shapes = self.collision_shapes.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(shapes.entry(frame).or_insert(shape).clone())
    }

    /// Returns the pose (4, 4), m, in W of the frame with this index, for one configuration; a batch is an
    /// error.
    pub(crate) fn pose_rows<'py>(&self, q: Any<'_, 'py>, frame: usize) -> PyResult<Array<'py>> {
        let pose = self.one(Kernel::FramePose(frame), &[q], None, &[4, 4], None, None)?;
        if pose.ndim() == 2 {
            return Ok(pose);
        }
        let (nq, states) = (self.model.nq(), pose.shape()[0]);
        Err(wrong_shape(q.py(), "q", &format!("({nq},)"), &[states, nq]))
    }

    /// Evaluates a kernel that has one output, of shape `shape` for each state.
    fn one<'py>(
        &self,
        kernel: Kernel,
        values: &[Any<'_, 'py>],
        external: External<'_, 'py>,
        shape: &[usize],
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        let out = out.map(|out| [out.clone()]);
        let [output] = evaluate(values[0].py(), self, kernel, values, external, [shape], out, threads)?;
        Ok(output)
    }
}
