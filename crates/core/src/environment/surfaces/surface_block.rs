//! Surfaces of eight bodies as a structure of arrays.

use super::cylinder::Cylinder;
use super::face::Face;
use super::face_pair::FacePair;
use super::optics::Optics;
use super::parts::Parts;
use super::sphere::Sphere;
use super::sums::{DragSums, PressureSums};
use super::surface::Surface;
use crate::environment::soa::{Column8, WIDTH};
use crate::environment::wrenches::WrenchLanes;
use crate::spatial::{Real, Vec3};

/// Surfaces of eight bodies.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::environment) struct SurfaceBlock {
    is_empty: bool,
    drag_coefficient: Column8,
    optics: Optics<Column8>,
    faces: PartTable<Face<Column8>>,
    face_pairs: PartTable<FacePair<Column8>>,
    cylinders: PartTable<Cylinder<Column8>>,
    spheres: PartTable<Sphere<Column8>>,
}

impl SurfaceBlock {
    /// Creates the block from the surfaces of at most eight bodies; `None` is a body without a surface.
    pub(super) fn new(surfaces: &[Option<Surface>]) -> Self {
        let surface = |i: usize| surfaces.get(i).and_then(Option::as_ref);
        Self {
            is_empty: surfaces.iter().all(Option::is_none),
            drag_coefficient: Column8::of(|i| surface(i).map_or(0.0, |surface| surface.drag_coefficient)),
            optics: Optics::block(|i| surface(i).map_or(Optics::default(), |surface| surface.optics)),
            faces: PartTable::new(surfaces, |parts| &parts.faces, |faces| Face::block(faces)),
            face_pairs: PartTable::new(surfaces, |parts| &parts.face_pairs, |pairs| FacePair::block(pairs)),
            cylinders: PartTable::new(
                surfaces,
                |parts| &parts.cylinders,
                |cylinders| Cylinder::block(cylinders),
            ),
            spheres: PartTable::new(surfaces, |parts| &parts.spheres, |spheres| Sphere::block(spheres)),
        }
    }

    /// Returns true if none of the bodies has a surface.
    pub(in crate::environment) fn is_empty(&self) -> bool {
        self.is_empty
    }

    /// Returns the drag wrenches at a density of 1 kg/m³ on consecutive bodies from body `offset` of the
    /// block on, one per lane of `S`, in body axes.
    ///
    /// `v` is the velocity of the centre of mass and `w` the angular velocity, both relative to the
    /// atmosphere, in body axes.
    #[inline(always)]
    pub(in crate::environment) fn drag<S: Real>(
        &self,
        offset: usize,
        v: Vec3<S>,
        w: Vec3<S>,
    ) -> WrenchLanes<S> {
        let mut sums = DragSums::zero();
        self.faces.rows::<S>(offset).for_each(|face| face.load(offset).add_drag(v, w, &mut sums));
        self.face_pairs.rows::<S>(offset).for_each(|pair| pair.load(offset).add_drag(v, w, &mut sums));
        self.cylinders.rows::<S>(offset).for_each(|cylinder| cylinder.load(offset).add_drag(v, w, &mut sums));
        self.spheres.rows::<S>(offset).for_each(|sphere| sphere.load(offset).add_drag(v, w, &mut sums));
        // F = -½ ρ C_D Σ a u
        sums.wrench(v, w) * (S::of(0.5) * self.drag_coefficient.load(offset))
    }

    /// Returns the wrenches of light from the direction `to_sun` (unit vectors in body axes) at a pressure of
    /// 1 N/m² on the same bodies as [`Self::drag`], in body axes.
    #[inline(always)]
    pub(in crate::environment) fn pressure<S: Real>(&self, offset: usize, to_sun: Vec3<S>) -> WrenchLanes<S> {
        let (mut sums, optics) = (PressureSums::zero(), self.optics.load(offset));
        self.faces
            .rows::<S>(offset)
            .for_each(|face| face.load(offset).add_pressure(to_sun, &optics, &mut sums));
        self.face_pairs
            .rows::<S>(offset)
            .for_each(|pair| pair.load(offset).add_pressure(to_sun, &optics, &mut sums));
        self.cylinders
            .rows::<S>(offset)
            .for_each(|cylinder| cylinder.load(offset).add_pressure(to_sun, &optics, &mut sums));
        self.spheres.rows::<S>(offset).for_each(|sphere| sphere.load(offset).add_pressure(&mut sums));
        sums.wrench(to_sun)
    }
}

/// Parts of one kind. Row `k` contains the `k`-th part of each body, or a part of size zero if the body has
/// fewer parts.
#[derive(Clone, Debug, PartialEq)]
struct PartTable<R> {
    rows: Vec<R>,
    /// Number of parts of each body.
    counts: [usize; WIDTH],
}

impl<R> PartTable<R> {
    fn new<P: Copy + Default>(
        surfaces: &[Option<Surface>],
        parts: fn(&Parts) -> &Vec<P>,
        row: impl Fn(&dyn Fn(usize) -> P) -> R,
    ) -> Self {
        let of = |body: usize| surfaces.get(body)?.as_ref().map(|surface| parts(&surface.parts));
        let counts = std::array::from_fn(|body| of(body).map_or(0, Vec::len));
        let part =
            |body: usize, k: usize| of(body).and_then(|parts| parts.get(k)).copied().unwrap_or_default();
        let most = counts.into_iter().max().unwrap_or_default();
        Self { rows: (0..most).map(|k| row(&|body| part(body, k))).collect(), counts }
    }

    /// Returns the rows that contain a part of at least one of the bodies in the lanes of `S`, of which the
    /// first is body `offset` of the block.
    #[inline(always)]
    fn rows<S: Real>(&self, offset: usize) -> std::slice::Iter<'_, R> {
        if S::LANES == WIDTH {
            return self.rows.iter();
        }
        let most = self.counts[offset..][..S::LANES].iter().max();
        self.rows[..most.map_or(0, |most| *most)].iter()
    }
}
