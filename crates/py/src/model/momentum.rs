//! Methods of `Model` for momentum, energy and centre of mass.

use super::{Any, Array, PyModel};
use crate::arrays::Threads;
use onorbit_core::batch::Kernel;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

#[pymethods]
impl PyModel {
    /// Return the linear momentum, and the angular momentum about the centre of mass of the robot.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// v : (nv,) or (B, nv) array
    ///     Velocity, m/s and rad/s.
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

    /// Return the kinetic energy of the robot relative to W.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration, m and rad.
    /// v : (nv,) or (B, nv) array
    ///     Velocity, m/s and rad/s.
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
    ///     Configuration, m and rad.
    /// threads, out
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// (3,) or (B, 3) array
    ///     Position, W axes, m.
    #[pyo3(signature = (q, *, threads=None, out=None))]
    fn center_of_mass<'py>(
        &self,
        q: Any<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::CenterOfMass, &[q], None, &[3], threads, out)
    }
}
