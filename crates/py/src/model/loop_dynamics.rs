//! Methods of `Model` for closed loops and mimic joints.

use super::closed_loop::{PyLoop, loops_in, with_loops};
use super::{Any, Array, External, PyModel};
use crate::arrays::{Input, Threads, array_of, wrong_shape};
use crate::dynamics::evaluate;
use crate::errors::{fields, plain, raise};
use onorbit_core::batch::Kernel;
use onorbit_core::dynamics::{ClosedLoops, Data, close_loops, close_velocity};
use onorbit_core::model::{Closure, QUATERNION};
use onorbit_core::number_text::unlike;
use pyo3::prelude::*;

#[pymethods]
impl PyModel {
    /// Closed loops of the robot, a list of :class:`Loop`.
    #[getter]
    fn loops(&self) -> Vec<PyLoop> {
        self.model.description().loops().iter().map(|closing| PyLoop { closing: closing.clone() }).collect()
    }

    /// Return a copy of the robot with additional closed loops.
    ///
    /// The bodies, joints and frames do not change.
    ///
    /// Parameters
    /// ----------
    /// loops : list of Loop
    ///     Joints that close the loops.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If a frame does not exist.
    /// ModelError
    ///     If a loop is invalid, for example because both of its frames are on the same body or its name is
    ///     already used.
    #[pyo3(signature = (loops))]
    fn with_loops(slf: &Bound<'_, Self>, loops: Any<'_, '_>) -> PyResult<Self> {
        with_loops(slf, loops_in(loops)?)
    }

