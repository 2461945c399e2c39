//! Collision shapes of the links that a pattern matches.

use super::declared::ContactSide;
use super::error::ContactError;
use crate::geometry::{GeometryError, LinkShape, Pose, Shape, link_shape};
use crate::model::{Model, nearest};
use crate::world::FrameIndex;
use std::sync::Arc;

/// Collision shapes of the links that a pattern matches, and warnings about their meshes.
#[derive(Debug, Default)]
pub struct LinkShapes {
    /// Pieces, in the order of the systems and their links.
    pub sides: Vec<ContactSide>,
    /// Warnings about defects of meshes, one line each; the convex hulls of these meshes are used
    /// nevertheless.
    pub warnings: Vec<String>,
}

/// Returns the collision shapes of the links whose paths `SYSTEM/LINK` match `pattern`, in which `*`
/// stands for any text. `systems` holds the names and models of the systems, and `contact` is the name of
/// the contact, for messages.
///
/// # Errors
/// [`ContactError::NoLink`] if no link matches, [`ContactError::NoShape`] if none of the links that match has
/// a collision shape, and [`ContactError::Geometry`] for a collision shape that cannot be read or is invalid.
pub fn links_matching(
    contact: &str,
    pattern: &str,
    systems: &[(String, Arc<Model>)],
) -> Result<LinkShapes, ContactError> {
    let (mut found, mut bare, mut known) = (LinkShapes::default(), None, Vec::new());
    for (system, (name, model)) in systems.iter().enumerate() {
        for (frame, description) in model.frames().iter().enumerate() {
            let path = format!("{name}/{}", description.name);
            if !matches(pattern, &path) {
                known.push(path);
                continue;
            }
            match link_shape(model, frame) {
                Ok(shape) => found.add(FrameIndex { system, frame }, shape),
                Err(GeometryError::NoCollision { .. }) => {
                    bare = Some((name.clone(), description.name.clone()));
                }
                Err(source) => return Err(ContactError::Geometry { contact: contact.to_owned(), source }),
            }
        }
    }
    match bare {
        _ if !found.sides.is_empty() => Ok(found),
        Some((system, link)) => Err(ContactError::NoShape { contact: contact.to_owned(), system, link }),
        None => {
            let (contact, pattern) = (contact.to_owned(), pattern.to_owned());
            let remedy = nearest(&known, &pattern);
            Err(ContactError::NoLink { contact, pattern, remedy })
        }
    }
}

impl LinkShapes {
    /// Adds the pieces of the shape of a link, and its warnings.
    fn add(&mut self, frame: FrameIndex, LinkShape { shape, warnings }: LinkShape) {
        self.warnings.extend(warnings);
        match shape {
            Shape::Compound(pieces) => {
                let sides = pieces.iter().map(|(shape, pose)| ContactSide {
                    frame,
                    shape: shape.clone(),
                    pose: *pose,
                });
                self.sides.extend(sides);
            }
            shape => self.sides.push(ContactSide { frame, shape, pose: Pose::identity() }),
        }
    }
}

/// Returns true if `text` matches `pattern`, in which `*` stands for any text.
fn matches(pattern: &str, text: &str) -> bool {
    let Some((before, after)) = pattern.split_once('*') else { return pattern == text };
    let Some(rest) = text.strip_prefix(before) else { return false };
    (0..=rest.len()).filter(|&at| rest.is_char_boundary(at)).any(|at| matches(after, &rest[at..]))
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn a_star_stands_for_any_text() {
        for (pattern, text, is_match) in [
            ("chaser/hand", "chaser/hand", true),
            ("chaser/hand", "chaser/hand2", false),
            ("chaser/*", "chaser/hand", true),
            ("*/hand", "chaser/hand", true),
            ("chaser/*nd*", "chaser/hand2", true),
            ("chaser/*x", "chaser/hand", false),
            ("*", "", true),
        ] {
            assert_eq!(matches(pattern, text), is_match, "{pattern} {text}");
        }
    }
}
