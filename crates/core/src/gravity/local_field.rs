//! Gravity field near a robot, expanded once per instant and evaluated at all bodies.

use super::expansion::{Expansion, is_near};
use super::sky::Sky;
use super::{Gravity, GravityError};
use crate::spatial::{Real, Sym3, Vec3};

/// Instant and positions for which the field is expanded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FieldPoint {
    /// Simulation time, s.
    pub(crate) time: f64,
    /// Position of the reference from the planet's centre, axes of `I`, m.
    pub(crate) r_ref: Vec3<f64>,
    /// Position of the robot's centre of mass relative to the reference, axes of `I`, m.
    pub(crate) com: Vec3<f64>,
    /// Distance that the robot travels through the field during the step being integrated, m.
    pub(crate) travel: f64,
}

/// Gravity near a robot at one instant, excluding the planet's point mass, axes of `I`.
///
/// Zonal fields in closed form are expanded about the robot. Other fields are expanded about the nearest
/// point of a grid fixed in the planet or, if the robot travels farther than the grid spacing during the
/// step, about the robot. If only differences from a nearby reference are required, the midpoint between
/// robot and reference replaces the robot. The result depends only on the instant and the step, so a run that
/// resumes from a checkpoint has bit-identical results.
#[derive(Clone, Debug)]
pub(crate) struct LocalField<'a> {
    gravity: &'a Gravity,
    time: f64,
    r_ref: Vec3<f64>,
    sky: &'a Sky,
    /// Expansion about the robot and, for differences over larger distances, a second one about the
    /// reference.
    expansions: [Option<Expansion>; 2],
}

impl Gravity {
    /// Computes the gravity near a robot, excluding the planet's point mass; `sky` is the result of
    /// [`Gravity::sky`] at the same instant.
    ///
    /// `tide_only` must be true if [`LocalField::difference`] will be called. If the reference is near, the
    /// field is then expanded about the midpoint between robot and reference, which makes the difference
    /// accurate to second order.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`] and the other errors of the field.
    pub(crate) fn local_field<'a>(
        &'a self,
        point: &FieldPoint,
        sky: &'a Sky,
        tide_only: bool,
    ) -> Result<LocalField<'a>, GravityError> {
        let FieldPoint { time, r_ref, com, travel } = *point;
        let mut local = LocalField { gravity: self, time, r_ref, sky, expansions: [None; 2] };
        if let Some(field) = &self.field {
            let fraction = if tide_only && is_near(com, Vec3::zero()) { 0.5 } else { 1.0 };
            let about = |at| self.expand_about(field, sky, at, travel);
            local.expansions[0] = Some(about(r_ref + com * fraction)?);
            if tide_only && local.expansion(r_ref).is_none() {
                local.expansions[1] = Some(about(r_ref)?);
            }
        }
        Ok(local)
    }
}

