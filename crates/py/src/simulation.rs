//! Runs.

use crate::arrays::{Input, fixed, record_every, wrong_shape};
use crate::checkpoint::{Keeper, PyCheckpoint};
use crate::control::{Robot, control_law};
use crate::earth::PyEarth;
use crate::environment::effects;
use crate::errors::{IntoPython, SimulationErrorExt, fields, plain, raise};
use crate::gravity::gravity_of;
use crate::interrupt::{PACE, prepare};
use crate::model::PyModel;
use crate::orbit::PyOrbit;
use crate::plant::PythonPlant;
use crate::reference;
use crate::trace::PyTrace;
use onorbit_core::control::{ControlError, ControlLaw};
use onorbit_core::environment::ReferenceMotion;
use onorbit_core::model::Model;
use onorbit_core::number_text::short;
use onorbit_core::simulation::{Integrator, Moment, RunFailure, Simulation, SimulationError};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, TryLockError};
use std::time::{Duration, Instant};

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// A robot, where it starts, what acts on it and how time is cut; :meth:`run` starts afresh at every call.
///
/// ``q`` (nq,), ``v`` (nv,); ``orbit`` brings gravity on every body: ``gravity_mode`` is
/// ``true`` (the robot falls away from a reference that does not fall freely) or ``carried`` (tides only, the robot goes
/// along; what is left out is ``trace.reference_residual``); ``earth`` says when that is and how the Earth turns. ``environment`` lists effects; ``controller`` is a law such
/// as ``ComputedTorque``, an object with ``update(t, state) -> tau (n,)``, or a list of ``Control``; ``reference`` is for the frame ``tool`` (by
/// default the controller's) and may start ``reference_start_tolerance`` (m, rad) from it, (0.05, 0.1) by default; ``control_period`` s between calls of the controller (every step by default);
/// ``integrator`` is ``rk4``, ``semi_implicit_euler`` or ``dormand_prince``, which takes steps as long as ``tolerance`` lets
/// it (a share: of a radian, of the robot's size, of rates) and records its rows on the grid of ``time_step`` in between;
/// ``enforce_limits`` puts rigid stops at the joints' position limits, which give back ``restitution`` (0 to 1) of the rate;
/// ``record_wrenches`` keeps the wrench of every effect on every body in ``trace.wrenches``;
/// a robot that nothing leads through W and whose base drifts more than ``rereference_beyond`` m from the reference is integrated about
/// one of its own from there (``trace.rereferenced`` says when; its rows stay in W);
/// ``plant`` is another physics engine that moves the robot, such as ``onorbit_rs.plants.Mujoco``: an object with
/// ``step(start, end, q, v, tau, wrenches)`` that returns ``(q, v)`` at the end, the acceleration at the start (nv,), the integral of
/// external forces and of their moments about the centre of mass (6,), the work done on the robot less what its joints lost, and
/// that loss, J. ``wrenches(t, q, v)`` (bodies, 6) is what the environment does to each body at a state: force through its centre of mass and
/// torque about it, W axes. The plant integrates its own way and does not remember; ``integrator``, ``enforce_limits``, ``restitution`` and
/// ``rereference_beyond`` are for our own.
#[pyclass(name = "Simulation", frozen, module = "onorbit_rs")]
pub(crate) struct PySimulation {
    simulation: Mutex<Simulation>,
    model: Arc<Model>,
}

