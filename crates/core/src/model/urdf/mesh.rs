//! Where mesh files are: `package://`, `file://` and relative names.

use crate::model::ModelWarning;
use std::path::{Path, PathBuf};

/// Finds meshes, and remembers those it did not find.
pub(super) struct Meshes<'a> {
    /// The URDF's folder.
    folder: Option<&'a Path>,
    /// Folders that hold packages, or are one.
    packages: &'a [PathBuf],
    missing: Vec<String>,
}

impl<'a> Meshes<'a> {
    pub(super) fn new(folder: Option<&'a Path>, packages: &'a [PathBuf]) -> Self {
        Self { folder, packages, missing: Vec::new() }
    }

    /// The path of a mesh that exists, else the name as it stands in the file.
    pub(super) fn resolve(&mut self, name: &str) -> String {
        let found = self.candidates(name).into_iter().find(|path| path.is_file());
        if let Some(path) = found.as_deref().and_then(Path::to_str) {
            return path.to_owned();
        }
        if !self.missing.iter().any(|missing| missing == name) {
            self.missing.push(name.to_owned());
        }
        name.to_owned()
    }

    /// One remark about all meshes that were not found.
    pub(super) fn warning(&self) -> Option<ModelWarning> {
        let first = self.missing.first()?;
        let (count, files) = (self.missing.len(), if self.missing.len() == 1 { "file" } else { "files" });
        let hint = match package_of(first) {
            Some((package, _)) => format!("; name the folder that holds the package '{package}'"),
            None => String::new(),
        };
        Some(ModelWarning::Note(format!(
            "{count} mesh {files} not found, the first is '{first}': simpler shapes are drawn instead{hint}"
        )))
    }

    fn candidates(&self, name: &str) -> Vec<PathBuf> {
        if let Some((package, rest)) = package_of(name) {
            return self.in_package(package, rest);
        }
        let name = name.strip_prefix("file://").unwrap_or(name);
        let path = Path::new(name);
        match self.folder {
            _ if path.is_absolute() => vec![path.to_owned()],
            Some(folder) => vec![folder.join(path)],
            None => Vec::new(),
        }
    }

    /// Below every folder given, then below every parent of the URDF: beside the package's own
    /// folder, or inside it.
    fn in_package(&self, package: &str, rest: &str) -> Vec<PathBuf> {
        let parents = self.folder.into_iter().flat_map(Path::ancestors);
        let roots = self.packages.iter().map(PathBuf::as_path).chain(parents);
        let mut candidates = Vec::new();
        for root in roots {
            if root.file_name().is_some_and(|name| name == package) {
                candidates.push(root.join(rest));
            }
            candidates.push(root.join(package).join(rest));
        }
        candidates
    }
}

/// `package://name/rest` (Gazebo also writes `model://`), split.
fn package_of(name: &str) -> Option<(&str, &str)> {
    let inside = name.strip_prefix("package://").or_else(|| name.strip_prefix("model://"))?;
    let (package, rest) = inside.split_once('/')?;
    (!package.is_empty()).then_some((package, rest))
}

#[cfg(test)]
mod tests {
    use super::{Meshes, package_of};
    use std::fs;
    use std::path::PathBuf;

    #[test]
    fn a_package_is_found_by_its_folder_beside_it_or_where_told() {
        let root = std::env::temp_dir().join(format!("onorbit_mesh_{}", std::process::id()));
        let (urdf, meshes) = (root.join("arm_description/urdf"), root.join("arm_description/meshes"));
        let other = root.join("elsewhere/hand_description");
        for folder in [&urdf, &meshes, &other] {
            fs::create_dir_all(folder).expect("a temporary folder can be made");
        }
        let (arm, hand) = (meshes.join("arm.stl"), other.join("hand.stl"));
        for file in [&arm, &hand] {
            fs::write(file, "solid").expect("a temporary file can be written");
        }
        let path = |file: &PathBuf| file.to_str().expect("the name is UTF-8").to_owned();

        let mut found = Meshes::new(Some(&urdf), &[]);
        assert_eq!(found.resolve("package://arm_description/meshes/arm.stl"), path(&arm));
        assert_eq!(found.resolve(&format!("file://{}", path(&arm))), path(&arm));
        assert_eq!(PathBuf::from(found.resolve("../meshes/arm.stl")), urdf.join("../meshes/arm.stl"));
        assert_eq!(found.warning(), None);
        assert_eq!(
            found.resolve("package://hand_description/hand.stl"),
            "package://hand_description/hand.stl"
        );
        assert!(found.warning().expect("one is missing").to_string().contains("'hand_description'"));

        for packages in [[root.join("elsewhere")], [other.clone()]] {
            let mut told = Meshes::new(None, &packages);
            assert_eq!(told.resolve("package://hand_description/hand.stl"), path(&hand));
        }
        fs::remove_dir_all(root).expect("the folder is ours");
    }

    #[test]
    fn odd_names_stay_as_they_are() {
        let mut meshes = Meshes::new(None, &[]);
        for name in ["", "package://", "package:///x", "http://a/b.stl", "a\u{0}b", "$(find x)/y.dae"] {
            assert_eq!(meshes.resolve(name), name);
        }
        assert_eq!(package_of("package://a/b/c"), Some(("a", "b/c")));
        assert_eq!(package_of("a/b"), None);
    }
}
