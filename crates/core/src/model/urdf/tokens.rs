//! Tokenizer that splits a text into tags, comments and the text between them, without validation.
//!
//! The text is read in one pass without recursion, so that neither deep nesting nor an entity bomb can
//! exhaust the stack or the memory.

/// Kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Text,
    Comment,
    /// A processing instruction or the XML declaration, `<?…?>`.
    Instruction,
    /// A document type, `<!DOCTYPE …>`, or a declaration in it.
    Declaration,
    CData,
    Open,
    Close,
    /// An empty-element tag, `<…/>`.
    Empty,
}

/// Contiguous part of a text: a tag, a comment or the text between them.
#[derive(Clone, Copy)]
pub(super) struct Token<'a> {
    pub(super) kind: Kind,
    /// Byte offset of the start of the token in the text.
    pub(super) at: usize,
    pub(super) text: &'a str,
}

impl Token<'_> {
    pub(super) fn is_tag(&self) -> bool {
        matches!(self.kind, Kind::Open | Kind::Close | Kind::Empty)
    }

    pub(super) fn end(&self) -> usize {
        self.at + self.text.len()
    }
}

impl<'a> Token<'a> {
    /// Splits a tag into its name and the text after the name.
    pub(super) fn split_name(&self) -> (&'a str, &'a str) {
        let rest = inside(self.text);
        let rest = rest.strip_prefix('/').map_or(rest, str::trim_start);
        let ends = |c: char| c.is_whitespace() || matches!(c, '/' | '>');
        rest.split_at(rest.find(ends).unwrap_or(rest.len()))
    }
}

/// Returns a tag without its leading `<` and the spaces after it, which tinyxml2 accepts.
fn inside(tag: &str) -> &str {
    tag.strip_prefix('<').map_or(tag, str::trim_start)
}

/// Returns all tokens of a text in order; together they are the whole text.
pub(super) fn tokens(xml: &str) -> impl Iterator<Item = Token<'_>> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let rest = xml.get(at..).filter(|rest| !rest.is_empty())?;
        let (kind, length) = first(rest);
        let token = Token { kind, at, text: &rest[..length] };
        at += length;
        Some(token)
    })
}

/// Returns the kind and the length, in bytes, of the first token of a text.
fn first(rest: &str) -> (Kind, usize) {
    if !rest.starts_with('<') {
        return (Kind::Text, rest.find('<').unwrap_or(rest.len()));
    }
    for (start, end, kind) in [
        ("<!--", "-->", Kind::Comment),
        ("<![CDATA[", "]]>", Kind::CData),
        ("<!", ">", Kind::Declaration),
        ("<?", "?>", Kind::Instruction),
    ] {
        if let Some(inside) = rest.strip_prefix(start) {
            // the dashes that open a comment are not part of its end
            let length = inside.find(end).map(|at| start.len() + at + end.len());
            return (kind, length.unwrap_or(rest.len()));
        }
    }
    let length = tag_length(rest);
    let kind = match (inside(rest).starts_with('/'), rest[..length].ends_with("/>")) {
        (true, _) => Kind::Close,
        (false, true) => Kind::Empty,
        (false, false) => Kind::Open,
    };
    (kind, length)
}

fn tag_length(tag: &str) -> usize {
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
