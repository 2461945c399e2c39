//! Captures and releases, and the conversion of all kinds of events to those of the core.

use super::brake::{PyDisengage, PyEngage, brake_at};
use crate::arrays::{fixed, list_of, names_in, text, wrong_entry};
use crate::errors::{IntoPython, fields, raise};
use crate::model::attach::isometry;
use crate::pickling::{ConstructorCall, Reduced, deep_copy};
use onorbit_core::model::Model;
use onorbit_core::number_text::{self, names};
use onorbit_core::world::{Action, Envelope, Event, FrameIndex, Seat, When};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Condition under which an event happens, as given in Python.
#[derive(Clone)]
pub(super) struct Condition {
    at: Option<f64>,
    after: Option<String>,
    delay: f64,
    latch: Option<Envelope>,
}

impl Condition {
    /// Creates the condition of the event `name`. Exactly one of `at`, `after`, `on_command` and `latch` must
    /// be given, otherwise the result is an error.
    pub(super) fn new(
        py: Python<'_>,
        name: &str,
        (at, after, delay, on_command): (Option<f64>, Option<String>, f64, bool),
        latch: Option<Envelope>,
    ) -> PyResult<Self> {
        let count = [at.is_some(), after.is_some(), on_command, latch.is_some()]
            .iter()
            .filter(|given| **given)
            .count();
        let problem = if count != 1 {
            "has none or more than one of at, after, on_command and (for a capture) within; give exactly one"
        } else if delay != 0.0 && after.is_none() {
            "has a delay without after; add after, or omit delay"
        } else {
            return Ok(Self { at, after, delay, latch });
        };
        let message = format!("the event '{name}' {problem}");
        Err(raise(py, "WorldError", &message, &fields!(py, "name": name)))
    }

    /// Stores the condition in `keywords`, the keyword arguments of the event's constructor.
    pub(super) fn write_to(&self, keywords: &Bound<'_, PyDict>) -> PyResult<()> {
        keywords.set_item("at", self.at)?;
        keywords.set_item("after", &self.after)?;
        keywords.set_item("delay", self.delay)?;
        let is_planned = self.at.is_some() || self.after.is_some() || self.latch.is_some();
        keywords.set_item("on_command", !is_planned)?;
        if let Some(Envelope { within, slower_than, held_for, touching }) = &self.latch {
            let is_limited = slower_than.iter().any(|rate| rate.is_finite());
            keywords.set_item("within", within)?;
            keywords.set_item("slower_than", is_limited.then_some(*slower_than))?;
            keywords.set_item("held_for", held_for)?;
            keywords.set_item("touching", touching)?;
        }
        Ok(())
    }

    /// Returns the condition of the core for the event `name`; `names` are the names of all events.
    pub(super) fn when(&self, py: Python<'_>, name: &str, names: &[String]) -> PyResult<When> {
        if let Some(envelope) = &self.latch {
            return Ok(When::Latch(envelope.clone()));
        }
        match (&self.after, self.at) {
            (Some(after), _) => {
                Ok(When::After { event: event_named(py, name, after, names)?, delay: self.delay })
            }
            (None, Some(t)) => Ok(When::At(t)),
            (None, None) => Ok(When::OnCommand),
        }
    }
}

/// Returns the index of the event `other`, to which the event `name` refers, in the `names` of all events.
fn event_named(py: Python<'_>, name: &str, other: &str, names: &[String]) -> PyResult<usize> {
    names.iter().position(|known| known == other).ok_or_else(|| {
        let message = format!(
            "the event '{name}' refers to the unknown event '{other}'; {}",
            number_text::names(names, "event")
        );
        raise(py, "WorldError", &message, &fields!(py, "name": name, "got": other))
    })
}

