//! Additional collision shapes of links.

use super::builder::ModelBuilder;
use super::description::Visual;
use super::error::ModelError;
use super::lookup::find;
use super::tree::Model;

impl Model {
    /// Returns this robot with a further collision shape on a link, in addition to the existing ones. The
    /// motion of the robot does not change.
    ///
    /// # Errors
    /// [`ModelError::UnknownName`] if no link has this name.
    pub fn with_collision(&self, link: &str, shape: Visual) -> Result<Self, ModelError> {
        let mut description = self.description().clone();
        let at = find("link", link, description.links.iter().map(|link| link.name.as_str()))?;
        description.links[at].collisions.push(shape);
        let mut builder = ModelBuilder::from_description(description)?;
        builder.keep_notes(self);
        builder.build()
    }
}
