//! The class `Simulation`: the simulation of one robot or of a world.

mod build;
mod given;

pub(crate) use build::{gravity_mode_named, integrator_named, set_environment};

use crate::arrays::record_every;
use crate::checkpoint::{CheckpointCallback, PyCheckpoint};
use crate::contact::PyContact;
use crate::earth::PyEarth;
use crate::engine::PythonEngine;
use crate::environment::{PyEffect, effects};
use crate::errors::SimulationErrorExt;
use crate::interrupt::{period, prepare};
use crate::model::PyModel;
use crate::orbit::PyOrbit;
use crate::shared_run::SharedRun;
use crate::stepper::PyStepper;
use crate::world::{PyWorld, RobotSettings, Systems};
use build::{of_robot, of_world};
use given::{Given, copies};
use onorbit_core::simulation::SimulationError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Simulation of one robot, or of a world: initial states, environment, controllers and integrator settings.
///
/// Parameters
/// ----------
/// model : Model or World
///     Robot, or a world of systems. Because a world has its own initial states, environment and controllers,
///     only ``time_step``, ``integrator``, ``tolerance``, ``record_every``, ``record_wrenches`` and ``engine``
///     may be given with it.
/// q : (nq,) array, optional
///     Initial configuration, m and rad; required for a robot.
/// v : (nv,) array, optional
///     Initial velocity, m/s and rad/s; required for a robot.
/// orbit : Orbit, optional
///     Reference orbit, on which the origin of W moves. An orbit around a planet adds gravity on every body.
/// earth : Earth, optional
///     Epoch and orientation of the Earth.
/// gravity_mode : {"true", "carried"}
///     Behaviour for a reference orbit that is not in free fall. ``true``: the robot falls in the modelled
///     gravity and therefore moves away from the reference. ``carried``: the robot moves along with the
///     reference; only tidal gravity acts, and drag and radiation pressure act without their common
///     acceleration. ``trace.reference_residual`` is the omitted difference between the acceleration of
///     gravity and that of the reference.
/// environment : list of Effect, optional
///     Effects on the bodies, such as ``GravityGradient()`` and ``Drag``.
/// controller : control law, object or list of Control, optional
///     Control law for all joints, such as ``ComputedTorque``; an object with ``update(t, state)`` that
///     returns joint torques (n,), N m or N; or several controls.
/// reference : Reference or JointReference, optional
///     Reference of the controller.
/// tool : str, optional
///     Frame that tracks the reference; default: the tool of the controller.
/// time_step : float
///     Length of fixed steps, s; with ``dormand_prince``, the spacing of the recorded rows.
/// control_period : float, optional
///     Time between calls of the controller, s; default: every step.
/// integrator : {"rk4", "semi_implicit_euler", "dormand_prince"}
///     Integrator; ``dormand_prince`` is adaptive.
/// record_every : int
///     Number of steps from one recorded row to the next.
/// reference_start_tolerance : (float, float), optional
///     Permitted initial deviation of the tool from its reference, m and rad; default: (0.05, 0.1).
/// tolerance : float
///     Permitted error per step of ``dormand_prince``, dimensionless: relative to 1 rad for angles, to the
///     robot's size or its distance from the origin of W for lengths, and to the magnitude of the rates for
///     rates.
/// enforce_limits : bool
///     If True, position limits of joints are rigid stops.
/// restitution : float
///     Coefficient of restitution of the stops, 0 to 1.
/// record_wrenches : bool
///     If True, ``trace.wrenches`` contains the wrench of every effect on every body.
/// rereference_beyond : float
///     Distance of the base from the reference orbit, m, beyond which integration continues about a new,
///     freely falling reference orbit. The reference orbit is kept without a planet, if ``gravity_mode`` is
///     ``carried``, and with a reference of the tool or a Python controller. ``trace.rereferenced`` contains
///     the times of these changes; recorded quantities still refer to W.
/// actuators : list of Brake, optional
///     Brakes of joints. Only events of a :class:`World` engage and disengage them during a run.
/// engine : object, optional
///     External physics engine that replaces the native engine, such as ``onorbit_rs.engines.Mujoco``. It is
///     an object with a method ``step`` (see Notes).
///
/// Raises
/// ------
/// TypeError
///     If ``model`` is neither a robot nor a world, ``q`` or ``v`` is missing for a robot, or an argument of
///     a robot is given with a world.
/// InputError, ShapeError
///     If a number is out of range, or an array has the wrong shape.
/// OrbitError, EarthError, GravityError, EffectError, ControlError, FrameError, WorldError, EngineError
///     If the orbit, the Earth, the environment, a controller, the tool, a brake or the engine is invalid, or
///     lacks something that another argument requires.
///
/// Notes
/// -----
/// ``engine.step(start, end, q, v, tau, wrenches)`` simulates one step from ``start`` to ``end``, s, with the
/// state ``q``, ``v`` at ``start`` and constant joint torques ``tau`` (n,), N m or N. It returns a tuple:
/// ``q`` and ``v`` at ``end``; the acceleration at ``start`` (nv,), m/s² and rad/s²; the time integrals of
/// the external forces and of their moments about the centre of mass (6,), W axes, N s and N m s; the work
/// done on the robot minus the energy dissipated in its joints, J; and the energy dissipated in its joints,
/// J. ``wrenches(t, q, v)`` returns the wrenches of the environment, (bodies, 6), W axes: the force on each
/// body, N, which acts at its centre of mass, and the torque about the centre of mass, N m. The object must
/// not keep state between calls. ``integrator``, ``enforce_limits``, ``restitution`` and
/// ``rereference_beyond`` apply only to the native engine.
///
/// A world of several systems needs ``engine.step_world(start, end, q, v, tau, wrenches, welds)``. Its
/// arrays, and those of ``wrenches``, hold the values of all systems, one system after another. ``welds``
/// lists the rigid connections during the step. Each consists of ``(system, body)`` of the capturing side and
/// of the captured side, by index; the origin of the captured frame in the axes of each body, (2, 3), m; and
/// the rotation from axes of the second body to axes of the first, (3, 3). The method returns a tuple: ``q``,
/// ``v`` and the acceleration; for each system the impulse (systems, 6), the work (systems,) and the
/// dissipated energy (systems,) as above; the impulse (systems, 6) and the work (systems,) of the connections
/// on each system; and the time integral of the moments of the external forces about the common centre of
/// mass, with each force acting at the centre of mass of its system, (3,), W axes, N m s. With such an
/// engine, captures cause no impact: the engine removes the relative velocity during the next steps.
///
/// The attribute ``contacts`` of an engine lists the names of the contacts whose forces the engine computes.
/// It includes their impulse and work in those of the connections, and ``step_world`` returns a tenth entry,
/// (contacts, 14): at ``start`` the force on the second side, N, its moment about the origin of W, N m, and
/// the power that the contact removes from the motion, W; then the time integrals of these seven numbers over
/// the step. Steps are shortened while bodies touch.
///
/// The attribute ``loops`` of an engine lists the closed loops and mimic joints whose constraints the engine
/// satisfies, as ``SYSTEM/NAME``, or ``NAME`` for a single robot. A robot with any other loop or mimic joint
/// is an error. If the attribute ``supports_brakes`` is True, both methods receive the keyword argument
/// ``brakes`` with the brakes that are engaged during the step: a list of ``(system, joint, slip_torque)``
/// with the indices of the system and of its joint, and the slip torque, N m or N. Otherwise, a robot with
/// brakes is an error.
#[pyclass(name = "Simulation", frozen, module = "onorbit_rs")]
pub(crate) struct PySimulation {
    run: SharedRun,
    systems: Arc<Systems>,
    /// Reference orbit; None without one.
    #[pyo3(get)]
    orbit: Option<Py<PyOrbit>>,
    /// Length of fixed steps, s; with ``dormand_prince``, the spacing of the recorded rows.
    #[pyo3(get)]
    time_step: f64,
    /// Number of steps from one recorded row to the next.
    #[pyo3(get)]
    record_every: usize,
    /// Name of the integrator.
    #[pyo3(get)]
    integrator: String,
    given: Given,
}

