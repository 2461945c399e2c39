//! Methods of `Model` for the reduced model of a free-floating manipulator.

use super::{Any, External, PyModel};
use crate::arrays::Threads;
use crate::dynamics::{PyFreeFloating, PyFreeFloatingDerivatives, free_floating, free_floating_derivatives};
use pyo3::prelude::*;

#[pymethods]
impl PyModel {
    /// Return the reduced model for one frame: ``M*``, ``c*``, ``Q*``, ``Jg`` and ``d`` of
    /// :class:`FreeFloating`.
    ///
    /// The model is exact for any momentum and wrench. ``out`` is the result of an earlier call with the same
    /// number of states; its contents are overwritten and it is returned.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// v : (nv,) or (B, nv) array
    ///     Velocity, m/s and rad/s.
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

    /// Return the derivatives of the torque ``M* q̈ + c* - Q*``, the acceleration ``ẍ = Jg q̈ + d`` of a
    /// frame and its twist ``ẋ`` at given joint accelerations ``q̈``; :class:`FreeFloating` defines the other
    /// symbols.
    ///
    /// Tangent vectors and wrenches are treated as in :meth:`inverse_dynamics_derivatives`. For ``q̈ = 0``,
    /// the results for torque and acceleration are the derivatives of ``c* - Q*`` and ``d``. The derivatives
    /// with respect to ``q̈`` are ``M*`` and ``Jg``; the derivative of ``ẋ`` with respect to ``v`` is
    /// :meth:`frame_jacobian`.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// v : (nv,) or (B, nv) array
    ///     Velocity, m/s and rad/s.
    /// joint_acceleration : (n,) or (B, n) array
    ///     Joint accelerations ``q̈``, rad/s² or m/s².
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
}
