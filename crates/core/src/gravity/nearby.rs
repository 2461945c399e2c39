//! The field near a robot: evaluated once, expanded to the bodies.

use super::expansion::{Expansion, is_near};
use super::point_mass::{point_mass_gradient, tide};
use super::{Gravity, GravityError, GravityField};
use crate::spatial::{Mat3, Real, Sym3, Vec3};
use std::cell::OnceCell;

/// Pitch of the points, fixed in the planet, about which a dear field is expanded for short steps, m: a robot in a low orbit
/// passes one every third step of 1 ms. No place is farther than 28 m from one; on the way from one to the next what the
/// expansion leaves out averages to nothing, because `∇²g = 0`.
const PITCH: f64 = 32.0;

/// Where and when: a robot beside its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Instant, s of simulation.
    pub time: f64,
    /// Position of the reference from the planet's centre, axes of `I`, m.
    pub origin: Vec3<f64>,
    /// Centre of mass of the robot from there, m.
    pub com: Vec3<f64>,
    /// Way through the planet's field in the step being integrated, m.
    pub travel: f64,
}

/// How the planet and the bodies beyond it stand at one instant.
#[derive(Clone, Debug)]
pub struct Sky {
    rot_fi: Mat3<f64>,
    /// The point of the grid that was asked for first, and the field about it in axes of `I`: stages share it.
    first: OnceCell<(Vec3<f64>, Expansion)>,
    /// What third bodies do, about the reference: over 40 m linear to 1e-7 of the Moon's tide.
    third: Option<Expansion>,
}

/// The field without its point mass, around the bodies of a robot at one instant, axes of `I`.
///
/// A cheap field is expanded about the robot as it stands; others about the next point of a grid fixed in the planet, or,
/// for steps that lead from point to point, about the robot as it stands. All of it is a function of the instant and of
/// the step: a run that goes on from a checkpoint finds the same bits.
#[derive(Clone, Debug)]
pub struct Nearby<'a> {
    gravity: &'a Gravity,
    time: f64,
    origin: Vec3<f64>,
    sky: &'a Sky,
    /// The planet's field about the robot, and about the reference where that lies elsewhere and is asked for.
    places: [Option<Expansion>; 2],
}

impl Gravity {
    /// How the planet and the bodies beyond it stand at an instant, the reference being at `origin`.
    ///
    /// # Errors
    /// What a third body says.
    pub fn sky(&self, time: f64, origin: Vec3<f64>) -> Result<Sky, GravityError> {
        let rot_fi = self.rot_fi(time).map_or_else(Mat3::identity, Mat3::from);
        let third = (!self.third_bodies.is_empty()).then(|| self.third_bodies_about(time, origin));
        Ok(Sky { rot_fi, first: OnceCell::new(), third: third.transpose()? })
    }

    /// All but the planet's point mass around a robot, under the [sky](Self::sky) of that instant and origin.
    ///
    /// `differs` says whether [`Nearby::difference`] will be asked for: what is expanded is then expanded half way to a
    /// reference that is near, which makes the mean difference right to second order.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    pub fn nearby<'a>(
        &'a self,
        station: &Station,
        sky: &'a Sky,
        differs: bool,
    ) -> Result<Nearby<'a>, GravityError> {
        let Station { time, origin, com, travel } = *station;
        let mut near = Nearby { gravity: self, time, origin, sky, places: [None; 2] };
        if let Some(field) = &self.field {
            let share = if differs && is_near(com, Vec3::zero()) { 0.5 } else { 1.0 };
            let about = |at| self.about(field, sky, at, travel);
            near.places[0] = Some(about(origin + com * share)?);
            if differs && near.expansion(origin).is_none() {
                near.places[1] = Some(about(origin)?);
            }
        }
        Ok(near)
    }

    /// What third bodies do at a place and around it.
    fn third_bodies_about(&self, t: f64, at: Vec3<f64>) -> Result<Expansion, GravityError> {
        let mut about = Expansion { at, value: Vec3::zero(), gradient: Sym3::default() };
        for body in &self.third_bodies {
            let place = Vec3::from(body.position(t)?);
            about.value += tide(body.mu(), &-place, at).0;
            about.gradient += point_mass_gradient(body.mu(), &(at - place).to_nalgebra()).into();
        }
        Ok(about)
    }

    /// The field about a place or the point of the grid next to it, axes of `I`.
    fn about(
        &self,
        field: &GravityField,
        sky: &Sky,
        at: Vec3<f64>,
        travel: f64,
    ) -> Result<Expansion, GravityError> {
        let here = sky.rot_fi * at;
        if field.is_closed() {
            return Ok(Expansion::of(field, here)?.turned_back(&sky.rot_fi));
        }
        let next = |x: f64| (x / PITCH).round() * PITCH;
        let point = if travel > PITCH { here } else { here.map(|x| next(*x)) };
        if let Some((_, expansion)) = sky.first.get().filter(|(first, _)| *first == point) {
            return Ok(*expansion);
        }
        let expansion = self.memo.about(field, point)?.turned_back(&sky.rot_fi);
        let _ = sky.first.set((point, expansion)); // the first stays
        Ok(expansion)
    }
}

