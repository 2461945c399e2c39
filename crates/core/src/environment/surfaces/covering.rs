//! Surfaces on the bodies of a robot.

use super::error::{SurfaceError, not_negative};
use super::from_shapes::parts_of_body;
use super::part::{Optics, Part, Push};
use crate::environment::Wrench;
use crate::model::{Frame, Model};
use crate::spatial::{Mat3, Scalar, Vec3};
use nalgebra::{Matrix3, Vector3};

/// How a body meets wind and light.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// The same from all sides, at the centre of mass: no torque.
    Cannonball {
        /// Area across the stream, m².
        area: f64,
        /// `C_D`.
        drag_coefficient: f64,
        /// `C_R`: 1 where all light is absorbed, 2 for a flat mirror that faces the Sun.
        reflectivity: f64,
    },
    /// Faces, each at its own angle.
    Faces {
        /// The faces.
        parts: Vec<Part>,
        /// `C_D` on the area that faces the stream.
        drag_coefficient: f64,
        /// What light does.
        optics: Optics,
    },
}

/// A body with what covers it.
#[derive(Clone, Debug, PartialEq)]
pub struct Covering {
    /// Index of the body.
    pub body: usize,
    /// What covers it.
    pub surface: Surface,
}

/// What a robot shows to wind and light: at most one covering per body, the others feel nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Surfaces {
    coverings: Vec<Covering>,
}

impl Surface {
    /// A cannonball.
    ///
    /// # Errors
    /// [`SurfaceError::Value`] for what is negative or not finite, and a reflectivity above 2.
    pub fn cannonball(area: f64, drag_coefficient: f64, reflectivity: f64) -> Result<Self, SurfaceError> {
        Ok(Self::Cannonball {
            area: not_negative("area", area)?,
            drag_coefficient: not_negative("drag_coefficient", drag_coefficient)?,
            reflectivity: match not_negative("reflectivity", reflectivity)? {
                value if value > 2.0 => {
                    let expected = "a number from 0 to 2 (a flat mirror that faces the Sun)";
                    return Err(SurfaceError::Value { name: "reflectivity", value, expected });
                }
                value => value,
            },
        })
    }

    /// The faces of all shapes fixed to a body: boxes, cylinders, capsules, balls.
    ///
    /// # Errors
    /// [`SurfaceError::NoShape`], [`SurfaceError::Mesh`], [`SurfaceError::Value`].
    pub fn from_shapes(
        model: &Model,
        body: usize,
        drag_coefficient: f64,
        optics: Optics,
    ) -> Result<Self, SurfaceError> {
        let parts = parts_of_body(model, body)?;
        if parts.is_empty() {
            return Err(SurfaceError::NoShape { body: model.body_frame(body).name.clone() });
        }
        let drag_coefficient = not_negative("drag_coefficient", drag_coefficient)?;
        Ok(Self::Faces { parts, drag_coefficient, optics })
    }

    /// Flat plates: areas, m², outward normals of any length, centroids, m; axes and origin of `frame`.
    ///
    /// # Errors
    /// [`SurfaceError::WrongLength`], [`SurfaceError::NoPlates`], [`SurfaceError::Normal`], [`SurfaceError::Value`].
    pub fn plates(
        model: &Model,
        frame: &Frame,
        areas: &[f64],
        normals: &[[f64; 3]],
        centroids: &[[f64; 3]],
        drag_coefficient: f64,
        optics: Optics,
    ) -> Result<Self, SurfaceError> {
        if areas.len() != normals.len() || areas.len() != centroids.len() {
            let (areas, normals, centroids) = (areas.len(), normals.len(), centroids.len());
            return Err(SurfaceError::WrongLength { areas, normals, centroids });
        }
        if areas.is_empty() {
            return Err(SurfaceError::NoPlates);
        }
        let com = model.nodes()[frame.body].com;
        let plate = |plate: usize| {
            let normal = Vec3::from(Vector3::from(normals[plate]));
            let length = normal.norm();
            if !(length > 0.0 && length.is_finite()) {
                return Err(SurfaceError::Normal { plate });
            }
            let centroid = Vec3::from(Vector3::from(centroids[plate]));
            not_negative("distance of a centroid", centroid.norm())?;
            Ok(Part::Plate {
                area: not_negative("area", areas[plate])?,
                normal: frame.rot_kf * (normal * (1.0 / length)),
                centroid: frame.rot_kf * centroid + frame.pos_kf - com,
            })
        };
        let parts = (0..areas.len()).map(plate).collect::<Result<_, _>>()?;
        let drag_coefficient = not_negative("drag_coefficient", drag_coefficient)?;
        Ok(Self::Faces { parts, drag_coefficient, optics })
    }

