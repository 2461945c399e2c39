//! Lookup of frames, joints and bodies by name.

use super::error::ModelError;
use super::tree::Model;

impl Model {
    /// Returns the index of the frame `name` in [`Model::frames`].
    ///
    /// # Errors
    /// [`ModelError::UnknownName`], which suggests a similar name if there is one.
    pub fn frame(&self, name: &str) -> Result<usize, ModelError> {
        find("frame", name, self.frame_names())
    }

    /// Returns the index of the joint `name` in the order of the joints in `v`; the first joint after the
    /// base has index 0.
    ///
    /// # Errors
    /// [`ModelError::UnknownName`], which suggests a similar name if there is one.
    pub fn joint(&self, name: &str) -> Result<usize, ModelError> {
        find("joint", name, self.joint_names())
    }

    /// Returns the index of the body `name`; the base has index 0.
    ///
    /// # Errors
    /// [`ModelError::UnknownName`], which suggests a similar name if there is one.
    pub fn body(&self, name: &str) -> Result<usize, ModelError> {
        find("body", name, self.body_names())
    }

    /// Returns true if `other` has the same frames and joints, by name and order, so that objects created for
    /// one robot are valid for the other.
    pub fn is_like(&self, other: &Self) -> bool {
        self.frame_names().eq(other.frame_names()) && self.joint_names().eq(other.joint_names())
    }

    /// Returns the names of the frames: all links, followed by the frames that were added to links.
    pub fn frame_names(&self) -> impl Iterator<Item = &str> + Clone {
        self.frames.iter().map(|frame| frame.name.as_str())
    }

    /// Returns the names of the moving joints, in the order of `v`.
    pub fn joint_names(&self) -> impl Iterator<Item = &str> + Clone {
        self.joints.iter().map(|joint| joint.name.as_str())
    }

    /// Returns the names of the bodies, base first.
    pub fn body_names(&self) -> impl Iterator<Item = &str> + Clone {
        self.body_frames.iter().map(|&frame| self.frames[frame].name.as_str())
    }
}

/// Returns the index of `name` in `names`. The error calls the object `what`, such as `joint`.
///
/// # Errors
/// [`ModelError::UnknownName`] if `name` is not among `names`.
pub(super) fn find<'a>(
    what: &'static str,
    name: &str,
    mut names: impl Iterator<Item = &'a str> + Clone,
) -> Result<usize, ModelError> {
    let candidates = names.clone();
    names.position(|candidate| candidate == name).ok_or_else(|| ModelError::UnknownName {
        what,
        name: name.to_owned(),
        candidates: candidates.map(str::to_owned).collect(),
    })
}
