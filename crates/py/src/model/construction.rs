//! Methods of `Model` that construct robots or convert states from one robot to another.

use super::collision::{with_collision, with_convex_pieces};
use super::file::{self, read_file};
use super::{Any, Array, PyModel, PyShape, builder, joint_change, link_change, reroot};
use crate::pickling::{ConstructorCall, Reduced};
use onorbit_core::model::JointChange;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

#[pymethods]
impl PyModel {
    /// Load a robot from a URDF or xacro file; its root link is free-floating.
    ///
    /// A file named ``*.xacro``, or any file with ``xacro=True`` or ``xacro_arguments``, is first expanded
    /// with PyPI's ``xacro`` (``pip install 'onorbit-rs[xacro]'``). Expressions in the file are evaluated by
    /// onorbit_rs; Python code in the file is not executed.
    ///
    /// Parameters
    /// ----------
    /// path : path
    ///     Path of the file.
    /// package_paths : list of path, optional
    ///     Folders that are ROS packages or contain them, searched for ``package://`` and ``$(find ...)``.
    /// xacro_arguments : dict of str to object, optional
    ///     Values of the file's arguments, by name; they replace ``$(arg name)``.
    /// xacro : bool
    ///     If True, the file is expanded as xacro regardless of its name.
    /// links : dict of str to dict, optional
    ///     ``{name: {"mass": kg, "com": (3,) m, "inertia": (3, 3) kg m²}}``: values that replace those in the
    ///     file before the robot is validated. Use :meth:`with_link` to replace values of a valid robot.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// ModelError
    ///     If the file does not describe a valid robot, ``links`` is invalid, or PyPI's ``xacro`` is required
    ///     but not installed.
    /// InputError, ShapeError
    ///     If a ``com`` or ``inertia`` in ``links`` is not finite or has the wrong shape.
    /// NotFoundError, ReadError
    ///     If the file does not exist or cannot be read.
    #[staticmethod]
    #[pyo3(signature = (path, *, package_paths=None, xacro_arguments=None, xacro=false, links=None))]
    fn from_urdf(
        py: Python<'_>,
        path: PathBuf,
        package_paths: Option<Vec<PathBuf>>,
        xacro_arguments: Option<&Bound<'_, PyDict>>,
        xacro: bool,
        links: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let (model, keywords) = read_file(py, &path, package_paths, xacro_arguments, xacro, links, false)?;
        let call = ConstructorCall::with_keywords("Model.from_urdf", &keywords)?;
        Self::wrap(py, model, Some(call), &[])
    }

    /// Load a robot from the text of a URDF.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     Text of the URDF.
    /// folder : path, optional
    ///     Folder to which relative paths of meshes refer.
    /// package_paths : list of path, optional
    ///     As for :meth:`from_urdf`.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// ModelError
    ///     If the text does not describe a valid robot.
    #[staticmethod]
    #[pyo3(signature = (text, *, folder=None, package_paths=None))]
    fn from_urdf_string(
        py: Python<'_>,
        text: &str,
        folder: Option<PathBuf>,
        package_paths: Option<Vec<PathBuf>>,
    ) -> PyResult<Self> {
        file::from_urdf_string(py, text, folder, package_paths)
    }

    /// Return a spacecraft without joints.
    ///
    /// The only body is named ``base``; its origin is the centre of mass.
    ///
    /// Parameters
    /// ----------
    /// mass : float
    ///     Mass, kg.
    /// inertia : (3, 3) array
    ///     Inertia about the centre of mass, kg m².
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// ModelError
    ///     If the mass or the inertia is not physical.
    /// InputError, ShapeError
    ///     If ``inertia`` is not finite or has the wrong shape.
    #[staticmethod]
    fn rigid_body(py: Python<'_>, mass: f64, inertia: Any<'_, '_>) -> PyResult<Self> {
        builder::rigid_body(py, mass, inertia)
    }

    /// Return a copy of the robot with the inertial properties of one link replaced.
    ///
    /// Properties that are omitted do not change.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Name of the link.
    /// mass : float, optional
    ///     Mass, kg. The inertia is not scaled with the mass.
    /// com : (3,) array, optional
    ///     Centre of mass in link axes, m.
    /// inertia : (3, 3) array, optional
    ///     Inertia about the centre of mass in link axes, kg m².
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If no link has this name.
    /// ModelError
    ///     If the values are not physical, or if the link has no inertial properties and no mass is given.
    /// InputError, ShapeError
    ///     If an array is not finite or has the wrong shape.
    #[pyo3(signature = (name, *, mass=None, com=None, inertia=None))]
    fn with_link(
        slf: &Bound<'_, Self>,
        name: &str,
        mass: Option<f64>,
        com: Option<Any<'_, '_>>,
        inertia: Option<Any<'_, '_>>,
    ) -> PyResult<Self> {
        link_change::with_link(slf, name, mass, com, inertia)
    }