    /// Force (N for a density of 1) and torque of the air, axes of the body.
    #[inline(always)]
    fn blow<S: Scalar>(&self, v: Vec3<S>, w: Vec3<S>) -> Push<S> {
        let mut push = Push::none();
        let half = match self {
            Self::Cannonball { area, drag_coefficient, .. } => {
                push.force = v * (v.norm() * S::of(-area));
                0.5 * drag_coefficient
            }
            Self::Faces { parts, drag_coefficient, .. } => {
                for part in parts {
                    part.blow(v, w, &mut push);
                }
                0.5 * drag_coefficient
            }
        };
        Push { force: push.force * S::of(half), torque: push.torque * S::of(half) }
    }

    /// Force (N for a pressure of 1) and torque of light from the direction `s`, axes of the body.
    #[inline(always)]
    fn shine<S: Scalar>(&self, s: Vec3<S>) -> Push<S> {
        let mut push = Push::none();
        match self {
            Self::Cannonball { area, reflectivity, .. } => push.force = s * S::of(-area * reflectivity),
            Self::Faces { parts, optics, .. } => {
                for part in parts {
                    part.shine(s, optics, &mut push);
                }
            }
        }
        push
    }
}

impl Surfaces {
    /// These coverings on a robot of `count` bodies.
    ///
    /// # Errors
    /// [`SurfaceError::Nothing`], [`SurfaceError::UnknownBody`], [`SurfaceError::Twice`].
    pub fn new(coverings: Vec<Covering>, count: usize) -> Result<Self, SurfaceError> {
        if coverings.is_empty() {
            return Err(SurfaceError::Nothing);
        }
        let mut is_covered = vec![false; count];
        for &Covering { body, .. } in &coverings {
            let covered = is_covered.get_mut(body).ok_or(SurfaceError::UnknownBody { body, count })?;
            if std::mem::replace(covered, true) {
                return Err(SurfaceError::Twice { body });
            }
        }
        Ok(Self { coverings })
    }

    /// Every body with the faces of its own shapes; bodies that look like nothing feel nothing.
    ///
    /// # Errors
    /// As [`Surface::from_shapes`]; [`SurfaceError::NoShape`] where no body has a shape.
    pub fn from_shapes(model: &Model, drag_coefficient: f64, optics: Optics) -> Result<Self, SurfaceError> {
        let has_shape =
            |body: &usize| model.visuals().iter().any(|(frame, _)| model.frames()[*frame].body == *body);
        let cover = |body: usize| {
            let surface = Surface::from_shapes(model, body, drag_coefficient, optics)?;
            Ok(Covering { body, surface })
        };
        let count = model.nodes().len();
        let coverings: Vec<_> = (0..count).filter(has_shape).map(cover).collect::<Result<_, _>>()?;
        if coverings.is_empty() {
            return Err(SurfaceError::NoShape { body: "the robot".to_owned() });
        }
        Self::new(coverings, count)
    }

    /// Names of the bodies with mass that are not covered: they feel nothing.
    pub fn bare<'a>(&self, model: &'a Model) -> Vec<&'a str> {
        let is_bare = |body: &usize| {
            model.nodes()[*body].mass > 0.0 && self.coverings.iter().all(|covering| covering.body != *body)
        };
        (0..model.nodes().len()).filter(is_bare).map(|body| model.body_frame(body).name.as_str()).collect()
    }

    /// The bodies that are covered, each with its covering.
    pub fn coverings(&self) -> &[Covering] {
        &self.coverings
    }
}

impl Covering {
    /// Force and torque about the centre of mass, `W` axes, of air with a density of 1 kg/m³.
    ///
    /// `v` and `w` are velocity of the centre of mass and turn relative to the air, `W` axes.
    #[inline(always)]
    pub(in crate::environment) fn blow<S: Scalar>(
        &self,
        rot_wk: &Matrix3<f64>,
        v: &Vector3<f64>,
        w: &Vector3<f64>,
    ) -> Wrench {
        let rot = Mat3::<S>::of(&Mat3::from(*rot_wk));
        let in_body = |v: &Vector3<f64>| rot.transpose_mul(Vec3::of(&Vec3::from(*v)));
        out(rot, self.surface.blow(in_body(v), in_body(w)))
    }

    /// Force and torque about the centre of mass, `W` axes, of light with a pressure of 1 Pa from `s`.
    #[inline(always)]
    pub(in crate::environment) fn shine<S: Scalar>(&self, rot_wk: &Matrix3<f64>, s: &Vector3<f64>) -> Wrench {
        let rot = Mat3::<S>::of(&Mat3::from(*rot_wk));
        out(rot, self.surface.shine(rot.transpose_mul(Vec3::of(&Vec3::from(*s)))))
    }
}

/// In `W` axes.
#[inline(always)]
fn out<S: Scalar>(rot_wk: Mat3<S>, push: Push<S>) -> Wrench {
    Wrench { force: (rot_wk * push.force).to_nalgebra(), torque: (rot_wk * push.torque).to_nalgebra() }
}