impl Nearby<'_> {
    /// `g(R + ρ)`, m/s²; `offset` is `ρ`, from the reference, of a body in each lane.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    #[inline(always)]
    pub fn acceleration<S: Real>(&self, offset: Vec3<S>) -> Result<Vec3<S>, GravityError> {
        let there = Vec3::of(&self.origin) + offset;
        let field = match self.expansion(there) {
            Some(near) => near.value_at(there),
            None => each(there, |there| self.field(there))?,
        };
        let third = match &self.sky.third {
            Some(third) if third.reaches(there) => third.value_at(there),
            Some(_) => each(there, |there| self.third_bodies(Vec3::zero(), there))?,
            None => Vec3::zero(),
        };
        Ok(field + third)
    }

    /// `g(R + ρ) - g(R)`, m/s², without cancellation for near bodies: `G ρ`, with `G` from the expansion or half way.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    #[inline(always)]
    pub fn difference<S: Real>(&self, offset: Vec3<S>) -> Result<Vec3<S>, GravityError> {
        let there = Vec3::of(&self.origin) + offset;
        let field = match self.expansion(self.origin).filter(|near| near.reaches(there)) {
            Some(near) => near.rise(offset),
            None => each(offset, |offset| self.difference_of_field(offset))?,
        };
        let third = match &self.sky.third {
            Some(third) if third.reaches(there) => third.rise(offset),
            Some(_) => each(offset, |offset| self.third_bodies(self.origin, offset))?,
            None => Vec3::zero(),
        };
        Ok(field + third)
    }

    /// `∂g/∂r` at `R + ρ`, 1/s².
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    #[inline(always)]
    pub fn gradient<S: Real>(&self, offset: Vec3<S>) -> Result<Sym3<S>, GravityError> {
        let there = Vec3::of(&self.origin) + offset;
        let known = self.expansion(there).map(|near| near.gradient);
        let field = if self.gravity.field.is_none() { Some(Sym3::default()) } else { known };
        match (field, &self.sky.third) {
            (Some(field), None) => Ok(Sym3::of(&field)),
            (Some(field), Some(third)) if third.reaches(there) => Ok(Sym3::of(&(field + third.gradient))),
            _ => {
                let column = |axis: fn(Sym3<f64>) -> Vec3<f64>| {
                    each(there, |there| self.exact_gradient(there).map(axis))
                };
                let (diagonal, rest) =
                    (column(|g| Vec3::new(g.xx, g.yy, g.zz))?, column(|g| Vec3::new(g.xy, g.xz, g.yz))?);
                Ok(Sym3::new(diagonal.x, diagonal.y, diagonal.z, rest.x, rest.y, rest.z))
            }
        }
    }

    /// The expansion of the planet's field that reaches all these places.
    #[inline(always)]
    fn expansion<S: Real>(&self, at: Vec3<S>) -> Option<&Expansion> {
        // by hand: an iterator would be left out of line
        let [first, second] = &self.places;
        match first {
            Some(first) if first.reaches(at) => Some(first),
            _ => second.as_ref().filter(|second| second.reaches(at)),
        }
    }

    /// The planet's field at one place.
    fn field(&self, at: Vec3<f64>) -> Result<Vec3<f64>, GravityError> {
        if let Some(near) = self.expansion(at) {
            return Ok(near.value_at(at));
        }
        let Some(field) = &self.gravity.field else { return Ok(Vec3::zero()) };
        let rot_fi = &self.sky.rot_fi;
        Ok(rot_fi.transpose_mul(field.acceleration(&(*rot_fi * at).to_nalgebra())?.into()))
    }

    /// What it is more at one place than at the reference.
    fn difference_of_field(&self, offset: Vec3<f64>) -> Result<Vec3<f64>, GravityError> {
        let there = self.origin + offset;
        match self.expansion(self.origin).filter(|near| near.reaches(there)) {
            Some(near) => Ok(near.rise(offset)),
            None if is_near(self.origin, there) => {
                Ok(self.gradient_of_field(self.origin + offset * 0.5)? * offset)
            }
            None => Ok(self.field(there)? - self.field(self.origin)?),
        }
    }

    fn gradient_of_field(&self, at: Vec3<f64>) -> Result<Sym3<f64>, GravityError> {
        let Some(field) = &self.gravity.field else { return Ok(Sym3::default()) };
        let rot_fi = &self.sky.rot_fi;
        Ok(Expansion::of(field, *rot_fi * at)?.turned_back(rot_fi).gradient)
    }

    /// Field and third bodies.
    fn exact_gradient(&self, at: Vec3<f64>) -> Result<Sym3<f64>, GravityError> {
        let third = self.gravity.third_bodies_about(self.time, at)?.gradient;
        Ok(match self.expansion(at) {
            Some(near) => near.gradient,
            None => self.gradient_of_field(at)?,
        } + third)
    }

    /// The tide of third bodies: what they do at `from + offset` beyond what they do at `from`.
    ///
    /// At the planet's centre they do nothing: its own fall is that of the frame.
    fn third_bodies(&self, from: Vec3<f64>, offset: Vec3<f64>) -> Result<Vec3<f64>, GravityError> {
        self.gravity.third_bodies.iter().try_fold(Vec3::zero(), |sum, body| {
            Ok(sum + tide(body.mu(), &(from - Vec3::from(body.position(self.time)?)), offset).0)
        })
    }
}

/// One place after the other.
#[inline(never)]
fn each<S: Real, E>(places: Vec3<S>, find: impl Fn(Vec3<f64>) -> Result<Vec3<f64>, E>) -> Result<Vec3<S>, E> {
    const MOST_LANES: usize = 8;
    let mut found = [Vec3::zero(); MOST_LANES];
    for (i, to) in found.iter_mut().enumerate().take(S::LANES) {
        *to = find(places.lane(i))?;
    }
    Ok(Vec3::from_lanes(|i| found[i]))
}