#[pymethods]
impl PySimulation {
    #[new]
    #[pyo3(signature = (
        model, q, v, *, orbit=None, earth=None, gravity_mode="true", environment=None, controller=None, reference=None, tool=None,
        time_step=1e-3, control_period=None, integrator="rk4", record_every=1, reference_start_tolerance=None,
        tolerance=1e-9, enforce_limits=false, restitution=0.0, record_wrenches=false,
        rereference_beyond=1e5, plant=None,
    ))]
    fn new(
        py: Python<'_>,
        model: &PyModel,
        q: Any<'_, '_>,
        v: Any<'_, '_>,
        orbit: Option<&Bound<'_, PyOrbit>>,
        earth: Option<&Bound<'_, PyEarth>>,
        gravity_mode: &str,
        environment: Option<&Bound<'_, PyAny>>,
        controller: Option<Any<'_, '_>>,
        reference: Option<Any<'_, '_>>,
        tool: Option<Any<'_, '_>>,
        time_step: f64,
        control_period: Option<f64>,
        integrator: &str,
        #[pyo3(from_py_with = record_every)] record_every: usize,
        reference_start_tolerance: Option<Any<'_, '_>>,
        tolerance: f64,
        enforce_limits: bool,
        restitution: f64,
        record_wrenches: bool,
        rereference_beyond: f64,
        plant: Option<Any<'_, '_>>,
    ) -> PyResult<Self> {
        let (q, v) = (Input::new(q, "q")?, Input::new(v, "v")?);
        let core = Arc::clone(&model.model);
        for (input, name, n) in [(&q, "q", core.nq()), (&v, "v", core.nv())] {
            if input.shape().len() != 1 {
                return Err(wrong_shape(py, name, &format!("({n},)"), input.shape()));
            }
        }
        let mut simulation = Simulation::new(Arc::clone(&core), q.data().to_vec(), v.data().to_vec());
        simulation.orbit = orbit.map(|orbit| Arc::clone(&orbit.get().orbit));
        simulation.earth = earth.map(|earth| earth.get().beneath(simulation.orbit.as_deref()));
        simulation.reference_motion = match gravity_mode {
            "true" => ReferenceMotion::True,
            "carried" => ReferenceMotion::Carried,
            other => {
                let message = format!("gravity_mode is '{other}'; there are 'true' and 'carried'");
                let fields = fields!(py, "name": "gravity_mode", "got": other);
                return Err(raise(py, "InputError", &message, &fields));
            }
        };
        let environment = effects(environment)?;
        let on_robot = environment.iter().filter_map(|effect| effect.get().on(py, &core).transpose());
        simulation.effects = on_robot.collect::<PyResult<_>>()?;
        let mu = simulation.orbit.as_ref().and_then(|orbit| orbit.mu());
        let own = simulation.orbit.as_ref().and_then(|orbit| orbit.gravity());
        let given = gravity_of(py, &environment, mu, simulation.earth.as_ref())?;
        if let (Some(orbit), Some(earth)) = (&simulation.orbit, &simulation.earth) {
            earth.fits(orbit.axes(), orbit.epoch()).map_err(|error| error.into_python(py))?;
        }
        let shared = given.map(|given| match own {
            Some(own) => given.shared_with(own),
            None => Ok(Arc::new(given)),
        });
        simulation.gravity = shared.transpose().map_err(|error| error.into_python(py))?;
        if let Some(tolerance) = reference_start_tolerance {
            simulation.reference_start_tolerance = fixed(tolerance, "reference_start_tolerance", &[2])?;
        }
        simulation.tool = tool.map(|tool| model.frame(tool)).transpose()?;
        if let Some(controller) = controller {
            let robot = Robot { model: &core, orbit: simulation.orbit.as_ref(), tool: simulation.tool };
            simulation.control = control_law(controller, reference, &robot)?;
        }
        match (&simulation.control, reference) {
            (ControlLaw::Stack(controls), _) => {
                let first = controls.iter().find_map(|control| control.task());
                simulation.tool = simulation.tool.or(first.map(|(frame, _)| frame));
            }
            (control, reference) => {
                if let ControlLaw::ComputedTorque(law) = control {
                    simulation.tool.get_or_insert(law.frame);
                }
                let bind = |value| reference::extract(value, simulation.orbit.as_ref());
                simulation.reference = reference.map(bind).transpose()?;
            }
        }
        simulation.time_step = time_step;
        simulation.control_period = control_period;
        simulation.integrator = integrator_named(py, integrator)?;
        simulation.record_every = record_every;
        simulation.tolerance = tolerance;
        simulation.record_wrenches = record_wrenches;
        simulation.rereference_beyond = rereference_beyond;
        simulation.stops = enforce_limits.then_some(restitution);
        simulation.check().map_err(|error| error.into_python_with(py, None))?;
        if let Some(plant) = plant {
            simulation.engine = Some(Box::new(PythonPlant::new(plant, &simulation)?));
        }
        Ok(Self { simulation: Mutex::new(simulation), model: core })
    }

    /// Run from the given state for ``duration`` s and return the :class:`Trace`.
    ///
    /// ``progress(t, duration)`` is called at a steady wall-clock pace. ``checkpoint(c)`` is handed a :class:`Checkpoint` every
    /// ``checkpoint_every`` s of wall clock (at most twenty a second) and at Ctrl-C; where it returns False, the next one has its
    /// rows again. With ``resume`` the run goes on from a checkpoint, to the same bits.
    /// Ctrl-C raises ``RunInterrupted``, a diverging run ``SimulationError``; both carry the trace so far.
    #[pyo3(signature = (duration, *, progress=None, checkpoint=None, checkpoint_every=30.0, resume=None))]
    fn run(
        &self,
        py: Python<'_>,
        duration: f64,
        progress: Option<Py<PyAny>>,
        checkpoint: Option<Py<PyAny>>,
        checkpoint_every: f64,
        resume: Option<&Bound<'_, PyCheckpoint>>,
    ) -> PyResult<PyTrace> {
        let every = Duration::try_from_secs_f64(checkpoint_every).map_err(|_| {
            let message =
                format!("checkpoint_every is {} s, it must be zero or positive", short(checkpoint_every));
            raise(
                py,
                "InputError",
                &message,
                &fields!(py, "name": "checkpoint_every", "got": checkpoint_every),
            )
        })?;
        let from = resume.map(|checkpoint| checkpoint.get().read(py)).transpose()?;
        let (rows, wall) =
            (from.as_ref().map_or(0, |from| from.0.rows()), resume.map_or(0.0, |c| c.get().wall_s));
        let begin = from.as_ref().map_or(0.0, |from| from.0.time());
        self.prepare(py, begin)?;
        let mut keeper = Keeper::new(checkpoint, every, rows, wall);
        let mut raised: Option<PyErr> = None;
        let ran = py.detach(|| {
            let mut simulation = match self.simulation.try_lock() {
                Ok(simulation) => simulation,
                Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
                Err(TryLockError::WouldBlock) => return None,
            };
            let mut last = Instant::now();
            let mut monitor = |now: &Moment<'_>| {
                if last.elapsed() < PACE {
                    return ControlFlow::Continue(());
                }
                last = Instant::now();
                let looked = Python::attach(|py| {
                    look(py, progress.as_ref(), now.time, duration).inspect_err(|_| {
                        let _ = keeper.keep(py, now); // the first error is told
                    })?;
                    keeper.keep_if_due(py, now)
                });
                match looked {
                    Ok(()) => ControlFlow::Continue(()),
                    Err(error) => {
                        raised = Some(error);
                        ControlFlow::Break(())
                    }
                }
            };
            Some(match from {
                None => simulation.run(duration, &mut monitor),
                Some((checkpoint, rows)) => simulation.resume(duration, (&checkpoint, rows), &mut monitor),
            })
        });
        let Some(result) = ran else {
            let message = "this simulation is running already; make another one to run beside it";
            return Err(plain(py, "SimulationError", message));
        };
        let wall_s = keeper.wall();
        let wrap =
            |trace, is_complete| PyTrace { trace, model: Arc::clone(&self.model), is_complete, wall_s };
        match result {
            Ok(trace) => Ok(wrap(trace, true)),
            Err(RunFailure { error, trace }) => Err(self.failure(py, error, wrap(*trace, false), raised)),
        }
    }
}

