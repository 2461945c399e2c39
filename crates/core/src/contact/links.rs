//! Collision shapes of the links that a pattern matches.

use super::declared::ContactSide;
use super::error::ContactError;
use crate::geometry::{Pose, Shape};
use crate::model::{Geometry, Model, Visual, nearest};
use crate::world::FrameIndex;
use nalgebra::Isometry3;
use std::sync::Arc;

/// Returns the collision shapes of the links that match `pattern`, a path `SYSTEM/LINK` in which `*` stands
/// for any text. `systems` are the names and models of the systems, and `contact` is the name of the contact.
///
/// # Errors
/// [`ContactError::NoLink`] if no link matches, and [`ContactError::NoShape`] if the links that match have no
/// collision shapes.
pub fn links_matching(
    contact: &str,
    pattern: &str,
    systems: &[(String, Arc<Model>)],
) -> Result<Vec<ContactSide>, ContactError> {
    let (mut sides, mut bare, mut known) = (Vec::new(), None, Vec::new());
    for (system, (name, model)) in systems.iter().enumerate() {
        for (frame, description) in model.frames().iter().enumerate() {
            let path = format!("{name}/{}", description.name);
            let shapes = model.collisions().iter().filter(|(owner, _)| *owner == frame);
            let own: Result<Vec<_>, _> =
                shapes.map(|(_, visual)| side(contact, FrameIndex { system, frame }, visual)).collect();
            if !matches(pattern, &path) {
                known.push(path);
            } else if model.collisions().iter().any(|(owner, _)| *owner == frame) {
                sides.extend(own?);
            } else {
                bare = Some((name.clone(), description.name.clone()));
            }
        }
    }
    match bare {
        _ if !sides.is_empty() => Ok(sides),
        Some((system, link)) => Err(ContactError::NoShape { contact: contact.to_owned(), system, link }),
        None => {
            let (contact, pattern) = (contact.to_owned(), pattern.to_owned());
            let remedy = nearest(&known, &pattern);
            Err(ContactError::NoLink { contact, pattern, remedy })
        }
    }
}

fn side(contact: &str, frame: FrameIndex, visual: &Visual) -> Result<ContactSide, ContactError> {
    let shape = match &visual.geometry {
        Geometry::Box(edges) => Shape::Box { half_edges: edges.map(|edge| 0.5 * edge) },
        Geometry::Cylinder { radius, length } => {
            Shape::Cylinder { radius: *radius, half_length: 0.5 * length }
        }
        Geometry::Capsule { radius, length } => Shape::Capsule { radius: *radius, half_length: 0.5 * length },
        Geometry::Sphere { radius } => Shape::Sphere { radius: *radius },
        Geometry::Mesh { filename, .. } => {
            return Err(ContactError::Mesh { contact: contact.to_owned(), file: filename.clone() });
        }
    };
    Ok(ContactSide { frame, shape, pose: pose_of(&visual.pose) })
}

fn pose_of(pose: &Isometry3<f64>) -> Pose {
    Pose { rot: pose.rotation.to_rotation_matrix().into_inner().into(), pos: pose.translation.vector.into() }
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