/// Returns the frame with the path `SYSTEM/FRAME`, to which the event `event` refers.
fn frame_at(
    py: Python<'_>,
    event: &str,
    path: &str,
    systems: &[(String, Arc<Model>)],
) -> PyResult<FrameIndex> {
    let wrong = |problem: &str| {
        let message = format!("the event '{event}' refers to the frame '{path}': {problem}");
        raise(py, "WorldError", &message, &fields!(py, "name": event, "got": path))
    };
    let Some((name, frame)) = path.split_once('/') else {
        return Err(wrong("it must be written SYSTEM/FRAME, as in 'chaser/tool'"));
    };
    let Some(system) = systems.iter().position(|(known, _)| known == name) else {
        let known: Vec<&str> = systems.iter().map(|(name, _)| name.as_str()).collect();
        return Err(wrong(&format!("there is no system '{name}'; {}", names(&known, "system"))));
    };
    let frame = systems[system].1.frame(frame).map_err(|error| error.into_python(py))?;
    Ok(FrameIndex { system, frame })
}

/// Event that rigidly connects two frames of different systems, with the relative pose that they have at that
/// instant.
///
/// Exactly one of ``at``, ``after``, ``on_command`` and ``within`` specifies when the capture happens.
///
/// Parameters
/// ----------
/// name : str
///     Name of the event.
/// frame_a : str
///     Path of the capturing frame, ``SYSTEM/FRAME``.
/// frame_b : str
///     Path of the captured frame, ``SYSTEM/FRAME``.
/// at : float, optional
///     Simulation time of the capture, s.
/// after : str, optional
///     Name of another event, after which the capture happens.
/// delay : float
///     Time from the other event to the capture, s; only with ``after``.
/// on_command : bool
///     If True, the capture happens when ``Stepper.trigger`` is called.
/// within : (float, float), optional
///     Distance, m, and angle, rad, of a latch. The capture happens once the frames are within both.
/// slower_than : (float, float), optional
///     Largest speed of the captured frame's origin as observed in the capturing frame, m/s, and largest
///     relative angular speed, rad/s, at which the latch closes; only with ``within``. Default: no limit.
/// held_for : float
///     Time for which the conditions of the latch must hold before the capture, s; only with ``within``.
/// touching : list of str, optional
///     Names of contacts between the two systems that must also touch for the latch to close; only with
///     ``within``. Default: none.
/// seat : float, optional
///     Time, s, during which the captured frame moves to ``pose`` after the capture, as with latches and
///     grapple fixtures. The motion starts and ends at rest. Default: the relative pose at the capture is
///     kept.
/// pose : (4, 4) array, optional
///     Final pose of the captured frame in the capturing frame, m, at a distance of at most 1000 m; only with
///     ``seat``. Default: the two frames coincide.
///
/// Raises
/// ------
/// WorldError
///     If not exactly one condition is given, or an argument is given without the argument that it requires.
/// InputError, ShapeError, DtypeError, ModelError
///     If a number is not finite, an array has the wrong shape, a name is not text, or ``pose`` is not a
///     rigid transform.
#[pyclass(name = "Capture", frozen, module = "onorbit_rs")]
pub(crate) struct PyCapture {
    /// Name of the event.
    #[pyo3(get)]
    pub(super) name: String,
    /// Path of the capturing frame, ``SYSTEM/FRAME``.
    #[pyo3(get)]
    frame_a: String,
    /// Path of the captured frame, ``SYSTEM/FRAME``.
    #[pyo3(get)]
    frame_b: String,
    condition: Condition,
    seat: Option<Seat>,
    /// Final pose of the seating motion as given in Python.
    pose: Option<Py<PyAny>>,
}

