//! A look at the text before any parser sees it: size, encoding, depth, document types.
//!
//! One pass without recursion, so that neither a deep document nor an entity bomb reaches code
//! that could exhaust the stack or the memory.

use super::error::{UrdfError, UrdfProblem};
use crate::text_file::{TextFileError, read_text};
use std::path::Path;

/// A humanoid with hands takes 0.1 MB; a file with embedded sensors and plugins one or two.
pub(super) const MAX_BYTES: usize = 16 << 20;
/// A URDF needs 6, the plugins of a simulator a dozen.
const MAX_DEPTH: usize = 64;
/// XML parsers compare every attribute of a tag with every other.
const MAX_TAG_BYTES: usize = 16 << 10;

/// The text of a file, read no further than it may be long.
pub(super) fn read(path: &Path) -> Result<String, UrdfError> {
    read_text(path, MAX_BYTES).map_err(|error| {
        let problem = match error {
            TextFileError::NotFound => UrdfProblem::NotFound,
            TextFileError::Folder => UrdfProblem::IsFolder,
            TextFileError::TooLarge { limit } => UrdfProblem::TooLarge { limit },
            TextFileError::NotUtf8 { at } => UrdfProblem::NotUtf8 { at },
            TextFileError::NotRegular | TextFileError::Unreadable { .. } => {
                UrdfProblem::Unreadable { reason: error.to_string() }
            }
        };
        UrdfError::new(None, problem)
    })
}

/// Refuses what no parser should be given.
pub(super) fn check(xml: &str) -> Result<(), UrdfError> {
    let fail = |at: usize, problem| {
        let line = xml.as_bytes()[..at].iter().filter(|&&b| b == b'\n').count() + 1;
        Err(UrdfError::new(u32::try_from(line).ok(), problem))
    };
    if xml.len() > MAX_BYTES {
        return Err(UrdfError::new(None, UrdfProblem::TooLarge { limit: MAX_BYTES }));
    }
    if xml.trim_start_matches('\u{feff}').trim().is_empty() {
        return Err(UrdfError::new(None, UrdfProblem::Empty));
    }
    if let Some(at) = xml.find('\0') {
        return fail(at, UrdfProblem::NotXml { reason: "binary data".to_owned() });
    }
    let (mut depth, mut at) = (0_usize, 0);
    while let Some(offset) = xml[at..].find('<') {
        let start = at + offset;
        let tag = &xml[start..];
        if tag.starts_with("<!DOCTYPE") {
            return fail(start, UrdfProblem::DocumentType);
        }
        let end = tag_end(tag);
        let is_markup = !tag.starts_with("<!") && !tag.starts_with("<?");
        if is_markup && end > MAX_TAG_BYTES {
            return fail(start, UrdfProblem::TagTooLong { limit: MAX_TAG_BYTES });
        }
        if tag.starts_with("</") {
            depth = depth.saturating_sub(1);
        } else if is_markup && !tag[..end].ends_with("/>") {
            depth += 1;
        }
        if depth > MAX_DEPTH {
            return fail(start, UrdfProblem::TooDeep { limit: MAX_DEPTH });
        }
        at = start + end;
    }
    Ok(())
}

/// Where the name of the outermost tag ends, in bytes.
pub(super) fn after_root_name(xml: &str) -> Option<usize> {
    let mut at = 0;
    loop {
        let start = at + xml[at..].find('<')?;
        let tag = &xml[start..];
        if !tag.starts_with("<!") && !tag.starts_with("<?") {
            let ends = |c: char| c.is_whitespace() || matches!(c, '/' | '>');
            return tag.find(ends).map(|end| start + end);
        }
        at = start + tag_end(tag);
    }
}

/// Bytes up to the end of the tag, comment, CDATA section or instruction that `tag` starts with.
fn tag_end(tag: &str) -> usize {
    let until = |end: &str| tag.find(end).map_or(tag.len(), |at| at + end.len());
    if tag.starts_with("<!--") {
        return until("-->");
    }
    if tag.starts_with("<![CDATA[") {
        return until("]]>");
    }
    if tag.starts_with("<?") {
        return until("?>");
    }
    let mut quote = None;
    for (at, byte) in tag.bytes().enumerate() {
        match (quote, byte) {
            (None, b'>') => return at + 1,
            (None, b'"' | b'\'') => quote = Some(byte),
            (Some(open), _) if open == byte => quote = None,
            _ => {}
        }
    }
    tag.len()
}

#[cfg(test)]
mod tests {
    use super::{MAX_BYTES, MAX_DEPTH, UrdfProblem, check};

    fn problem(xml: &str) -> UrdfProblem {
        check(xml).expect_err("must be refused").problem.as_ref().clone()
    }

    #[test]
    fn depth_is_counted_through_quotes_comments_and_closed_tags() {
        let nested = |n: usize| "<a b='>'>".repeat(n) + &"</a>".repeat(n);
        assert_eq!(check(&nested(MAX_DEPTH)), Ok(()));
        assert_eq!(problem(&nested(MAX_DEPTH + 1)), UrdfProblem::TooDeep { limit: MAX_DEPTH });
        assert_eq!(problem(&nested(100_000)), UrdfProblem::TooDeep { limit: MAX_DEPTH });
        let flat = format!("<r>{}<!--{}--></r>", "<a/><b></b>".repeat(1000), "<c>".repeat(1000));
        assert_eq!(check(&flat), Ok(()));
    }

    #[test]
    fn what_no_parser_should_see_is_named() {
        assert_eq!(problem(""), UrdfProblem::Empty);
        assert_eq!(problem("\u{feff} \n"), UrdfProblem::Empty);
        assert!(matches!(problem("<robot>\0"), UrdfProblem::NotXml { .. }));
        assert_eq!(problem("<!DOCTYPE r [<!ENTITY a \"b\">]><r>&a;</r>"), UrdfProblem::DocumentType);
        assert_eq!(problem(&" ".repeat(MAX_BYTES + 1)), UrdfProblem::TooLarge { limit: MAX_BYTES });
        let many_attributes = format!("<r {}/>", "a='' ".repeat(100_000));
        assert!(matches!(problem(&many_attributes), UrdfProblem::TagTooLong { .. }));
    }

    #[test]
    fn the_line_is_the_tag_s() {
        let error = check("<r>\n\n<!DOCTYPE x></r>").expect_err("must be refused");
        assert_eq!(error.line, Some(3));
    }
}
