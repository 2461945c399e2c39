//! A robot with another mass, centre of mass or inertia of one link.

use super::builder::ModelBuilder;
use super::description::{Inertial, Link};
use super::error::ModelError;
use super::tree::Model;
use nalgebra::{Matrix3, Vector3};

/// New values for a link; what is `None` stays as it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinkChange {
    /// Mass, kg.
    pub mass: Option<f64>,
    /// Centre of mass in link axes, m.
    pub com: Option<Vector3<f64>>,
    /// Inertia about the centre of mass in link axes, kg m².
    pub inertia: Option<Matrix3<f64>>,
}

impl LinkChange {
    /// Changes a link. Where it had no mass its centre of mass is its origin, its inertia zero.
    ///
    /// # Errors
    /// [`ModelError::ChangeWithoutMass`] for a link without mass that is given none.
    pub fn apply(&self, link: &mut Link) -> Result<(), ModelError> {
        let old = link.inertial.take();
        let nothing = || Inertial { mass: 0.0, com: Vector3::zeros(), inertia: Matrix3::zeros() };
        if old.is_none() && self.mass.is_none() {
            return Err(ModelError::ChangeWithoutMass { link: link.name.clone() });
        }
        let old = old.unwrap_or_else(nothing);
        link.inertial = Some(Inertial {
            mass: self.mass.unwrap_or(old.mass),
            com: self.com.unwrap_or(old.com),
            inertia: self.inertia.unwrap_or(old.inertia),
        });
        Ok(())
    }
}

impl Model {
    /// The same robot with a link changed.
    ///
    /// # Errors
    /// No such link, or values that no robot can have.
    pub fn with_link(&self, name: &str, change: &LinkChange) -> Result<Self, ModelError> {
        let mut description = self.description().clone();
        let candidates = || self.description().links.iter().map(|link| link.name.clone()).collect();
        let link = description.links.iter_mut().find(|link| link.name == name).ok_or_else(|| {
            ModelError::UnknownName { what: "link", name: name.to_owned(), candidates: candidates() }
        })?;
        change.apply(link)?;
        let mut builder = ModelBuilder::from_description(description)?;
        builder.keep_notes(self);
        builder.build()
    }
}
