//! The class `Model`. Its methods are in one block, as PyO3 requires; their bodies are in the files named in
//! the calls, and `dynamics/`.

pub(crate) mod attach;
mod builder;
mod description;
mod file;
mod link_change;
mod part;
mod reroot;
mod xacro;

use crate::arrays::{Threads, array_of, type_name};
use crate::dynamics::{
    PyFreeFloating, PyFreeFloatingDerivatives, evaluate, evaluate_three, free_floating,
    free_floating_derivatives,
};
use crate::errors::{IntoPython, fields, raise};
use crate::pickling::{ConstructorCall, Reduced};
use description::{PyBody, PyFrame, PyJoint, PyVisual};
use file::read_file;
use numpy::PyArrayDyn;
use onorbit_core::batch::{Evaluator, Kernel};
use onorbit_core::model::{Model, ModelWarning, neutral};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;
type Any<'a, 'py> = &'a Bound<'py, PyAny>;
type External<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyModel>()?;
    m.add_class::<part::PyRobotPart>()?;
    m.add_class::<PyVisual>()?;
    m.add_class::<PyJoint>()?;
    m.add_class::<PyBody>()?;
    m.add_class::<PyFrame>()?;
    m.add_class::<builder::PyModelBuilder>()?;
    m.add_function(wrap_pyfunction!(attach::attach, m)?)
}

/// Model of a free-floating robot: an immutable tree of bodies.
///
/// ``q = [p(3), quat_xyzw(4), joints(n)]`` in m and rad, ``v = [v_body(3), w_body(3), rates(n)]`` in m/s
/// and rad/s: linear and angular velocity of the base in base axes, then joint rates. W is the world frame
/// of the simulation. Methods with an argument ``q``, except :meth:`transfer_state`, accept one state ``(n,)`` or a
/// batch ``(B, n)`` and return arrays of the matching shape.
///
/// Two keyword arguments are common to these methods. ``threads`` is the number of threads for a batch
/// (default: all cores). ``out`` receives the result and is then returned, which avoids the allocation of large arrays:
/// a contiguous float64 array, three of them for the derivatives of the dynamics, or an earlier result of the same
/// class. It must not be accessed by other threads during the call, and its contents are undefined after an error.
#[pyclass(name = "Model", frozen, module = "onorbit_rs")]
pub(crate) struct PyModel {
    pub(crate) model: Arc<Model>,
    pub(crate) evaluator: Mutex<Evaluator>,
    constructor_call: Option<ConstructorCall>,
}

impl PyModel {
    /// Wraps a model and issues its warnings, except those in `known`.
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
        Ok(Self { model: Arc::new(model), evaluator, constructor_call })
    }

    /// Returns the index of the frame with this name.
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
}

#[pymethods]
impl PyModel {
    /// Load a robot from a URDF or xacro file; its root link is free-floating.
    ///
    /// A file named ``.xacro``, or any file with ``xacro=True`` or ``xacro_arguments``, is first expanded
    /// with PyPI's ``xacro`` (``pip install 'onorbit-rs[xacro]'``). Its expressions are evaluated by
    /// onorbit_rs; Python code in the file is not executed.
    ///
    /// Parameters
    /// ----------
    /// path : path
    ///     File.
    /// package_paths : list of path, optional
    ///     ROS packages or folders that contain them, searched for ``package://`` and ``$(find ...)``.
    /// xacro_arguments : dict of str to object, optional
    ///     Values of ``$(arg name)``.
    /// xacro : bool
    ///     If True, the file is expanded as xacro regardless of its name.
    /// links : dict of str to dict, optional
    ///     ``{name: {"mass": kg, "com": (3,) m, "inertia": (3, 3) kg m²}}``: values that replace those of the
    ///     file before the robot is validated; :meth:`with_link` replaces them afterwards.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// ModelError
    ///     If the file does not describe a valid robot, or ``links`` is invalid.
    /// NotFoundError, ReadError
    ///     If the file does not exist or cannot be read.
    #[staticmethod]
    #[pyo3(signature = (path, *, package_paths=None, xacro_arguments=None, xacro=false, links=None))]
    fn from_urdf(
        py: Python<'_>,
        path: PathBuf,
        package_paths: Option<Vec<PathBuf>>,
        xacro_arguments: Option<&Bound<'_, PyDict>>,
        xacro: bool,
        links: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let (model, keywords) = read_file(py, &path, package_paths, xacro_arguments, xacro, links, false)?;
        let call = ConstructorCall::with_keywords("Model.from_urdf", &keywords)?;
        Self::wrap(py, model, Some(call), &[])
    }

