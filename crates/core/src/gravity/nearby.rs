//! A planet's field near a robot: evaluated once, expanded to the bodies.

use super::point_mass::{point_mass_gradient, tide};
use super::{Gravity, GravityError, GravityField};
use nalgebra::{Matrix3, Vector3};
use std::sync::{Arc, Mutex, PoisonError};

/// Distance over which a field is taken for linear, m.
///
/// What that leaves out is `½ |∂²g| d²`: 1.5e-13 m/s² over 15 m in a low orbit (EGM2008 36 × 36, measured in
/// `tests/gravity_nearby.rs`), a hundred-billionth of the field without its point mass. A step of 1 ms takes 7.6 m there.
const REACH: f64 = 20.0;

/// Where and when: a robot beside its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Instant, s of simulation.
    pub time: f64,
    /// Position of the reference from the planet's centre, axes of `I`, m.
    pub origin: Vector3<f64>,
    /// Centre of mass of the robot from there, m.
    pub com: Vector3<f64>,
}

/// The field without its point mass, around the bodies of a robot at one instant, axes of `I`.
///
/// A cheap field is expanded about the robot as it stands. Others are expanded about it as it stood when the step
/// began, in axes fixed in the planet, and where that is too far, as it stands:
/// a function of the two stations alone, so that a run that goes on from a checkpoint finds the same bits. Third bodies
/// are expanded about the robot as it stands: over the same distance that leaves out 5e-8 of the Moon's tide.
#[derive(Clone, Debug)]
pub struct Nearby<'a> {
    gravity: &'a Gravity,
    time: f64,
    origin: Vector3<f64>,
    local: Local,
}

/// What is expanded, and about where.
#[derive(Clone, Copy, Debug)]
struct Local {
    rot_fi: Matrix3<f64>,
    /// The planet's field about the robot, and about the reference where that lies elsewhere and is asked for.
    places: [Option<Expansion>; 2],
    /// Third bodies, about the robot.
    third: Option<Expansion>,
}

/// `g(x) = g₀ + G₀ (x - x₀)`
#[derive(Clone, Copy, Debug)]
struct Expansion {
    at: Vector3<f64>,
    value: Vector3<f64>,
    gradient: Matrix3<f64>,
}

impl Expansion {
    fn of(field: &GravityField, at: Vector3<f64>) -> Result<Self, GravityError> {
        let (value, gradient) = field.gradient(&at)?;
        Ok(Self { at, value, gradient })
    }

    /// Whether it is good at a place.
    fn reaches(&self, place: &Vector3<f64>) -> bool {
        is_near(&self.at, place, 1.0)
    }

    /// In the axes that `rot` takes to those of this one.
    fn turned_back(&self, rot: &Matrix3<f64>) -> Self {
        Self {
            at: rot.tr_mul(&self.at),
            value: rot.tr_mul(&self.value),
            gradient: rot.tr_mul(&self.gradient) * rot,
        }
    }
}

/// When and where, axes of `I`.
type Place = (f64, Vector3<f64>);

/// What was expanded last: functions of place and time alone, so that it does not matter who asked for them.
#[derive(Debug, Default)]
pub(super) struct Memo {
    /// The planet's field, `F` axes.
    fields: Mutex<[Option<(Place, Expansion)>; 4]>,
    /// All there was, for the effects that look one after the other.
    last: Mutex<Option<([Station; 2], bool, Local)>>,
}

impl Clone for Memo {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Memo {
    fn find(&self, place: &Place) -> Option<Expansion> {
        let known = self.fields.lock().unwrap_or_else(PoisonError::into_inner);
        known.iter().flatten().find(|(known, _)| known == place).map(|(_, expansion)| *expansion)
    }

    fn keep(&self, place: Place, expansion: Expansion) {
        let mut known = self.fields.lock().unwrap_or_else(PoisonError::into_inner);
        known.rotate_right(1);
        known[0] = Some((place, expansion));
    }
}

impl Gravity {
    /// All but the planet's point mass around a robot that is at `now` and was at `start` when its step began; none where
    /// that is all there is.
    ///
    /// `differs` says whether [`Nearby::difference`] will be asked for: what is expanded is then expanded half way to a
    /// reference that is near, which makes the mean difference right to second order.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`], and what a third body says.
    pub fn nearby(
        &self,
        now: &Station,
        start: &Station,
        differs: bool,
    ) -> Result<Option<Nearby<'_>>, GravityError> {
        if self.is_point_mass() {
            return Ok(None);
        }
        let stations = [*now, *start];
        let mut last = self.memo.last.lock().unwrap_or_else(PoisonError::into_inner);
        let known = last.filter(|(known, differed, _)| *known == stations && *differed == differs);
        let local = match known {
            Some((_, _, local)) => local,
            None => self.local(now, start, differs)?,
        };
        *last = Some((stations, differs, local));
        Ok(Some(Nearby { gravity: self, time: now.time, origin: now.origin, local }))
    }

    fn local(&self, now: &Station, start: &Station, differs: bool) -> Result<Local, GravityError> {
        let share = if differs && now.com.norm_squared() <= REACH * REACH { 0.5 } else { 1.0 };
        let rot_fi = self.rot_fi(now.time).unwrap_or_else(Matrix3::identity);
        let mut local = Local { rot_fi, places: [None; 2], third: None };
        if let Some(field) = &self.field {
            let about = |share: f64| {
                let [now, start] = [now, start].map(|s| (s.time, s.origin + s.com * share));
                self.about(field, &rot_fi, now, start)
            };
            local.places[0] = Some(about(share)?);
            if differs && local.expansion(&now.origin).is_none() {
                local.places[1] = Some(about(0.0)?);
            }
        }
        if !self.third_bodies.is_empty() {
            local.third = Some(self.third_bodies_about(now.time, now.origin + now.com * share)?);
        }
        Ok(local)
    }

