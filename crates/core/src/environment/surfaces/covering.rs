//! Surfaces on the bodies of a robot.

use super::ball::Ball;
use super::eight_surfaces::EightSurfaces;
use super::error::{SurfaceError, not_negative};
use super::from_shapes::parts_of_body;
use super::optics::Optics;
use super::plate::Plate;
use super::slab::Slab;
use super::tube::Tube;
use crate::environment::eight::WIDTH;
use crate::model::{Frame, Model, Node};
use crate::spatial::Vec3;
use nalgebra::Vector3;

/// How a body meets wind and light.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    pub(super) parts: Parts,
    /// `C_D` on the area that faces the stream.
    pub(super) drag_coefficient: f64,
    /// What light does.
    pub(super) optics: Optics,
}

/// The outside of a body; axes of the body, positions from its centre of mass.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Parts {
    pub(super) plates: Vec<Plate<f64>>,
    pub(super) slabs: Vec<Slab<f64>>,
    pub(super) tubes: Vec<Tube<f64>>,
    pub(super) balls: Vec<Ball<f64>>,
}

impl Parts {
    fn is_empty(&self) -> bool {
        self.plates.is_empty() && self.slabs.is_empty() && self.tubes.is_empty() && self.balls.is_empty()
    }
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
    /// By body.
    is_covered: Vec<bool>,
    blocks: Vec<EightSurfaces>,
}

impl Surface {
    /// A cannonball.
    ///
    /// # Errors
    /// [`SurfaceError::Value`] for what is negative or not finite, and a reflectivity above 2.
    pub fn cannonball(area: f64, drag_coefficient: f64, reflectivity: f64) -> Result<Self, SurfaceError> {
        let area = not_negative("area", area)?;
        let drag_coefficient = not_negative("drag_coefficient", drag_coefficient)?;
        let value = not_negative("reflectivity", reflectivity)?;
        if value > 2.0 {
            let expected = "a number from 0 to 2 (a flat mirror that faces the Sun)";
            return Err(SurfaceError::Value { name: "reflectivity", value, expected });
        }
        let balls = vec![Ball { area, centre: Vec3::zero(), reflectivity }];
        let parts = Parts { balls, ..Parts::default() };
        Ok(Self { parts, drag_coefficient, optics: Optics::default() })
    }

    /// The faces of all shapes fixed to a body: boxes, cylinders, capsules, balls.
    ///
    /// # Errors
    /// [`SurfaceError::UnknownBody`], [`SurfaceError::NoShape`], [`SurfaceError::Mesh`], [`SurfaceError::Value`].
    pub fn from_shapes(
        model: &Model,
        body: usize,
        drag_coefficient: f64,
        optics: Optics,
    ) -> Result<Self, SurfaceError> {
        node_of(model, body)?;
        let parts = parts_of_body(model, body, &optics)?;
        if parts.is_empty() {
            return Err(SurfaceError::NoShape { body: model.body_frame(body).name.clone() });
        }
        let drag_coefficient = not_negative("drag_coefficient", drag_coefficient)?;
        Ok(Self { parts, drag_coefficient, optics })
    }

    /// Flat plates: areas, m², outward normals of any length, centroids, m; axes and origin of `frame`.
    ///
    /// # Errors
    /// [`SurfaceError::UnknownBody`], [`SurfaceError::WrongLength`], [`SurfaceError::NoPlates`], [`SurfaceError::Normal`], [`SurfaceError::Value`].
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
        let com = node_of(model, frame.body)?.com;
        let plate = |plate: usize| {
            let normal = Vec3::from(Vector3::from(normals[plate]));
            let length = normal.norm();
            if !(length > 0.0 && length.is_finite()) {
                return Err(SurfaceError::Normal { plate });
            }
            let centroid = Vec3::from(Vector3::from(centroids[plate]));
            not_negative("distance of a centroid", centroid.norm())?;
            let area = not_negative("area", areas[plate])?;
            let normal = frame.rot_kf * (normal * (1.0 / length));
            Ok(Plate::new(area, normal, frame.rot_kf * centroid + frame.pos_kf - com))
        };
        let plates = (0..areas.len()).map(plate).collect::<Result<_, _>>()?;
        let parts = Parts { plates, ..Parts::default() };
        let drag_coefficient = not_negative("drag_coefficient", drag_coefficient)?;
        Ok(Self { parts, drag_coefficient, optics })
    }
}

/// A body that the robot has.
fn node_of(model: &Model, body: usize) -> Result<&Node, SurfaceError> {
    let count = model.nodes().len();
    model.nodes().get(body).ok_or(SurfaceError::UnknownBody { body, count })
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
        let mut surfaces = vec![None; count];
        for Covering { body, surface } in coverings {
            let place = surfaces.get_mut(body).ok_or(SurfaceError::UnknownBody { body, count })?;
            if place.replace(surface).is_some() {
                return Err(SurfaceError::Twice { body });
            }
        }
        let is_covered = surfaces.iter().map(Option::is_some).collect();
        Ok(Self { is_covered, blocks: surfaces.chunks(WIDTH).map(EightSurfaces::new).collect() })
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
        let is_bare = |body: &usize| model.nodes()[*body].mass > 0.0 && !self.cover(*body);
        (0..model.nodes().len()).filter(is_bare).map(|body| model.body_frame(body).name.as_str()).collect()
    }

    /// Whether they cover a body.
    pub(in crate::environment) fn cover(&self, body: usize) -> bool {
        self.is_covered.get(body).is_some_and(|is| *is)
    }

    /// What covers the eight bodies among which body number `first` is; `None` where nothing does.
    #[inline(always)]
    pub(in crate::environment) fn around(&self, first: usize) -> Option<&EightSurfaces> {
        self.blocks.get(first / WIDTH).filter(|block| !block.is_bare())
    }
}
