//! Parts of the surface of a body.

use super::cylinder::Cylinder;
use super::face::Face;
use super::face_pair::FacePair;
use super::sphere::Sphere;

/// Parts of the surface of one body, in body axes with positions from the centre of mass.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Parts {
    pub(super) faces: Vec<Face<f64>>,
    pub(super) face_pairs: Vec<FacePair<f64>>,
    pub(super) cylinders: Vec<Cylinder<f64>>,
    pub(super) spheres: Vec<Sphere<f64>>,
}

impl Parts {
    pub(super) fn is_empty(&self) -> bool {
        self.faces.is_empty()
            && self.face_pairs.is_empty()
            && self.cylinders.is_empty()
            && self.spheres.is_empty()
    }
}
