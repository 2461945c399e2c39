//! Robots built link by link.

use super::closed_loop::{PyLoop, mimic_in};
use super::{Any, PyModel};
use crate::arrays::{fixed, vector};
use crate::errors::{IntoPython, fields, raise};
use crate::pickling::ConstructorCall;
use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion};
use onorbit_core::model::{Inertial, Joint, JointKind, JointSpring, Limits, Link, Model, ModelBuilder};
use pyo3::prelude::*;

/// Builder that constructs a robot link by link. The first link is the free-floating base.
///
/// Parameters
/// ----------
/// name : str
///     Name of the robot.
/// base : str
///     Name of the base link.
/// mass : float, optional
///     Mass of the base, kg. Default: the link is massless.
/// com : (3,) array, optional
///     Centre of mass in link axes, m; only with ``mass``. Default: the origin of the link.
/// inertia : (3, 3) array, optional
///     Inertia about the centre of mass in link axes, kg m²; only with ``mass``. Default: zero, a point mass.
///
/// Raises
/// ------
/// ModelError
///     If ``com`` or ``inertia`` is given without ``mass``, or a value is invalid.
/// InputError, ShapeError
///     If an array is not finite or has the wrong shape.
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

    /// Add a link and the joint that connects it to its parent.
    ///
    /// Position limits are enforced only with ``Simulation(enforce_limits=True)``; rate limits are not
    /// enforced. Effort limits are the default limits of :class:`JointPid`.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Name of the link.
    /// parent : str
    ///     Name of the parent link.
    /// joint : str
    ///     Name of the joint.
    /// kind : {"revolute", "continuous", "prismatic", "fixed"}
    ///     Type of the joint.
    /// axis : (3,) array, optional
    ///     Joint axis in link axes, of any length; default: z.
    /// xyz, rpy : (3,) array, optional
    ///     Position, m, and roll, pitch, yaw, rad, of the link frame in the parent's frame at joint position
    ///     zero. Default: zero.
    /// mass : float, optional
    ///     Mass, kg. Default: the link is massless.
    /// com : (3,) array, optional
    ///     Centre of mass in link axes, m; only with ``mass``. Default: the origin of the link.
    /// inertia : (3, 3) array, optional
    ///     Inertia about the centre of mass in link axes, kg m²; only with ``mass``. Default: zero.
    /// damping : float
    ///     Coefficient of viscous friction, N m s/rad or N s/m.
    /// friction : float
    ///     Kinetic Coulomb friction, which acts while the joint moves, N m or N.
    /// rotor_inertia : float
    ///     Rotor inertia reflected to the joint, kg m² or kg.
    /// lower, upper : float, optional
    ///     Position limits, rad or m.
    /// velocity : float, optional
    ///     Rate limit, rad/s or m/s.
    /// effort : float, optional
    ///     Effort limit, N m or N.
    /// static_friction : float, optional
    ///     Largest torque or force that static friction can hold, N m or N; at least ``friction``, which is
    ///     the default.
    /// mimic : str or (str, float, float), optional
    ///     Name of the leading joint, or a tuple of this name, a ratio and an offset (rad or m). The position
    ///     of the joint is constrained to the ratio times the position of its leader, plus the offset.
    ///     Default ratio and offset: 1 and 0.
    /// stiffness : float
    ///     Stiffness ``k`` of a spring at the joint, N m/rad or N/m: with the cubic stiffness ``k3`` and the
    ///     deflection ``d`` from the rest position, its torque or force is ``-k d - k3 d**3``.
    /// cubic_stiffness : float
    ///     Cubic stiffness ``k3`` of the spring, N m/rad³ or N/m³; negative for a spring that softens.
    /// rest_position : float
    ///     Joint position at which the spring exerts no torque or force, rad or m.
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If the parent does not exist.
    /// ModelError
    ///     If the name is already used, or a value is invalid.
    /// InputError, ShapeError
    ///     If an array is not finite or has the wrong shape.
    #[pyo3(signature = (
        name, *, parent, joint, kind="revolute", axis=None, xyz=None, rpy=None, mass=None, com=None, inertia=None,
        damping=0.0, friction=0.0, rotor_inertia=0.0, lower=None, upper=None, velocity=None, effort=None,
        static_friction=None, mimic=None, stiffness=0.0, cubic_stiffness=0.0, rest_position=0.0,
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
        mimic: Option<Any<'_, '_>>,
        stiffness: f64,
        cubic_stiffness: f64,
        rest_position: f64,
    ) -> PyResult<()> {
        let axis = vector(axis, "axis", [0.0, 0.0, 1.0])?;
        let kind = match kind {
            "revolute" | "continuous" => JointKind::Revolute(axis),
            "prismatic" => JointKind::Prismatic(axis),
            "fixed" => JointKind::Fixed,
            other => {
                let message = format!(
                    "joint '{joint}' is of kind '{other}'; the kinds are revolute, continuous, prismatic and fixed"
                );
                return Err(raise(py, "ModelError", &message, &fields!(py, "joint": joint)));
            }
        };
        let position = match (lower, upper) {
            (None, None) => None,
            _ => Some((lower.unwrap_or(f64::NEG_INFINITY), upper.unwrap_or(f64::INFINITY))),
        };
        let limits = Limits { position, velocity, effort };
        let mimic = mimic.map(mimic_in).transpose()?;
        let plain = Joint::new(joint, kind, pose(xyz, rpy)?);
        let spring = JointSpring::new(stiffness, cubic_stiffness, rest_position);
        let joint =
            Joint { limits, damping, friction, static_friction, rotor_inertia, spring, mimic, ..plain };
        let link = Link::new(name, inertial(py, mass, com, inertia)?);
        self.builder.add(parent, joint, link).map_err(|error| error.into_python(py))?;
        Ok(())
    }

    /// Add a named frame that is fixed to a link.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Name of the frame.
    /// link : str
    ///     Link to which the frame is fixed.
    /// xyz, rpy : (3,) array, optional
    ///     Position, m, and roll, pitch, yaw, rad, of the frame in the link's frame. Default: zero.
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If the link does not exist.
    /// ModelError
    ///     If the name is already used, or a value is invalid.
    /// InputError, ShapeError
    ///     If an array is not finite or has the wrong shape.
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

    /// Close a loop between two frames.
    ///
    /// Parameters
    /// ----------
    /// loop : Loop
    ///     Joint between two links or frames that were added before.
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If a frame does not exist.
    /// ModelError
    ///     If the name is empty or that of another loop, both frames are the same, or the length is out of
    ///     range.
    #[pyo3(signature = (r#loop))]
    fn close(&mut self, py: Python<'_>, r#loop: &PyLoop) -> PyResult<()> {
        self.builder.close(r#loop.closing.clone()).map_err(|error| error.into_python(py))?;
        Ok(())
    }

    /// Return the robot.
    ///
    /// Links that are added to the builder afterwards do not change the returned robot.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// ModelError
    ///     If the robot is invalid, for example because a joint moves only massless links.
    fn build(&self, py: Python<'_>) -> PyResult<PyModel> {
        let model = self.builder.clone().build().map_err(|error| error.into_python(py))?;
        PyModel::wrap(py, model, None, &[])
    }
}