    /// Load a robot from the text of a URDF.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     URDF.
    /// folder : path, optional
    ///     Folder to which relative paths of meshes refer.
    /// package_paths : list of path, optional
    ///     As for :meth:`from_urdf`.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// ModelError
    ///     If the text does not describe a valid robot.
    #[staticmethod]
    #[pyo3(signature = (text, *, folder=None, package_paths=None))]
    fn from_urdf_string(
        py: Python<'_>,
        text: &str,
        folder: Option<PathBuf>,
        package_paths: Option<Vec<PathBuf>>,
    ) -> PyResult<Self> {
        file::from_urdf_string(py, text, folder, package_paths)
    }

    /// Return a spacecraft without joints.
    ///
    /// Its body is named ``base``, and its origin is the centre of mass.
    ///
    /// Parameters
    /// ----------
    /// mass : float
    ///     Mass, kg.
    /// inertia : (3, 3) array
    ///     Inertia about the centre of mass, kg m².
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// ModelError
    ///     If the mass or the inertia is not physical.
    #[staticmethod]
    fn rigid_body(py: Python<'_>, mass: f64, inertia: Any<'_, '_>) -> PyResult<Self> {
        builder::rigid_body(py, mass, inertia)
    }

    /// Return a copy of the robot with the inertial properties of one link replaced.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Name of the link.
    /// mass : float, optional
    ///     Mass, kg. The inertia does not scale with it.
    /// com : (3,) array, optional
    ///     Centre of mass in link axes, m.
    /// inertia : (3, 3) array, optional
    ///     Inertia about the centre of mass in link axes, kg m².
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If no link has this name.
    /// ModelError
    ///     If the values are not physical, or the link has no inertial and no mass is given.
    #[pyo3(signature = (name, *, mass=None, com=None, inertia=None))]
    fn with_link(
        slf: &Bound<'_, Self>,
        name: &str,
        mass: Option<f64>,
        com: Option<Any<'_, '_>>,
        inertia: Option<Any<'_, '_>>,
    ) -> PyResult<Self> {
        link_change::with_link(slf, name, mass, com, inertia)
    }

    /// Return the same robot with another link as its floating base.
    ///
    /// Links, frames and joints keep their names, and joints the signs of their positions, rates and torques. Bodies
    /// and joints are numbered depth first from the new base.
    ///
    /// Parameters
    /// ----------
    /// link : str
    ///     Name of the link that becomes the base.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If no link has this name.
    fn rerooted(slf: &Bound<'_, Self>, link: &str) -> PyResult<Self> {
        reroot::rerooted(slf, link)
    }

