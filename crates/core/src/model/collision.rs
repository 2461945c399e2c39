//! Collision shapes of links, and their replacement by other shapes.

use super::builder::ModelBuilder;
use super::description::Visual;
use super::error::ModelError;
use super::lookup::find;
use super::tree::Model;

impl Model {
    /// Returns the collision shapes of a link.
    ///
    /// # Errors
    /// [`ModelError::UnknownName`] if no link has this name.
    pub fn collisions_of(&self, link: &str) -> Result<&[Visual], ModelError> {
        let links = &self.description().links;
        find("link", link, links.iter().map(|link| link.name.as_str())).map(|at| &links[at].collisions[..])
    }

    /// Returns this robot with `shapes` as the collision shapes of a link, instead of the existing ones. The
    /// bodies, joints and inertias do not change.
    ///
    /// # Errors
    /// [`ModelError::UnknownName`] if no link has this name.
    pub fn with_collisions(&self, link: &str, shapes: Vec<Visual>) -> Result<Self, ModelError> {
        let mut description = self.description().clone();
        let at = find("link", link, description.links.iter().map(|link| link.name.as_str()))?;
        description.links[at].collisions = shapes;
        let mut builder = ModelBuilder::from_description(description)?;
        builder.keep_notes(self);
        builder.build()
    }
}
