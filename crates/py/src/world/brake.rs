//! Brakes of joints, and the events that engage and disengage them.

use super::event::{Condition, event_name};
use crate::arrays::{list_of, text};
use crate::errors::{fields, raise};
use crate::pickling::{ConstructorCall, Reduced};
use onorbit_core::model::Model;
use onorbit_core::number_text::{names, short};
use onorbit_core::world::{Brake, BrakeIndex};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Brake of a joint. It is one of the actuators of a system.
///
/// While it is engaged, a brake with a finite slip torque adds Coulomb friction to the joint: it holds a
/// joint at rest against torques up to the slip torque, and opposes the motion of a moving joint with the
/// slip torque. A brake with an infinite slip torque holds the joint rigidly. It stops a moving joint by an
/// impulse, which does not change the momentum of the system.
///
/// Parameters
/// ----------
/// name : str
///     Name, unique among the actuators of the system.
/// joint : str
///     Name of the joint.
/// slip_torque : float
///     Largest torque that the brake holds, N m (N for a prismatic joint); positive, and may be infinite.
/// engaged : bool
///     If True, the brake is engaged at the start of the run.
///
/// Raises
/// ------
/// InputError, DtypeError
///     If the slip torque is not positive, or a name is not text.
#[pyclass(name = "Brake", frozen, module = "onorbit_rs")]
pub(crate) struct PyBrake {
    /// Name of the brake.
    #[pyo3(get)]
    name: String,
    /// Name of the joint.
    #[pyo3(get)]
    joint: String,
    /// Largest torque that the brake holds, N m (N for a prismatic joint).
    #[pyo3(get)]
    slip_torque: f64,
    /// True if the brake is engaged at the start of the run.
    #[pyo3(get)]
    engaged: bool,
}

#[pymethods]
impl PyBrake {
    #[new]
    #[pyo3(signature = (name, joint, *, slip_torque=f64::INFINITY, engaged=false))]
    fn new(
        py: Python<'_>,
        name: &Bound<'_, PyAny>,
        joint: &Bound<'_, PyAny>,
        slip_torque: f64,
        engaged: bool,
    ) -> PyResult<Self> {
        let name = text(name, "name", "the name of a brake (str), such as 'elbow_brake'")?;
        let joint = text(joint, "joint", "the name of a joint (str), such as 'elbow'")?;
        if slip_torque.is_nan() || slip_torque <= 0.0 {
            let value = short(slip_torque);
            let message = format!(
                "the slip torque of the brake '{name}' is {value} N m (N for a prismatic joint); it must be \
                 positive, and may be infinite"
            );
            return Err(raise(
                py,
                "InputError",
                &message,
                &fields!(py, "name": "slip_torque", "got": slip_torque),
            ));
        }
        Ok(Self { name, joint, slip_torque, engaged })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(py);
        keywords.set_item("slip_torque", self.slip_torque)?;
        keywords.set_item("engaged", self.engaged)?;
        ConstructorCall::new("Brake", (&self.name, &self.joint), &keywords)?.reduce(py)
    }

    fn __repr__(&self) -> String {
        format!("<Brake '{}' of {}>", self.name, self.joint)
    }
}

/// Returns the brakes given as the actuators of a robot.
pub(super) fn brakes_of(py: Python<'_>, actuators: &Bound<'_, PyAny>, model: &Model) -> PyResult<Vec<Brake>> {
    let brakes = list_of::<PyBrake>(actuators, "actuators", "actuators, such as [oo.Brake(…)]")?;
    let read = |brake: &Bound<'_, PyBrake>| {
        let PyBrake { name, joint, slip_torque, engaged } = brake.get();
        let wrong = |problem: String| {
            let message = format!(
                "the brake '{name}' has no joint that moves (revolute, continuous or prismatic): {problem}"
            );
            raise(py, "WorldError", &message, &fields!(py, "name": name, "got": joint))
        };
        let joint = model.joint(joint).map_err(|error| wrong(error.to_string()))?;
        Ok(Brake { name: name.clone(), joint, slip_torque: *slip_torque, is_engaged: *engaged })
    };
    brakes.iter().map(read).collect()
}

