//! Search for mesh files by name: `package://`, `file://`, relative paths, and files near the URDF.

use super::mesh_name::MeshName;
use super::mesh_near::Near;
use crate::model::ModelWarning;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Finder of mesh files. It records the missing ones and those whose location was guessed.
pub(super) struct Meshes<'a> {
    /// Folder of the URDF file; `None` if the URDF was given as text without a folder.
    folder: Option<&'a Path>,
    /// Folders that are packages or contain packages.
    packages: &'a [PathBuf],
    /// Results of the search for each name, cached because many links refer to the same file.
    known: HashMap<String, Option<Found>>,
    /// True for each folder that exists; cached to avoid a system call for each file in a missing folder.
    folders: HashMap<PathBuf, bool>,
    near: Near<'a>,
    /// For each file that was found for a reference to a package, the name of that package.
    taken: HashMap<String, String>,
    missing: Vec<String>,
    guessed: Vec<(String, String)>,
}

#[derive(Clone)]
struct Found {
    path: String,
    /// True if only the bare file name matches, without any folder.
    is_guess: bool,
}

impl<'a> Meshes<'a> {
    pub(super) fn new(folder: Option<&'a Path>, packages: &'a [PathBuf]) -> Self {
        Self {
            folder,
            packages,
            known: HashMap::new(),
            folders: HashMap::new(),
            near: Near::new(folder, packages),
            taken: HashMap::new(),
            missing: Vec::new(),
            guessed: Vec::new(),
        }
    }

    /// Returns the path of the mesh file `name`, and records it if its location was guessed. If no file is
    /// found, returns `name` unchanged and records the file as missing.
    pub(super) fn resolve(&mut self, name: &str) -> String {
        match self.look_up(name) {
            Some(Found { path, is_guess: false }) => path,
            Some(Found { path, is_guess: true }) => {
                if !self.guessed.iter().any(|(known, _)| known == name) {
                    self.guessed.push((name.to_owned(), path.clone()));
                }
                path
            }
            None => {
                if !self.missing.iter().any(|missing| missing == name) {
                    self.missing.push(name.to_owned());
                }
                name.to_owned()
            }
        }
    }

    /// Returns the path of a mesh file if it is found. Missing files and guessed locations are not recorded.
    pub(super) fn find(&mut self, name: &str) -> Option<String> {
        self.look_up(name).map(|found| found.path)
    }

    /// Returns up to two warnings: one about missing meshes, and one about meshes whose location was guessed.
    pub(super) fn warnings(&self) -> impl Iterator<Item = ModelWarning> {
        self.about_missing().into_iter().chain(self.about_guessed()).map(ModelWarning::Note)
    }

    fn about_missing(&self) -> Option<String> {
        let first = self.missing.first()?;
        let files = mesh_files(self.missing.len());
        let hint = match MeshName::of(first) {
            Some(MeshName::InPackage { package, .. }) => {
                format!(
                    "; give the folder that contains the package '{package}' in package_paths (on the \
                     command line: --package-path)"
                )
            }
            Some(MeshName::File(_)) => {
                "; copy each missing file into a folder 'meshes' beside the URDF file".to_owned()
            }
            None => {
                "; only local files are read: give a path, package://PACKAGE/PATH or file://PATH".to_owned()
            }
        };
        let such = if self.missing.len() == 1 { ":" } else { ", the first being" };
        Some(format!("{files} not found{such} '{first}'; simpler shapes are drawn instead{hint}"))
    }

    fn about_guessed(&self) -> Option<String> {
        let (name, path) = self.guessed.first()?;
        let files = mesh_files(self.guessed.len());
        Some(format!(
            "{files} not found where the URDF states; a file of the same name in the folder of the URDF, or \
             in its subfolder 'meshes', is drawn instead (for '{name}': {path}); correct the URDF if another \
             file is meant"
        ))
    }

    fn look_up(&mut self, name: &str) -> Option<Found> {
        if let Some(known) = self.known.get(name) {
            return known.clone();
        }
        let found =
            MeshName::of(name).and_then(|parsed| self.at_its_path(&parsed).or_else(|| self.near(&parsed)));
        self.known.insert(name.to_owned(), found.clone());
        found
    }

    /// Returns the file at the exact path that its name states, if it exists; for names in a package, see
    /// [`Self::in_package`].
    fn at_its_path(&mut self, name: &MeshName) -> Option<Found> {
        let candidates = match name {
            MeshName::InPackage { package, rest } => self.in_package(package, rest),
            MeshName::File(path) if path.is_absolute() => vec![path.clone()],
            MeshName::File(path) => self.folder.map(|folder| folder.join(path)).into_iter().collect(),
        };
        let path = candidates.iter().find(|path| self.is_file(path))?.to_str()?.to_owned();
        if let MeshName::InPackage { package, .. } = name {
            self.taken.insert(path.clone(), package.clone());
        }
        Some(Found { path, is_guess: false })
    }