impl LocalField<'_> {
    /// Returns `g(r_ref + ρ)`, m/s², where `offset` is the position `ρ` relative to the reference, m, with
    /// one body per lane.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`], and the errors of third bodies.
    #[inline(always)]
    pub(crate) fn acceleration<S: Real>(&self, offset: Vec3<S>) -> Result<Vec3<S>, GravityError> {
        let there = Vec3::of(&self.r_ref) + offset;
        let field = match self.expansion(there) {
            Some(near) => near.value_at(there),
            None => lanes(each(there, |there| self.field(there))?),
        };
        let third = match &self.sky.third {
            Some(third) if third.covers(there) => third.value_at(there),
            Some(_) => {
                lanes(each(there, |there| self.gravity.tide_of_third_bodies(self.time, Vec3::zero(), there))?)
            }
            None => Vec3::zero(),
        };
        Ok(field + third)
    }

    /// Returns `g(r_ref + ρ) - g(r_ref)`, m/s², with `ρ` (`offset`) as in [`Self::acceleration`]. If the
    /// expansion covers the bodies, the result is `G ρ` with the gradient `G` at the centre of the expansion.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`], and the errors of third bodies.
    #[inline(always)]
    pub(crate) fn difference<S: Real>(&self, offset: Vec3<S>) -> Result<Vec3<S>, GravityError> {
        let there = Vec3::of(&self.r_ref) + offset;
        let field = match self.expansion(self.r_ref).filter(|near| near.covers(there)) {
            Some(near) => near.difference(offset),
            None => lanes(each(offset, |offset| self.field_difference(offset))?),
        };
        let third = match &self.sky.third {
            Some(third) if third.covers(there) => third.difference(offset),
            Some(_) => lanes(each(offset, |offset| {
                self.gravity.tide_of_third_bodies(self.time, self.r_ref, offset)
            })?),
            None => Vec3::zero(),
        };
        Ok(field + third)
    }

    /// Returns the gradient `∂g/∂r` at `r_ref + ρ`, 1/s², with `ρ` (`offset`) as in [`Self::acceleration`].
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`], and the errors of third bodies.
    #[inline(always)]
    pub(crate) fn gradient<S: Real>(&self, offset: Vec3<S>) -> Result<Sym3<S>, GravityError> {
        let there = Vec3::of(&self.r_ref) + offset;
        let expanded = self.expansion(there).map(|near| near.gradient);
        let field = if self.gravity.field.is_none() { Some(Sym3::default()) } else { expanded };
        match (field, &self.sky.third) {
            (Some(field), None) => Ok(Sym3::of(&field)),
            (Some(field), Some(third)) if third.covers(there) => Ok(Sym3::of(&(field + third.gradient))),
            _ => {
                let g = each(there, |there| self.gradient_at(there))?;
                let number = |of: fn(&Sym3<f64>) -> f64| S::from_lanes(|i| of(&g[i]));
                let (xx, yy, zz) = (number(|g| g.xx), number(|g| g.yy), number(|g| g.zz));
                Ok(Sym3::new(xx, yy, zz, number(|g| g.xy), number(|g| g.xz), number(|g| g.yz)))
            }
        }
    }

    /// Returns the expansion of the planet's field that covers the positions in all lanes; `None` if no
    /// expansion covers them.
    #[inline(always)]
    fn expansion<S: Real>(&self, at: Vec3<S>) -> Option<&Expansion> {
        // no loop, because an iterator would not be inlined
        let [first, second] = &self.expansions;
        match first {
            Some(first) if first.covers(at) => Some(first),
            _ => second.as_ref().filter(|second| second.covers(at)),
        }
    }

    /// Returns the planet's field, m/s², at the position `at` from the planet's centre, axes of `I`, m.
    fn field(&self, at: Vec3<f64>) -> Result<Vec3<f64>, GravityError> {
        if let Some(near) = self.expansion(at) {
            return Ok(near.value_at(at));
        }
        let Some(field) = &self.gravity.field else { return Ok(Vec3::zero()) };
        let rot_fi = &self.sky.rot_fi;
        Ok(rot_fi.transpose_mul(field.acceleration(&(*rot_fi * at).to_nalgebra())?.into()))
    }

    /// Returns the planet's field at `offset` from the reference, m, less the field at the reference, m/s².
    fn field_difference(&self, offset: Vec3<f64>) -> Result<Vec3<f64>, GravityError> {
        let there = self.r_ref + offset;
        match self.expansion(self.r_ref).filter(|near| near.covers(there)) {
            Some(near) => Ok(near.difference(offset)),
            None if is_near(self.r_ref, there) => {
                Ok(self.field_gradient(self.r_ref + offset * 0.5)? * offset)
            }
            None => Ok(self.field(there)? - self.field(self.r_ref)?),
        }
    }

    /// Returns the gradient of the planet's field, 1/s², at the position `at` from the planet's centre, axes
    /// of `I`, m.
    fn field_gradient(&self, at: Vec3<f64>) -> Result<Sym3<f64>, GravityError> {
        let Some(field) = &self.gravity.field else { return Ok(Sym3::default()) };
        let rot_fi = &self.sky.rot_fi;
        Ok(Expansion::of(field, *rot_fi * at)?.rotated_back(rot_fi).gradient)
    }

    /// Returns the sum of the gradients of the planet's field and of the third bodies, 1/s², at the position
    /// `at` from the planet's centre, axes of `I`, m.
    fn gradient_at(&self, at: Vec3<f64>) -> Result<Sym3<f64>, GravityError> {
        let third = self.gravity.third_bodies_about(self.time, at)?.gradient;
        Ok(match self.expansion(at) {
            Some(near) => near.gradient,
            None => self.field_gradient(at)?,
        } + third)
    }
}

/// Number of lanes of the widest SIMD type.
const MAX_LANES: usize = 8;

/// Calls `find` for the position in each lane and gathers the results.
#[inline(never)]
fn each<S: Real, T: Copy + Default>(
    positions: Vec3<S>,
    find: impl Fn(Vec3<f64>) -> Result<T, GravityError>,
) -> Result<[T; MAX_LANES], GravityError> {
    let mut found = [T::default(); MAX_LANES];
    for (i, to) in found.iter_mut().enumerate().take(S::LANES) {
        *to = find(positions.lane(i))?;
    }
    Ok(found)
}

/// Returns a vector of SIMD numbers whose lane `i` holds `vectors[i]`.
#[inline(always)]
fn lanes<S: Real>(vectors: [Vec3<f64>; MAX_LANES]) -> Vec3<S> {
    Vec3::from_lanes(|i| vectors[i])
}
