//! Whether what is said twice of gravity is the same.

use super::{Gravity, GravityError, ThirdBody};
use std::sync::Arc;

impl Gravity {
    /// The gravity of a run that is told this one and whose reference obeys `reference`: that very one where they are alike.
    ///
    /// A reference that obeys a point mass alone does not fall as the robot does, and need not.
    ///
    /// # Errors
    /// [`GravityError::OtherGravity`] where the reference obeys a field or third bodies, and others than these.
    pub fn shared_with(self, reference: &Arc<Self>) -> Result<Arc<Self>, GravityError> {
        match self.differs_from(reference) {
            None => Ok(Arc::clone(reference)),
            Some(_) if reference.is_point_mass() => Ok(Arc::new(self)),
            Some(what) => Err(GravityError::OtherGravity { what }),
        }
    }

    /// What of it differs, if anything does.
    fn differs_from(&self, other: &Self) -> Option<&'static str> {
        let alike = |(a, b): (&Arc<dyn ThirdBody>, &Arc<dyn ThirdBody>)| {
            a.name() == b.name() && a.mu() == b.mu() && a.position(0.0) == b.position(0.0)
        };
        let sorted = |gravity: &Self| {
            let mut bodies = gravity.third_bodies.clone();
            bodies.sort_by(|a, b| a.name().cmp(b.name()));
            bodies
        };
        let (own, others) = (sorted(self), sorted(other));
        if self.mu != other.mu || self.field != other.field {
            Some("the planet's field")
        } else if self.field.is_some() && self.earth != other.earth {
            Some("the earth (its epoch or how it turns)")
        } else if own.len() != others.len() || !own.iter().zip(&others).all(alike) {
            Some("third bodies")
        } else {
            None
        }
    }
}
