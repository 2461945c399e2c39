//! The field near a robot: evaluated once, expanded to the bodies.

use super::expansion::{Expansion, is_near};
use super::sky::Sky;
use super::{Gravity, GravityError};
use crate::spatial::{Real, Sym3, Vec3};

/// Where and when: a robot beside its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Station {
    /// Instant, s of simulation.
    pub(crate) time: f64,
    /// Position of the reference from the planet's centre, axes of `I`, m.
    pub(crate) origin: Vec3<f64>,
    /// Centre of mass of the robot from there, m.
    pub(crate) com: Vec3<f64>,
    /// Way through the planet's field in the step being integrated, m.
    pub(crate) travel: f64,
}

/// The field without its point mass, around the bodies of a robot at one instant, axes of `I`.
///
/// A cheap field is expanded about the robot as it stands; others about the next point of a grid fixed in the planet, or,
/// for steps that lead from point to point, about the robot as it stands. All of it is a function of the instant and of
/// the step: a run that goes on from a checkpoint finds the same bits.
#[derive(Clone, Debug)]
pub(crate) struct Nearby<'a> {
    gravity: &'a Gravity,
    time: f64,
    origin: Vec3<f64>,
    sky: &'a Sky,
    /// The planet's field about the robot, and about the reference where that lies elsewhere and is asked for.
    places: [Option<Expansion>; 2],
}

impl Gravity {
    /// All but the planet's point mass around a robot, under the [sky](Self::sky) of that instant and origin.
    ///
    /// `differs` says whether [`Nearby::difference`] will be asked for: what is expanded is then expanded half way to a
    /// reference that is near, which makes the mean difference right to second order.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    pub(crate) fn nearby<'a>(
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
}

impl Nearby<'_> {
    /// `g(R + ρ)`, m/s²; `offset` is `ρ`, from the reference, of a body in each lane.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    #[inline(always)]
    pub(crate) fn acceleration<S: Real>(&self, offset: Vec3<S>) -> Result<Vec3<S>, GravityError> {
        let there = Vec3::of(&self.origin) + offset;
        let field = match self.expansion(there) {
            Some(near) => near.value_at(there),
            None => lanes(each(there, |there| self.field(there))?),
        };
        let third = match &self.sky.third {
            Some(third) if third.reaches(there) => third.value_at(there),
            Some(_) => {
                lanes(each(there, |there| self.gravity.tide_of_third_bodies(self.time, Vec3::zero(), there))?)
            }
            None => Vec3::zero(),
        };
        Ok(field + third)
    }

    /// `g(R + ρ) - g(R)`, m/s², without cancellation for near bodies: `G ρ`, with `G` from the expansion or half way.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    #[inline(always)]
    pub(crate) fn difference<S: Real>(&self, offset: Vec3<S>) -> Result<Vec3<S>, GravityError> {
        let there = Vec3::of(&self.origin) + offset;
        let field = match self.expansion(self.origin).filter(|near| near.reaches(there)) {
            Some(near) => near.rise(offset),
            None => lanes(each(offset, |offset| self.difference_of_field(offset))?),
        };
        let third = match &self.sky.third {
            Some(third) if third.reaches(there) => third.rise(offset),
            Some(_) => lanes(each(offset, |offset| {
                self.gravity.tide_of_third_bodies(self.time, self.origin, offset)
            })?),
            None => Vec3::zero(),
        };
        Ok(field + third)
    }

    /// `∂g/∂r` at `R + ρ`, 1/s².
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    #[inline(always)]
    pub(crate) fn gradient<S: Real>(&self, offset: Vec3<S>) -> Result<Sym3<S>, GravityError> {
        let there = Vec3::of(&self.origin) + offset;
        let known = self.expansion(there).map(|near| near.gradient);
        let field = if self.gravity.field.is_none() { Some(Sym3::default()) } else { known };
        match (field, &self.sky.third) {
            (Some(field), None) => Ok(Sym3::of(&field)),
            (Some(field), Some(third)) if third.reaches(there) => Ok(Sym3::of(&(field + third.gradient))),
            _ => {
                let g = each(there, |there| self.exact_gradient(there))?;
                let number = |of: fn(&Sym3<f64>) -> f64| S::from_lanes(|i| of(&g[i]));
                let (xx, yy, zz) = (number(|g| g.xx), number(|g| g.yy), number(|g| g.zz));
                Ok(Sym3::new(xx, yy, zz, number(|g| g.xy), number(|g| g.xz), number(|g| g.yz)))
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
}

/// Most places side by side.
const MOST_LANES: usize = 8;

/// One place after the other.
#[inline(never)]
fn each<S: Real, T: Copy + Default>(
    places: Vec3<S>,
    find: impl Fn(Vec3<f64>) -> Result<T, GravityError>,
) -> Result<[T; MOST_LANES], GravityError> {
    let mut found = [T::default(); MOST_LANES];
    for (i, to) in found.iter_mut().enumerate().take(S::LANES) {
        *to = find(places.lane(i))?;
    }
    Ok(found)
}

/// A vector of each place.
#[inline(always)]
fn lanes<S: Real>(vectors: [Vec3<f64>; MOST_LANES]) -> Vec3<S> {
    Vec3::from_lanes(|i| vectors[i])
}
