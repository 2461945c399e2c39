//! The robot.

use crate::arrays::{Threads, array_of, fixed, type_name};
use crate::derivatives::{PyFreeFloatingDerivatives, free_floating_derivatives, three};
use crate::errors::{IntoPython, fields, raise};
use crate::kernels::{PyFreeFloating, evaluate, free_floating};
use crate::link_change::link_change;
use crate::made::{Made, absolute, copied};
use crate::records::{self, PyBody, PyFrame, PyJoint, PyVisual};
use crate::robot_file::read_file;
use nalgebra::Matrix3;
use numpy::PyArrayDyn;
use onorbit_core::batch::{Evaluator, Kernel};
use onorbit_core::model::urdf;
use onorbit_core::model::{Model, ModelWarning, neutral};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;
type Any<'a, 'py> = &'a Bound<'py, PyAny>;
type External<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// A robot with a free base: an immutable tree of bodies.
///
/// ``q = [p(3), quat_xyzw(4), joints(n)]`` in m and rad, ``v = [v_body(3), w_body(3), rates(n)]``: the
/// base's velocity in its own axes, linear first. W is the world of the simulation. Every method takes
/// one state ``(n,)`` or a batch ``(B, n)`` and returns the matching shape; batches run on all cores
/// unless ``threads`` says otherwise. ``out`` is an array of that shape to write into, which is then what
/// returns: large fresh ones cost page faults (nobody may look at it meanwhile; after an error it holds anything).
#[pyclass(name = "Model", frozen, module = "onorbit_rs")]
pub(crate) struct PyModel {
    pub(crate) model: Arc<Model>,
    pub(crate) evaluator: Mutex<Evaluator>,
    made: Option<Made>,
}

impl PyModel {
    /// Wraps a model and issues its warnings, except those in `known`.
    pub(crate) fn wrap(
        py: Python<'_>,
        model: Model,
        made: Option<Made>,
        known: &[ModelWarning],
    ) -> PyResult<Self> {
        let warnings = py.import("warnings")?;
        for warning in model.warnings().iter().filter(|warning| !known.contains(warning)) {
            warnings.call_method1("warn", (warning.to_string(),))?;
        }
        let evaluator = Mutex::new(Evaluator::new(&model));
        Ok(Self { model: Arc::new(model), evaluator, made })
    }

    /// Index of a frame by name.
    pub(crate) fn frame(&self, name: &Bound<'_, PyAny>) -> PyResult<usize> {
        let py = name.py();
        let Ok(text) = name.cast::<PyString>() else {
            let got = type_name(name);
            let message = format!("frame is of type {got}, a name is needed");
            let fields = fields!(py, "name": "frame", "expected": "str", "got": got);
            return Err(raise(py, "DtypeError", &message, &fields));
        };
        self.model.frame(&text.to_cow()?).map_err(|error| error.into_python(py))
    }
}

