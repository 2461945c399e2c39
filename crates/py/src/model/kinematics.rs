//! Methods of `Model` for configurations, poses and Jacobians.

use super::{Any, Array, PyModel};
use crate::arrays::Threads;
use onorbit_core::batch::Kernel;
use pyo3::prelude::*;

#[pymethods]
impl PyModel {
    /// Return ``q ⊕ dv``, the configuration that is reached from ``q`` with the constant velocity ``dv`` in
    /// unit time.
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

    /// Return ``q2 ⊖ q``, the ``dv`` for which ``integrate(q, dv) = q2``. Of the two possible rotations of
    /// the base, the shorter one is used.
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

    /// Return the Jacobian ``J`` of a frame: ``J v`` is the twist at the frame's origin, in W axes.
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
    ///     Jacobian with rows in W axes, linear first; dimensionless and m.
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
