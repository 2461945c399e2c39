//! Changes to the inertial properties of links, read from Python arguments.

use super::merged_call::merged_call;
use super::{Any, PyModel};
use crate::arrays::{fixed, type_name, vector};
use crate::errors::{IntoPython, fields, raise};
use crate::pickling::deep_copy;
use nalgebra::Matrix3;
use onorbit_core::model::LinkChange;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Returns a copy of the robot with the inertial properties of one link replaced.
pub(super) fn with_link(
    model: &Bound<'_, PyModel>,
    name: &str,
    mass: Option<f64>,
    com: Option<Any<'_, '_>>,
    inertia: Option<Any<'_, '_>>,
) -> PyResult<PyModel> {
    let py = model.py();
    let change = link_change(name, mass, com, inertia)?;
    let old = &model.get().model;
    let new = old.with_link(&change).map_err(|error| error.into_python(py))?;
    let keywords = fields!(py, "mass": mass, "com": deep_copy(com)?, "inertia": deep_copy(inertia)?);
    let call = merged_call(model, "Model.with_link", name, keywords)?;
    PyModel::wrap(py, new, Some(call), old.warnings())
}

/// Converts the arguments of `with_link`: `mass`, kg; `com` (3,), m; `inertia` (3, 3), kg m².
fn link_change(
    link: &str,
    mass: Option<f64>,
    com: Option<Any<'_, '_>>,
    inertia: Option<Any<'_, '_>>,
) -> PyResult<LinkChange> {
    let com = com.map(|com| vector(Some(com), "com", [0.0; 3])).transpose()?;
    let inertia = inertia.map(|inertia| fixed::<9>(inertia, "inertia", &[3, 3])).transpose()?;
    let inertia = inertia.map(|rows| Matrix3::from_row_slice(&rows));
    Ok(LinkChange { link: link.to_owned(), mass, com, inertia })
}

/// Converts a dict `{link: {"mass": ..., "com": ..., "inertia": ...}}` (kg, m and kg m²); `None` means no
/// changes.
pub(super) fn link_changes(links: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<LinkChange>> {
    let Some(links) = links else { return Ok(Vec::new()) };
    links.iter().map(|(name, values)| change_from_dict(&name.extract::<String>()?, &values)).collect()
}

/// Converts the dict of values for one link. An unknown key, or a value of the wrong type, is an error.
fn change_from_dict(link: &str, values: &Bound<'_, PyAny>) -> PyResult<LinkChange> {
    let py = values.py();
    let refuse = |message: &str| Err(raise(py, "ModelError", message, &fields!(py, "link": link)));
    let Ok(values) = values.cast::<PyDict>() else {
        let got = type_name(values);
        return refuse(&format!(
            "links[{link:?}] is of type {got}; expected a dict with mass, com or inertia"
        ));
    };
    for key in values.keys() {
        if !["mass", "com", "inertia"].iter().any(|known| key.eq(known).unwrap_or(false)) {
            return refuse(&format!(
                "links[{link:?}] has the unknown key {}; the keys are mass, com and inertia",
                key.repr()?
            ));
        }
    }
    let value = |key| Ok::<_, PyErr>(values.get_item(key)?.filter(|value| !value.is_none()));
    let mass = value("mass")?;
    let Ok(mass) = mass.as_ref().map(|mass| mass.extract::<f64>()).transpose() else {
        let got = mass.as_ref().map_or_else(String::new, type_name);
        return refuse(&format!(
            "the mass in links[{link:?}] is not a number but of type {got}; expected a mass in kg"
        ));
    };
    link_change(link, mass, value("com")?.as_ref(), value("inertia")?.as_ref())
}