#[pymethods]
impl PyModel {
    /// Load a robot from a URDF file; its root link floats.
    ///
    /// A file named ``.xacro``, or any with ``xacro=True`` or ``xacro_arguments``, is expanded first with PyPI's
    /// ``xacro`` (``pip install 'onorbit-rs[xacro]'``); its expressions are evaluated by onorbit_rs, which runs
    /// none of them as Python. ``package_paths``: folders that hold ROS packages or are one, searched for
    /// ``package://`` and ``$(find ...)``; ``xacro_arguments``: ``{name: value}``, what ``$(arg name)`` gives.
    /// ``links``: ``{name: {"mass": kg, "com": (3,) m, "inertia": (3, 3) kg m²}}`` replaces values of the file before the robot
    /// is checked, as :meth:`with_link` does afterwards.
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
        let made = Some(Made::by("Model.from_urdf", &keywords)?);
        Self::wrap(py, model, made, &[])
    }

    /// Load a robot from the text of a URDF; ``folder`` is where its relative paths start.
    #[staticmethod]
    #[pyo3(signature = (text, *, folder=None, package_paths=None))]
    fn from_urdf_string(
        py: Python<'_>,
        text: &str,
        folder: Option<PathBuf>,
        package_paths: Option<Vec<PathBuf>>,
    ) -> PyResult<Self> {
        let packages = package_paths.unwrap_or_default();
        let options = urdf::Options { packages: &packages, ..Default::default() };
        let model =
            urdf::from_str(text, folder.as_deref(), &options).map_err(|error| error.into_python(py))?;
        let packages: Vec<PathBuf> = packages.iter().map(|path| absolute(path)).collect();
        let folder = folder.as_deref().map(absolute);
        let keywords = fields!(py, "text": text, "folder": folder, "package_paths": packages);
        Self::wrap(py, model, Some(Made::by("Model.from_urdf_string", &keywords)?), &[])
    }

    /// A spacecraft without joints: mass, kg, and inertia (3, 3) about its centre of mass, kg m².
    ///
    /// Its one body is called ``base``, its origin is the centre of mass.
    #[staticmethod]
    fn rigid_body(py: Python<'_>, mass: f64, inertia: Any<'_, '_>) -> PyResult<Self> {
        let given = fixed::<9>(inertia, "inertia", &[3, 3])?;
        let inertia = Matrix3::from_row_slice(&given);
        let model = Model::rigid_body(mass, inertia).map_err(|error| error.into_python(py))?;
        let rows: Vec<&[f64]> = given.chunks(3).collect();
        let keywords = fields!(py, "mass": mass, "inertia": rows);
        Self::wrap(py, model, Some(Made::by("Model.rigid_body", &keywords)?), &[])
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
        let py = slf.py();
        let change = link_change(name, mass, com, inertia)?;
        let old = &slf.get().model;
        let model = old.with_link(&change).map_err(|error| error.into_python(py))?;
        let keywords = fields!(py, "mass": mass, "com": copied(com)?, "inertia": copied(inertia)?);
        let made = made_by_with_link(slf, name, keywords)?;
        Self::wrap(py, model, Some(made), old.warnings())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        match &slf.get().made {
            Some(made) => made.robot_again(slf),
            None => Err(PyTypeError::new_err(
                "a model built link by link does not pickle: build it where it is needed, or write it as URDF",
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

    /// Names of the bodies: links that move on their own, base first.
    #[getter]
    fn body_names(&self) -> Vec<&str> {
        self.model.body_names().collect()
    }

    /// Names of the frames: every link, and frames added.
    #[getter]
    fn frame_names(&self) -> Vec<&str> {
        self.model.frame_names().collect()
    }

    /// The moving joints, in the order of ``v``.
    #[getter]
    fn joints(&self) -> Vec<PyJoint> {
        records::joints(&self.model)
    }

    /// The bodies, base first: masses, centres of mass, inertias.
    #[getter]
    fn bodies(&self) -> Vec<PyBody> {
        records::bodies(&self.model)
    }

    /// The frames: every link, and frames added.
    #[getter]
    fn frames(&self) -> Vec<PyFrame> {
        records::frames(&self.model)
    }

    /// What was odd in the description, one line each.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.model.warnings().iter().map(ToString::to_string).collect()
    }

    /// Shapes to draw.
    #[getter]
    fn visuals(&self) -> Vec<PyVisual> {
        records::shapes(&self.model, self.model.visuals())
    }

    /// Collision shapes; meshes only if their file exists. There are no contacts: they are drawn if a visual mesh cannot be.
    #[getter]
    fn collisions(&self) -> Vec<PyVisual> {
        records::shapes(&self.model, self.model.collisions())
    }

    /// The configuration at W's origin, unrotated, joints at zero: (nq,).
    fn neutral<'py>(&self, py: Python<'py>) -> Array<'py> {
        array_of(py, &[self.model.nq()], &neutral(&self.model))
    }

    /// ``q ⊕ dv``: the base follows the constant body twist ``dv[:6]`` (m, rad) for unit time: (nq,).
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

    /// ``q2 ⊖ q``: the ``dv`` (nv,) with ``integrate(q, dv) = q2``, the base turning the shorter way.
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

    /// Pose of a frame in W: (4, 4), m.
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

    /// Twist of a frame at its origin in W axes: (6,), m/s and rad/s, linear first.
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

    /// Jacobian of a frame: (6, nv), its twist at its origin in W axes is ``J v``.
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

    /// Mass matrix: (nv, nv), rotor inertia included.
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

    /// Coriolis and centrifugal forces ``c(q, v)``, less ``Σ Jᵀ F`` of ``external`` wrenches: (nv,), N and N m.
    ///
    /// ``external`` as in :meth:`inverse_dynamics`.
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

    /// Forces ``M a + c - Σ Jᵀ F`` behind an acceleration: (nv,); ``tau[:6]`` is the wrench on the base, its axes.
    ///
    /// ``external``: ``{frame: (6,) or (B, 6)}``, wrenches in the frame's axes about its origin, N and N m.
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

    /// Acceleration ``M⁻¹ (tau - c + Σ Jᵀ F)`` in O(n): (nv,), m/s² and rad/s².
    ///
    /// ``tau[:6]`` is a wrench on the base in its axes; ``external`` as in :meth:`inverse_dynamics`.
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

    /// Derivatives of :meth:`inverse_dynamics` with respect to ``q``, ``v``, ``a``: three arrays (nv, nv).
    ///
    /// Column ``j`` of the first is the rate along ``integrate(q, eps * e_j)``: the base's shifts, m, and turns, rad, in
    /// its own axes, then the joints. The third is the mass matrix. ``external`` stays constant in the axes of its frames.
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
        three(q.py(), self, Kernel::InverseDynamicsDerivatives, &[q, v, a], external, out, threads)
    }

    /// Derivatives of :meth:`forward_dynamics` with respect to ``q``, ``v``, ``tau``: three arrays (nv, nv).
    ///
    /// Tangent and wrenches as in :meth:`inverse_dynamics_derivatives`; the third is the inverse mass matrix.
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
        three(q.py(), self, Kernel::ForwardDynamicsDerivatives, &[q, v, tau], external, out, threads)
    }

    /// Linear momentum and angular momentum about the system's centre of mass: (6,), W axes, kg m/s and kg m²/s.
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

    /// Kinetic energy in W, J: a float, or (B,).
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

    /// Centre of mass in W: (3,), m.
    #[pyo3(signature = (q, *, threads=None, out=None))]
    fn center_of_mass<'py>(
        &self,
        q: Any<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::CenterOfMass, &[q], None, &[3], threads, out)
    }

    /// The reduced model for one frame: ``M*, c*, Q*, Jg, d``, exact for any momentum and wrench.
    ///
    /// ``out``: what an earlier call with as many states returned, to be written anew.
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

    /// Derivatives of ``M* q̈ + c* - Q*``, ``ẍ = Jg q̈ + d`` and ``ẋ`` at given joint accelerations (n,).
    ///
    /// Tangent and wrenches as in :meth:`inverse_dynamics_derivatives`. With ``q̈ = 0`` those of ``c* - Q*`` and ``d``;
    /// with respect to ``q̈`` they are ``M*`` and ``Jg``, that of ``ẋ`` with respect to ``v`` is :meth:`frame_jacobian`.
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

/// How `model.with_link(name, **keywords)` is made again. Successive changes of one link become a single one, so that a loop
/// that changes it does not keep every model on the way.
fn made_by_with_link(model: &Bound<'_, PyModel>, name: &str, keywords: Bound<'_, PyDict>) -> PyResult<Made> {
    let py = model.py();
    let call = model.get().made.as_ref().map(|made| made.call_of(py, "Model.with_link")).transpose()?;
    if let Some((arguments, earlier)) = call.flatten() {
        let (origin, link): (Bound<'_, PyAny>, String) = arguments.extract()?;
        if link == name {
            let merged = earlier.copy()?;
            for (key, value) in keywords.iter().filter(|(_, value)| !value.is_none()) {
                merged.set_item(key, value)?;
            }
            return Made::with("Model.with_link", (origin, name), &merged);
        }
    }
    Made::with("Model.with_link", (model, name), &keywords)
}

impl PyModel {
    /// A kernel with one output.
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
