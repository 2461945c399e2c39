//! Attributes and numbers of an element, with errors that name the link or joint they belong to.

use super::error::{UrdfError, UrdfProblem};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use roxmltree::Node;

/// An element and the link or joint (`link 'hand'`) whose description it is part of.
#[derive(Clone, Copy)]
pub(super) struct Element<'a> {
    pub(super) node: Node<'a, 'a>,
    pub(super) owner: &'a str,
}

impl<'a> Element<'a> {
    pub(super) fn fail(&self, problem: UrdfProblem) -> UrdfError {
        UrdfError::at(self.node, problem)
    }

    fn tag(&self) -> String {
        self.node.tag_name().name().to_owned()
    }

    /// Elements of that name directly inside; those of other namespaces are others' extensions.
    pub(super) fn children(self, name: &'static str) -> impl Iterator<Item = Self> {
        let namespace = self.node.tag_name().namespace();
        let is_ours = move |node: &Node<'a, 'a>| {
            node.tag_name().name() == name && node.tag_name().namespace() == namespace
        };
        self.node.children().filter(Node::is_element).filter(is_ours).map(move |node| Self { node, ..self })
    }

    /// The first element of that name, as urdfdom reads it.
    pub(super) fn child(self, name: &'static str) -> Option<Self> {
        self.children(name).next()
    }

    pub(super) fn required_child(self, name: &'static str) -> Result<Self, UrdfError> {
        self.child(name).ok_or_else(|| {
            self.fail(UrdfProblem::MissingElement { owner: self.owner.to_owned(), element: name })
        })
    }

    pub(super) fn text(&self, attribute: &str) -> Option<&'a str> {
        self.node.attribute(attribute)
    }

    /// An attribute that must be there and hold no leftover of xacro.
    pub(super) fn required_text(&self, attribute: &'static str) -> Result<&'a str, UrdfError> {
        let text = self.text(attribute).ok_or_else(|| {
            self.fail(UrdfProblem::MissingAttribute {
                owner: self.owner.to_owned(),
                element: self.tag(),
                attribute,
            })
        })?;
        if is_xacro(text) { Err(self.xacro(text)) } else { Ok(text) }
    }

    pub(super) fn number(&self, attribute: &'static str) -> Result<Option<f64>, UrdfError> {
        Ok(self.numbers::<1>(attribute)?.map(|[x]| x))
    }

    pub(super) fn required_number(&self, attribute: &'static str) -> Result<f64, UrdfError> {
        self.required_text(attribute)?;
        Ok(self.number(attribute)?.expect("the attribute is there"))
    }

    /// The length of an edge, a radius.
    pub(super) fn required_size(&self, attribute: &'static str) -> Result<f64, UrdfError> {
        let value = self.required_number(attribute)?;
        self.positive(attribute, value)
    }

    pub(super) fn positive(&self, attribute: &'static str, value: f64) -> Result<f64, UrdfError> {
        if value > 0.0 {
            return Ok(value);
        }
        let (owner, element) = (self.owner.to_owned(), self.tag());
        Err(self.fail(UrdfProblem::NotPositive { owner, element, attribute, value }))
    }

    /// A limit: `inf` says that there is none.
    pub(super) fn limit(&self, attribute: &'static str) -> Result<Option<f64>, UrdfError> {
        let text = self.text(attribute).map(|text| text.trim().trim_start_matches(['+', '-']).to_lowercase());
        match text.as_deref() {
            Some("inf" | "infinity") => Ok(None),
            _ => self.number(attribute),
        }
    }

    /// `N` finite numbers between spaces.
    pub(super) fn numbers<const N: usize>(
        &self,
        attribute: &'static str,
    ) -> Result<Option<[f64; N]>, UrdfError> {
        let Some(text) = self.text(attribute) else { return Ok(None) };
        let mut values = [0.0; N];
        let mut words = text.split_whitespace();
        let is_read = values.iter_mut().all(|value| {
            let word = words.next().and_then(|word| word.parse::<f64>().ok());
            *value = word.unwrap_or(f64::NAN);
            value.is_finite()
        });
        if is_read && words.next().is_none() {
            return Ok(Some(values));
        }
        Err(if is_xacro(text) {
            self.xacro(text)
        } else {
            self.fail(UrdfProblem::BadNumber {
                owner: self.owner.to_owned(),
                element: self.tag(),
                attribute,
                text: text.to_owned(),
                expected: N,
            })
        })
    }

    /// Pose of `<origin>`: `xyz` in m, and `rpy` in rad about the fixed axes x, y, z in turn
    /// (URDF 1.1: or `quat_xyzw`).
    pub(super) fn origin(self) -> Result<Isometry3<f64>, UrdfError> {
        let Some(origin) = self.child("origin") else { return Ok(Isometry3::identity()) };
        let xyz = origin.numbers::<3>("xyz")?.unwrap_or_default();
        let rotation = match (origin.numbers::<3>("rpy")?, origin.numbers::<4>("quat_xyzw")?) {
            (Some(_), Some(_)) => {
                return Err(origin.fail(UrdfProblem::TwoOrientations { owner: self.owner.to_owned() }));
            }
            (Some([r, p, y]), None) => UnitQuaternion::from_euler_angles(r, p, y),
            (None, Some([x, y, z, w])) => {
                let text = origin.text("quat_xyzw").unwrap_or_default().to_owned();
                let zero = UrdfProblem::ZeroQuaternion { owner: self.owner.to_owned(), text };
                UnitQuaternion::try_new(Quaternion::new(w, x, y, z), f64::MIN_POSITIVE)
                    .ok_or_else(|| origin.fail(zero))?
            }
            (None, None) => UnitQuaternion::identity(),
        };
        Ok(Isometry3::from_parts(Translation3::from(Vector3::from(xyz)), rotation))
    }

    fn xacro(&self, text: &str) -> UrdfError {
        self.fail(UrdfProblem::Xacro { found: format!("'{text}' ({})", self.owner) })
    }
}

/// Whether a text holds an expression that xacro would have replaced.
pub(super) fn is_xacro(text: &str) -> bool {
    text.contains("${") || text.contains("$(")
}
