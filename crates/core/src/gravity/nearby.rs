//! A planet's field near a robot: evaluated once, expanded to the bodies.

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
/// a function of the two stations alone, so that a run that goes on from a checkpoint finds the same bits.
#[derive(Clone, Debug)]
pub struct Nearby<'a> {
    field: &'a GravityField,
    rot_fi: Matrix3<f64>,
    origin: Vector3<f64>,
    /// The field about the robot, and about the reference where that lies elsewhere and is asked for.
    places: [Option<Expansion>; 2],
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

/// The last expansions, `F` axes: of functions of the place alone, so that it does not matter who asked for them.
#[derive(Debug, Default)]
pub(super) struct Memo(Mutex<[Option<(Place, Expansion)>; 4]>);

impl Clone for Memo {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Memo {
    fn find(&self, place: &Place) -> Option<Expansion> {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        known.iter().flatten().find(|(known, _)| known == place).map(|(_, expansion)| *expansion)
    }

    fn keep(&self, place: Place, expansion: Expansion) {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        known.rotate_right(1);
        known[0] = Some((place, expansion));
    }
}

impl Gravity {
    /// The planet's field around a robot that is at `now` and was at `start` when its step began; none for a point mass.
    ///
    /// `differs` says whether [`Nearby::difference`] will be asked for: the field is then expanded half way to a
    /// reference that is near, which makes the mean difference right to second order.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    pub fn nearby(
        &self,
        now: &Station,
        start: &Station,
        differs: bool,
    ) -> Result<Option<Nearby<'_>>, GravityError> {
        let Some(field) = self.field.as_ref().map(Arc::as_ref) else { return Ok(None) };
        let rot_fi = self.rot_fi(now.time).unwrap_or_else(Matrix3::identity);
        let mut nearby = Nearby { field, rot_fi, origin: now.origin, places: [None; 2] };
        let share = if differs && now.com.norm_squared() <= REACH * REACH { 0.5 } else { 1.0 };
        let about = |share: f64| {
            let [now, start] = [now, start].map(|s| (s.time, s.origin + s.com * share));
            self.about(field, &rot_fi, now, start)
        };
        nearby.places[0] = Some(about(share)?);
        if differs && nearby.expansion(&nearby.origin).is_none() {
            nearby.places[1] = Some(about(0.0)?);
        }
        Ok(Some(nearby))
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
    pub fn acceleration(&self, offset: &Vector3<f64>) -> Result<Vector3<f64>, GravityError> {
        self.value(&(self.origin + offset))
    }

    /// `g(R + ρ) - g(R)`, m/s², without cancellation for near bodies: `G ρ`, with `G` from the expansion or half way.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    pub fn difference(&self, offset: &Vector3<f64>) -> Result<Vector3<f64>, GravityError> {
        let there = self.origin + offset;
        let shared = self.expansion(&self.origin).filter(|expansion| is_near(&expansion.at, &there, 1.0));
        match shared {
            Some(expansion) => Ok(expansion.gradient * offset),
            None if is_near(&self.origin, &there, 1.0) => {
                Ok(self.exact(&(self.origin + offset * 0.5))?.gradient * offset)
            }
            None => Ok(self.value(&there)? - self.value(&self.origin)?),
        }
    }

    /// `∂g/∂r` at `R + ρ`, 1/s².
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    pub fn gradient(&self, offset: &Vector3<f64>) -> Result<Matrix3<f64>, GravityError> {
        let there = self.origin + offset;
        self.expansion(&there)
            .map_or_else(|| self.exact(&there).map(|exact| exact.gradient), |near| Ok(near.gradient))
    }

    fn value(&self, at: &Vector3<f64>) -> Result<Vector3<f64>, GravityError> {
        match self.expansion(at) {
            Some(expansion) => Ok(expansion.value + expansion.gradient * (at - expansion.at)),
            None => Ok(self.rot_fi.tr_mul(&self.field.acceleration(&(self.rot_fi * at))?)),
        }
    }

    fn exact(&self, at: &Vector3<f64>) -> Result<Expansion, GravityError> {
        Ok(Expansion::of(self.field, self.rot_fi * at)?.turned_back(&self.rot_fi))
    }

    /// The expansion that reaches a place.
    fn expansion(&self, at: &Vector3<f64>) -> Option<&Expansion> {
        self.places.iter().flatten().find(|expansion| is_near(&expansion.at, at, 1.0))
    }
}

/// Whether two places are within this share of the reach of each other.
fn is_near(a: &Vector3<f64>, b: &Vector3<f64>, share: f64) -> bool {
    (a - b).norm_squared() <= (share * REACH) * (share * REACH)
}
