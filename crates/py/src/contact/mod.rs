//! Contacts between links, and their laws.

mod declared;
mod laws;
mod recorded;

pub(crate) use declared::{PyContact, contacts_in, contacts_of};
pub(crate) use recorded::PyContactTrace;

use pyo3::prelude::*;

/// Adds the classes of contacts to the module.
pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<laws::PyHuntCrossley>()?;
    m.add_class::<laws::PyImpactLaw>()?;
    m.add_class::<laws::PySpringDashpot>()?;
    m.add_class::<laws::PyFriction>()?;
    m.add_class::<PyContact>()?;
    m.add_class::<PyContactTrace>()
}