    /// Return a copy of the robot with the damping, friction, rotor inertia or spring of one joint replaced.
    ///
    /// Properties that are omitted do not change. If the stiffness and the cubic stiffness of the joint are
    /// both 0 afterwards, it has no spring.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Name of the joint, which must not be fixed.
    /// damping : float, optional
    ///     Coefficient of viscous friction, N m s/rad or N s/m.
    /// friction : float, optional
    ///     Kinetic Coulomb friction, N m or N.
    /// static_friction : float, optional
    ///     Largest torque or force that static friction can hold, N m or N; at least ``friction``.
    /// rotor_inertia : float, optional
    ///     Rotor inertia reflected to the joint, kg m² or kg.
    /// stiffness : float, optional
    ///     Stiffness ``k`` of the spring, N m/rad or N/m: with the cubic stiffness ``k3`` and the deflection
    ///     ``d`` from the rest position, its torque or force is ``-k d - k3 d**3``.
    /// cubic_stiffness : float, optional
    ///     Cubic stiffness ``k3`` of the spring, N m/rad³ or N/m³; negative for a spring that softens.
    /// rest_position : float, optional
    ///     Joint position at which the spring exerts no torque or force, rad or m.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If no joint has this name.
    /// ModelError
    ///     If the joint is fixed, or a value is invalid.
    #[pyo3(signature = (
        name, *, damping=None, friction=None, static_friction=None, rotor_inertia=None, stiffness=None,
        cubic_stiffness=None, rest_position=None,
    ))]
    fn with_joint(
        slf: &Bound<'_, Self>,
        name: String,
        damping: Option<f64>,
        friction: Option<f64>,
        static_friction: Option<f64>,
        rotor_inertia: Option<f64>,
        stiffness: Option<f64>,
        cubic_stiffness: Option<f64>,
        rest_position: Option<f64>,
    ) -> PyResult<Self> {
        let change = JointChange {
            joint: name,
            damping,
            friction,
            static_friction,
            rotor_inertia,
            stiffness,
            cubic_stiffness,
            rest_position,
        };
        joint_change::with_joint(slf, &change)
    }

    /// Return a copy of the robot with an additional collision shape on a link.
    ///
    /// The collision shape of the link becomes the union of its previous shapes and the new one. It is used
    /// for contacts and distances, and does not change masses.
    ///
    /// Parameters
    /// ----------
    /// link : str
    ///     Name of the link.
    /// shape : Shape
    ///     Shape, such as ``Shape.cone(0.05, 0.08)``.
    /// pose : (4, 4) array, optional
    ///     Pose of the shape in link axes, m. Default: the identity.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If no link has this name.
    /// ModelError
    ///     If the pose is invalid.
    #[pyo3(signature = (link, shape, *, pose=None))]
    fn with_collision(
        slf: &Bound<'_, Self>,
        link: &str,
        shape: &Bound<'_, PyShape>,
        pose: Option<Any<'_, '_>>,
    ) -> PyResult<Self> {
        with_collision(slf, link, shape, pose)
    }

    /// Return a copy of the robot with the collision meshes of a link divided into convex pieces.
    ///
    /// The collision shape of a mesh that is not divided is its convex hull, which fills notches and holes.
    /// The tool CoACD divides the meshes, which takes seconds to minutes; the pieces are stored in the user's
    /// cache folder. A convex mesh is one piece.
    ///
    /// Parameters
    /// ----------
    /// link : str
    ///     Name of the link.
    /// pieces : int
    ///     Largest number of convex pieces of each mesh.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If no link has this name.
    /// InputError
    ///     If ``pieces`` is below 1 or above 1000.
    /// ModelError
    ///     If the link has no collision mesh, if a mesh is missing, open or without volume, or if CoACD fails
    ///     or is not installed (``pip install 'onorbit-rs[meshes]'``).
    fn with_convex_pieces(slf: &Bound<'_, Self>, link: &str, pieces: Any<'_, '_>) -> PyResult<Self> {
        with_convex_pieces(slf, link, pieces)
    }

    /// Return a copy of the robot with another link as its floating base.
    ///
    /// Links, frames and joints keep their names, and joints keep the signs of their positions, rates and
    /// torques. Bodies and joints are numbered depth first from the new base.
    ///
    /// Parameters
    /// ----------
    /// link : str
    ///     Name of the link that becomes the base.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If no link has this name.
    /// ModelError
    ///     If the new tree is invalid, for example because a joint would move only massless links.
    fn rerooted(slf: &Bound<'_, Self>, link: &str) -> PyResult<Self> {
        reroot::rerooted(slf, link)
    }

    /// Convert a state to the coordinates of another model of the same links, such as the result of
    /// :meth:`rerooted`.
    ///
    /// Parameters
    /// ----------
    /// q : (nq,) array
    ///     Configuration of this model, m and rad.
    /// v : (nv,) array
    ///     Velocity of this model, m/s and rad/s.
    /// to : Model
    ///     Model to whose coordinates the state is converted. All of its joints, and the link that is its
    ///     base, must exist in this model.
    ///
    /// Returns
    /// -------
    /// (nq,) array, (nv,) array
    ///     Configuration and velocity of ``to`` with which the links have the same poses and twists.
    ///
    /// Raises
    /// ------
    /// FrameError
    ///     If a joint or the base of ``to`` is not in this model.
    /// ShapeError
    ///     If ``q`` or ``v`` has the wrong shape.
    fn transfer_state<'py>(
        &self,
        py: Python<'py>,
        q: Any<'_, '_>,
        v: Any<'_, '_>,
        to: &Self,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        reroot::transfer_state(py, &self.model, (q, v), &to.model)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        match &slf.get().constructor_call {
            Some(call) => call.reduce_robot(slf),
            None => Err(PyTypeError::new_err(
                "a model built link by link or returned by Simulation.models cannot be pickled; build it in \
                 the process that uses it, or write it as URDF and load the file",
            )),
        }
    }
}
