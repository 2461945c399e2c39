//! `<material>`: colours, defined once and named elsewhere.

use super::element::Element;
use super::error::UrdfError;
use std::collections::HashMap;
use urdf_rs::Color;

/// The file's named colours.
pub(super) struct Materials<'a> {
    named: HashMap<&'a str, Element<'a>>,
}

impl<'a> Materials<'a> {
    /// Collects the definitions: those of the robot itself first, then those inside visuals,
    /// which other visuals of real files refer to.
    pub(super) fn new(robot: Element<'a>) -> Self {
        let nested = robot
            .children("link")
            .flat_map(|link| link.children("visual"))
            .flat_map(|visual| visual.children("material"));
        let mut named = HashMap::new();
        for material in robot.children("material").chain(nested) {
            if let (Some(name), Some(color)) = (material.text("name"), material.color()) {
                named.entry(name).or_insert(color);
            }
        }
        Self { named }
    }

    /// Returns the colour of a visual's material: its own, or the one defined under its name.
    pub(super) fn rgba(&self, material: urdf_rs::Material) -> Result<Option<[f64; 4]>, UrdfError> {
        let named = || self.named.get(material.name.as_str()).map(|color| color.read::<Color>());
        let color = material.color.map(Ok).or_else(named).transpose()?;
        Ok(color.map(|color| *color.rgba))
    }
}
