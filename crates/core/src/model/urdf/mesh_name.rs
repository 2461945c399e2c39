//! Parser of the `filename` of a mesh.

use std::path::{Component, Path, PathBuf};

/// Largest number of path components compared when searching for a file by the end of its path.
const LONGEST_TAIL: usize = 5;

/// Parsed `filename` of a mesh.
#[derive(Debug, PartialEq)]
pub(super) enum MeshName {
    /// `package://name/rest` (also with a third slash), or Gazebo's `model://name/rest`.
    InPackage { package: String, rest: PathBuf },
    /// Path, absolute or relative to the URDF, with or without `file://`.
    File(PathBuf),
}

impl MeshName {
    /// Parses a name; returns `None` if it does not refer to a local file.
    pub(super) fn of(name: &str) -> Option<Self> {
        if let Some(inside) = name.strip_prefix("package://").or_else(|| name.strip_prefix("model://")) {
            let inside = plain(inside.trim_start_matches('/'));
            let (package, rest) = inside.split_once('/')?;
            let is_whole = !package.is_empty() && !rest.is_empty();
            return is_whole.then(|| Self::InPackage { package: package.to_owned(), rest: rest.into() });
        }
        if let Some(path) = name.strip_prefix("file://") {
            let path = plain(path);
            return Some(Self::File(
                path.strip_prefix("localhost").filter(|at| at.starts_with('/')).unwrap_or(&path).into(),
            ));
        }
        (!name.is_empty() && !name.contains("://")).then(|| Self::File(name.replace('\\', "/").into()))
    }

    /// Returns the path below the package or, for a file outside packages, the whole path.
    pub(super) fn path(&self) -> &Path {
        match self {
            Self::InPackage { rest, .. } => rest,
            Self::File(path) => path,
        }
    }
}

/// Returns the path endings with at most `LONGEST_TAIL` components, the longest first, omitting the root and
/// `..`.
pub(super) fn tails(path: &Path) -> Vec<PathBuf> {
    let names: Vec<_> = path.components().filter(|part| matches!(part, Component::Normal(_))).collect();
    let first = names.len().saturating_sub(LONGEST_TAIL);
    (first..names.len()).map(|start| names[start..].iter().collect()).collect()
}

/// Decodes the escapes of a URI (`%20`) and replaces backslashes by slashes. A `%` that begins no escape is
/// kept.
fn plain(uri: &str) -> String {
    let hex = |at: usize| uri.get(at..at + 2).and_then(|digits| u8::from_str_radix(digits, 16).ok());
    let (mut bytes, mut at) = (Vec::with_capacity(uri.len()), 0);
    while let Some(&byte) = uri.as_bytes().get(at) {
        let escaped = if byte == b'%' { hex(at + 1) } else { None };
        bytes.push(escaped.unwrap_or(byte));
        at += if escaped.is_some() { 3 } else { 1 };
    }
    String::from_utf8(bytes).unwrap_or_else(|_| uri.to_owned()).replace('\\', "/")
}

#[cfg(test)]
mod tests {
    use super::{MeshName, tails};
    use std::path::{Path, PathBuf};

    #[test]
    fn names_are_packages_or_files() {
        let file = |path: &str| Some(MeshName::File(path.into()));
        let inside = |package: &str, rest: &str| {
            Some(MeshName::InPackage { package: package.to_owned(), rest: rest.into() })
        };
        assert_eq!(MeshName::of("package://a/b/c.stl"), inside("a", "b/c.stl"));
        assert_eq!(MeshName::of("package:///a/b/c.stl"), inside("a", "b/c.stl"));
        assert_eq!(MeshName::of("model://a/b%20c.stl"), inside("a", "b c.stl"));
        assert_eq!(MeshName::of("file:///a/50%25%zz%C3%A4.stl"), file("/a/50%%zzä.stl"));
        assert_eq!(MeshName::of("file://localhost/a.stl"), file("/a.stl"));
        assert_eq!(MeshName::of("file://meshes/a.stl"), file("meshes/a.stl"));
        assert_eq!(MeshName::of("..\\meshes\\a%20b.stl"), file("../meshes/a%20b.stl"));
        for none in ["", "package://", "package://a", "package:///x", "package://a/", "http://a/b.stl"] {
            assert_eq!(MeshName::of(none), None, "{none}");
        }
    }

    #[test]
    fn tails_go_from_long_to_short() {
        let found = |path| tails(Path::new(path));
        assert_eq!(found("../m/./a.stl"), ["m/a.stl", "a.stl"].map(PathBuf::from));
        assert_eq!(found("/1/2/3/4/5/6.stl")[0], PathBuf::from("2/3/4/5/6.stl"));
        assert!(found("/").is_empty() && found("..").is_empty());
    }
}
