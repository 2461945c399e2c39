//! Meshes that are not where their name says, but near the URDF.

use super::mesh_name::tails;
use std::collections::{HashMap, HashSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Folders above the URDF's in which the end of a name is looked for.
const PARENTS: usize = 3;

/// Finds files by the end of their name; looks into each folder once, since many links have meshes.
pub(super) struct Near<'a> {
    /// The URDF's folder.
    folder: Option<&'a Path>,
    /// Folders that hold packages, or are one.
    packages: &'a [PathBuf],
    /// Where a file may be, by the folder in its name.
    places: HashMap<PathBuf, Rc<[Place]>>,
    /// What is in a folder; nothing where it is not there.
    listings: HashMap<PathBuf, Rc<HashSet<OsString>>>,
}

struct Place {
    folder: PathBuf,
    names: Rc<HashSet<OsString>>,
    /// Nothing of the folders in the file's name is in its own.
    is_guess: bool,
}

impl<'a> Near<'a> {
    pub(super) fn new(folder: Option<&'a Path>, packages: &'a [PathBuf]) -> Self {
        Self { folder, packages, places: HashMap::new(), listings: HashMap::new() }
    }

    /// What is named as a path ends, the longest end first, and whether only the bare name speaks for it.
    pub(super) fn candidates(&mut self, path: &Path) -> Vec<(PathBuf, bool)> {
        let (Some(folder), Some(file)) = (path.parent(), path.file_name()) else { return Vec::new() };
        let places = self.places(folder);
        let holding = places.iter().filter(|place| place.names.contains(file));
        holding.map(|place| (place.folder.join(file), place.is_guess)).collect()
    }

    /// Folders that end as one in a name does, below those given, the URDF's and some above it; then,
    /// for the bare name of a file, the URDF's own and `meshes` in it.
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
