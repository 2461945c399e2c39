//! Methods of `Model` for the equations of motion and their derivatives.

use super::{Any, Array, External, PyModel};
use crate::arrays::Threads;
use crate::dynamics::evaluate_three;
use onorbit_core::batch::Kernel;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

#[pymethods]
impl PyModel {
    /// Return the mass matrix, including rotor inertia.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (nv, nv) or (B, nv, nv) array
    ///     Mass matrix, kg, kg m and kg m²; the base, in base axes, precedes the joints.
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

    /// Return the bias forces ``c - Σ Jᵀ F``: the Coriolis and centrifugal forces ``c`` minus the generalized
    /// forces of the external wrenches ``F``, with the Jacobians ``J`` of their frames.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// v : (nv,) or (B, nv) array
    ///     Velocity, m/s and rad/s.
    /// external : dict of str to (6,) or (B, 6) array, optional
    ///     Wrench by frame: force, N, and moment, N m, in the frame's axes about its origin.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (nv,) or (B, nv) array
    ///     Wrench on the base in base axes, then joint efforts, N and N m.
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

    /// Return the generalized forces ``M a + c - Σ Jᵀ F`` for an acceleration ``a``, with the mass matrix
    /// ``M`` and the bias forces ``c - Σ Jᵀ F`` of :meth:`bias_forces`.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// v : (nv,) or (B, nv) array
    ///     Velocity, m/s and rad/s.
    /// a : (nv,) or (B, nv) array
    ///     Acceleration, the time derivative of ``v``, m/s² and rad/s².
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

    /// Return the acceleration ``M⁻¹ (tau - c + Σ Jᵀ F)``, with the mass matrix ``M`` and the bias forces ``c
    /// - Σ Jᵀ F`` of :meth:`bias_forces`, in O(n) operations for n joints.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// v : (nv,) or (B, nv) array
    ///     Velocity, m/s and rad/s.
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
    ///     Acceleration, the time derivative of ``v``, m/s² and rad/s².
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
    /// Column ``j`` of the derivative with respect to ``q`` is the derivative along ``integrate(q, eps *
    /// e_j)`` with respect to ``eps`` at zero, where ``e_j`` is a unit vector. The columns belong to
    /// translations (m) and rotations (rad) of the base in base axes, then to the joints (rad or m).
    /// ``external`` is held constant in the axes of its frames.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// v : (nv,) or (B, nv) array
    ///     Velocity, m/s and rad/s.
    /// a : (nv,) or (B, nv) array
    ///     Acceleration, the time derivative of ``v``, m/s² and rad/s².
    /// external : dict of str to (6,) or (B, 6) array, optional
    ///     Wrench by frame: force, N, and moment, N m, in the frame's axes about its origin.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// dq, dv, da : (nv, nv) or (B, nv, nv) array
    ///     Derivatives with respect to ``q``, ``v`` and ``a``, in SI units; ``da`` is the mass matrix.
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
    ///     Configuration, m and rad.
    /// v : (nv,) or (B, nv) array
    ///     Velocity, m/s and rad/s.
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
    ///     Derivatives with respect to ``q``, ``v`` and ``tau``, in SI units; ``dtau`` is the inverse mass
    ///     matrix.
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
}
