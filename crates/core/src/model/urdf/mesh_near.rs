//! Search near the URDF for meshes that do not exist at their named path.

use super::mesh_name::tails;
use std::collections::{HashMap, HashSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Number of parent folders of the URDF in which tails of a path are searched.
const PARENTS: usize = 3;

/// Finder of files by the tail of their name, which lists each folder only once, since many links have
/// meshes.
pub(super) struct Near<'a> {
    /// Folder of the URDF file.
    folder: Option<&'a Path>,
    /// Folders that are packages or contain packages.
    packages: &'a [PathBuf],
    /// Candidate folders of a file, by the folder in its name.
    places: HashMap<PathBuf, Rc<[Place]>>,
    /// Entries of a folder; empty if it does not exist.
    listings: HashMap<PathBuf, Rc<HashSet<OsString>>>,
}

struct Place {
    folder: PathBuf,
    names: Rc<HashSet<OsString>>,
    /// True if none of the folders in the file's name matches.
    is_guess: bool,
}

impl<'a> Near<'a> {
    pub(super) fn new(folder: Option<&'a Path>, packages: &'a [PathBuf]) -> Self {
        Self { folder, packages, places: HashMap::new(), listings: HashMap::new() }
    }

    /// Returns the files that match a tail of a path, the longest tail first, each with true if only the bare file name
    /// matches.
    pub(super) fn candidates(&mut self, path: &Path) -> Vec<(PathBuf, bool)> {
        let (Some(folder), Some(file)) = (path.parent(), path.file_name()) else { return Vec::new() };
        let places = self.places(folder);
        let holding = places.iter().filter(|place| place.names.contains(file));
        holding.map(|place| (place.folder.join(file), place.is_guess)).collect()
    }

    /// Returns the folders that match a tail of `folder`, below the given folders, the folder of the URDF and some of
    /// its parents. These are followed by the folder of the URDF and its subfolder `meshes`, in which only the bare
    /// file name must match.
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