    /// Convert a state to the coordinates of another model of the same links, such as a :meth:`rerooted` one.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) array
    ///     Configuration of this model.
    /// v : (nv,) array
    ///     Velocity of this model.
    /// to : Model
    ///     Other model. All its joints and the link of its base exist in this model.
    ///
    /// Returns
    /// -------
    /// (nq,) array, (nv,) array
    ///     Configuration and velocity of ``to`` that place and move its links as ``q`` and ``v`` do those of this model.
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If a joint or the base of ``to`` is not in this model.
    fn transfer_state<'py>(
        &self,
        py: Python<'py>,
        q: Any<'_, '_>,
        v: Any<'_, '_>,
        to: &Self,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        reroot::transfer_state(py, &self.model, (q, v), &to.model)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        match &slf.get().constructor_call {
            Some(call) => call.reduce_robot(slf),
            None => Err(PyTypeError::new_err(
                "a model built link by link cannot be pickled; build it in the process that uses it, or \
                 write it as \
                 URDF and load the file",
            )),
        }
    }

    /// Name of the robot.
    #[getter]
    fn name(&self) -> &str {
        self.model.name()
    }

    /// Length of a configuration, ``7 + n``.
    #[getter]
    fn nq(&self) -> usize {
        self.model.nq()
    }

    /// Length of a velocity, ``6 + n``.
    #[getter]
    fn nv(&self) -> usize {
        self.model.nv()
    }

    /// Total mass, kg.
    #[getter]
    fn mass(&self) -> f64 {
        self.model.mass()
    }

    /// Names of the moving joints, in the order of ``v``.
    #[getter]
    fn joint_names(&self) -> Vec<&str> {
        self.model.joint_names().collect()
    }

    /// Names of the bodies, base first; a body is named after its first link.
    #[getter]
    fn body_names(&self) -> Vec<&str> {
        self.model.body_names().collect()
    }

    /// Names of the frames: every link, and additional frames.
    #[getter]
    fn frame_names(&self) -> Vec<&str> {
        self.model.frame_names().collect()
    }

    /// Moving joints, in the order of ``v``.
    #[getter]
    fn joints(&self) -> Vec<PyJoint> {
        description::joints(&self.model)
    }

    /// Bodies with masses, centres of mass and inertias, base first.
    #[getter]
    fn bodies(&self) -> Vec<PyBody> {
        description::bodies(&self.model)
    }

    /// Frames: every link, and additional frames.
    #[getter]
    fn frames(&self) -> Vec<PyFrame> {
        description::frames(&self.model)
    }

    /// Warnings about the robot file, one line each.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.model.warnings().iter().map(ToString::to_string).collect()
    }

    /// Shapes of the visual geometry.
    #[getter]
    fn visuals(&self) -> Vec<PyVisual> {
        description::shapes(&self.model, self.model.visuals())
    }

    /// Collision shapes, with meshes only if their file exists. They are drawn in place of visual meshes that
    /// cannot be drawn; there are no contacts.
    #[getter]
    fn collisions(&self) -> Vec<PyVisual> {
        description::shapes(&self.model, self.model.collisions())
    }

    /// Return the configuration at the origin of W, without rotation, with all joints at zero.
    ///
    /// Returns
    /// -------
    /// (nq,) array
    ///     Configuration, m and rad.
    fn neutral<'py>(&self, py: Python<'py>) -> Array<'py> {
        array_of(py, &[self.model.nq()], &neutral(&self.model))
    }

    /// Return ``q ⊕ dv``, the configuration reached by a constant velocity during unit time.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// dv : (nv,) or (B, nv) array
    ///     Tangent vector: body twist of the base (m, rad), then joint displacements.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    #[pyo3(signature = (q, dv, *, threads=None, out=None))]
    fn integrate<'py>(
        &self,
        q: Any<'_, 'py>,
        dv: Any<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::Integrate, &[q, dv], None, &[self.model.nq()], threads, out)
    }

    /// Return ``q2 ⊖ q``, the ``dv`` for which ``integrate(q, dv) = q2``, with the shorter rotation of the
    /// base.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// q2 : (nq,) or (B, nq) array
    ///     Second configuration.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (nv,) or (B, nv) array
    ///     Tangent vector, m and rad.
    #[pyo3(signature = (q, q2, *, threads=None, out=None))]
    fn difference<'py>(
        &self,
        q: Any<'_, 'py>,
        q2: Any<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::Difference, &[q, q2], None, &[self.model.nv()], threads, out)
    }

    /// Return the pose of a frame in W.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// frame : str
    ///     Name of the frame.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (4, 4) or (B, 4, 4) array
    ///     Homogeneous matrix, m.
    #[pyo3(signature = (q, frame, *, threads=None, out=None))]
    fn frame_pose<'py>(
        &self,
        q: Any<'_, 'py>,
        frame: Any<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::FramePose(self.frame(frame)?), &[q], None, &[4, 4], threads, out)
    }

    /// Return the twist of a frame at its origin.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// v : (nv,) or (B, nv) array
    ///     Velocity.
    /// frame : str
    ///     Name of the frame.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (6,) or (B, 6) array
    ///     Linear, then angular velocity, W axes, m/s and rad/s.
    #[pyo3(signature = (q, v, frame, *, threads=None, out=None))]
    fn frame_velocity<'py>(
        &self,
        q: Any<'_, 'py>,
        v: Any<'_, 'py>,
        frame: Any<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::FrameVelocity(self.frame(frame)?), &[q, v], None, &[6], threads, out)
    }

    /// Return the Jacobian ``J`` of a frame; its twist at its origin in W axes is ``J v``.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// frame : str
    ///     Name of the frame.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (6, nv) or (B, 6, nv) array
    ///     Rows in W axes, linear first; dimensionless and m.
    #[pyo3(signature = (q, frame, *, threads=None, out=None))]
    fn frame_jacobian<'py>(
        &self,
        q: Any<'_, 'py>,
        frame: Any<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::FrameJacobian(self.frame(frame)?), &[q], None, &[6, self.model.nv()], threads, out)
    }

    /// Return the mass matrix, including rotor inertia.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (nv, nv) or (B, nv, nv) array
    ///     Base in base axes first, then joints; kg, kg m and kg m².
    #[pyo3(signature = (q, *, threads=None, out=None))]
    fn mass_matrix<'py>(
        &self,
        q: Any<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        let nv = self.model.nv();
        self.one(Kernel::MassMatrix, &[q], None, &[nv, nv], threads, out)
    }

    /// Return the Coriolis and centrifugal forces less the external forces, ``c - Σ Jᵀ F``.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// v : (nv,) or (B, nv) array
    ///     Velocity.
    /// external : dict of str to (6,) or (B, 6) array, optional
    ///     Wrench by frame: force, N, and moment, N m, in the frame's axes about its origin.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (nv,) or (B, nv) array
    ///     Generalized forces, N and N m.
    #[pyo3(signature = (q, v, *, external=None, threads=None, out=None))]
    fn bias_forces<'py>(
        &self,
        q: Any<'_, 'py>,
        v: Any<'_, 'py>,
        external: External<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::BiasForces, &[q, v], external, &[self.model.nv()], threads, out)
    }

    /// Return the generalized forces ``M a + c - Σ Jᵀ F`` for an acceleration.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// v : (nv,) or (B, nv) array
    ///     Velocity.
    /// a : (nv,) or (B, nv) array
    ///     Acceleration, the time derivative of ``v``.
    /// external : dict of str to (6,) or (B, 6) array, optional
    ///     Wrench by frame: force, N, and moment, N m, in the frame's axes about its origin.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (nv,) or (B, nv) array
    ///     Wrench on the base in base axes, then joint efforts, N and N m.
    #[pyo3(signature = (q, v, a, *, external=None, threads=None, out=None))]
    fn inverse_dynamics<'py>(
        &self,
        q: Any<'_, 'py>,
        v: Any<'_, 'py>,
        a: Any<'_, 'py>,
        external: External<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::InverseDynamics, &[q, v, a], external, &[self.model.nv()], threads, out)
    }

    /// Return the acceleration ``M⁻¹ (tau - c + Σ Jᵀ F)``, computed in O(n).
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// v : (nv,) or (B, nv) array
    ///     Velocity.
    /// tau : (nv,) or (B, nv) array
    ///     Wrench on the base in base axes, then joint efforts, N and N m.
    /// external : dict of str to (6,) or (B, 6) array, optional
    ///     Wrench by frame: force, N, and moment, N m, in the frame's axes about its origin.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (nv,) or (B, nv) array
    ///     Acceleration, m/s² and rad/s².
    #[pyo3(signature = (q, v, tau, *, external=None, threads=None, out=None))]
    fn forward_dynamics<'py>(
        &self,
        q: Any<'_, 'py>,
        v: Any<'_, 'py>,
        tau: Any<'_, 'py>,
        external: External<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::ForwardDynamics, &[q, v, tau], external, &[self.model.nv()], threads, out)
    }

    /// Return the derivatives of :meth:`inverse_dynamics`.
    ///
    /// Column ``j`` of the derivative with respect to ``q`` is that along ``integrate(q, eps * e_j)``:
    /// translations (m) and rotations (rad) of the base in base axes, then joints. ``external`` is held
    /// constant in the axes of its frames.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// v : (nv,) or (B, nv) array
    ///     Velocity.
    /// a : (nv,) or (B, nv) array
    ///     Acceleration, the time derivative of ``v``.
    /// external : dict of str to (6,) or (B, 6) array, optional
    ///     Wrench by frame: force, N, and moment, N m, in the frame's axes about its origin.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// dq, dv, da : (nv, nv) or (B, nv, nv) array
    ///     Derivatives with respect to ``q``, ``v`` and ``a``; the last is the mass matrix.
    #[pyo3(signature = (q, v, a, *, external=None, threads=None, out=None))]
    fn inverse_dynamics_derivatives<'py>(
        &self,
        q: Any<'_, 'py>,
        v: Any<'_, 'py>,
        a: Any<'_, 'py>,
        external: External<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        evaluate_three(q.py(), self, Kernel::InverseDynamicsDerivatives, &[q, v, a], external, out, threads)
    }

    /// Return the derivatives of :meth:`forward_dynamics`.
    ///
    /// Tangent vectors and wrenches are treated as in :meth:`inverse_dynamics_derivatives`.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// v : (nv,) or (B, nv) array
    ///     Velocity.
    /// tau : (nv,) or (B, nv) array
    ///     Wrench on the base in base axes, then joint efforts, N and N m.
    /// external : dict of str to (6,) or (B, 6) array, optional
    ///     Wrench by frame: force, N, and moment, N m, in the frame's axes about its origin.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// dq, dv, dtau : (nv, nv) or (B, nv, nv) array
    ///     Derivatives with respect to ``q``, ``v`` and ``tau``; the last is the inverse mass matrix.
    #[pyo3(signature = (q, v, tau, *, external=None, threads=None, out=None))]
    fn forward_dynamics_derivatives<'py>(
        &self,
        q: Any<'_, 'py>,
        v: Any<'_, 'py>,
        tau: Any<'_, 'py>,
        external: External<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        evaluate_three(q.py(), self, Kernel::ForwardDynamicsDerivatives, &[q, v, tau], external, out, threads)
    }

    /// Return the linear momentum, and the angular momentum about the centre of mass of the robot.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// v : (nv,) or (B, nv) array
    ///     Velocity.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (6,) or (B, 6) array
    ///     Linear, then angular momentum, W axes, kg m/s and kg m²/s.
    #[pyo3(signature = (q, v, *, threads=None, out=None))]
    fn momentum<'py>(
        &self,
        q: Any<'_, 'py>,
        v: Any<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::Momentum, &[q, v], None, &[6], threads, out)
    }

    /// Return the kinetic energy in W.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// v : (nv,) or (B, nv) array
    ///     Velocity.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// float or (B,) array
    ///     Energy, J; with ``out``, always an array.
    #[pyo3(signature = (q, v, *, threads=None, out=None))]
    fn kinetic_energy<'py>(
        &self,
        q: Any<'_, 'py>,
        v: Any<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let energy = self.one(Kernel::KineticEnergy, &[q, v], None, &[], threads, out)?;
        match out {
            Some(_) => Ok(energy.into_any()),
            None => energy.call_method1("__getitem__", (PyTuple::empty(q.py()),)),
        }
    }

    /// Return the position of the centre of mass in W.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (3,) or (B, 3) array
    ///     Position, m.
    #[pyo3(signature = (q, *, threads=None, out=None))]
    fn center_of_mass<'py>(
        &self,
        q: Any<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::CenterOfMass, &[q], None, &[3], threads, out)
    }

    /// Return the reduced model ``M*, c*, Q*, Jg, d`` for one frame, exact for any momentum and wrench.
    ///
    /// ``out`` is the result of an earlier call with the same number of states, which is overwritten.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// v : (nv,) or (B, nv) array
    ///     Velocity.
    /// frame : str
    ///     Name of the frame.
    /// external : dict of str to (6,) or (B, 6) array, optional
    ///     Wrench by frame: force, N, and moment, N m, in the frame's axes about its origin.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// FreeFloating
    #[pyo3(signature = (q, v, frame, *, external=None, threads=None, out=None))]
    fn free_floating<'py>(
        &self,
        q: Any<'_, 'py>,
        v: Any<'_, 'py>,
        frame: Any<'_, 'py>,
        external: External<'_, 'py>,
        threads: Option<Threads>,
        out: Option<&Bound<'py, PyFreeFloating>>,
    ) -> PyResult<Bound<'py, PyFreeFloating>> {
        free_floating(q.py(), self, self.frame(frame)?, &[q, v], external, out, threads)
    }

    /// Return the derivatives of ``M* q̈ + c* - Q*``, ``ẍ = Jg q̈ + d`` and ``ẋ`` at given joint
    /// accelerations.
    ///
    /// Tangent vectors and wrenches are treated as in :meth:`inverse_dynamics_derivatives`. For ``q̈ = 0``
    /// the first two are the derivatives of ``c* - Q*`` and ``d``. The derivatives with respect to ``q̈`` are
    /// ``M*`` and ``Jg``; that of ``ẋ`` with respect to ``v`` is :meth:`frame_jacobian`.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration.
    /// v : (nv,) or (B, nv) array
    ///     Velocity.
    /// joint_acceleration : (n,) or (B, n) array
    ///     ``q̈``, rad/s² or m/s².
    /// frame : str
    ///     Name of the frame.
    /// external : dict of str to (6,) or (B, 6) array, optional
    ///     Wrench by frame: force, N, and moment, N m, in the frame's axes about its origin.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// FreeFloatingDerivatives
    #[pyo3(signature = (q, v, joint_acceleration, frame, *, external=None, threads=None, out=None))]
    fn free_floating_derivatives<'py>(
        &self,
        q: Any<'_, 'py>,
        v: Any<'_, 'py>,
        joint_acceleration: Any<'_, 'py>,
        frame: Any<'_, 'py>,
        external: External<'_, 'py>,
        threads: Option<Threads>,
        out: Option<&Bound<'py, PyFreeFloatingDerivatives>>,
    ) -> PyResult<Bound<'py, PyFreeFloatingDerivatives>> {
        let state = [q, v, joint_acceleration];
        free_floating_derivatives(q.py(), self, self.frame(frame)?, &state, external, out, threads)
    }

    fn __repr__(&self) -> String {
        let m = &self.model;
        format!(
            "<Model '{}': {} bodies, {} joints, {:.6} kg>",
            m.name(),
            m.nodes().len(),
            m.joint_count(),
            m.mass()
        )
    }
}

impl PyModel {
    /// Evaluates a kernel with one output.
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
