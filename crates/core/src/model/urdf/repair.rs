//! Repair of text that is not well-formed XML but is accepted by tinyxml2, which urdfdom uses.
//!
//! The repair does not change line numbers. Well-formed files are not rewritten.

use super::error::{UrdfError, UrdfProblem};
use super::precheck::line;
use super::rewrite::Writer;
use super::tokens::{Kind, Token, tokens};
use crate::model::ModelWarning;
use std::ops::Range;

/// Returns the malformed text `xml` rewritten as XML, and a warning if elements outside the robot were
/// removed.
///
/// The main changes are:
///
/// - only the first outermost `<robot>`, or else the first element, is kept; text after the first zero byte
///   is dropped;
/// - comments, processing instructions and document types are removed, except for their line breaks;
/// - characters that XML forbids are replaced by spaces;
/// - `&` and `<` that are not markup are escaped;
/// - attributes are separated by spaces;
/// - every prefix is declared, each with a separate namespace.
///
/// The result is not well-formed if, for example, a closing tag is missing; the parser then reports the
/// fault.
///
/// # Errors
/// [`UrdfProblem::Entity`] if the text uses an entity that the document type defines.
pub(super) fn repair(xml: &str) -> Result<(String, Option<ModelWarning>), UrdfError> {
    let xml = &xml[..xml.find('\0').unwrap_or(xml.len())];
    let (robot, note) = outermost(xml);
    let defines = |token: Token<'_>| token.kind == Kind::Declaration && token.text.contains("<!ENTITY");
    let mut writer = Writer::new(xml.len(), tokens(xml).any(defines));
    for token in tokens(xml) {
        match token.kind {
            _ if !robot.contains(&token.at) => writer.blank(token.text),
            // an unterminated comment hides the rest of the text; the parser reports it
            Kind::Comment if !token.text.ends_with("-->") => writer.plain(token.text),
            Kind::Comment | Kind::Instruction | Kind::Declaration => writer.blank(token.text),
            Kind::CData => writer.plain(token.text),
            Kind::Text => writer.escaped(token.text),
            Kind::Open | Kind::Close | Kind::Empty => writer.tag(&token),
        }
        .map_err(|name| UrdfError::new(line(xml, token.at), UrdfProblem::Entity { name }))?;
    }
    Ok((writer.finish(), note))
}

/// Returns the byte range of the first outermost `<robot>` or, without one, of the first element. If there
/// are further elements outside that range, also returns a warning that names the first of them.
fn outermost(xml: &str) -> (Range<usize>, Option<ModelWarning>) {
    let (mut depth, mut found) = (0_usize, Vec::new());
    for token in tokens(xml).filter(Token::is_tag) {
        if depth == 0 && token.kind != Kind::Close {
            let end = if token.kind == Kind::Empty { token.end() } else { xml.len() };
            found.push((token.at..end, token.split_name().0));
        }
        match token.kind {
            Kind::Open => depth += 1,
            Kind::Close => depth = depth.saturating_sub(1),
            _ => {}
        }
        if let (Kind::Close, 0, Some((range, _))) = (token.kind, depth, found.last_mut()) {
            range.end = range.end.min(token.end());
        }
    }
    if found.is_empty() {
        return (0..0, None);
    }
    let robot = found.iter().position(|(_, name)| *name == "robot").unwrap_or(0);
    let (robot, _) = found.remove(robot);
    let note = found.first().map(|(range, name)| {
        let line = line(xml, range.start).unwrap_or_default();
        ModelWarning::Note(format!(
            "line {line}: <{name}> is outside <robot> and is ignored; move it into <robot> if it is needed"
        ))
    });
    (robot, note)
}

#[cfg(test)]
mod tests {
    use super::{UrdfProblem, repair};

    fn repaired(xml: &str) -> String {
        repair(xml).expect("is no use of an entity").0
    }

    #[test]
    fn text_that_is_not_xml_is_rewritten_and_keeps_its_lines() {
        for (xml, expected) in [
            ("\n<?xml?>\n<!-- a -- b\n-->\n<r/>", "\n\n\n\n<r/>"),
            ("<!DOCTYPE r [<!ENTITY a \"<\">\n]>\n<r/>", "\n\n<r/>"),
            ("text\n<r a='1'b=\"2\"\n c = '3'/>\n</r>\u{0}junk", "\n<r a='1' b=\"2\"\n c = '3'/>\n"),
            (
                "<r a='R & D &amp; <x> &#65; &#1; &no;'>a]]>\u{8}b</r>",
                "<r a='R &amp; D &amp; &lt;x&gt; &#65; &amp;#1; &amp;no;'>a]]&gt; b</r>",
            ),
            ("<r><![CDATA[<&]]></r>", "<r><![CDATA[<&]]></r>"),
            (
                "<r\nxmlns:p='u' xmlns='v'><p:a q:b:c='1'/></r>",
                "<r xmlns:p=\"urn:prefix:p\" xmlns:q=\"urn:prefix:q\"\n><p:a q:b_c='1'/></r>",
            ),
            ("<r/><r><s/></r>", "<r/>"),
            ("<r><!--><s/>--><a:b/></r>", "<r xmlns:a=\"urn:prefix:a\"><a:b/></r>"),
            ("<r>< a\u{b}b='1'/><\na></\na b='2'></ r>", "<r><a  b='1'/><a\n></a\n></r>"),
            ("<xml:a xmlns:b='1' :c='2'/>", "<xml_a _c='2'/>"),
            ("<r/>\n<robot><s/></robot>", "\n<robot><s/></robot>"),
            ("<r><s></r>", "<r><s></r>"),
            ("<r><!-- no end", "<r><!-- no end"),
        ] {
            assert_eq!(repaired(xml), expected, "{xml}");
        }
    }

    #[test]
    fn an_entity_may_be_defined_but_not_used() {
        let error = repair("<!DOCTYPE r [<!ENTITY a 'b'>]>\n<r>\n&a;</r>").expect_err("must be refused");
        assert_eq!((error.line, *error.problem), (Some(2), UrdfProblem::Entity { name: "a".to_owned() }));
    }
}
