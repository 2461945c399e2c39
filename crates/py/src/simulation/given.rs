//! Effects, contacts, controllers and engine of a simulation, as they were given in Python.

use crate::contact::PyContact;
use crate::environment::PyEffect;
use crate::world::PyWorld;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

/// Objects from which a simulation was created.
#[derive(Default)]
pub(super) struct Given {
    pub(super) environment: Vec<Py<PyEffect>>,
    pub(super) contacts: Vec<Py<PyContact>>,
    /// Controllers of each system, in the order of the systems.
    pub(super) controllers: Vec<Vec<Py<PyAny>>>,
    pub(super) engine: Option<Py<PyAny>>,
}

impl Given {
    /// Returns the objects of a world.
    pub(super) fn of_world(py: Python<'_>, world: &PyWorld) -> Self {
        let controllers = world.controllers().map(|one| listed(py, one)).collect();
        Self {
            environment: copies(py, &world.environment),
            contacts: copies(py, &world.contacts),
            controllers,
            engine: None,
        }
    }

    /// Returns the objects of a simulation of one robot.
    pub(super) fn of_robot(
        py: Python<'_>,
        environment: &[Bound<'_, PyEffect>],
        controller: Option<&Py<PyAny>>,
    ) -> Self {
        let environment = environment.iter().map(|effect| effect.clone().unbind()).collect();
        Self { environment, controllers: vec![listed(py, controller)], ..Self::default() }
    }
}

/// Returns new references to objects.
pub(super) fn copies<T>(py: Python<'_>, objects: &[Py<T>]) -> Vec<Py<T>> {
    objects.iter().map(|one| one.clone_ref(py)).collect()
}

/// Returns the elements of a list or tuple of controllers, or a list of the only controller.
fn listed(py: Python<'_>, controller: Option<&Py<PyAny>>) -> Vec<Py<PyAny>> {
    let Some(controller) = controller.map(|one| one.bind(py)) else { return Vec::new() };
    if let Ok(list) = controller.cast::<PyList>() {
        list.iter().map(Bound::unbind).collect()
    } else if let Ok(tuple) = controller.cast::<PyTuple>() {
        tuple.iter().map(Bound::unbind).collect()
    } else {
        vec![controller.clone().unbind()]
    }
}
