//! Changes of link properties, as given from Python.

use crate::arrays::{fixed, type_name};
use crate::builder::vector;
use crate::errors::{fields, raise};
use nalgebra::Matrix3;
use onorbit_core::model::LinkChange;
use pyo3::prelude::*;
use pyo3::types::PyDict;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Converts the arguments of ``with_link``: ``com`` (3,), m; ``inertia`` (3, 3), kg m².
pub(crate) fn link_change(
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

/// Converts ``{link: {"mass": ..., "com": ..., "inertia": ...}}``.
pub(crate) fn link_changes(links: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<LinkChange>> {
    let Some(links) = links else { return Ok(Vec::new()) };
    links.iter().map(|(name, values)| change_from_dict(&name.extract::<String>()?, &values)).collect()
}

fn change_from_dict(link: &str, values: &Bound<'_, PyAny>) -> PyResult<LinkChange> {
    let py = values.py();
    let refuse = |message: &str| Err(raise(py, "ModelError", message, &fields!(py, "link": link)));
    let Ok(values) = values.cast::<PyDict>() else {
        let got = type_name(values);
        return refuse(&format!(
            "links[{link:?}] is of type {got}, a dict with mass, com or inertia is needed"
        ));
    };
    for key in values.keys() {
        if !["mass", "com", "inertia"].iter().any(|known| key.eq(known).unwrap_or(false)) {
            return refuse(&format!("links[{link:?}] has a key {key}: there are mass, com and inertia"));
        }
    }
    let value = |key| Ok::<_, PyErr>(values.get_item(key)?.filter(|value| !value.is_none()));
    let mass = value("mass")?;
    let Ok(mass) = mass.map(|mass| mass.extract::<f64>()).transpose() else {
        return refuse(&format!("the mass in links[{link:?}] is no number; a mass in kg is needed"));
    };
    link_change(link, mass, value("com")?.as_ref(), value("inertia")?.as_ref())
}
