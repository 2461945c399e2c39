//! Connections between the systems of a run.

use super::members::SavedPart;
use crate::model::{Closure, Model, ModelError};
use crate::spatial::{Mat3, Vec3};
use crate::world::{Assembly, FrameIndex, Member, Weld, assemble};
use serde::{Deserialize, Serialize};

/// Active connections of the systems of a run.
#[derive(Debug, Default)]
pub(super) struct Connections {
    /// Models of the systems, with the names of the systems as prefixes of all links, joints and frames;
    /// empty if the run has no events.
    prefixed: Vec<Model>,
    pub(super) active: ActiveWelds,
}

/// Active connections (welds) between systems, and the roots of the trees that they form.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct ActiveWelds {
    pub(super) welds: Vec<Weld>,
    /// Indices of the systems that are the roots of trees that have, or have had, several members.
    pub(super) roots: Vec<usize>,
}

impl Connections {
    /// Creates the connections at the start of a run, when no systems are connected yet. The systems are
    /// given by their names and models.
    pub(super) fn new<'m>(
        systems: impl Iterator<Item = (&'m str, &'m Model)>,
        has_events: bool,
    ) -> Result<Self, ModelError> {
        let prefixed =
            systems.filter(|_| has_events).map(|(name, model)| model.prefixed(&format!("{name}/")));
        Ok(Self { prefixed: prefixed.collect::<Result<_, _>>()?, active: ActiveWelds::default() })
    }

    /// Returns the indices of the systems that are connected to a system, including that system, in ascending
    /// order.
    pub(super) fn connected_to(&self, system: usize) -> Vec<usize> {
        let (mut found, mut next) = (vec![system], 0);
        while let Some(&system) = found.get(next) {
            next += 1;
            for [a, b] in self.active.welds.iter().map(|weld| [weld.by.system, weld.of.system]) {
                let other = if a == system { b } else { a };
                if [a, b].contains(&system) && !found.contains(&other) {
                    found.push(other);
                }
            }
        }
        found.sort_unstable();
        found
    }

    /// Removes the weld with index `weld`. If this separates its tree in two, one of the two trees keeps the
    /// root. The system at the other end of the weld becomes the root of the other tree.
    pub(super) fn remove(&mut self, weld: usize) {
        let Weld { by, of, .. } = self.active.welds.remove(weld);
        for system in [by.system, of.system] {
            if self.root_of(system).is_none() {
                self.active.roots.push(system);
            }
        }
    }

    /// Adds a weld. The root of the joined tree is the root of the tree of the capturing frame.
    pub(super) fn add(&mut self, weld: Weld) {
        let root = self.root_of(weld.by.system).unwrap_or(weld.by.system);
        self.active.welds.push(weld);
        let tree = self.connected_to(root);
        self.active.roots.retain(|root| !tree.contains(root));
        self.active.roots.push(root);
    }

    /// Returns the index of the root of the tree that contains a system; `None` if this tree has no root,
    /// because the system has never been connected or a removed weld has separated it from its root.
    fn root_of(&self, system: usize) -> Option<usize> {
        let tree = self.connected_to(system);
        self.active.roots.iter().copied().find(|root| tree.contains(root))
    }

    /// Assembles the trees for the active connections.
    pub(super) fn assemble(&self) -> Result<Vec<Assembly>, ModelError> {
        assemble(&self.prefixed, &self.active.welds, &self.active.roots)
    }

    /// Returns the model and the members of the tree whose root is `system`. Its other members are those
    /// systems in `knows` that are connected to `system`, directly or through each other. Returns `None` if
    /// there are no other members.
    pub(super) fn known_tree(
        &self,
        system: usize,
        knows: &[usize],
    ) -> Result<Option<(Model, Vec<Member>)>, ModelError> {
        let is_known = |other: usize| other == system || knows.contains(&other);
        let welds =
            self.active.welds.iter().filter(|weld| is_known(weld.by.system) && is_known(weld.of.system));
        // controllers do not know a seating motion in advance
        let welds: Vec<Weld> = welds.map(|weld| Weld { seating: None, ..weld.clone() }).collect();
        if welds.is_empty() {
            return Ok(None);
        }
        let tree = assemble(&self.prefixed, &welds, &[system])?.into_iter().next();
        Ok(tree.and_then(|Assembly { model, members, .. }| Some((model?, members))))
    }

    /// Returns the index in a tree of each frame of a system.
    pub(super) fn frames_in(&self, system: usize, tree: &Model) -> Result<Vec<usize>, ModelError> {
        self.prefixed[system].frames().iter().map(|frame| tree.frame(&frame.name)).collect()
    }

    /// Returns the pose of a frame in another frame of the same body of a tree; `None` if one of the frames
    /// is not in the tree, or if the frames belong to different bodies. The pose consists of the rotation to
    /// the axes of `other` and the position in these axes, m.
    pub(super) fn pose_in(
        &self,
        tree: &Model,
        frame: FrameIndex,
        other: FrameIndex,
    ) -> Option<(Mat3<f64>, Vec3<f64>)> {
        let find = |place| Some(&tree.frames()[tree.frame(self.frame_name(place)).ok()?]);
        let (frame, other) = (find(frame)?, find(other)?);
        let rot = other.rot_kf.transpose() * frame.rot_kf;
        (frame.body == other.body).then(|| (rot, other.rot_kf.transpose_mul(frame.pos_kf - other.pos_kf)))
    }

    /// Returns, for each loop or mimic joint of a tree, its name in the trace of a system: the name of the
    /// loop in that system, or of the capture that closes the loop; `None` for the loops and mimic joints of
    /// other systems. `name` returns the name of a capture from its index.
    pub(super) fn loops_in(
        &self,
        system: usize,
        tree: &Model,
        name: impl Fn(usize) -> String,
    ) -> Vec<Option<String>> {
        let own = self.prefixed[system].closures();
        let of = |closure: &Closure| {
            let closed_by = || {
                let weld = self.active.welds.iter().find(|weld| weld.loop_name() == closure.name)?;
                Some(name(weld.capture))
            };
            let is_own = own.iter().any(|own| own.name == closure.name);
            // names of systems have no slash
            let name = closure.name.split_once('/').filter(|_| is_own).map(|(_, name)| name.to_owned());
            name.or_else(closed_by)
        };
        tree.closures().iter().map(of).collect()
    }

    /// Returns the name of a frame in the models of trees, `SYSTEM/FRAME`.
    pub(super) fn frame_name(&self, place: FrameIndex) -> &str {
        &self.prefixed[place.system].frames()[place.frame].name
    }
}

/// State of the connections, for checkpoints.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedMembers {
    pub(super) active: ActiveWelds,
    pub(super) parts: Vec<SavedPart>,
}
