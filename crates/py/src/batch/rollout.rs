//! Integration of many states of a robot at once.

use crate::arrays::{self, Input, Threads, shape_text, steps, type_name, wrong_shape};
use crate::control::PyComputedTorque;
use crate::errors::{IntoPython, fields, plain, raise};
use crate::interrupt::interruptible;
use crate::model::PyModel;
use crate::output::{outputs, pair};
use crate::reference::{self, Around};
use crate::simulation::integrator_named;
use onorbit_core::batch::{Rollout, RolloutControl};
use onorbit_core::number_text::short;
use pyo3::prelude::*;
use std::sync::atomic::AtomicBool;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Integrate many states of a robot without an environment.
///
/// The joints are free, have given torques, or are moved by a computed-torque controller. The bits of the
/// results do not depend on ``threads``. If the robot has closed loops or mimic joints, each run starts at the
/// nearest state that closes them, as a simulation does.
///
/// Parameters
/// ----------
/// model : Model
///     Model of the robot.
/// q0 : (B, nq) array
///     Initial configurations, m and rad.
/// v0 : (B, nv) array
///     Initial velocities, m/s and rad/s.
/// steps : int
///     Number of steps.
/// time_step : float
///     Length of each step, s.
/// tau : (B, steps, n) array, optional
///     Joint torques, each held for one step, N m or N.
/// controller : ComputedTorque, optional
///     Controller that tracks ``reference``.
/// reference : Reference, optional
///     Reference that the tool of the controller tracks.
/// integrator : {"rk4", "semi_implicit_euler"}
///     Integration method.
/// record_every : int, optional
///     If given, the initial state and the state after every ``record_every`` steps are returned. Default:
///     only the final state is returned.
/// threads : int, optional
///     Number of threads; default: all cores.
/// out : tuple of two arrays, optional
///     Arrays of the shapes of ``q`` and ``v`` in which the results are stored and which are returned.
///
/// Returns
/// -------
/// q, v : (B, nq) and (B, nv) array
///     Final configurations, m and rad, and velocities, m/s and rad/s. With ``record_every``, the shapes are
///     (B, K, nq) and (B, K, nv), where ``K = steps // record_every + 1``; the first of the K rows is the
///     initial state.
///
/// Raises
/// ------
/// SimulationError
///     If the motion diverges.
/// ControlError
///     If only one of ``controller`` and ``reference`` is given, if ``tau`` is given as well, if the
///     controller is of another kind or for another robot, or if the reference is in the frame ``"lvlh"`` or
///     in a frame of another system.
/// InputError, ShapeError
///     If a number is invalid, the integrator is not one of those listed, an initial state opens a loop that
///     has ``project=False`` or that cannot be closed, or an array has the wrong shape.
#[pyfunction]
#[pyo3(signature = (
    model, q0, v0, *, steps, time_step=1e-3, tau=None, controller=None, reference=None, integrator="rk4",
    record_every=None, threads=None, out=None,
))]
pub(super) fn rollout<'py>(
    py: Python<'py>,
    model: &PyModel,
    q0: Any<'_, 'py>,
    v0: Any<'_, 'py>,
    #[pyo3(from_py_with = steps)] steps: usize,
    time_step: f64,
    tau: Option<Any<'_, 'py>>,
    controller: Option<Any<'_, 'py>>,
    reference: Option<Any<'_, 'py>>,
    integrator: &str,
    record_every: Option<Any<'_, 'py>>,
    threads: Option<Threads>,
    out: Option<Any<'_, 'py>>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
    let core = &*model.model;
    let record_every = record_every.map(arrays::record_every).transpose()?;
    let (q0, v0) = (Input::new(q0, "q0")?, Input::new(v0, "v0")?);
    let batch = batch_of(py, &q0, "q0", core.nq())?;
    if batch_of(py, &v0, "v0", core.nv())? != batch {
        return Err(wrong_shape(
            py,
            "v0",
            &format!("({batch}, {}), one row per row of q0", core.nv()),
            v0.shape(),
        ));
    }
    if !(time_step.is_finite() && time_step > 0.0) {
        let message = format!("time_step is {} s; it must be positive and finite", short(time_step));
        return Err(raise(py, "InputError", &message, &fields!(py, "name": "time_step", "got": time_step)));
    }
    let tau = tau.map(|tau| Input::new(tau, "tau")).transpose()?;
    let inputs: Vec<Input<'py>> = [q0, v0].into_iter().chain(tau).collect();
    let reference = reference.map(|value| reference::extract(value, &Around::default())).transpose()?;
    let controller = controller.map(law_of).transpose()?;
    let control = match (inputs.get(2), controller, &reference) {
        (_, None, Some(_)) => {
            return Err(plain(
                py,
                "ControlError",
                "a reference is given, but no controller that tracks it; give a controller, or omit the reference",
            ));
        }
        (None, None, None) => RolloutControl::Passive,
        (Some(tau), None, None) => {
            let shape = [batch, steps, core.joint_count()];
            if tau.shape() != shape {
                return Err(wrong_shape(py, "tau", &shape_text(&shape), tau.shape()));
            }
            RolloutControl::Torques(tau.data())
        }
        (None, Some(controller), Some(reference)) => {
            controller.get().check_model(py, &model.model)?;
            RolloutControl::ComputedTorque(&controller.get().law, reference)
        }
        (None, Some(_), None) => {
            return Err(plain(
                py,
                "ControlError",
                "a controller is given, but no reference to track; give a reference, or omit the controller",
            ));
        }
        (Some(_), Some(_), _) => {
            return Err(plain(
                py,
                "ControlError",
                "both tau and a controller are given; omit one of the two",
            ));
        }
    };
    let integrator = integrator_named(py, integrator)?;
    let (stop, threads) = (AtomicBool::new(false), threads.map(|count| count.0));
    let rollout = Rollout { steps, time_step, integrator, control, record_every, threads, stop: &stop };
    let shape = |width: usize| match record_every {
        None => vec![batch, width],
        Some(_) => vec![batch, rollout.rows(), width],
    };
    let (q_shape, v_shape) = (shape(core.nq()), shape(core.nv()));
    let what = format!("(q, v) of shapes {} and {}", shape_text(&q_shape), shape_text(&v_shape));
    let [mut q, mut v] = outputs(py, pair(out, &what)?, [&q_shape, &v_shape], &inputs)?;
    let (to_q, to_v, from_q, from_v) = (q.numbers(), v.numbers(), inputs[0].data(), inputs[1].data());
    let result = interruptible(py, &stop, || rollout.run(core, from_q, from_v, to_q, to_v))?;
    result.map_err(|error| error.into_python(py))?;
    Ok((q.into_array().into_any(), v.into_array().into_any()))
}

/// Returns the computed-torque law, which is the only law that a rollout supports.
fn law_of<'a, 'py>(controller: Any<'a, 'py>) -> PyResult<&'a Bound<'py, PyComputedTorque>> {
    controller.cast::<PyComputedTorque>().map_err(|_| {
        let py = controller.py();
        let got = type_name(controller);
        let message = format!(
            "controller is of type {got}, but a rollout supports only ComputedTorque, or torques given as \
             tau; use a Simulation for other controllers"
        );
        let fields = fields!(py, "name": "controller", "got": got, "expected": "ComputedTorque");
        raise(py, "ControlError", &message, &fields)
    })
}

/// Returns the batch size B of an array of shape `(B, width)`.
fn batch_of(py: Python<'_>, input: &Input<'_>, name: &str, width: usize) -> PyResult<usize> {
    match input.shape() {
        [batch, got] if *got == width => Ok(*batch),
        other => Err(wrong_shape(py, name, &format!("(B, {width})"), other)),
    }
}
