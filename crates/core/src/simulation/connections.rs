//! Connections between the systems of a run.

use super::members::SavedPart;
use crate::model::{Model, ModelError};
use crate::world::{Assembly, FrameIndex, Weld, assemble};
use serde::{Deserialize, Serialize};

/// Active connections of the systems of a run.
#[derive(Debug, Default)]
pub(super) struct Connections {
    /// Models of the systems, with the names of the systems as prefixes; empty if the run has no events.
    prefixed: Vec<Model>,
    pub(super) active: ActiveWelds,
}

/// Active welds, and the roots of the trees that they connect.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct ActiveWelds {
    pub(super) welds: Vec<Weld>,
    /// Systems that are roots of trees with several members.
    pub(super) roots: Vec<usize>,
}

impl Connections {
    /// Returns the connections of systems with these names and models before any event.
    pub(super) fn new<'m>(
        systems: impl Iterator<Item = (&'m str, &'m Model)>,
        has_events: bool,
    ) -> Result<Self, ModelError> {
        let prefixed =
            systems.filter(|_| has_events).map(|(name, model)| model.prefixed(&format!("{name}/")));
        Ok(Self { prefixed: prefixed.collect::<Result<_, _>>()?, active: ActiveWelds::default() })
    }

    /// Returns the trees for the active connections.
    pub(super) fn assemble(&self) -> Result<Vec<Assembly>, ModelError> {
        assemble(&self.prefixed, &self.active.welds, &self.active.roots)
    }

    /// Returns the name that a frame has in every tree.
    pub(super) fn frame_name(&self, place: FrameIndex) -> &str {
        &self.prefixed[place.system].frames()[place.frame].name
    }
}

/// State of the connections for checkpoints.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedMembers {
    pub(super) active: ActiveWelds,
    pub(super) parts: Vec<SavedPart>,
}
