//! The class `Contact`, which declares a contact between links.

use super::laws::{Law, PyFriction, normal_law};
use crate::arrays::{list_of, names_in, text};
use crate::errors::{IntoPython, fields, raise};
use crate::pickling::{ConstructorCall, Reduced};
use onorbit_core::contact::{Contact, ContactLaw, ContactSide, ImpactLaw, links_matching};
use onorbit_core::model::Model;
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use std::ffi::CString;
use std::sync::Arc;

/// Contact between the collision shapes of two sets of links.
///
/// Links are given as ``SYSTEM/LINK``, in which ``*`` stands for any text: ``"chaser/gripper*"``. The force
/// acts on the links of the second set, and the opposite force on those of the first.
///
/// Parameters
/// ----------
/// links_a, links_b : str or list of str
///     Links of the first and of the second side, or patterns that match them.
/// normal : HuntCrossley, SpringDashpot or ImpactLaw, optional
///     Law of the normal force, or of rigid impacts. Without it, only the distance is recorded and no force
///     acts.
/// friction : Friction, optional
///     Law of friction; default: no friction. It requires a compliant normal force: an ``ImpactLaw`` has its
///     own coefficient of friction.
/// name : str, optional
///     Name of the contact; default: the links of both sides, such as ``"chaser/gripper|target/handle"``.
/// start_overlapping : bool
///     If True, the links may overlap at the start of a run. It cannot be combined with an ``ImpactLaw``.
///
/// Raises
/// ------
/// WorldError, DtypeError
///     If a side has no links, if the name is empty or contains control characters, if there is friction
///     without a normal force, if an ``ImpactLaw`` is combined with ``friction`` or ``start_overlapping``, or
///     if an argument has the wrong type.
#[pyclass(name = "Contact", frozen, module = "onorbit_rs")]
pub(crate) struct PyContact {
    /// Name of the contact.
    #[pyo3(get)]
    pub(crate) name: String,
    /// Links or patterns of the first side.
    #[pyo3(get)]
    links_a: Vec<String>,
    /// Links or patterns of the second side.
    #[pyo3(get)]
    links_b: Vec<String>,
    /// Law of the normal force or of rigid impacts; None if only the distance is recorded.
    #[pyo3(get)]
    normal: Option<Py<PyAny>>,
    /// Law of friction; None without friction.
    #[pyo3(get)]
    friction: Option<Py<PyFriction>>,
    /// True if the links may overlap at the start of a run.
    #[pyo3(get)]
    start_overlapping: bool,
}

#[pymethods]
impl PyContact {
    #[new]
    #[pyo3(signature = (links_a, links_b, *, normal=None, friction=None, name=None, start_overlapping=false))]
    fn new(
        py: Python<'_>,
        links_a: &Bound<'_, PyAny>,
        links_b: &Bound<'_, PyAny>,
        normal: Option<&Bound<'_, PyAny>>,
        friction: Option<Py<PyFriction>>,
        name: Option<&Bound<'_, PyAny>>,
        start_overlapping: bool,
    ) -> PyResult<Self> {
        let (links_a, links_b) = (links(links_a, "links_a")?, links(links_b, "links_b")?);
        let default = || format!("{}|{}", links_a.join(","), links_b.join(","));
        let name = name.map(|name| text(name, "name", "the name of a contact (str), such as 'touch'"));
        let name = name.transpose()?.unwrap_or_else(default);
        if name.is_empty() || name.contains(char::is_control) {
            let message = format!(
                "the name of a contact is {name:?}; it must not be empty and must not contain line breaks or other \
                 control characters"
            );
            return Err(raise(py, "WorldError", &message, &fields!(py, "name": name)));
        }
        let law = normal.map(normal_law).transpose()?;
        if let (Some(Law::Impact(_)), true) = (&law, friction.is_some() || start_overlapping) {
            let (excluded, remedy) = match friction {
                Some(_) => (
                    "friction",
                    "omit friction and give its coefficient in the law, such as oo.ImpactLaw(0.5, 0.3)",
                ),
                None => ("start_overlapping", "rigid bodies cannot overlap; omit start_overlapping"),
            };
            let message = format!("the contact '{name}' has an ImpactLaw together with {excluded}; {remedy}");
            return Err(raise(py, "WorldError", &message, &fields!(py, "name": excluded)));
        }
        if normal.is_none() && friction.is_some() {
            let message = format!(
                "the contact '{name}' has friction but no normal force; add normal, such as oo.HuntCrossley(1e5)"
            );
            return Err(raise(py, "WorldError", &message, &fields!(py, "name": name)));
        }
        let normal = normal.map(|normal| normal.clone().unbind());
        Ok(Self { name, links_a, links_b, normal, friction, start_overlapping })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(py);
        keywords.set_item("normal", &self.normal)?;
        keywords.set_item("friction", &self.friction)?;
        keywords.set_item("name", &self.name)?;
        keywords.set_item("start_overlapping", self.start_overlapping)?;
        ConstructorCall::new("Contact", (&self.links_a, &self.links_b), &keywords)?.reduce(py)
    }

