//! A planet's field near a robot: evaluated once, expanded to the bodies.

use super::{Gravity, GravityError, GravityField};
use nalgebra::{Matrix3, Vector3};
use std::sync::{Arc, Mutex, PoisonError};

/// Distance over which a field is taken for linear, m.
///
/// What that leaves out is `½ |∂²g| d²`: 2e-12 m/s² over 20 m in a low orbit (J2, measured with EGM2008 36 × 36 in
/// `tests/gravity_nearby.rs`), a ten-billionth of the field without its point mass. A step of 1 ms takes a low orbit 7.6 m.
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

/// The field without its point mass, around the bodies of a robot at one instant.
///
/// Fields that are cheap are evaluated at every body. Others are expanded about the robot as it stood when the step
/// began, in axes fixed in the planet, and where that is too far, about the robot as it stands:
/// a function of the two stations alone, so that a run that goes on from a checkpoint finds the same bits.
#[derive(Clone, Debug)]
pub struct Nearby<'a> {
    field: &'a GravityField,
    rot_fi: Matrix3<f64>,
    /// The reference, `F` axes, m.
    origin: Vector3<f64>,
    /// The field about the robot, and about the reference where that lies elsewhere and is asked for.
    places: [Option<Expansion>; 2],
}

/// `g(x) = g₀ + G₀ (x - x₀)`, `F` axes.
#[derive(Clone, Copy, Debug)]
struct Expansion {
    at: Vector3<f64>,
    value: Vector3<f64>,
    gradient: Matrix3<f64>,
}

/// The last expansions: of functions of the place alone, so that it does not matter who asked for them.
#[derive(Debug, Default)]
pub(super) struct Memo(Mutex<[Option<Expansion>; 4]>);

impl Clone for Memo {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Memo {
    fn about(&self, field: &GravityField, at: Vector3<f64>) -> Result<Expansion, GravityError> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(expansion) = known.iter().flatten().find(|expansion| expansion.at == at) {
            return Ok(*expansion);
        }
        let (value, gradient) = field.gradient(&at)?;
        let expansion = Expansion { at, value, gradient };
        known.rotate_right(1);
        known[0] = Some(expansion);
        Ok(expansion)
    }
}

impl Gravity {
    /// The planet's field around a robot that is at `now` and was at `start` when its step began; none for a point mass.
    ///
    /// `differs` says whether [`Nearby::difference`] will be asked for.
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
        let turned = |t: f64| self.rot_fi(t).unwrap_or_else(Matrix3::identity);
        let rot_fi = turned(now.time);
        let mut nearby = Nearby { field, rot_fi, origin: rot_fi * now.origin, places: [None; 2] };
        if field.is_closed() {
            return Ok(Some(nearby));
        }
        let rot_then = turned(start.time);
        let about = |now: Vector3<f64>, then: Vector3<f64>| {
            let (now, then) = (rot_fi * now, rot_then * then);
            self.memo.about(field, if is_near(&now, &then, 0.5) { then } else { now })
        };
        nearby.places[0] = Some(about(now.origin + now.com, start.origin + start.com)?);
        if differs && nearby.expansion(&nearby.origin).is_none() {
            nearby.places[1] = Some(about(now.origin, start.origin)?);
        }
        Ok(Some(nearby))
    }
}

impl Nearby<'_> {
    /// `g(R + ρ)`, axes of `I`, m/s²; `offset` is `ρ`, from the reference.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    pub fn acceleration(&self, offset: &Vector3<f64>) -> Result<Vector3<f64>, GravityError> {
        let g = self.value(&(self.origin + self.rot_fi * offset))?;
        Ok(self.rot_fi.tr_mul(&g))
    }

    /// `g(R + ρ) - g(R)`, axes of `I`, m/s², without cancellation for near bodies: `G ρ`, with `G` from the expansion
    /// or half way.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    pub fn difference(&self, offset: &Vector3<f64>) -> Result<Vector3<f64>, GravityError> {
        let step = self.rot_fi * offset;
        let there = self.origin + step;
        let shared = self.expansion(&self.origin).filter(|expansion| is_near(&expansion.at, &there, 1.0));
        let g = match shared {
            Some(expansion) => expansion.gradient * step,
            None if is_near(&self.origin, &there, 1.0) => {
                self.field.gradient(&(self.origin + step * 0.5))?.1 * step
            }
            None => self.value(&there)? - self.value(&self.origin)?,
        };
        Ok(self.rot_fi.tr_mul(&g))
    }

    /// `∂g/∂r` at `R + ρ`, axes of `I`, 1/s².
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`].
    pub fn gradient(&self, offset: &Vector3<f64>) -> Result<Matrix3<f64>, GravityError> {
        let there = self.origin + self.rot_fi * offset;
        let tensor = match self.expansion(&there) {
            Some(expansion) => expansion.gradient,
            None => self.field.gradient(&there)?.1,
        };
        Ok(self.rot_fi.tr_mul(&tensor) * self.rot_fi)
    }

    fn value(&self, at: &Vector3<f64>) -> Result<Vector3<f64>, GravityError> {
        match self.expansion(at) {
            Some(expansion) => Ok(expansion.value + expansion.gradient * (at - expansion.at)),
            None => self.field.acceleration(at),
        }
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
