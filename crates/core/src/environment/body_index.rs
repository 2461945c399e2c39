//! Indices of bodies: by system and body, and by row in blocks of eight.

use super::soa::WIDTH;
use std::fmt;

/// Index of a body of one of the systems of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BodyIndex {
    /// Number of the system, from 0.
    pub system: usize,
    /// Index of the body in its system, base first.
    pub body: usize,
}

impl From<usize> for BodyIndex {
    /// Returns the body with this index in the first system.
    fn from(body: usize) -> Self {
        Self { system: 0, body }
    }
}

impl fmt::Display for BodyIndex {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.system {
            0 => write!(f, "body {}", self.body),
            system => write!(f, "body {} of system {system}", self.body),
        }
    }
}

/// Rows of all bodies in blocks of [`WIDTH`]; every system starts a new block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BlockLayout {
    /// First row and number of bodies of each system.
    systems: Vec<(usize, usize)>,
}

impl BlockLayout {
    /// Returns the layout of systems with these numbers of bodies.
    pub(super) fn new(counts: &[usize]) -> Self {
        let mut next = 0;
        let place = |&count: &usize| {
            let first = next;
            next += count.next_multiple_of(WIDTH);
            (first, count)
        };
        Self { systems: counts.iter().map(place).collect() }
    }

    pub(super) fn block_count(&self) -> usize {
        self.systems.last().map_or(0, |(first, count)| (first + count).div_ceil(WIDTH))
    }

    pub(super) fn body_count(&self) -> usize {
        self.systems.iter().map(|(_, count)| count).sum()
    }

    /// Returns the first row and the number of bodies of each system.
    pub(super) fn systems(&self) -> &[(usize, usize)] {
        &self.systems
    }

    /// Returns the row of a body, if it exists.
    pub(super) fn row(&self, BodyIndex { system, body }: BodyIndex) -> Option<usize> {
        self.systems.get(system).filter(|(_, count)| body < *count).map(|(first, _)| first + body)
    }

    /// Returns all bodies, system by system, base first.
    pub(super) fn bodies(&self) -> impl Iterator<Item = BodyIndex> {
        let systems = self.systems.iter().enumerate();
        systems.flat_map(|(system, (_, count))| (0..*count).map(move |body| BodyIndex { system, body }))
    }
}