/// Returns a spacecraft without joints, with the given mass, kg, and inertia (3, 3) about its centre of mass,
/// kg m².
pub(super) fn rigid_body(py: Python<'_>, mass: f64, inertia: Any<'_, '_>) -> PyResult<PyModel> {
    let numbers = fixed::<9>(inertia, "inertia", &[3, 3])?;
    let inertia = Matrix3::from_row_slice(&numbers);
    let model = Model::rigid_body(mass, inertia).map_err(|error| error.into_python(py))?;
    let rows: Vec<&[f64]> = numbers.chunks(3).collect();
    let keywords = fields!(py, "mass": mass, "inertia": rows);
    PyModel::wrap(py, model, Some(ConstructorCall::with_keywords("Model.rigid_body", &keywords)?), &[])
}

/// Reads a pose from a position, m, and roll, pitch, yaw, rad; both are zero by default.
fn pose(xyz: Option<Any<'_, '_>>, rpy: Option<Any<'_, '_>>) -> PyResult<Isometry3<f64>> {
    let angles = vector(rpy, "rpy", [0.0; 3])?;
    let rotation = UnitQuaternion::from_euler_angles(angles.x, angles.y, angles.z);
    Ok(Isometry3::from_parts(Translation3::from(vector(xyz, "xyz", [0.0; 3])?), rotation))
}

/// Reads mass, kg, centre of mass, m, and inertia, kg m², of a link. Returns `None` if none of them is given.
fn inertial(
    py: Python<'_>,
    mass: Option<f64>,
    com: Option<Any<'_, '_>>,
    inertia: Option<Any<'_, '_>>,
) -> PyResult<Option<Inertial>> {
    let Some(mass) = mass else {
        if com.is_some() || inertia.is_some() {
            let message = "com or inertia is given without mass; give the mass (kg) as well, or omit both";
            return Err(raise(py, "ModelError", message, &fields!(py,)));
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