#[pymethods]
impl PySimulation {
    #[new]
    #[pyo3(signature = (
        model, q=None, v=None, *, orbit=None, earth=None, gravity_mode="true", environment=None, controller=None, reference=None, tool=None,
        time_step=1e-3, control_period=None, integrator="rk4", record_every=1, reference_start_tolerance=None,
        tolerance=1e-9, enforce_limits=false, restitution=0.0, record_wrenches=false,
        rereference_beyond=1e5, actuators=None, engine=None,
    ))]
    fn new(
        py: Python<'_>,
        model: Any<'_, '_>,
        q: Option<Any<'_, '_>>,
        v: Option<Any<'_, '_>>,
        orbit: Option<&Bound<'_, PyOrbit>>,
        earth: Option<&Bound<'_, PyEarth>>,
        gravity_mode: &str,
        environment: Option<&Bound<'_, PyAny>>,
        controller: Option<Py<PyAny>>,
        reference: Option<Py<PyAny>>,
        tool: Option<Py<PyAny>>,
        time_step: f64,
        control_period: Option<f64>,
        integrator: &str,
        #[pyo3(from_py_with = record_every)] record_every: usize,
        reference_start_tolerance: Option<Py<PyAny>>,
        tolerance: f64,
        enforce_limits: bool,
        restitution: f64,
        record_wrenches: bool,
        rereference_beyond: f64,
        actuators: Option<Py<PyAny>>,
        engine: Option<Any<'_, '_>>,
    ) -> PyResult<Self> {
        let given = [
            ("q", q.is_some()),
            ("v", v.is_some()),
            ("orbit", orbit.is_some()),
            ("earth", earth.is_some()),
            ("gravity_mode", gravity_mode != "true"),
            ("environment", environment.is_some()),
            ("controller", controller.is_some()),
            ("reference", reference.is_some()),
            ("tool", tool.is_some()),
            ("control_period", control_period.is_some()),
            ("reference_start_tolerance", reference_start_tolerance.is_some()),
            ("enforce_limits", enforce_limits),
            ("restitution", restitution != 0.0),
            ("rereference_beyond", rereference_beyond != 1e5),
            ("actuators", actuators.is_some()),
        ];
        let mut objects;
        let mut own_orbit = orbit.map(|orbit| orbit.clone().unbind());
        let mut simulation = if let Ok(world) = model.cast::<PyWorld>() {
            own_orbit = world.get().orbit(py);
            objects = Given::of_world(py, world.get());
            of_world(world, &given)?
        } else {
            let environment = effects(environment)?;
            objects = Given::of_robot(py, &environment, controller.as_ref());
            let settings = RobotSettings {
                controller,
                reference,
                tool,
                control_period,
                enforce_limits,
                restitution,
                reference_start_tolerance,
                actuators,
            };
            let mut simulation =
                of_robot(model, (q, v), (orbit, earth, gravity_mode, &environment), &settings)?;
            simulation.rereference_beyond = rereference_beyond;
            simulation
        };
        simulation.time_step = time_step;
        simulation.integrator = integrator_named(py, integrator)?;
        simulation.record_every = record_every;
        simulation.tolerance = tolerance;
        simulation.record_wrenches = record_wrenches;
        simulation.check().map_err(|error| error.into_python_with(py, None))?;
        if let Some(engine) = engine {
            objects.engine = Some(engine.clone().unbind());
            simulation.engine = Some(Box::new(PythonEngine::new(engine, &simulation)?));
            simulation.check().map_err(|error| error.into_python_with(py, None))?;
        }
        let systems = Arc::new(Systems::of(&simulation));
        let (run, integrator) = (SharedRun::new(simulation), integrator.to_owned());
        Ok(Self { run, systems, orbit: own_orbit, time_step, record_every, integrator, given: objects })
    }

    /// Models of the robots, by the name of the system. A single robot has the name of its model.
    #[getter]
    fn models<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for (name, model) in self.systems.names.iter().zip(&self.systems.models) {
            all.set_item(name, PyModel::of(Arc::clone(model)))?;
        }
        Ok(all)
    }

    /// Effects on the bodies, as given.
    #[getter]
    fn environment(&self, py: Python<'_>) -> Vec<Py<PyEffect>> {
        copies(py, &self.given.environment)
    }

    /// Contacts between links, as given; empty for a single robot.
    #[getter]
    fn contacts(&self, py: Python<'_>) -> Vec<Py<PyContact>> {
        copies(py, &self.given.contacts)
    }

    /// Controllers as given: for the name of each system, a list of laws, Python objects or :class:`Control`.
    #[getter]
    fn controllers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for (name, controllers) in self.systems.names.iter().zip(&self.given.controllers) {
            all.set_item(name, copies(py, controllers))?;
        }
        Ok(all)
    }

    /// External physics engine; None for the native engine.
    #[getter]
    fn engine(&self, py: Python<'_>) -> Option<Py<PyAny>> {
        self.given.engine.as_ref().map(|engine| engine.clone_ref(py))
    }

    /// Simulate from the initial state and return the trace.
    ///
    /// If :meth:`start` began a run that is still in progress, that run ends.
    ///
    /// Parameters
    /// ----------
    /// duration : float
    ///     Simulated time, s.
    /// progress : callable, optional
    ///     Function ``progress(t, duration)``, called at regular intervals of wall-clock time with the
    ///     simulation time and the duration, s.
    /// checkpoint : callable, optional
    ///     Function ``checkpoint(c)``, called with a :class:`Checkpoint` that contains the rows since the
    ///     last one. If it returns False, the next checkpoint contains the same rows again.
    /// checkpoint_every : float, optional
    ///     Wall-clock time between checkpoints, s; there are at most twenty checkpoints per second. Ctrl-C
    ///     causes a checkpoint as well.
    /// resume : Checkpoint, optional
    ///     Checkpoint from which the run resumes, with bit-identical results.
    ///
    /// Returns
    /// -------
    /// Trace or WorldTrace
    ///     Result of the run; a WorldTrace for a world of several systems.
    ///
    /// Raises
    /// ------
    /// RunInterrupted
    ///     At Ctrl-C; its attribute ``trace`` contains the rows so far.
    /// SimulationError
    ///     If the run diverges; its attribute ``trace`` contains the rows so far.
    /// InputError, CheckpointError
    ///     If ``duration`` or ``checkpoint_every`` is invalid, or if ``resume`` is damaged, lacks rows or
    ///     belongs to a different simulation or version.
    #[pyo3(signature = (duration, *, progress=None, checkpoint=None, checkpoint_every=30.0, resume=None))]
    fn run(
        &self,
        py: Python<'_>,
        duration: f64,
        progress: Option<Py<PyAny>>,
        checkpoint: Option<Py<PyAny>>,
        checkpoint_every: f64,
        resume: Option<&Bound<'_, PyCheckpoint>>,
    ) -> PyResult<Py<PyAny>> {
        let every = period(py, "checkpoint_every", checkpoint_every)?;
        let stepper = self.start(py, Some(duration), resume, false)?;
        let rows = stepper.row_counts(py)?; // the rows of the checkpoint
        let mut saver =
            checkpoint.map(|to| CheckpointCallback::new(to, self.systems.names.clone(), every, rows));
        stepper.run_to_end(py, duration, &mut |py, stepper, wall_s| {
            let called = py.check_signals().and_then(|()| match &progress {
                Some(progress) => progress.call1(py, (stepper.time(), duration)).map(|_| ()),
                None => Ok(()),
            });
            let Some(saver) = &mut saver else { return called };
            match called {
                Ok(()) => saver.save_if_due(py, stepper, wall_s),
                Err(error) => {
                    let _ = saver.save(py, stepper, wall_s); // only the first error is reported
                    Err(error)
                }
            }
        })
    }

    /// Start a run that is advanced step by step.
    ///
    /// The steps are those of :meth:`run` for any times to which the stepper is advanced. A simulation has
    /// one run at a time: starting another run ends the current run.
    ///
    /// Parameters
    /// ----------
    /// duration : float, optional
    ///     Planned end of the run, s. The last step ends at this time. Default: the planned end of ``resume``
    ///     or, without it, no planned end.
    /// resume : Checkpoint, optional
    ///     Checkpoint from which the run resumes, with bit-identical results.
    /// streamed : bool
    ///     If True, memory is reserved for only a few rows. Of the rows of ``resume``, only the first and the
    ///     last ones stay in memory; the others are removed once they have been checked. The columns of
    ///     ``resume`` are read in blocks, so they may be arrays in files. Read the rows with
    ///     :meth:`Stepper.columns`, and remove them with ``drop_rows(keep, checked=True)``.
    ///
    /// Returns
    /// -------
    /// Stepper
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If the duration is not positive and finite.
    /// CheckpointError
    ///     If ``resume`` is damaged, lacks rows or belongs to a different simulation or version.
    #[pyo3(signature = (*, duration=None, resume=None, streamed=false))]
    fn start(
        &self,
        py: Python<'_>,
        duration: Option<f64>,
        resume: Option<&Bound<'_, PyCheckpoint>>,
        streamed: bool,
    ) -> PyResult<PyStepper> {
        if let Some(duration) = duration {
            let checked = SimulationError::check_positive("duration", duration);
            checked.map_err(|error| error.into_python_with(py, None))?; // before the current run ends
        }
        let from = resume.map(|checkpoint| checkpoint.get().read(py, &self.systems, streamed)).transpose()?;
        let begin = from.as_ref().map_or(0.0, |from| from.0.time());
        if let Some(orbit) = &self.orbit {
            prepare(py, &*orbit.get().orbit, &[begin])?; // Ctrl-C can interrupt this call
        }
        let wall_s = resume.map_or(0.0, |checkpoint| checkpoint.get().wall_s);
        let number = self.run.start(py, (duration, streamed), from, wall_s)?;
        Ok(PyStepper::new(self.run.clone(), number, Arc::clone(&self.systems)))
    }
}
