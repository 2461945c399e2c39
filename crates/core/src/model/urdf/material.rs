//! Reader of `<material>`, which defines a colour of one shape or a named colour for several shapes.

use super::element::Element;
use super::error::UrdfError;
use std::collections::HashMap;
use urdf_rs::Color;

/// Named colours of the file.
pub(super) struct Materials<'a> {
    named: HashMap<&'a str, Element<'a>>,
}

impl<'a> Materials<'a> {
    /// Collects the materials defined in `<robot>`, followed by those defined inside visuals, because in some
    /// files other visuals refer to the latter. The first definition of a name applies.
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

    /// Returns the colour of the material of a shape: red, green, blue and opacity, each from 0 to 1. It is
    /// the colour given there, or else the colour defined elsewhere under the same name; `None` if there is
    /// neither.
    pub(super) fn rgba(&self, material: urdf_rs::Material) -> Result<Option<[f64; 4]>, UrdfError> {
        let named = || self.named.get(material.name.as_str()).map(|color| color.read::<Color>());
        let color = material.color.map(Ok).or_else(named).transpose()?;
        Ok(color.map(|color| *color.rgba))
    }
}
