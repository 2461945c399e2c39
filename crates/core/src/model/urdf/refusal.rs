//! Error type of the deserializer, which is converted to a [`UrdfError`].

use super::element::Element;
use super::error::{UrdfError, UrdfProblem};
use super::schema::elements;
use serde::de;
use std::fmt;

/// Reason why a urdf-rs type cannot be deserialized.
#[derive(Debug)]
pub(super) enum Refusal {
    /// A required field is missing; the element is not yet known.
    Missing(&'static str),
    /// Another reason, as stated by urdf-rs.
    Other(String),
    /// An error with its location.
    Placed(UrdfError),
}

impl Refusal {
    pub(super) fn at(self, element: &Element<'_>) -> UrdfError {
        match self {
            Self::Missing(name) if elements(element.tag()).contains(&name) => element.lacks_element(name),
            Self::Missing(name) => element.lacks_attribute(name),
            Self::Other(reason) => {
                let (owner, element_name) = (element.owner.to_owned(), element.tag().to_owned());
                element.fail(UrdfProblem::InvalidElement { owner, element: element_name, reason })
            }
            Self::Placed(error) => error,
        }
    }
}

impl de::Error for Refusal {
    fn custom<T: fmt::Display>(reason: T) -> Self {
        Self::Other(reason.to_string())
    }

    fn missing_field(name: &'static str) -> Self {
        Self::Missing(name)
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing(name) => write!(f, "no '{name}'"),
            Self::Other(reason) => f.write_str(reason),
            Self::Placed(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Refusal {}

/// Creates the error for an unknown type of joint.
pub(super) fn unknown_kind(element: &Element<'_>, kind: &str) -> UrdfError {
    let joint = element.text("name").unwrap_or_default().to_owned();
    element.fail(UrdfProblem::JointType { joint, kind: kind.to_owned() })
}
