//! Text that is not XML by the letter, as tinyxml2 takes it, which urdfdom reads with.
//!
//! Rewrites what a parser would stumble over and keeps the lines. Files that are XML never come here.

use super::error::{UrdfError, UrdfProblem};
use super::first_look::line;
use super::tokens::{Kind, Token, tokens};
use crate::model::ModelWarning;
use std::collections::BTreeSet;
use std::ops::Range;

/// Prefixes of one file; the parser compares each with every other.
const MOST_PREFIXES: usize = 1000;

/// Makes XML of `xml`, with what a reader should know:
///
/// - the outermost `<robot>` alone stays, or else the first element, and the text ends at the first zero byte;
/// - comments, instructions and document types go, and characters that XML does not have;
/// - `&` and `<` are escaped where they stand for themselves;
/// - attributes have a space between them;
/// - every prefix is declared, as a namespace of its own.
///
/// # Errors
/// [`UrdfProblem::Entity`] where the text uses what a document type defines.
pub(super) fn tidy(xml: &str) -> Result<(String, Option<ModelWarning>), UrdfError> {
    let xml = &xml[..xml.find('\0').unwrap_or(xml.len())];
    let (robot, note) = outermost(xml);
    let defines = |token: Token<'_>| token.kind == Kind::Declaration && token.text.contains("<!ENTITY");
    let mut writer = Writer {
        out: String::with_capacity(xml.len()),
        prefixes: BTreeSet::new(),
        root_name_ends: 0,
        has_entities: tokens(xml).any(defines),
    };
    for token in tokens(xml) {
        match token.kind {
            _ if !robot.contains(&token.at) => writer.blank(token.text),
            // one that does not end hides the rest: the parser says so
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

/// Where the robot stands, with a remark on what stands beside it.
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
        ModelWarning::Note(format!("line {line}: <{name}> stands outside the robot and is left out"))
    });
    (robot, note)
}

/// What is written of the text.
struct Writer<'a> {
    out: String,
    prefixes: BTreeSet<&'a str>,
    /// Where the name of the outermost tag ends.
    root_name_ends: usize,
    /// Whether a document type defines any.
    has_entities: bool,
}

/// The name of an entity that may not be used.
type Written = Result<(), String>;

impl<'a> Writer<'a> {
    /// Nothing but the ends of the lines.
    fn blank(&mut self, text: &str) -> Written {
        self.out.extend(text.chars().filter(|&c| c == '\n'));
        Ok(())
    }

    /// The text with spaces for what is no character of XML.
    fn plain(&mut self, text: &str) -> Written {
        self.out.extend(text.chars().map(|c| if is_character(c) { c } else { ' ' }));
        Ok(())
    }

    /// The text with references for what would be markup.
    fn escaped(&mut self, text: &str) -> Written {
        for (at, c) in text.char_indices() {
            match c {
                '&' => match reference(&text[at..]) {
                    Some(name) if is_known(name) => self.out.push('&'),
                    Some(name) if self.has_entities => return Err(name.to_owned()),
                    _ => self.out.push_str("&amp;"),
                },
                '<' => self.out.push_str("&lt;"),
                '>' => self.out.push_str("&gt;"),
                c => self.out.push(if is_character(c) { c } else { ' ' }),
            }
        }
        Ok(())
    }

    /// A tag, its attributes with a space before each; those that declare prefixes go.
    fn tag(&mut self, tag: &Token<'a>) -> Written {
        let (name, mut rest) = tag.split_name();
        self.out.push_str(if tag.kind == Kind::Close { "</" } else { "<" });
        self.name(name)?;
        // what breaks a line in front of the name does so after it
        let front = tag.text.len() - name.len() - rest.len();
        self.blank(&tag.text[..front])?;
        if tag.kind == Kind::Close {
            self.blank(rest)?;
            return self.plain(if rest.ends_with('>') { ">" } else { "" });
        }
        if self.root_name_ends == 0 {
            self.root_name_ends = self.out.len();
        }
        while let Some((before, quote, value)) = first_value(rest) {
            rest = &rest[before.len() + value.len() + 2..];
            let named = before.trim_end_matches(|c: char| c == '=' || c.is_ascii_whitespace());
            let (space, name) =
                named.split_at(named.rfind(|c: char| c.is_ascii_whitespace()).map_or(0, |at| at + 1));
            if name == "xmlns" || name.starts_with("xmlns:") {
                self.blank(before)?;
                self.blank(value)?;
                continue;
            }
            self.plain(if space.is_empty() { " " } else { space })?;
            self.name(name)?;
            self.plain(&before[named.len()..])?;
            self.out.push(quote);
            self.escaped(value)?;
            self.out.push(quote);
        }
        self.plain(rest)
    }

