//! Reduced model of a free-floating robot with closed loops.

use super::{Any, External, PyModel};
use crate::arrays::{Input, array_of, names_in, wrong_shape};
use crate::dynamics::single_wrenches;
use crate::errors::{IntoPython, fields, raise};
use onorbit_core::dynamics::constrained_free_floating;
use pyo3::prelude::*;

/// Reduced model of a free-floating robot with closed loops.
///
/// ``M ÿ + c = Gᵀ τ + Q`` and ``ẍ = J ÿ + d``, with the positions ``y`` of ``f`` independent joints, the
/// torques ``τ`` of all ``n`` joints and the acceleration ``ẍ`` of a frame. The rates of all joints are ``q̇
/// = G ẏ``, and their accelerations are ``q̈ = G ÿ + g``. :class:`FreeFloating` defines ``M*``, ``c*``,
/// ``Q*`` and ``Jg``.
#[pyclass(name = "ConstrainedFreeFloating", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyConstrainedFreeFloating {
    /// Names of the ``f`` independent joints, in the order of ``ÿ``.
    independent: Vec<String>,
    /// Matrix ``G``, (n, f): rates of all joints per rate of an independent joint.
    joint_map: Py<PyAny>,
    /// Joint accelerations ``g`` for ``ÿ = 0``, (n,), rad/s² or m/s².
    joint_drift: Py<PyAny>,
    /// Reduced mass matrix ``M = Gᵀ M* G``, (f, f), kg m², kg m and kg.
    inertia: Py<PyAny>,
    /// Reduced bias forces ``c = Gᵀ (c* + M* g)``, (f,), N m or N.
    bias: Py<PyAny>,
    /// Generalized external forces ``Q = Gᵀ Q*``, (f,), N m or N.
    external: Py<PyAny>,
    /// Generalized Jacobian ``J = Jg G`` of the frame, (6, f), at the frame's origin in W axes, linear rows
    /// first; dimensionless, m and 1/m.
    jacobian: Py<PyAny>,
    /// Drift ``d``, the acceleration of the frame for ``ÿ = 0``, (6,), m/s² and rad/s², W axes.
    drift: Py<PyAny>,
}

#[pymethods]
impl PyModel {
    /// Return the reduced model of a robot with closed loops for one frame, in terms of independent joints.
    ///
    /// The constraints ``K q̇ = 0`` of closed loops and mimic joints are solved for the dependent joints by
    /// Gaussian elimination with complete pivoting; redundant constraints have no pivot. The model is exact
    /// for any momentum and wrench. Without constraints, all joints are independent and the result is that of
    /// :meth:`free_floating`. Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, sections 3.2 and
    /// 8.8.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) array
    ///     Configuration that closes the loops; see :meth:`closed_configuration`.
    /// v : (nv,) array
    ///     Velocity that satisfies the constraints; see :meth:`closed_velocity`.
    /// frame : str
    ///     Name of the frame.
    /// independent : list of str, optional
    ///     Names of the independent joints. By default, the dependent joints are those with the largest
    ///     pivots, mimic joints first.
    /// external : dict of str to (6,) array, optional
    ///     Wrench by frame: force, N, and moment, N m, in the frame's axes about its origin.
    ///
    /// Returns
    /// -------
    /// ConstrainedFreeFloating
    ///
    /// Raises
    /// ------
    /// FrameError, ModelError
    ///     If the frame does not exist, or if the joints in ``independent`` do not exist, depend on each
    ///     other, or do not determine the motion of all joints.
    /// InputError, ShapeError
    ///     If a number is not finite, the quaternion is not a unit quaternion, or an array has the wrong
    ///     shape.
    #[pyo3(signature = (q, v, frame, *, independent=None, external=None))]
    fn constrained_free_floating(
        &self,
        q: Any<'_, '_>,
        v: Any<'_, '_>,
        frame: Any<'_, '_>,
        independent: Option<Any<'_, '_>>,
        external: External<'_, '_>,
    ) -> PyResult<PyConstrainedFreeFloating> {
        let (py, model) = (q.py(), &*self.model);
        let frame = self.frame(frame)?;
        let (q, v) = (self.configuration(q)?, self.velocity(v)?);
        let wrenches = single_wrenches(self, external)?;
        let names = independent.map(|names| names_in(names, "independent", "names of joints", "elbow"));
        let chosen = names.transpose()?.map(|names| self.joints_of(py, &names)).transpose()?;
        let preferred = chosen.as_deref().unwrap_or_default();
        let reduced = constrained_free_floating(model, (&q, &v), frame, &wrenches, preferred);
        if let Some(chosen) = &chosen {
            self.check_independent(py, chosen, &reduced.joints.independent)?;
        }
        let (n, f) = (model.joint_count(), reduced.joints.count());
        let array = |shape: &[usize], numbers: &[f64]| array_of(py, shape, numbers).into_any().unbind();
        let joints = model.joints();
        Ok(PyConstrainedFreeFloating {
            independent: reduced.joints.independent.iter().map(|&j| joints[j].name.clone()).collect(),
            joint_map: array(&[n, f], &reduced.joints.map),
            joint_drift: array(&[n], &reduced.joints.drift),
            inertia: array(&[f, f], &reduced.inertia),
            bias: array(&[f], &reduced.bias),
            external: array(&[f], &reduced.external),
            jacobian: array(&[6, f], &reduced.jacobian),
            drift: array(&[6], &reduced.drift),
        })
    }
}

impl PyModel {
    /// Returns the indices of the joints with these names.
    fn joints_of(&self, py: Python<'_>, names: &[String]) -> PyResult<Vec<usize>> {
        names.iter().map(|name| self.model.joint(name).map_err(|error| error.into_python(py))).collect()
    }

    /// Returns an error unless `chosen` and `independent` contain the same joints, given by index.
    fn check_independent(&self, py: Python<'_>, chosen: &[usize], independent: &[usize]) -> PyResult<()> {
        let names = |joints: &mut dyn Iterator<Item = &usize>| -> Vec<&str> {
            joints.map(|&j| &*self.model.joints()[j].name).collect()
        };
        let dependent = names(&mut chosen.iter().filter(|joint| !independent.contains(joint)));
        let missing = names(&mut independent.iter().filter(|joint| !chosen.contains(joint)));
        let problem = match (dependent.is_empty(), missing.is_empty()) {
            (true, true) => return Ok(()),
            (false, _) => {
                format!("the other joints determine {} in this configuration", dependent.join(", "))
            }
            (true, false) => format!("they do not determine the motion of {}", missing.join(", ")),
        };
        let message = format!(
            "the joints in 'independent' are not a set of independent joints: {problem}; a valid choice \
             is [{}]",
            names(&mut independent.iter()).join(", ")
        );
        Err(raise(py, "ModelError", &message, &fields!(py, "name": "independent")))
    }

    /// Reads one velocity, (nv,), m/s and rad/s, whose values must be finite.
    pub(super) fn velocity(&self, v: Any<'_, '_>) -> PyResult<Vec<f64>> {
        let (py, given) = (v.py(), Input::new(v, "v")?);
        if given.shape() != [self.model.nv()] {
            return Err(wrong_shape(py, "v", &format!("({},)", self.model.nv()), given.shape()));
        }
        let v = given.data().to_vec();
        crate::arrays::finite(py, "v", &v)?;
        Ok(v)
    }
}
