//! Checks of size, encoding and nesting depth of a text before it is parsed.

use super::error::{UrdfError, UrdfProblem};
use super::tokens::{Kind, Token, tokens};
use crate::model::ModelWarning;
use crate::text_file::{TextFileError, read_bytes};
use std::path::Path;

/// Largest size of a file, bytes. The URDF of a humanoid with hands has 0.1 MB; files with embedded sensors
/// and plugins have 1 to 2 MB.
pub(super) const MAX_BYTES: usize = 16 << 20;
/// Largest nesting depth, equal to the limit of tinyxml2, which urdfdom uses. A URDF has 6 levels, or about
/// 12 with simulator plugins.
const MAX_DEPTH: usize = 500;
/// Largest number of attributes of a tag, limited because XML parsers compare each attribute with all others.
const MAX_ATTRIBUTES: usize = 1000;

/// Reads a file of limited size. Returns its text, with a warning if the file is not UTF-8.
pub(super) fn read(path: &Path) -> Result<(String, Option<ModelWarning>), UrdfError> {
    let bytes = read_bytes(path, MAX_BYTES).map_err(|error| {
        let problem = match error {
            TextFileError::NotFound => UrdfProblem::NotFound,
            TextFileError::Folder => UrdfProblem::IsFolder,
            TextFileError::TooLarge { limit } => UrdfProblem::TooLarge { limit },
            other => UrdfProblem::Unreadable { reason: other.to_string() },
        };
        UrdfError::new(None, problem)
    })?;
    decode(bytes)
}

/// Decodes bytes as UTF-8 or, if they are not UTF-8, as Latin-1, which occurs in comments and names. UTF-16,
/// which contains zero bytes, is rejected.
fn decode(bytes: Vec<u8>) -> Result<(String, Option<ModelWarning>), UrdfError> {
    let (bytes, at) = match String::from_utf8(bytes) {
        Ok(text) => return Ok((text, None)),
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            (error.into_bytes(), at)
        }
    };
    let is_blank = |byte: &u8| *byte == 0 || byte.is_ascii_whitespace();
    let ends = bytes.iter().rposition(|byte| !is_blank(byte)).unwrap_or(0);
    if bytes[..ends].contains(&0) {
        return Err(UrdfError::new(None, UrdfProblem::NotUtf8 { at }));
    }
    let line = 1 + bytes[..at].iter().filter(|&&byte| byte == b'\n').count();
    let note = format!("line {line} is not UTF-8, so the file is read as Latin-1; save it as UTF-8");
    Ok((bytes.into_iter().map(char::from).collect(), Some(ModelWarning::Note(note))))
}

/// Checks that a text may be passed to the parser: that it is neither empty nor too large, that its elements
/// are not nested too deeply, and that no tag has too many attributes.
pub(super) fn check(xml: &str) -> Result<(), UrdfError> {
    if xml.len() > MAX_BYTES {
        return Err(UrdfError::new(None, UrdfProblem::TooLarge { limit: MAX_BYTES }));
    }
    if xml.trim_start_matches('\u{feff}').trim().is_empty() {
        return Err(UrdfError::new(None, UrdfProblem::Empty));
    }
    let mut depth = 0_usize;
    for token in tokens(xml).filter(Token::is_tag) {
        let fail = |problem| Err(UrdfError::new(line(xml, token.at), problem));
        if token.text.len() > MAX_ATTRIBUTES && token.text.matches('=').count() > MAX_ATTRIBUTES {
            return fail(UrdfProblem::TooManyAttributes { limit: MAX_ATTRIBUTES });
        }
        match token.kind {
            Kind::Open => depth += 1,
            Kind::Close => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > MAX_DEPTH {
            return fail(UrdfProblem::TooDeep { limit: MAX_DEPTH });
        }
    }
    Ok(())
}

/// Returns the line number of a byte offset, counted from 1; `None` if it exceeds `u32`.
pub(super) fn line(xml: &str, at: usize) -> Option<u32> {
    let before = xml.as_bytes()[..at].iter().filter(|&&b| b == b'\n').count();
    u32::try_from(before + 1).ok()
}

#[cfg(test)]
mod tests {
    use super::{MAX_ATTRIBUTES, MAX_BYTES, MAX_DEPTH, UrdfProblem, check, decode};

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
    fn text_that_must_not_be_parsed_is_rejected() {
        assert_eq!(problem(""), UrdfProblem::Empty);
        assert_eq!(problem("\u{feff} \n"), UrdfProblem::Empty);
        assert_eq!(problem(&" ".repeat(MAX_BYTES + 1)), UrdfProblem::TooLarge { limit: MAX_BYTES });
        let many_attributes = format!("<r {}/>", "a='' ".repeat(100_000));
        assert!(matches!(problem(&many_attributes), UrdfProblem::TooManyAttributes { .. }));
        assert_eq!(check(&format!("<r a='{}'/>", "a".repeat(100_000))), Ok(()));
    }

    #[test]
    fn the_line_is_that_of_the_tag() {
        let attributes = " a=''".repeat(MAX_ATTRIBUTES + 1);
        let error = check(&format!("<r>\n\n<a{attributes}/></r>")).expect_err("too many");
        assert_eq!(error.line, Some(3));
    }

    #[test]
    fn bytes_that_are_not_utf_8_are_latin_1() {
        let (text, note) = decode(b"<r>\n<!-- L\xe4nge --></r>\0\n".to_vec()).expect("a text");
        assert!(text.contains("L\u{e4}nge"));
        assert!(note.expect("a remark").to_string().starts_with("line 2 is not UTF-8"));
        let two_bytes = decode(b"\xff\xfe<\0r\0/\0>\0".to_vec()).expect_err("must be refused");
        assert_eq!(*two_bytes.problem, UrdfProblem::NotUtf8 { at: 0 });
    }
}
