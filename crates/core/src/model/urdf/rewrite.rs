//! Writer of the tokens of a malformed text as well-formed XML.

use super::tokens::{Kind, Token};
use std::collections::BTreeSet;

/// Largest number of prefixes in a file, limited because the parser compares each prefix with all others.
const MOST_PREFIXES: usize = 1000;

/// Writer that converts the tokens of a malformed text to well-formed XML.
pub(super) struct Writer<'a> {
    out: String,
    prefixes: BTreeSet<&'a str>,
    /// Byte offset in `out` at which the name of the outermost tag ends.
    root_name_ends: usize,
    /// True if a document type (`<!DOCTYPE>`) defines entities.
    has_entities: bool,
}

/// Result of a method of [`Writer`]; the error is the name of an unsupported entity.
pub(super) type Written = Result<(), String>;

impl<'a> Writer<'a> {
    /// Creates a writer whose text has a capacity of `length` bytes.
    pub(super) fn new(length: usize, has_entities: bool) -> Self {
        let out = String::with_capacity(length);
        Self { out, prefixes: BTreeSet::new(), root_name_ends: 0, has_entities }
    }

    /// Writes only the line breaks of a text.
    pub(super) fn blank(&mut self, text: &str) -> Written {
        self.out.extend(text.chars().filter(|&c| c == '\n'));
        Ok(())
    }

    /// Writes a text with a space in place of each character that XML forbids.
    pub(super) fn plain(&mut self, text: &str) -> Written {
        self.out.extend(text.chars().map(|c| if is_character(c) { c } else { ' ' }));
        Ok(())
    }

    /// Writes a text with markup characters replaced by references, and a space in place of each character
    /// that XML forbids. References that XML predefines are kept.
    pub(super) fn escaped(&mut self, text: &str) -> Written {
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

    /// Writes a tag with a space before each attribute, but without declarations of prefixes. A closing tag
    /// is written without attributes.
    pub(super) fn tag(&mut self, tag: &Token<'a>) -> Written {
        let (name, mut rest) = tag.split_name();
        self.out.push_str(if tag.kind == Kind::Close { "</" } else { "<" });
        self.name(name)?;
        // a line break before the name of a tag is moved behind the name
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

    /// Writes a name. Only its first colon separates a prefix; further colons become underscores. All colons
    /// do if the prefix is empty, `xml` or `xmlns`, or if nothing follows the first colon.
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

    /// Returns the written text, with its prefixes, at most [`MOST_PREFIXES`], declared in the outermost tag.
    pub(super) fn finish(mut self) -> String {
        let declare = |prefix: &&str| format!(" xmlns:{prefix}=\"urn:prefix:{prefix}\"");
        let declared: String = self.prefixes.iter().take(MOST_PREFIXES).map(declare).collect();
        self.out.insert_str(self.root_name_ends, &declared);
        self.out
    }
}

/// Splits a text into three parts: the text before the first attribute value, the quote character, and the
/// value. Returns `None` for a text without a quoted value.
fn first_value(text: &str) -> Option<(&str, char, &str)> {
    let open = text.find(['"', '\''])?;
    let (before, rest) = text.split_at(open);
    let quote = rest.chars().next()?;
    let (value, _) = rest[1..].split_once(quote)?;
    Some((before, quote, value))
}

/// Returns `name` if the text starts with the reference `&name;`.
fn reference(text: &str) -> Option<&str> {
    let rest = text.strip_prefix('&')?;
    let fits = |c: char| c.is_alphanumeric() || matches!(c, '#' | '-' | '_' | '.' | ':');
    let (name, end) = rest.split_at(rest.find(|c| !fits(c))?);
    (!name.is_empty() && end.starts_with(';')).then_some(name)
}

/// Returns true if XML predefines the reference `name`, such as `amp`, or if the reference is the number of a
/// character that XML permits, such as `#65`.
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
