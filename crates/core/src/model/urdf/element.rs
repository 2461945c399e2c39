//! XML elements with the name of the link or joint that they describe; error messages contain this name.

use super::error::{UrdfError, UrdfProblem};
use roxmltree::Node;

/// Largest number of values in one attribute: a colour or a quaternion has four.
pub(super) const MOST_NUMBERS: usize = 4;

/// XML element with its owner, the link or joint that it describes, such as `link 'hand'`.
#[derive(Clone, Copy)]
pub(super) struct Element<'a> {
    pub(super) node: Node<'a, 'a>,
    pub(super) owner: &'a str,
    /// Child elements and attributes that do not apply to this owner and are therefore ignored.
    pub(super) unread: &'static [&'static str],
}

impl<'a> Element<'a> {
    pub(super) fn new(node: Node<'a, 'a>, owner: &'a str) -> Self {
        Self { node, owner, unread: &[] }
    }

    pub(super) fn fail(&self, problem: UrdfProblem) -> UrdfError {
        UrdfError::at(self.node, problem)
    }

    pub(super) fn tag(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// Returns the child elements with this name and the namespace prefix of this element. Elements with
    /// another prefix are extensions.
    pub(super) fn children(self, name: &'static str) -> impl Iterator<Item = Self> {
        let is_ours =
            move |node: &Node<'a, 'a>| node.tag_name().name() == name && prefix(*node) == prefix(self.node);
        self.node.children().filter(Node::is_element).filter(is_ours).map(move |node| Self { node, ..self })
    }

    /// Returns the first child element with this name, if there is one. Further ones are ignored, as in
    /// urdfdom.
    pub(super) fn child(self, name: &'static str) -> Option<Self> {
        self.children(name).next()
    }

    /// Returns the `<color>` element of a material if it has an `rgba` attribute.
    pub(super) fn color(self) -> Option<Self> {
        self.child("color").filter(|color| color.text("rgba").is_some())
    }

    pub(super) fn required_child(self, name: &'static str) -> Result<Self, UrdfError> {
        self.child(name).ok_or_else(|| self.lacks_element(name))
    }

    pub(super) fn text(&self, attribute: &str) -> Option<&'a str> {
        self.node.attribute(attribute)
    }

    /// Returns the text of a required attribute.
    pub(super) fn required_text(&self, attribute: &'static str) -> Result<&'a str, UrdfError> {
        self.text(attribute).ok_or_else(|| self.lacks_attribute(attribute))
    }

    pub(super) fn number(&self, attribute: &'static str) -> Result<Option<f64>, UrdfError> {
        let text = self.text(attribute);
        text.map(|text| self.numbers(attribute, text, 1).map(|[x, ..]| x)).transpose()
    }

    /// Parses `text` as exactly `count` finite numbers separated by spaces; the rest of the returned array is
    /// zero.
    pub(super) fn numbers(
        &self,
        attribute: &'static str,
        text: &str,
        count: usize,
    ) -> Result<[f64; MOST_NUMBERS], UrdfError> {
        let mut values = [0.0; MOST_NUMBERS];
        let mut words = text.split_whitespace();
        let is_read = values[..count].iter_mut().all(|value| {
            let word = words.next().and_then(|word| word.parse::<f64>().ok());
            *value = word.unwrap_or(f64::NAN);
            value.is_finite()
        });
        if is_read && words.next().is_none() {
            return Ok(values);
        }
        self.refuse_xacro(text)?;
        Err(self.fail(UrdfProblem::BadNumber {
            owner: self.owner.to_owned(),
            element: self.tag().to_owned(),
            attribute,
            text: text.to_owned(),
            expected: count,
        }))
    }

    pub(super) fn refuse_xacro(&self, text: &str) -> Result<(), UrdfError> {
        if has_expression(text) {
            return Err(self.fail(UrdfProblem::Xacro { found: format!("'{text}' ({})", self.owner) }));
        }
        Ok(())
    }

    pub(super) fn lacks_element(&self, element: &'static str) -> UrdfError {
        self.fail(UrdfProblem::MissingElement { owner: self.owner.to_owned(), element })
    }

    pub(super) fn lacks_attribute(&self, attribute: &'static str) -> UrdfError {
        let (owner, element) = (self.owner.to_owned(), self.tag().to_owned());
        self.fail(UrdfProblem::MissingAttribute { owner, element, attribute })
    }
}

/// Returns true if a text contains an xacro expression.
pub(super) fn has_expression(text: &str) -> bool {
    text.contains("${") || text.contains("$(")
}

/// Returns the namespace prefix of an element as it is written in the file, whatever namespace it denotes;
/// `None` for an element without a prefix.
pub(super) fn prefix<'a>(node: Node<'a, 'a>) -> Option<&'a str> {
    node.tag_name().namespace()?; // an element without a namespace has no prefix
    let tag = node.document().input_text().get(node.range().start + 1..)?;
    let name = &tag[..tag.find(|c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>'))?];
    name.split_once(':').map(|(prefix, _)| prefix)
}
