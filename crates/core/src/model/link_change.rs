//! A robot with another mass, centre of mass or inertia of one link.

use super::builder::ModelBuilder;
use super::description::{Inertial, Link};
use super::error::ModelError;
use super::tree::Model;
use nalgebra::{Matrix3, Vector3};

/// New values for a link; what is `None` stays as it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinkChange {
    /// Its name.
    pub link: String,
    /// Mass, kg.
    pub mass: Option<f64>,
    /// Centre of mass in link axes, m.
    pub com: Option<Vector3<f64>>,
    /// Inertia about the centre of mass in link axes, kg m².
    pub inertia: Option<Matrix3<f64>>,
}

impl LinkChange {
    /// Changes the link, if it is this one. Where it had no mass its centre of mass is its origin, its inertia zero.
    ///
    /// # Errors
    /// [`ModelError::ChangeWithoutMass`] for a link without mass that is given none.
    pub(super) fn apply(&self, link: &mut Link) -> Result<(), ModelError> {
        if link.name != self.link {
            return Ok(());
        }
        let inertial = match (link.inertial.take(), self.mass) {
            (Some(inertial), _) => inertial,
            (None, Some(mass)) => Inertial { mass, com: Vector3::zeros(), inertia: Matrix3::zeros() },
            (None, None) => return Err(ModelError::ChangeWithoutMass { link: link.name.clone() }),
        };
        link.inertial = Some(Inertial {
            mass: self.mass.unwrap_or(inertial.mass),
            com: self.com.unwrap_or(inertial.com),
            inertia: self.inertia.unwrap_or(inertial.inertia),
        });
        Ok(())
    }

    /// Refuses a change of a link that is none of `names`.
    pub(super) fn check_is_one_of<'a>(
        &self,
        names: impl Iterator<Item = &'a str> + Clone,
    ) -> Result<(), ModelError> {
        if names.clone().any(|name| name == self.link) {
            return Ok(());
        }
        let candidates = names.map(str::to_owned).collect();
        Err(ModelError::UnknownName { what: "link", name: self.link.clone(), candidates })
    }
}

impl Model {
    /// The same robot with a link changed.
    ///
    /// # Errors
    /// No such link, or values that no robot can have.
    pub fn with_link(&self, change: &LinkChange) -> Result<Self, ModelError> {
        let mut description = self.description().clone();
        change.check_is_one_of(description.links.iter().map(|link| link.name.as_str()))?;
        for link in &mut description.links {
            change.apply(link)?;
        }
        let mut builder = ModelBuilder::from_description(description)?;
        builder.keep_notes(self);
        builder.build()
    }
}