/// Returns the brake with the path `SYSTEM/BRAKE`, to which the event `event` refers. `systems` are the names
/// of the systems, each with the names of its brakes.
pub(super) fn brake_at(
    py: Python<'_>,
    event: &str,
    path: &str,
    systems: &[(String, Vec<String>)],
) -> PyResult<BrakeIndex> {
    let wrong = |problem: &str| {
        let message = format!("the event '{event}' refers to the brake '{path}': {problem}");
        raise(py, "WorldError", &message, &fields!(py, "name": event, "got": path))
    };
    let Some((name, brake)) = path.split_once('/') else {
        return Err(wrong("it must be written SYSTEM/BRAKE, as in 'chaser/elbow_brake'"));
    };
    let Some(system) = systems.iter().position(|(known, _)| known == name) else {
        let known: Vec<&str> = systems.iter().map(|(name, _)| name.as_str()).collect();
        return Err(wrong(&format!("there is no system '{name}'; {}", names(&known, "system"))));
    };
    let known = &systems[system].1;
    match known.iter().position(|name| name == brake) {
        Some(brake) => Ok(BrakeIndex { system, brake }),
        None if known.is_empty() => Err(wrong(&format!(
            "the system '{name}' has no brakes; add the brake to the 'actuators' of this system"
        ))),
        None => {
            let known = match &known[..] {
                [only] => format!("the only brake of the system '{name}' is '{only}'"),
                _ => format!("the brakes of the system '{name}' are: {}", known.join(", ")),
            };
            Err(wrong(&format!("there is no brake '{brake}'; {known}")))
        }
    }
}

/// Reads the path `SYSTEM/BRAKE` of a brake.
fn brake_path(value: &Bound<'_, PyAny>) -> PyResult<String> {
    text(value, "brake", "a brake as SYSTEM/BRAKE (str), such as 'chaser/elbow_brake'")
}

/// Declares the Python class of an event that engages or disengages a brake.
macro_rules! brake_event {
    ($(#[$doc:meta])* $type:ident, $name:literal, $verb:literal) => {
        $(#[$doc])*
        #[pyclass(name = $name, frozen, module = "onorbit_rs")]
        pub(crate) struct $type {
            /// Name of the event.
            #[pyo3(get)]
            pub(super) name: String,
            /// Path of the brake, ``SYSTEM/BRAKE``.
            #[pyo3(get)]
            pub(super) brake: String,
            pub(super) condition: Condition,
        }

        #[pymethods]
        impl $type {
            #[new]
            #[pyo3(signature = (name, brake, *, at=None, after=None, delay=0.0, on_command=false))]
            fn new(
                py: Python<'_>,
                name: &Bound<'_, PyAny>,
                brake: &Bound<'_, PyAny>,
                at: Option<f64>,
                after: Option<&Bound<'_, PyAny>>,
                delay: f64,
                on_command: bool,
            ) -> PyResult<Self> {
                let (name, brake) = (event_name(name, "name")?, brake_path(brake)?);
                let after = after.map(|after| event_name(after, "after")).transpose()?;
                let condition = Condition::new(py, &name, (at, after, delay, on_command), None)?;
                Ok(Self { name, brake, condition })
            }

            fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
                let keywords = PyDict::new(py);
                self.condition.write_to(&keywords)?;
                ConstructorCall::new($name, (&self.name, &self.brake), &keywords)?.reduce(py)
            }

            fn __repr__(&self) -> String {
                format!(concat!("<", $name, " '{}': ", $verb, " {}>"), self.name, self.brake)
            }
        }
    };
}

brake_event! {
    /// Event that engages a brake. A brake that is already engaged stays engaged.
    ///
    /// Exactly one of ``at``, ``after`` and ``on_command`` specifies when the event happens. From then on, a
    /// brake with a finite slip torque slows its joint down by friction. A brake with an infinite slip torque
    /// stops the joint at once by an impulse; ``energy_lost`` of the event's record is the kinetic energy
    /// lost.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Name of the event.
    /// brake : str
    ///     Path of the brake, ``SYSTEM/BRAKE``.
    /// at : float, optional
    ///     Simulation time of the event, s.
    /// after : str, optional
    ///     Name of another event, after which this event happens.
    /// delay : float
    ///     Time from the other event to this event, s; only with ``after``.
    /// on_command : bool
    ///     If True, the event happens when ``Stepper.trigger`` is called.
    ///
    /// Raises
    /// ------
    /// WorldError, DtypeError
    ///     If not exactly one condition is given, ``delay`` is given without ``after``, or a name is not
    ///     text.
    PyEngage, "Engage", "engages"
}

brake_event! {
    /// Event that disengages a brake, whose joint can then move. A brake that is not engaged stays
    /// disengaged.
    ///
    /// Exactly one of ``at``, ``after`` and ``on_command`` specifies when the event happens.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Name of the event.
    /// brake : str
    ///     Path of the brake, ``SYSTEM/BRAKE``.
    /// at : float, optional
    ///     Simulation time of the event, s.
    /// after : str, optional
    ///     Name of another event, after which this event happens.
    /// delay : float
    ///     Time from the other event to this event, s; only with ``after``.
    /// on_command : bool
    ///     If True, the event happens when ``Stepper.trigger`` is called.
    ///
    /// Raises
    /// ------
    /// WorldError, DtypeError
    ///     If not exactly one condition is given, ``delay`` is given without ``after``, or a name is not
    ///     text.
    PyDisengage, "Disengage", "disengages"
}