    /// A name; only its first colon ends a prefix.
    fn name(&mut self, name: &'a str) -> Written {
        let is_free = |prefix: &str| !matches!(prefix, "" | "xml" | "xmlns");
        let split = name.split_once(':').filter(|(prefix, local)| is_free(prefix) && !local.is_empty());
        let Some((prefix, local)) = split else { return self.plain(&name.replace(':', "_")) };
        let is_name = prefix.chars().all(|c| c.is_alphanumeric() || matches!(c, '-' | '_' | '.'));
        if is_name {
            self.prefixes.insert(prefix);
        }
        self.plain(prefix)?;
        self.out.push(':');
        self.plain(&local.replace(':', "_"))
    }

    fn finish(mut self) -> String {
        let declare = |prefix: &&str| format!(" xmlns:{prefix}=\"urn:prefix:{prefix}\"");
        let declared: String = self.prefixes.iter().take(MOST_PREFIXES).map(declare).collect();
        self.out.insert_str(self.root_name_ends, &declared);
        self.out
    }
}

/// What stands before the first value of an attribute, its quotes, and the value.
fn first_value(text: &str) -> Option<(&str, char, &str)> {
    let open = text.find(['"', '\''])?;
    let (before, rest) = text.split_at(open);
    let quote = rest.chars().next()?;
    let (value, _) = rest[1..].split_once(quote)?;
    Some((before, quote, value))
}

/// The name in `&name;`, where a text starts so.
fn reference(text: &str) -> Option<&str> {
    let rest = text.strip_prefix('&')?;
    let fits = |c: char| c.is_alphanumeric() || matches!(c, '#' | '-' | '_' | '.' | ':');
    let (name, end) = rest.split_at(rest.find(|c| !fits(c))?);
    (!name.is_empty() && end.starts_with(';')).then_some(name)
}

/// Whether XML knows a reference without being told.
fn is_known(name: &str) -> bool {
    let code = match (name.strip_prefix("#x"), name.strip_prefix('#')) {
        (Some(digits), _) => u32::from_str_radix(digits, 16),
        (None, Some(digits)) => digits.parse(),
        _ => return matches!(name, "lt" | "gt" | "amp" | "quot" | "apos"),
    };
    code.ok().and_then(char::from_u32).is_some_and(is_character)
}

fn is_character(c: char) -> bool {
    matches!(c, '\t' | '\n' | '\r' | ' '..='\u{FFFD}' | '\u{10000}'..)
}

#[cfg(test)]
mod tests {
    use super::{UrdfProblem, tidy};

    fn tidied(xml: &str) -> String {
        tidy(xml).expect("is no use of an entity").0
    }

    #[test]
    fn what_is_not_xml_is_rewritten_and_the_lines_stay() {
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
            ("<r>< a\u{b}b='1'/><\na></\na b='2'></ r>", "<r><a b='1'/><a\n></a\n></r>"),
            ("<xml:a xmlns:b='1' :c='2'/>", "<xml_a _c='2'/>"),
            ("<r/>\n<robot><s/></robot>", "\n<robot><s/></robot>"),
            ("<r><s></r>", "<r><s></r>"),
            ("<r><!-- no end", "<r><!-- no end"),
        ] {
            assert_eq!(tidied(xml), expected, "{xml}");
        }
    }

    #[test]
    fn an_entity_may_be_defined_but_not_used() {
        let error = tidy("<!DOCTYPE r [<!ENTITY a 'b'>]>\n<r>\n&a;</r>").expect_err("must be refused");
        assert_eq!((error.line, *error.problem), (Some(2), UrdfProblem::Entity { name: "a".to_owned() }));
    }
}