#[pymethods]
impl PyCapture {
    #[new]
    #[pyo3(signature = (
        name, frame_a, frame_b, *, at=None, after=None, delay=0.0, on_command=false, within=None, slower_than=None,
        held_for=0.0, touching=None, seat=None, pose=None,
    ))]
    fn new(
        py: Python<'_>,
        name: &Bound<'_, PyAny>,
        frame_a: &Bound<'_, PyAny>,
        frame_b: &Bound<'_, PyAny>,
        at: Option<f64>,
        after: Option<&Bound<'_, PyAny>>,
        delay: f64,
        on_command: bool,
        within: Option<&Bound<'_, PyAny>>,
        slower_than: Option<&Bound<'_, PyAny>>,
        held_for: f64,
        touching: Option<&Bound<'_, PyAny>>,
        seat: Option<f64>,
        pose: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let name = event_name(name, "name")?;
        let (frame_a, frame_b) = (frame_path(frame_a, "frame_a")?, frame_path(frame_b, "frame_b")?);
        let after = after.map(|after| event_name(after, "after")).transpose()?;
        let within = within.map(|within| fixed(within, "within", &[2])).transpose()?;
        let slower = slower_than.map(|slower| fixed(slower, "slower_than", &[2])).transpose()?;
        let touching =
            touching.map(|names| names_in(names, "touching", "names of contacts", "grip")).transpose()?;
        if within.is_none() && (slower.is_some() || held_for != 0.0 || touching.is_some()) {
            let message = format!(
                "the event '{name}' has slower_than, held_for or touching without within; add within, or omit \
                 them"
            );
            return Err(raise(py, "WorldError", &message, &fields!(py, "name": name)));
        }
        let slower_than = slower.unwrap_or([f64::INFINITY; 2]);
        let touching = touching.unwrap_or_default();
        let latch = within.map(|within| Envelope { within, slower_than, held_for, touching });
        if seat.is_none() && pose.is_some() {
            let message = format!(
                "the event '{name}' has a pose without seat; add seat, the duration of the motion in s"
            );
            return Err(raise(py, "WorldError", &message, &fields!(py, "name": name)));
        }
        let nominal = pose.map(isometry).transpose()?.unwrap_or_default();
        let seat = seat.map(|duration| Seat { duration, pose: nominal.into() });
        let pose = deep_copy(pose)?.map(Bound::unbind);
        let condition = Condition::new(py, &name, (at, after, delay, on_command), latch)?;
        Ok(Self { name, frame_a, frame_b, condition, seat, pose })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(py);
        self.condition.write_to(&keywords)?;
        keywords.set_item("seat", self.seat.map(|seat| seat.duration))?;
        keywords.set_item("pose", &self.pose)?;
        ConstructorCall::new("Capture", (&self.name, &self.frame_a, &self.frame_b), &keywords)?.reduce(py)
    }

    fn __repr__(&self) -> String {
        format!("<Capture '{}': {} captures {}>", self.name, self.frame_a, self.frame_b)
    }
}

/// Event that removes the connection that a capture established.
///
/// Exactly one of ``at``, ``after`` and ``on_command`` specifies when the release happens. If the frames are
/// not connected, the release has no effect.
///
/// Parameters
/// ----------
/// name : str
///     Name of the event.
/// capture : str
///     Name of the capture.
/// at : float, optional
///     Simulation time of the release, s.
/// after : str, optional
///     Name of another event, after which the release happens.
/// delay : float
///     Time from the other event to the release, s; only with ``after``.
/// on_command : bool
///     If True, the release happens when ``Stepper.trigger`` is called.
/// impulse : (6,) array, optional
///     Impulse of a spring on the captured system: linear, N s, then angular, N m s, in the axes of the
///     capturing frame at its origin. The opposite impulse acts on the other system. Default: zero.
///
/// Raises
/// ------
/// WorldError
///     If not exactly one condition is given, or ``delay`` is given without ``after``.
/// InputError, ShapeError, DtypeError
///     If ``impulse`` is not finite or has the wrong shape, or a name is not text.
#[pyclass(name = "Release", frozen, module = "onorbit_rs")]
pub(crate) struct PyRelease {
    /// Name of the event.
    #[pyo3(get)]
    pub(super) name: String,
    /// Name of the capture.
    #[pyo3(get)]
    capture: String,
    condition: Condition,
    impulse: [f64; 6],
}

