//! Checks that the run and its reference orbit use the same gravity model.

use super::{Gravity, GravityError, ThirdBody};
use std::sync::Arc;

impl Gravity {
    /// Returns the gravity of a run whose environment has the gravity `self` and whose reference orbit has
    /// the gravity `reference`.
    ///
    /// If both are equal, the result is `reference`. If `reference` is only a point mass, `self` may differ
    /// from it and is the result; the reference orbit is then not in free fall.
    ///
    /// # Errors
    /// [`GravityError::OtherGravity`] if the two differ and `reference` is more than a point mass.
    pub fn shared_with(self, reference: &Arc<Self>) -> Result<Arc<Self>, GravityError> {
        match self.differs_from(reference) {
            None => Ok(Arc::clone(reference)),
            Some(_) if reference.is_point_mass() => Ok(Arc::new(self)),
            Some(what) => Err(GravityError::OtherGravity { what }),
        }
    }

    /// Returns the name of the first part in which two gravity models differ; `None` if the models are equal.
    fn differs_from(&self, other: &Self) -> Option<&'static str> {
        let is_same = |(a, b): (&Arc<dyn ThirdBody>, &Arc<dyn ThirdBody>)| {
            a.name() == b.name() && a.mu() == b.mu() && a.position(0.0) == b.position(0.0)
        };
        let sorted = |gravity: &Self| {
            let mut bodies = gravity.third_bodies.clone();
            bodies.sort_by(|a, b| a.name().cmp(b.name()));
            bodies
        };
        let (own, others) = (sorted(self), sorted(other));
        if self.mu != other.mu || self.field != other.field {
            Some("the planet's mu or field")
        } else if self.field.is_some() && self.earth != other.earth {
            Some("the Earth (its epoch or rotation model)")
        } else if own.len() != others.len() || !own.iter().zip(&others).all(is_same) {
            Some("the third bodies")
        } else {
            None
        }
    }
}