    /// What third bodies do at a place and around it.
    fn third_bodies_about(&self, t: f64, at: Vector3<f64>) -> Result<Expansion, GravityError> {
        let mut about = Expansion { at, value: Vector3::zeros(), gradient: Matrix3::zeros() };
        for body in &self.third_bodies {
            let place = body.position(t)?;
            about.value += tide(body.mu(), &-place, &at).0;
            about.gradient += point_mass_gradient(body.mu(), &(at - place));
        }
        Ok(about)
    }

    /// The field about `start` if that is near `now`, seen from the turned planet, else about `now`; axes of `I`.
    fn about(
        &self,
        field: &GravityField,
        rot_fi: &Matrix3<f64>,
        now: Place,
        start: Place,
    ) -> Result<Expansion, GravityError> {
        let here = rot_fi * now.1;
        if field.is_closed() {
            return Ok(Expansion::of(field, here)?.turned_back(rot_fi));
        }
        let begun = self.memo.find(&start);
        let at = begun.map_or_else(
            || self.rot_fi(start.0).unwrap_or_else(Matrix3::identity) * start.1,
            |expansion| expansion.at,
        );
        let (place, at, known) =
            if is_near(&at, &here, 0.5) { (start, at, begun) } else { (now, here, self.memo.find(&now)) };
        let expansion = match known {
            Some(expansion) => expansion,
            None => {
                let expansion = Expansion::of(field, at)?;
                self.memo.keep(place, expansion);
                expansion
            }
        };
        Ok(expansion.turned_back(rot_fi))
    }
}

impl Nearby<'_> {
    /// `g(R + ρ)`, m/s²; `offset` is `ρ`, from the reference.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    #[inline]
    pub fn acceleration(&self, offset: &Vector3<f64>) -> Result<Vector3<f64>, GravityError> {
        let there = self.origin + offset;
        Ok(self.field(&there)? + self.third_bodies(&Vector3::zeros(), &there)?)
    }

    /// `g(R + ρ) - g(R)`, m/s², without cancellation for near bodies: `G ρ`, with `G` from the expansion or half way.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    #[inline]
    pub fn difference(&self, offset: &Vector3<f64>) -> Result<Vector3<f64>, GravityError> {
        let there = self.origin + offset;
        let shared = self.local.expansion(&self.origin).filter(|near| near.reaches(&there));
        let field = match shared {
            Some(expansion) => expansion.gradient * offset,
            None if is_near(&self.origin, &there, 1.0) => {
                self.exact_gradient(&(self.origin + offset * 0.5))? * offset
            }
            None => self.field(&there)? - self.field(&self.origin)?,
        };
        Ok(field + self.third_bodies(&self.origin, offset)?)
    }

    /// `∂g/∂r` at `R + ρ`, 1/s².
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    #[inline]
    pub fn gradient(&self, offset: &Vector3<f64>) -> Result<Matrix3<f64>, GravityError> {
        let there = self.origin + offset;
        let field = match self.local.expansion(&there) {
            Some(near) => near.gradient,
            None => self.exact_gradient(&there)?,
        };
        Ok(field
            + match self.local.third.filter(|third| third.reaches(&there)) {
                Some(third) => third.gradient,
                None => self.gravity.third_bodies_about(self.time, there)?.gradient,
            })
    }

    /// The planet's field.
    fn field(&self, at: &Vector3<f64>) -> Result<Vector3<f64>, GravityError> {
        if let Some(near) = self.local.expansion(at) {
            return Ok(near.value + near.gradient * (at - near.at));
        }
        let rot_fi = &self.local.rot_fi;
        let exact = |field: &Arc<GravityField>| Ok(rot_fi.tr_mul(&field.acceleration(&(rot_fi * at))?));
        self.gravity.field.as_ref().map_or_else(|| Ok(Vector3::zeros()), exact)
    }

    fn exact_gradient(&self, at: &Vector3<f64>) -> Result<Matrix3<f64>, GravityError> {
        let rot_fi = &self.local.rot_fi;
        let Some(field) = &self.gravity.field else { return Ok(Matrix3::zeros()) };
        Ok(Expansion::of(field, rot_fi * at)?.turned_back(rot_fi).gradient)
    }

    /// The tide of third bodies: what they do at `from + offset` beyond what they do at `from`.
    ///
    /// At the planet's centre they do nothing: its own fall is that of the frame.
    fn third_bodies(&self, from: &Vector3<f64>, offset: &Vector3<f64>) -> Result<Vector3<f64>, GravityError> {
        let Some(third) = &self.local.third else { return Ok(Vector3::zeros()) };
        let there = from + offset;
        if third.reaches(&there) {
            if third.reaches(from) {
                return Ok(third.gradient * offset);
            }
            if *from == Vector3::zeros() {
                return Ok(third.value + third.gradient * (there - third.at));
            }
        }
        self.gravity.third_bodies.iter().try_fold(Vector3::zeros(), |sum, body| {
            Ok(sum + tide(body.mu(), &(from - body.position(self.time)?), offset).0)
        })
    }
}

impl Local {
    /// The expansion of the planet's field that reaches a place.
    fn expansion(&self, at: &Vector3<f64>) -> Option<&Expansion> {
        self.places.iter().flatten().find(|expansion| expansion.reaches(at))
    }
}

/// Whether two places are within this share of the reach of each other.
fn is_near(a: &Vector3<f64>, b: &Vector3<f64>, share: f64) -> bool {
    (a - b).norm_squared() <= (share * REACH) * (share * REACH)
}
