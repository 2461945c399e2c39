//! Properties of `Model`, and its neutral configuration.

use super::description::{self, PyBody, PyFrame, PyJoint, PyVisual};
use super::{Array, PyModel};
use crate::arrays::array_of;
use onorbit_core::model::{Constraint, neutral};
use onorbit_core::number_text::count;
use pyo3::prelude::*;

#[pymethods]
impl PyModel {
    /// Name of the robot.
    #[getter]
    fn name(&self) -> &str {
        self.model.name()
    }

    /// Length of a configuration: ``7 + n`` for ``n`` moving joints.
    #[getter]
    fn nq(&self) -> usize {
        self.model.nq()
    }

    /// Length of a velocity: ``6 + n`` for ``n`` moving joints.
    #[getter]
    fn nv(&self) -> usize {
        self.model.nv()
    }

    /// Total mass of the robot, kg.
    #[getter]
    fn mass(&self) -> f64 {
        self.model.mass()
    }

    /// Names of the moving joints, in the order of ``v``.
    #[getter]
    fn joint_names(&self) -> Vec<&str> {
        self.model.joint_names().collect()
    }

    /// Names of the bodies, base first. The name of a body is that of its first link.
    #[getter]
    fn body_names(&self) -> Vec<&str> {
        self.model.body_names().collect()
    }

    /// Names of the frames: all links, followed by the frames that were added.
    #[getter]
    fn frame_names(&self) -> Vec<&str> {
        self.model.frame_names().collect()
    }

    /// Moving joints, in the order of ``v``.
    #[getter]
    fn joints(&self) -> Vec<PyJoint> {
        description::joints(&self.model)
    }

    /// Bodies with masses, centres of mass and inertias, base first.
    #[getter]
    fn bodies(&self) -> Vec<PyBody> {
        description::bodies(&self.model)
    }

    /// Frames: all links, followed by the frames that were added.
    #[getter]
    fn frames(&self) -> Vec<PyFrame> {
        description::frames(&self.model)
    }

    /// Warnings about the description of the robot, one line each.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.model.warnings().iter().map(ToString::to_string).collect()
    }

    /// Visual shapes of all links.
    #[getter]
    fn visuals(&self) -> Vec<PyVisual> {
        description::shapes(&self.model, self.model.visuals())
    }

    /// Collision shapes of all links, except meshes whose file does not exist. :func:`distance` uses these
    /// shapes, and they are drawn instead of visual meshes that cannot be drawn.
    #[getter]
    fn collisions(&self) -> Vec<PyVisual> {
        description::shapes(&self.model, self.model.collisions())
    }

    /// Return the configuration with the base at the origin of W, unrotated, and all joint positions equal to
    /// zero.
    ///
    /// Returns
    /// -------
    /// (nq,) array
    ///     Configuration, m and rad.
    fn neutral<'py>(&self, py: Python<'py>) -> Array<'py> {
        array_of(py, &[self.model.nq()], &neutral(&self.model))
    }

    fn __repr__(&self) -> String {
        let m = &self.model;
        let mimics =
            m.closures().iter().filter(|closure| matches!(closure.constraint, Constraint::Mimic { .. }));
        let constraints: String = [("loop", m.description().loops().len()), ("mimic joint", mimics.count())]
            .into_iter()
            .filter(|(_, number)| *number > 0)
            .map(|(what, number)| format!("{}, ", count(number, what)))
            .collect();
        format!(
            "<Model '{}': {}, {}, {constraints}{:.6} kg>",
            m.name(),
            count(m.nodes().len(), "body"),
            count(m.joint_count(), "joint"),
            m.mass()
        )
    }
}
