//! Building a robot link by link.

use crate::arrays::fixed;
use crate::errors::{IntoPython, fields, raise};
use crate::model::PyModel;
use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};
use onorbit_core::model::{Inertial, Joint, JointKind, Limits, Link, ModelBuilder};
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Collects links and joints, then builds the tree; the first link floats.
///
/// A link without ``mass`` is massless. ``com`` (3,) m and ``inertia`` (3, 3) kg m² about it are in link
/// axes; ``xyz`` (3,) m and ``rpy`` (3,) rad place a frame in its parent's, as in URDF.
#[pyclass(name = "ModelBuilder", module = "onorbit_rs")]
pub(crate) struct PyModelBuilder {
    builder: ModelBuilder,
}

#[pymethods]
impl PyModelBuilder {
    #[new]
    #[pyo3(signature = (name, *, base, mass=None, com=None, inertia=None))]
    fn new(
        py: Python<'_>,
        name: &str,
        base: &str,
        mass: Option<f64>,
        com: Option<Any<'_, '_>>,
        inertia: Option<Any<'_, '_>>,
    ) -> PyResult<Self> {
        let link = Link::new(base, inertial(py, mass, com, inertia)?);
        let builder = ModelBuilder::new(name, link).map_err(|error| error.into_python(py))?;
        Ok(Self { builder })
    }

    /// Hang a new link on ``parent`` by a joint.
    ///
    /// ``kind``: ``revolute``, ``continuous``, ``prismatic`` or ``fixed``; ``axis`` (3,) in the link's frame;
    /// ``damping`` N m s/rad, ``friction`` N m, ``rotor_inertia`` kg m² seen at the joint; limits in rad, rad/s, N m
    /// (m, m/s, N for a slider) are stored, not enforced. ``friction`` acts on a joint that moves; at rest it is held
    /// by up to ``static_friction``, at least as much and the same where it is None.
    #[pyo3(signature = (
        name, *, parent, joint, kind="revolute", axis=None, xyz=None, rpy=None, mass=None, com=None, inertia=None,
        damping=0.0, friction=0.0, rotor_inertia=0.0, lower=None, upper=None, velocity=None, effort=None,
        static_friction=None,
    ))]
    fn add_link(
        &mut self,
        py: Python<'_>,
        name: &str,
        parent: &str,
        joint: &str,
        kind: &str,
        axis: Option<Any<'_, '_>>,
        xyz: Option<Any<'_, '_>>,
        rpy: Option<Any<'_, '_>>,
        mass: Option<f64>,
        com: Option<Any<'_, '_>>,
        inertia: Option<Any<'_, '_>>,
        damping: f64,
        friction: f64,
        rotor_inertia: f64,
        lower: Option<f64>,
        upper: Option<f64>,
        velocity: Option<f64>,
        effort: Option<f64>,
        static_friction: Option<f64>,
    ) -> PyResult<()> {
        let axis = vector(axis, "axis", [0.0, 0.0, 1.0])?;
        let kind = match kind {
            "revolute" | "continuous" => JointKind::Revolute(axis),
            "prismatic" => JointKind::Prismatic(axis),
            "fixed" => JointKind::Fixed,
            other => {
                let message = format!(
                    "joint '{joint}' is of kind '{other}'; there are revolute, continuous, prismatic and fixed"
                );
                return Err(raise(py, "ModelError", &message, &fields!(py, "joint": joint)));
            }
        };
        let position = match (lower, upper) {
            (None, None) => None,
            _ => Some((lower.unwrap_or(f64::NEG_INFINITY), upper.unwrap_or(f64::INFINITY))),
        };
        let limits = Limits { position, velocity, effort };
        let plain = Joint::new(joint, kind, pose(xyz, rpy)?);
        let joint = Joint { limits, damping, friction, static_friction, rotor_inertia, ..plain };
        let link = Link::new(name, inertial(py, mass, com, inertia)?);
        self.builder.add(parent, joint, link).map_err(|error| error.into_python(py))?;
        Ok(())
    }

    /// Name a frame fixed to a link.
    #[pyo3(signature = (name, link, *, xyz=None, rpy=None))]
    fn add_frame(
        &mut self,
        py: Python<'_>,
        name: &str,
        link: &str,
        xyz: Option<Any<'_, '_>>,
        rpy: Option<Any<'_, '_>>,
    ) -> PyResult<()> {
        let pose = pose(xyz, rpy)?;
        self.builder.add_frame(name, link, pose).map_err(|error| error.into_python(py))?;
        Ok(())
    }

    /// The finished robot; the builder can go on.
    fn build(&self, py: Python<'_>) -> PyResult<PyModel> {
        let model = self.builder.clone().build().map_err(|error| error.into_python(py))?;
        PyModel::wrap(py, model, None, &[])
    }
}

pub(crate) fn vector(value: Option<Any<'_, '_>>, name: &str, default: [f64; 3]) -> PyResult<Vector3<f64>> {
    Ok(Vector3::from(value.map_or(Ok(default), |value| fixed(value, name, &[3]))?))
}

fn pose(xyz: Option<Any<'_, '_>>, rpy: Option<Any<'_, '_>>) -> PyResult<Isometry3<f64>> {
    let turn = vector(rpy, "rpy", [0.0; 3])?;
    let rotation = UnitQuaternion::from_euler_angles(turn.x, turn.y, turn.z);
    Ok(Isometry3::from_parts(Translation3::from(vector(xyz, "xyz", [0.0; 3])?), rotation))
}

fn inertial(
    py: Python<'_>,
    mass: Option<f64>,
    com: Option<Any<'_, '_>>,
    inertia: Option<Any<'_, '_>>,
) -> PyResult<Option<Inertial>> {
    let Some(mass) = mass else {
        if com.is_some() || inertia.is_some() {
            return Err(raise(py, "ModelError", "com or inertia is given without a mass", &fields!(py,)));
        }
        return Ok(None);
    };
    let inertia = inertia.map_or(Ok([0.0; 9]), |value| fixed(value, "inertia", &[3, 3]))?;
    Ok(Some(Inertial {
        mass,
        com: vector(com, "com", [0.0; 3])?,
        inertia: Matrix3::from_row_slice(&inertia),
    }))
}