    /// Return the acceleration under the constraints of closed loops and mimic joints, and the constraint
    /// forces.
    ///
    /// The acceleration is ``a = M⁻¹ (tau - h + Jᵀ λ)`` with ``J a + J̇ v = 0``, the mass matrix ``M``, the
    /// bias forces ``h`` of :meth:`bias_forces`, the Jacobian ``J`` of the constraints and the constraint
    /// forces ``λ``. Without constraints, it is that of :meth:`forward_dynamics`. The forces of redundant
    /// constraints are zero.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) or (B, nq) array
    ///     Configuration that closes the loops; see :meth:`closed_configuration`.
    /// v : (nv,) or (B, nv) array
    ///     Velocity that satisfies the constraints; see :meth:`closed_velocity`.
    /// tau : (nv,) or (B, nv) array
    ///     Wrench on the base in base axes, then joint efforts, N and N m.
    /// loops : list of Loop, optional
    ///     Loops in addition to those of the model. For many calls, :meth:`with_loops` is faster.
    /// external : dict of str to (6,) or (B, 6) array, optional
    ///     Wrench by frame: force, N, and moment, N m, in the frame's axes about its origin.
    /// threads
    ///     As described for :class:`Model`.
    ///
    /// Returns
    /// -------
    /// a : (nv,) or (B, nv) array
    ///     Acceleration, m/s² and rad/s².
    /// forces : (m,) or (B, m) array
    ///     Constraint forces ``λ``, N and N m, in the order of :meth:`loop_errors`. The forces of a loop act
    ///     on its second body and are expressed in the axes of the joint on its first frame. The force of a
    ///     loop of kind ``distance`` acts along the line from the first to the second origin. The force of a
    ///     mimic joint is its torque, or its force if it is prismatic.
    ///
    /// Raises
    /// ------
    /// FrameError, ModelError
    ///     If a frame of ``loops`` does not exist, or a loop is invalid, as for :meth:`with_loops`.
    /// ShapeError
    ///     If an array has the wrong shape.
    #[pyo3(signature = (q, v, tau, loops=None, *, external=None, threads=None))]
    fn constrained_forward_dynamics<'py>(
        slf: &Bound<'py, Self>,
        q: Any<'_, 'py>,
        v: Any<'_, 'py>,
        tau: Any<'_, 'py>,
        loops: Option<Any<'_, '_>>,
        external: External<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        let closed = loops.map(|loops| with_loops(slf, loops_in(loops)?)).transpose()?;
        let robot = closed.as_ref().unwrap_or_else(|| slf.get());
        let (nv, m) = (robot.model.nv(), robot.constraint_count());
        let (kernel, shapes) = (Kernel::ConstrainedForwardDynamics, [&[nv][..], &[m]]);
        let outputs = evaluate(slf.py(), robot, kernel, &[q, v, tau], external, shapes, None, threads)?;
        Ok(outputs.into())
    }

    /// Return the constraint errors of closed loops and mimic joints. They are zero in a configuration that
    /// closes all loops.
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
    /// (m,) or (B, m) array
    ///     Errors, m and rad. For each loop in :attr:`loops`, the errors of its constrained translations
    ///     along the axes x, y, z of the joint on the first frame precede those of its constrained rotations.
    ///     Mimic joints follow in the order in which the robot's description lists the joints.
    #[pyo3(signature = (q, *, threads=None, out=None))]
    fn loop_errors<'py>(
        &self,
        q: Any<'_, 'py>,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<Array<'py>> {
        self.one(Kernel::LoopErrors, &[q], None, &[self.constraint_count()], threads, out)
    }

    /// Return the nearest configuration that closes all loops and in which mimic joints follow their leaders.
    ///
    /// Distances are measured with the mass matrix, so that, to first order, the centre of mass does not
    /// move.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) array
    ///     Configuration close to one that closes the loops, m and rad.
    ///
    /// Returns
    /// -------
    /// (nq,) array
    ///     Configuration whose :meth:`loop_errors` are zero up to rounding, m and rad.
    ///
    /// Raises
    /// ------
    /// ConvergenceError
    ///     If the loops cannot all be closed near ``q``, or a mimic joint cannot follow its leader there.
    /// InputError, ShapeError
    ///     If ``q`` is not finite, its quaternion is not a unit quaternion, or its shape is wrong.
    fn closed_configuration<'py>(&self, q: Any<'_, 'py>) -> PyResult<Array<'py>> {
        let py = q.py();
        let mut closed = self.configuration(q)?;
        let model = &*self.model;
        let mut loops = ClosedLoops::new(model, model.closures());
        close_loops(model, &mut Data::new(model), &mut loops, &mut closed);
        loops.check_closed(model).map_err(|error| plain(py, "ConvergenceError", &error.to_string()))?;
        Ok(array_of(py, &[closed.len()], &closed))
    }

    /// Return the nearest velocity at which the loops remain closed and mimic joints follow their leaders.
    ///
    /// Distances are measured with the mass matrix, so that the momentum does not change.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) array
    ///     Configuration that closes the loops, m and rad.
    /// v : (nv,) array
    ///     Velocity that need not satisfy the constraints, m/s and rad/s.
    ///
    /// Returns
    /// -------
    /// (nv,) array
    ///     Velocity that satisfies the constraints, m/s and rad/s.
    fn closed_velocity<'py>(&self, q: Any<'_, 'py>, v: Any<'_, 'py>) -> PyResult<Array<'py>> {
        let (py, model) = (q.py(), &*self.model);
        let q = self.configuration(q)?;
        let mut v = self.velocity(v)?;
        let mut loops = ClosedLoops::new(model, model.closures());
        close_velocity(model, &mut Data::new(model), &mut loops, &q, &mut v);
        Ok(array_of(py, &[v.len()], &v))
    }
}

impl PyModel {
    /// Returns the number of scalar constraints of loops and mimic joints.
    fn constraint_count(&self) -> usize {
        self.model.closures().iter().map(Closure::rows).sum()
    }

    /// Reads one configuration, (nq,), m and rad. Its quaternion must have norm 1 within 1e-6 and is
    /// normalised.
    pub(super) fn configuration(&self, q: Any<'_, '_>) -> PyResult<Vec<f64>> {
        let (py, nq) = (q.py(), self.model.nq());
        let given = Input::new(q, "q")?;
        if given.shape() != [nq] {
            return Err(wrong_shape(py, "q", &format!("({nq},)"), given.shape()));
        }
        let mut q = given.data().to_vec();
        crate::arrays::finite(py, "q", &q)?;
        let norm = q[QUATERNION].iter().map(|x| x * x).sum::<f64>().sqrt();
        if (norm - 1.0).abs() > 1e-6 {
            let norm = unlike(norm, &[1.0]);
            let message = format!(
                "the quaternion q[3:7] (x, y, z, w) has norm {norm}; it must be 1 within 1e-6; normalise it"
            );
            return Err(raise(py, "InputError", &message, &fields!(py, "name": "q")));
        }
        q[QUATERNION].iter_mut().for_each(|x| *x /= norm);
        Ok(q)
    }
}
