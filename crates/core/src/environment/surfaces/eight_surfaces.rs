//! The surfaces of eight bodies side by side.

use super::ball::Ball;
use super::covering::{Parts, Surface};
use super::optics::Optics;
use super::plate::Plate;
use super::slab::Slab;
use super::sums::{Pressed, Swept};
use super::tube::Tube;
use crate::environment::eight::{Eight, WIDTH};
use crate::environment::wrenches::Push;
use crate::spatial::{Real, Vec3};

/// What covers eight bodies.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::environment) struct EightSurfaces {
    is_bare: bool,
    drag_coefficient: Eight,
    optics: Optics<Eight>,
    plates: Parallel<Plate<Eight>>,
    slabs: Parallel<Slab<Eight>>,
    tubes: Parallel<Tube<Eight>>,
    balls: Parallel<Ball<Eight>>,
}

impl EightSurfaces {
    /// The surfaces of at most eight bodies.
    pub(super) fn new(surfaces: &[Option<Surface>]) -> Self {
        let surface = |i: usize| surfaces.get(i).and_then(Option::as_ref);
        Self {
            is_bare: surfaces.iter().all(Option::is_none),
            drag_coefficient: Eight::of(|i| surface(i).map_or(0.0, |surface| surface.drag_coefficient)),
            optics: Optics::eight(|i| surface(i).map_or(Optics::default(), |surface| surface.optics)),
            plates: Parallel::new(surfaces, |parts| &parts.plates, |plates| Plate::eight(plates)),
            slabs: Parallel::new(surfaces, |parts| &parts.slabs, |slabs| Slab::eight(slabs)),
            tubes: Parallel::new(surfaces, |parts| &parts.tubes, |tubes| Tube::eight(tubes)),
            balls: Parallel::new(surfaces, |parts| &parts.balls, |balls| Ball::eight(balls)),
        }
    }

    /// Whether there is nothing on any of the bodies.
    pub(in crate::environment) fn is_bare(&self) -> bool {
        self.is_bare
    }

    /// Force (N for a density of 1) and torque of the air on as many bodies as there are lanes, body axes.
    ///
    /// `v` and `w` are velocity of the centre of mass and turn relative to the air, axes of the body.
    #[inline(always)]
    pub(in crate::environment) fn blow<S: Real>(&self, offset: usize, v: Vec3<S>, w: Vec3<S>) -> Push<S> {
        let mut swept = Swept::nothing();
        self.plates.rows::<S>(offset).for_each(|plate| plate.load(offset).blow(v, w, &mut swept));
        self.slabs.rows::<S>(offset).for_each(|slab| slab.load(offset).blow(v, w, &mut swept));
        self.tubes.rows::<S>(offset).for_each(|tube| tube.load(offset).blow(v, w, &mut swept));
        self.balls.rows::<S>(offset).for_each(|ball| ball.load(offset).blow(v, w, &mut swept));
        swept.push(v, w) * (S::of(0.5) * self.drag_coefficient.load(offset))
    }

    /// Force (N for a pressure of 1) and torque of light from the direction `to_sun`, axes of each body.
    #[inline(always)]
    pub(in crate::environment) fn shine<S: Real>(&self, offset: usize, to_sun: Vec3<S>) -> Push<S> {
        let (mut pressed, optics) = (Pressed::nothing(), self.optics.load(offset));
        self.plates
            .rows::<S>(offset)
            .for_each(|plate| plate.load(offset).shine(to_sun, &optics, &mut pressed));
        self.slabs.rows::<S>(offset).for_each(|slab| slab.load(offset).shine(to_sun, &optics, &mut pressed));
        self.tubes.rows::<S>(offset).for_each(|tube| tube.load(offset).shine(to_sun, &optics, &mut pressed));
        self.balls.rows::<S>(offset).for_each(|ball| ball.load(offset).shine(&mut pressed));
        pressed.push(to_sun)
    }
}

/// The first part of each body, the second of each, ...; a body that has fewer than another fills up with parts of no size.
#[derive(Clone, Debug, PartialEq)]
struct Parallel<R> {
    rows: Vec<R>,
    /// How many parts each body has.
    counts: [usize; WIDTH],
}

impl<R> Parallel<R> {
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

    /// Those in which one of as many bodies as `S` has lanes, from number `offset` on, has a part.
    #[inline(always)]
    fn rows<S: Real>(&self, offset: usize) -> std::slice::Iter<'_, R> {
        if S::LANES == WIDTH {
            return self.rows.iter();
        }
        let most = self.counts[offset..][..S::LANES].iter().max();
        self.rows[..most.map_or(0, |most| *most)].iter()
    }
}
