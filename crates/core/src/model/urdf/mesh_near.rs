//! Search near the URDF for meshes that do not exist at the path given by their name.

use super::mesh_name::tails;
use std::collections::{HashMap, HashSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Number of parent folders of the URDF that are searched as well.
const PARENTS: usize = 3;

/// Finder of files by the end of their path. Each folder is listed only once, because many links have meshes.
pub(super) struct Near<'a> {
    /// Folder of the URDF file; `None` if the URDF was given as text without a folder.
    folder: Option<&'a Path>,
    /// Folders that are packages or contain packages.
    packages: &'a [PathBuf],
    /// Folders in which a mesh file is searched for; the key is the folder in the name of the file.
    places: HashMap<PathBuf, Rc<[Place]>>,
    /// Names of the entries of each folder; empty if the folder does not exist.
    listings: HashMap<PathBuf, Rc<HashSet<OsString>>>,
}

struct Place {
    folder: PathBuf,
    names: Rc<HashSet<OsString>>,
    /// True if none of the folders in the name of the file matches.
    is_guess: bool,
}

impl<'a> Near<'a> {
    pub(super) fn new(folder: Option<&'a Path>, packages: &'a [PathBuf]) -> Self {
        Self { folder, packages, places: HashMap::new(), listings: HashMap::new() }
    }

    /// Returns the files that match the end of a path, the longest match first. Each is paired with a flag
    /// that is true if only the bare file name matches.
    pub(super) fn candidates(&mut self, path: &Path) -> Vec<(PathBuf, bool)> {
        let (Some(folder), Some(file)) = (path.parent(), path.file_name()) else { return Vec::new() };
        let places = self.places(folder);
        let holding = places.iter().filter(|place| place.names.contains(file));
        holding.map(|place| (place.folder.join(file), place.is_guess)).collect()
    }

    /// Returns the folders that match the end of the path `folder`, below the given folders, the folder of
    /// the URDF and some of its parents. These are followed by the folder of the URDF and its subfolder
    /// `meshes`, in which only the bare file name must match.
    fn places(&mut self, folder: &Path) -> Rc<[Place]> {
        if let Some(known) = self.places.get(folder) {
            return known.clone();
        }
        let own = self.folder;
        let above = own.into_iter().flat_map(Path::ancestors).take(PARENTS + 1);
        let roots: Vec<&Path> = self.packages.iter().map(PathBuf::as_path).chain(above).collect();
        let ends = tails(folder);
        let alike = ends.iter().flat_map(|end| roots.iter().map(move |root| (root.join(end), false)));
        let bare = own.into_iter().flat_map(|own| [(own.to_owned(), true), (own.join("meshes"), true)]);
        let all = alike.chain(bare).map(|(folder, is_guess)| {
            let names = self.names_in(&folder);
            Place { folder, names, is_guess }
        });
        let found: Rc<[Place]> = all.filter(|place| !place.names.is_empty()).collect();
        self.places.insert(folder.to_owned(), found.clone());
        found
    }

    fn names_in(&mut self, folder: &Path) -> Rc<HashSet<OsString>> {
        if let Some(known) = self.listings.get(folder) {
            return known.clone();
        }
        let entries = folder.read_dir().into_iter().flatten().flatten();
        let names = Rc::new(entries.map(|entry| entry.file_name()).collect::<HashSet<_>>());
        self.listings.insert(folder.to_owned(), names.clone());
        names
    }
}
