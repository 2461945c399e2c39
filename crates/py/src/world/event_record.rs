//! Records of events that have happened.

use crate::arrays::{Input, array_of, wrong_shape};
use crate::errors::{fields, raise};
use crate::pickling::{ConstructorCall, Reduced};
use numpy::PyArrayDyn;
use onorbit_core::number_text::short;
use onorbit_core::simulation::{EventKind, EventRecord};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Record of an event that happened, with a check of momentum and energy. ``trace.events`` of a world
/// contains these records.
///
/// Parameters
/// ----------
/// name : str
///     Name of the event or of the contact.
/// kind : {"capture", "release", "touch_down", "lift_off", "engage", "disengage"}
///     Kind of the event. A contact touches down when the first pieces of its links touch, and lifts off when
///     the last ones separate.
/// time : float
///     Simulation time, s.
/// systems : (str, str)
///     Names of the two systems, beginning with the capturing system. For a contact, the systems of the links
///     that touched first, in the order of its sides; for a brake, twice the name of its system.
/// impulse : (6,) array
///     Impulse on the second system and the systems connected to it: linear, N s, then angular about
///     ``point``, N m s, axes of W. For a lift-off, the impulse of the contact since its touch-down; for a
///     touch-down, zero. For a brake, the impulse with which it stops the link that the joint moves.
/// point : (3,) array
///     Point at which the impulse acts, in W, m: for a contact, the point of contact; for a brake, the origin
///     of the link that the joint moves.
/// energy_lost : float
///     Kinetic energy lost, J; negative if a spring added energy. For a lift-off, the energy dissipated since
///     the touch-down.
/// momentum_error : (2,) array
///     Changes of the linear and of the angular momentum of the systems that may interact, relative to the
///     sums of the magnitudes of the momenta of their bodies. Zero for a contact, whose forces on both sides
///     act at one point.
/// peak_force : float, optional
///     Largest normal force since the touch-down, N; None unless the event is the lift-off of a contact with a
///     compliant normal force. It is the largest force at the end of a step, or the maximum of the parabola
///     through three such forces.
///
/// Raises
/// ------
/// InputError, ShapeError
///     If ``kind`` is unknown, or an array has the wrong shape.
#[pyclass(name = "EventRecord", frozen, module = "onorbit_rs")]
#[derive(PartialEq)]
pub(crate) struct PyEventRecord {
    /// Name of the event, or of the contact.
    #[pyo3(get)]
    name: String,
    kind: EventKind,
    /// Simulation time, s.
    #[pyo3(get)]
    time: f64,
    /// Names of the two systems, beginning with the capturing system; for a contact, in the order of its
    /// sides; for a brake, twice the name of its system.
    #[pyo3(get)]
    systems: (String, String),
    impulse: [f64; 6],
    point: [f64; 3],
    /// Kinetic energy lost, J; negative if a spring added energy. For a lift-off, the energy dissipated since
    /// the touch-down.
    #[pyo3(get)]
    energy_lost: f64,
    momentum_error: [f64; 2],
    /// Largest normal force since the touch-down, N; None unless the event is the lift-off of a contact with a
    /// compliant normal force.
    #[pyo3(get)]
    peak_force: Option<f64>,
}

impl PyEventRecord {
    /// Creates the record of an event; `names` are the names of all systems.
    pub(crate) fn of(record: &EventRecord, names: &[String]) -> Self {
        let EventRecord { name, kind, time, systems, impulse, point, energy_lost, .. } = record;
        let [by, of] = systems.map(|system| names[system].clone());
        Self {
            name: name.clone(),
            kind: *kind,
            time: *time,
            systems: (by, of),
            impulse: *impulse,
            point: *point,
            energy_lost: *energy_lost,
            momentum_error: record.momentum_error,
            peak_force: record.peak_force,
        }
    }
}

