//! Replacement of the mass, centre of mass or inertia of a link by new values.

use super::builder::ModelBuilder;
use super::description::{Inertial, Link};
use super::error::ModelError;
use super::lookup::find;
use super::tree::Model;
use nalgebra::{Matrix3, Vector3};

/// New inertial values of a link; `None` keeps the current value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinkChange {
    /// Name of the link.
    pub link: String,
    /// Mass, kg.
    pub mass: Option<f64>,
    /// Centre of mass in link axes, m.
    pub com: Option<Vector3<f64>>,
    /// Inertia about the centre of mass in link axes, kg m².
    pub inertia: Option<Matrix3<f64>>,
}

impl LinkChange {
    /// Replaces the inertial values of `link` if the change is for a link of that name. A link without
    /// inertial properties is treated as a point mass at the origin of the link.
    ///
    /// # Errors
    /// [`ModelError::ChangeWithoutMass`] if the link has no inertial properties and no mass is given.
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

    /// Checks that the link to be changed is one of `names`.
    pub(super) fn check_is_one_of<'a>(
        &self,
        names: impl Iterator<Item = &'a str> + Clone,
    ) -> Result<(), ModelError> {
        find("link", &self.link, names).map(|_| ())
    }
}

impl Model {
    /// Returns this robot with the mass, centre of mass or inertia of one link replaced.
    ///
    /// # Errors
    /// [`ModelError`] for an unknown link, values that are not physical, or a massless link if the change
    /// specifies no mass.
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