impl PySimulation {
    /// Integrates the reference orbit as far as the begin of a run, interruptible; a run that runs already has it.
    fn prepare(&self, py: Python<'_>, begin: f64) -> PyResult<()> {
        let orbit = self.simulation.try_lock().ok().and_then(|simulation| simulation.orbit.clone());
        orbit.map_or(Ok(()), |orbit| prepare(py, &*orbit, &[begin]))
    }

    /// The exception for a run that stopped early.
    fn failure(
        &self,
        py: Python<'_>,
        error: SimulationError,
        trace: PyTrace,
        raised: Option<PyErr>,
    ) -> PyErr {
        let is_ctrl_c = |error: &PyErr| error.is_instance_of::<PyKeyboardInterrupt>(py);
        // Ctrl-C arrives where Python runs: at the monitor, in a controller of the user's, in another plant, or here,
        // where it has been pending while the engine came upon an error of its own
        let ctrl_c = match (raised, &error) {
            (Some(other), _) if !is_ctrl_c(&other) => return other, // the progress callback raised
            (Some(ctrl_c), _) => Some(ctrl_c),
            (
                None,
                SimulationError::Control(ControlError::User(source)) | SimulationError::Engine(source),
            ) => source.downcast_ref::<PyErr>().filter(|error| is_ctrl_c(error)).map(|e| e.clone_ref(py)),
            (None, _) => match py.check_signals() {
                Err(other) if !is_ctrl_c(&other) => return other,
                checked => checked.err(),
            },
        };
        let (time, is_interrupted) = match (&error, trace.trace.time.last()) {
            (SimulationError::Interrupted { time }, _) => (Some(*time), true),
            (_, last) => (last.copied(), false),
        };
        let trace = Py::new(py, trace).ok();
        let Some(ctrl_c) = ctrl_c else { return error.into_python_with(py, trace) };
        let Some(time) = time else { return ctrl_c };
        let interrupted = SimulationError::Interrupted { time }.into_python_with(py, trace);
        if !is_interrupted {
            interrupted.set_context(py, Some(error.into_python_with(py, None)));
        }
        interrupted.set_cause(py, Some(ctrl_c)); // which signal it was
        interrupted
    }
}

/// Ctrl-C and progress.
fn look(py: Python<'_>, progress: Option<&Py<PyAny>>, t: f64, duration: f64) -> PyResult<()> {
    py.check_signals()?;
    match progress {
        Some(progress) => progress.call1(py, (t, duration)).map(|_| ()),
        None => Ok(()),
    }
}

pub(crate) fn integrator_named(py: Python<'_>, name: &str) -> PyResult<Integrator> {
    match name {
        "rk4" => Ok(Integrator::Rk4),
        "semi_implicit_euler" => Ok(Integrator::SemiImplicitEuler),
        "dormand_prince" => Ok(Integrator::DormandPrince),
        other => {
            let way_out = if other.eq_ignore_ascii_case("euler") {
                "; did you mean 'semi_implicit_euler'?"
            } else {
                ""
            };
            let message = format!(
                "integrator is '{other}'; there are 'rk4', 'semi_implicit_euler' and 'dormand_prince'{way_out}"
            );
            Err(raise(py, "InputError", &message, &fields!(py, "name": "integrator", "got": other)))
        }
    }
}
