//! Methods of `Model` for configurations, poses and Jacobians.

use super::{Any, Array, PyModel};
use crate::arrays::Threads;
use onorbit_core::batch::Kernel;
use pyo3::prelude::*;

#[pymethods]
impl PyModel {
    /// Return ``q ⊕ dv``, the configuration that the robot reaches from ``q`` if it moves with the constant
    /// velocity ``dv`` for a unit of time.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// dv : (nv,) or (B, nv) array
    ///     Tangent vector: translation (m) and rotation (rad) of the base in base axes, then joint
    ///     displacements (rad or m).
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

    /// Return ``q2 ⊖ q``, the tangent vector ``dv`` for which ``integrate(q, dv) = q2``. The base rotates by
    /// at most half a turn.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// q2 : (nq,) or (B, nq) array
    ///     Configuration to reach from ``q``, m and rad.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (nv,) or (B, nv) array
    ///     Tangent vector, m and rad, as for :meth:`integrate`.
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
    ///     Configuration, m and rad.
    /// frame : str
    ///     Name of the frame.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (4, 4) or (B, 4, 4) array
    ///     Homogeneous transform from frame axes to W, m.
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

    /// Return the twist of a frame: the velocity of its origin and its angular velocity, relative to W.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// v : (nv,) or (B, nv) array
    ///     Velocity, m/s and rad/s.
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

    /// Return the Jacobian ``J`` of a frame: ``J v`` is the twist at the frame's origin, in W axes.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// frame : str
    ///     Name of the frame.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (6, nv) or (B, 6, nv) array
    ///     Jacobian with rows in W axes, linear rows first, and columns in the order of ``v``; dimensionless
    ///     and m.
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
}
