//! Conversion of the visual geometry of links to faces.

use super::cylinder::Cylinder;
use super::error::SurfaceError;
use super::face::Face;
use super::face_pair::FacePair;
use super::optics::Optics;
use super::parts::Parts;
use super::sphere::Sphere;
use crate::model::{Frame, Geometry, Model, Visual};
use crate::spatial::{Mat3, Vec3};
use std::f64::consts::PI;

/// Returns the surface parts of all shapes fixed to the body with index `body`, in body axes with positions
/// from the centre of mass.
pub(super) fn parts_of_body(model: &Model, body: usize, optics: &Optics) -> Result<Parts, SurfaceError> {
    let mut parts = Parts::default();
    for (frame, visual) in model.visuals() {
        let frame = &model.frames()[*frame];
        if frame.body == body {
            let pose = ShapePose::of(frame, visual, model.nodes()[body].com);
            pose.add(frame, &visual.geometry, optics, &mut parts)?;
        }
    }
    Ok(parts)
}

/// Pose of a shape: rotation from shape axes to body axes, and position of the origin of the shape
/// relative to the centre of mass of the body, m, in body axes.
struct ShapePose {
    rot: Mat3<f64>,
    pos: Vec3<f64>,
}

impl ShapePose {
    fn of(frame: &Frame, visual: &Visual, com: Vec3<f64>) -> Self {
        let rot: Mat3<f64> = visual.pose.rotation.to_rotation_matrix().into_inner().into();
        let pos: Vec3<f64> = visual.pose.translation.vector.into();
        Self { rot: frame.rot_kf * rot, pos: frame.rot_kf * pos + frame.pos_kf - com }
    }

    fn axis(&self, k: usize) -> Vec3<f64> {
        let unit = |i: usize| if i == k { 1.0 } else { 0.0 };
        self.rot * Vec3::new(unit(0), unit(1), unit(2))
    }

    fn add(
        &self,
        frame: &Frame,
        geometry: &Geometry,
        optics: &Optics,
        parts: &mut Parts,
    ) -> Result<(), SurfaceError> {
        match geometry {
            Geometry::Box([x, y, z]) => {
                self.add_face_pair(0, y * z, *x, parts);
                self.add_face_pair(1, z * x, *y, parts);
                self.add_face_pair(2, x * y, *z, parts);
            }
            Geometry::Cylinder { radius, length } => {
                parts.cylinders.push(self.cylinder(*radius, *length));
                self.add_face_pair(2, PI * radius * radius, *length, parts);
            }
            Geometry::Capsule { radius, length } => {
                parts.cylinders.push(self.cylinder(*radius, *length));
                for end in [-1.0, 1.0] {
                    self.add_dome(*radius, 0.5 * end * length, end, parts);
                }
            }
            Geometry::Sphere { radius } => {
                let (area, centre, reflectivity) = (PI * radius * radius, self.pos, optics.of_sphere());
                parts.spheres.push(Sphere { area, centre, reflectivity });
            }
            Geometry::Mesh { filename, .. } => {
                let (link, filename) = (frame.name.clone(), filename.clone());
                return Err(SurfaceError::Mesh { link, filename });
            }
            Geometry::Cone { .. } | Geometry::Torus { .. } | Geometry::HalfSpace | Geometry::Hull { .. } => {
                let kind = match geometry {
                    Geometry::Cone { .. } => "a cone",
                    Geometry::Torus { .. } => "a torus",
                    Geometry::HalfSpace => "a half-space",
                    _ => "a convex hull",
                };
                return Err(SurfaceError::Shape { link: frame.name.clone(), kind });
            }
        }
        Ok(())
    }

    /// Adds the two faces of the given area, m², normal to axis `k` of the shape, at a `distance` from each
    /// other, m.
    fn add_face_pair(&self, k: usize, area: f64, distance: f64, parts: &mut Parts) {
        parts.face_pairs.push(FacePair::new(area, distance, self.axis(k), self.pos));
    }

    fn cylinder(&self, radius: f64, length: f64) -> Cylinder<f64> {
        Cylinder { radius, length, axis: self.axis(2), centre: self.pos }
    }

    /// Adds a hemisphere of the given radius, m, approximated by faces. Its centre is at `height`, m, on
    /// the z axis of the shape, and it bulges towards +z or −z (`end` is 1 or −1). Its projected area is
    /// exact along z, and within 2 % in other directions.
    fn add_dome(&self, radius: f64, height: f64, end: f64, parts: &mut Parts) {
        const RINGS: usize = 4;
        const SECTORS: usize = 12;
        for ring in 0..RINGS {
            // patch between the latitudes b and c: projection on the equatorial plane ½ r² Δλ (cos² b - cos²
            // c)
            let latitude = |ring: usize| ring as f64 / RINGS as f64 * 0.5 * PI;
            let (b, c, sector) = (latitude(ring), latitude(ring + 1), 2.0 * PI / SECTORS as f64);
            let projection = 0.5 * (b.cos().powi(2) - c.cos().powi(2));
            let side = 0.5 * (c - b + c.sin() * c.cos() - b.sin() * b.cos());
            for k in 0..SECTORS {
                // the vector area ∫ n dA of the patch is exact
                let longitude = (k as f64 + 0.5) * sector;
                let wide = 2.0 * (0.5 * sector).sin() * side;
                let vector =
                    Vec3::new(wide * longitude.cos(), wide * longitude.sin(), end * sector * projection);
                let size = vector.norm();
                let normal = self.rot * (vector * (1.0 / size));
                let centre = self.pos + self.axis(2) * height;
                let area = size * radius * radius;
                parts.faces.push(Face::new(area, normal, centre + normal * radius));
            }
        }
    }
}