    /// Returns the paths at which the file `rest` of `package` may be: first below the given folders, then
    /// below the folder of the URDF and each of its parents. Each of these folders may either be the package
    /// or contain it.
    fn in_package(&self, package: &str, rest: &Path) -> Vec<PathBuf> {
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

    fn near(&mut self, name: &MeshName) -> Option<Found> {
        for (candidate, is_guess) in self.near.candidates(name.path()) {
            let Some(path) = candidate.to_str() else { continue };
            if candidate.is_file() && self.is_free(path, name) {
                return Some(Found { path: path.to_owned(), is_guess });
            }
        }
        None
    }

    /// Returns true unless the file was already found for a reference that names another package, because two
    /// packages may both contain `meshes/base.stl`. A file that is found for the first time is recorded for
    /// the package.
    fn is_free(&mut self, path: &str, name: &MeshName) -> bool {
        let MeshName::InPackage { package, .. } = name else { return true };
        self.taken.entry(path.to_owned()).or_insert_with(|| package.clone()) == package
    }

    fn is_file(&mut self, path: &Path) -> bool {
        let Some(folder) = path.parent() else { return false };
        if let Some(is_there) = self.folders.get(folder) {
            return *is_there && path.is_file();
        }
        let is_there = folder.is_dir();
        self.folders.insert(folder.to_owned(), is_there);
        is_there && path.is_file()
    }
}

fn mesh_files(count: usize) -> String {
    format!("{count} mesh {}", if count == 1 { "file was" } else { "files were" })
}

#[cfg(test)]
mod tests {
    use super::Meshes;
    use std::fs;
    use std::path::PathBuf;

    #[test]
    fn a_package_is_found_beside_the_file_or_in_a_given_folder() {
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
        assert_eq!(found.warnings().next(), None);
        assert_eq!(
            found.resolve("package://hand_description/hand.stl"),
            "package://hand_description/hand.stl"
        );
        let warning = found.warnings().next().expect("one is missing");
        assert!(warning.to_string().contains("'hand_description'"));

        for packages in [[root.join("elsewhere")], [other.clone()]] {
            let mut given = Meshes::new(None, &packages);
            assert_eq!(given.resolve("package://hand_description/hand.stl"), path(&hand));
        }
        fs::remove_dir_all(root).expect("the folder is ours");
    }

    #[test]
    fn meshes_near_the_file_are_found_by_the_end_of_their_name() {
        let root = std::env::temp_dir().join(format!("onorbit_near_{}", std::process::id()));
        let (urdf, meshes) = (root.join("copy/urdf"), root.join("copy/meshes"));
        for folder in [urdf.join("meshes"), meshes.join("visual")] {
            fs::create_dir_all(folder).expect("a temporary folder can be made");
        }
        let files = ["copy/meshes/visual/arm.dae", "copy/urdf/meshes/hand.stl", "copy/urdf/my bus.obj"];
        for file in files.iter().chain(&["bus.stl"]) {
            fs::write(root.join(file), "solid").expect("a temporary file can be written");
        }
        let [arm, hand, bus] = files.map(|file| root.join(file).to_str().expect("UTF-8").to_owned());

        let mut found = Meshes::new(Some(&urdf), &[]);
        assert_eq!(found.resolve("package://arm/meshes/visual/arm.dae"), arm);
        assert_eq!(found.resolve("file:///home/me/ws/src/arm/meshes/visual/arm.dae"), arm);
        assert_eq!(found.resolve("file://my%20bus.obj"), bus);
        assert_eq!(found.warnings().next(), None, "folders in their names match, so there is no warning");
        assert_eq!(found.resolve("package://arm/stl/hand.stl"), hand);
        let guesses: Vec<_> = found.warnings().map(|warning| warning.to_string()).collect();
        assert!(guesses.len() == 1 && guesses[0].contains("'package://arm/stl/hand.stl'"), "{guesses:?}");
        // files of the same name in another package, or above the folders that identify the package, are not
        // used
        for other in ["package://gripper/meshes/visual/arm.dae", "package://arm/bus.stl"] {
            assert_eq!(found.resolve(other), other);
        }
        assert_eq!(found.find("package://arm/bus.stl"), None);

        let given = [root.join("copy")];
        assert_eq!(Meshes::new(None, &given).resolve("package://x/meshes/visual/arm.dae"), arm);
        fs::remove_dir_all(root).expect("the folder is ours");
    }

    #[test]
    fn odd_names_stay_as_they_are() {
        let mut meshes = Meshes::new(None, &[]);
        for name in ["", "package://", "package:///x", "http://a/b.stl", "a\u{0}b", "$(find x)/y.dae"] {
            assert_eq!(meshes.resolve(name), name);
        }
        let mut meshes = Meshes::new(None, &[]);
        meshes.resolve("http://a/b.stl");
        let warning = meshes.warnings().next().expect("it is missing").to_string();
        assert!(warning.contains("'http://a/b.stl'") && warning.contains("only local files"), "{warning}");
    }
}