#[pymethods]
impl PyEventRecord {
    #[new]
    #[pyo3(signature = (name, kind, time, systems, *, impulse, point, energy_lost, momentum_error, peak_force=None))]
    fn new(
        py: Python<'_>,
        name: String,
        kind: &str,
        time: f64,
        systems: (String, String),
        impulse: &Bound<'_, PyAny>,
        point: &Bound<'_, PyAny>,
        energy_lost: f64,
        momentum_error: &Bound<'_, PyAny>,
        peak_force: Option<f64>,
    ) -> PyResult<Self> {
        let Some(kind) = EventKind::ALL.into_iter().find(|known| known.name() == kind) else {
            let known = EventKind::ALL.map(|kind| format!("'{}'", kind.name())).join(", ");
            let message = format!("kind is '{kind}'; it must be one of {known}");
            return Err(raise(py, "InputError", &message, &fields!(py, "name": "kind", "got": kind)));
        };
        let (impulse, point) = (entries(impulse, "impulse")?, entries(point, "point")?);
        let momentum_error = entries(momentum_error, "momentum_error")?;
        Ok(Self { name, kind, time, systems, impulse, point, energy_lost, momentum_error, peak_force })
    }

    /// Kind of the event: ``capture``, ``release``, ``touch_down``, ``lift_off``, ``engage`` or
    /// ``disengage``.
    #[getter]
    fn kind(&self) -> &'static str {
        self.kind.name()
    }

    /// Impulse on the second system and the systems connected to it, (6,): linear, N s, then angular about
    /// ``point``, N m s, axes of W. For a lift-off, the impulse of the contact since its touch-down; for a
    /// brake, the impulse with which it stops the link that the joint moves.
    #[getter]
    fn impulse<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        array_of(py, &[6], &self.impulse)
    }

    /// Point at which the impulse acts, in W, (3,), m.
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        array_of(py, &[3], &self.point)
    }

    /// Changes of the linear and of the angular momentum of the systems that may interact, (2,), relative to
    /// the sums of the magnitudes of the momenta of their bodies.
    #[getter]
    fn momentum_error<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        array_of(py, &[2], &self.momentum_error)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self == other
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        (&self.name, self.kind.name(), &self.systems).hash(&mut hasher);
        hasher.finish()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(py);
        keywords.set_item("impulse", self.impulse)?;
        keywords.set_item("point", self.point)?;
        keywords.set_item("energy_lost", self.energy_lost)?;
        keywords.set_item("momentum_error", self.momentum_error)?;
        keywords.set_item("peak_force", self.peak_force)?;
        let arguments = (&self.name, self.kind.name(), self.time, &self.systems);
        ConstructorCall::new("EventRecord", arguments, &keywords)?.reduce(py)
    }

    fn __repr__(&self) -> String {
        let (Self { name, energy_lost, .. }, (by, of)) = (self, &self.systems);
        let (kind, lost, time) = (self.kind.name(), short(*energy_lost), short(self.time));
        match self.kind {
            EventKind::TouchDown => format!("<{kind} '{name}' of {by} and {of} at t = {time} s>"),
            EventKind::LiftOff => {
                format!("<{kind} '{name}' of {by} and {of} at t = {time} s: {lost} J lost>")
            }
            EventKind::Engage | EventKind::Disengage => {
                format!("<{kind} '{name}' of {of} at t = {time} s: {lost} J lost>")
            }
            _ => format!("<{kind} '{name}' of {of} by {by} at t = {time} s: {lost} J lost>"),
        }
    }
}

/// Reads a vector of `N` numbers, which need not be finite, because the run may have diverged.
fn entries<const N: usize>(value: &Bound<'_, PyAny>, name: &str) -> PyResult<[f64; N]> {
    let input = Input::new(value, name)?;
    match <[f64; N]>::try_from(input.data()) {
        Ok(entries) if input.shape().len() == 1 => Ok(entries),
        _ => Err(wrong_shape(value.py(), name, &format!("({N},)"), input.shape())),
    }
}