    fn __repr__(&self) -> String {
        format!("<Contact '{}': {} with {}>", self.name, self.links_a.join(", "), self.links_b.join(", "))
    }
}

impl PyContact {
    /// Returns the law of the compliant forces and the law of impacts, of which at most one is not `None`.
    fn laws(&self, py: Python<'_>) -> PyResult<(Option<ContactLaw>, Option<ImpactLaw>)> {
        let Some(normal) = &self.normal else { return Ok((None, None)) };
        match normal_law(normal.bind(py))? {
            Law::Compliant(normal) => {
                let friction = self.friction.as_ref();
                let friction = friction.map(|friction| friction.get().law(normal.tangential_stiffness()));
                Ok((Some(ContactLaw { normal, friction }), None))
            }
            Law::Impact(law) => Ok((None, Some(law))),
        }
    }

    fn side(
        &self,
        py: Python<'_>,
        patterns: &[String],
        systems: &[(String, Arc<Model>)],
    ) -> PyResult<Vec<ContactSide>> {
        let mut sides: Vec<ContactSide> = Vec::new();
        for pattern in patterns {
            let found =
                links_matching(&self.name, pattern, systems).map_err(|error| error.into_python(py))?;
            // a link that several patterns match is taken once
            let known: Vec<_> = sides.iter().map(|side| side.frame).collect();
            sides.extend(found.sides.into_iter().filter(|side| !known.contains(&side.frame)));
            for warning in found.warnings {
                PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(warning)?, 1)?;
            }
        }
        Ok(sides)
    }
}

/// Reads one link, or a list of at least one link.
fn links(value: &Bound<'_, PyAny>, argument: &str) -> PyResult<Vec<String>> {
    if value.is_instance_of::<PyString>() {
        return Ok(vec![value.extract()?]);
    }
    let links = names_in(value, argument, "links as SYSTEM/LINK", "chaser/gripper")?;
    if links.is_empty() {
        let (py, message) = (value.py(), format!("{argument} is empty; give at least one link"));
        return Err(raise(py, "WorldError", &message, &fields!(py, "name": argument)));
    }
    Ok(links)
}

/// Reads a list of contacts.
pub(crate) fn contacts_in(value: &Bound<'_, PyAny>) -> PyResult<Vec<Py<PyContact>>> {
    let contacts = list_of::<PyContact>(value, "contacts", "contacts, such as [oo.Contact(…)]")?;
    Ok(contacts.into_iter().map(Bound::unbind).collect())
}

/// Returns the contacts of the core for a world whose systems have these names and models.
pub(crate) fn contacts_of(
    py: Python<'_>,
    contacts: &[Py<PyContact>],
    systems: &[(String, Arc<Model>)],
) -> PyResult<Vec<Contact>> {
    let read = |contact: &Py<PyContact>| {
        let contact = contact.get();
        let (law, impact) = contact.laws(py)?;
        Ok(Contact {
            name: contact.name.clone(),
            sides: [
                contact.side(py, &contact.links_a, systems)?,
                contact.side(py, &contact.links_b, systems)?,
            ],
            law,
            impact,
            may_start_overlapping: contact.start_overlapping,
        })
    };
    contacts.iter().map(read).collect()
}