#[pymethods]
impl PyRelease {
    #[new]
    #[pyo3(signature = (name, capture, *, at=None, after=None, delay=0.0, on_command=false, impulse=None))]
    fn new(
        py: Python<'_>,
        name: &Bound<'_, PyAny>,
        capture: &Bound<'_, PyAny>,
        at: Option<f64>,
        after: Option<&Bound<'_, PyAny>>,
        delay: f64,
        on_command: bool,
        impulse: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (name, capture) = (event_name(name, "name")?, event_name(capture, "capture")?);
        let after = after.map(|after| event_name(after, "after")).transpose()?;
        let impulse = impulse.map_or(Ok([0.0; 6]), |impulse| fixed(impulse, "impulse", &[6]))?;
        let condition = Condition::new(py, &name, (at, after, delay, on_command), None)?;
        Ok(Self { name, capture, condition, impulse })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(py);
        self.condition.write_to(&keywords)?;
        keywords.set_item("impulse", self.impulse)?;
        ConstructorCall::new("Release", (&self.name, &self.capture), &keywords)?.reduce(py)
    }

    fn __repr__(&self) -> String {
        format!("<Release '{}' of '{}'>", self.name, self.capture)
    }
}

/// Reads the argument `argument`, the name of an event.
pub(crate) fn event_name(value: &Bound<'_, PyAny>, argument: &str) -> PyResult<String> {
    text(value, argument, "the name of an event (str), such as 'grasp'")
}

fn frame_path(value: &Bound<'_, PyAny>, argument: &str) -> PyResult<String> {
    text(value, argument, "a frame as SYSTEM/FRAME (str), such as 'chaser/tool'")
}

/// Reads a list of events.
pub(super) fn events_in(value: &Bound<'_, PyAny>) -> PyResult<Vec<Py<PyAny>>> {
    const WHAT: &str = "events, such as [oo.Capture(…)]";
    let events = list_of::<PyAny>(value, "events", WHAT)?;
    let is_event = |event: &&Bound<'_, PyAny>| {
        let is_of_brake = event.is_instance_of::<PyEngage>() || event.is_instance_of::<PyDisengage>();
        is_of_brake || event.is_instance_of::<PyCapture>() || event.is_instance_of::<PyRelease>()
    };
    match events.iter().find(|event| !is_event(event)) {
        Some(other) => Err(wrong_entry(other, "events", WHAT)),
        None => Ok(events.into_iter().map(Bound::unbind).collect()),
    }
}

/// Returns the names of the given events.
pub(super) fn names_of(py: Python<'_>, events: &[Py<PyAny>]) -> PyResult<Vec<String>> {
    events.iter().map(|event| event.bind(py).getattr("name")?.extract()).collect()
}

/// Reads the events of a world; `names` are the names of the events, `systems` the names and models of the
/// systems, and `brakes` the names of the systems and of their brakes.
pub(super) fn events_of(
    py: Python<'_>,
    events: &[Py<PyAny>],
    names: &[String],
    systems: &[(String, Arc<Model>)],
    brakes: &[(String, Vec<String>)],
) -> PyResult<Vec<Event>> {
    let read = |event: &Py<PyAny>| {
        let event = event.bind(py);
        if let Ok(event) = event.cast::<PyCapture>() {
            let PyCapture { name, frame_a, frame_b, condition, seat, .. } = event.get();
            let (by, of) = (frame_at(py, name, frame_a, systems)?, frame_at(py, name, frame_b, systems)?);
            let (when, action) = (condition.when(py, name, names)?, Action::Capture { by, of, seat: *seat });
            return Ok(Event { name: name.clone(), when, action });
        }
        if let Ok(event) = event.cast::<PyEngage>() {
            let PyEngage { name, brake, condition } = event.get();
            let action = Action::Engage(brake_at(py, name, brake, brakes)?);
            return Ok(Event { name: name.clone(), when: condition.when(py, name, names)?, action });
        }
        if let Ok(event) = event.cast::<PyDisengage>() {
            let PyDisengage { name, brake, condition } = event.get();
            let action = Action::Disengage(brake_at(py, name, brake, brakes)?);
            return Ok(Event { name: name.clone(), when: condition.when(py, name, names)?, action });
        }
        let PyRelease { name, capture, condition, impulse } = event.cast::<PyRelease>()?.get();
        let (when, capture) = (condition.when(py, name, names)?, event_named(py, name, capture, names)?);
        let action = Action::Release { capture, impulse: *impulse };
        Ok(Event { name: name.clone(), when, action })
    };
    events.iter().map(read).collect()
}
