//! Indices of bodies: by system and body, and by row in blocks of eight.

use super::soa::WIDTH;
use crate::number_text::{choice, count as counted};
use std::fmt;

/// Index of a body in one of the systems of a world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BodyIndex {
    /// Number of the system in the world, from 0. A run of only some of the systems keeps these numbers.
    pub system: usize,
    /// Index of the body in its system; the base has the index 0.
    pub body: usize,
}

impl From<usize> for BodyIndex {
    /// Creates the index of a body in the first system.
    fn from(body: usize) -> Self {
        Self { system: 0, body }
    }
}

impl fmt::Display for BodyIndex {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.body {
            0 => f.write_str("the base")?,
            body => write!(f, "body {body} (the base is body 0)")?,
        }
        if self.system > 0 { write!(f, " of system {}", self.system) } else { Ok(()) }
    }
}

/// Rows of all bodies in blocks of [`WIDTH`] rows; every system starts a new block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BlockLayout {
    systems: Vec<SystemRows>,
}

/// Rows of the bodies of one system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SystemRows {
    /// Number of the system in the world.
    pub(super) number: usize,
    /// Row of the base.
    pub(super) first: usize,
    /// Number of bodies of the system.
    pub(super) count: usize,
}

impl BlockLayout {
    /// Computes the layout of systems with the given numbers of bodies.
    pub(super) fn new(counts: &[usize]) -> Self {
        Self::of(counts.iter().copied().enumerate())
    }

    /// Computes the layout of some systems of a world, given as pairs of the system's number and its number
    /// of bodies.
    pub(super) fn of(systems: impl Iterator<Item = (usize, usize)>) -> Self {
        let mut next = 0;
        let place = |(number, count): (usize, usize)| {
            let first = next;
            next += count.next_multiple_of(WIDTH);
            SystemRows { number, first, count }
        };
        Self { systems: systems.map(place).collect() }
    }

    pub(super) fn block_count(&self) -> usize {
        self.systems.last().map_or(0, |rows| (rows.first + rows.count).div_ceil(WIDTH))
    }

    pub(super) fn body_count(&self) -> usize {
        self.systems.iter().map(|rows| rows.count).sum()
    }

    /// Returns the bodies that exist in a system, with the advice to give one of them, for the error about
    /// the index of a body that does not exist.
    pub(super) fn known(&self, system: usize) -> String {
        match (self.systems.iter().find(|rows| rows.number == system), self.systems.len()) {
            (Some(rows), 1) => format!("the robot has {}", choice(rows.count, "body")),
            (Some(rows), _) => format!("system {system} has {}", choice(rows.count, "body")),
            (None, _) => format!("there is no system {system}; give the number of an existing system"),
        }
    }

    /// Returns the rows of each system.
    pub(super) fn systems(&self) -> &[SystemRows] {
        &self.systems
    }

    /// Returns the row of a body, or `None` if the body does not exist.
    pub(super) fn row(&self, BodyIndex { system, body }: BodyIndex) -> Option<usize> {
        let rows = self.systems.iter().find(|rows| rows.number == system)?;
        (body < rows.count).then(|| rows.first + body)
    }

    /// Returns the indices of all bodies, system by system; the first body of a system is its base.
    pub(super) fn bodies(&self) -> impl Iterator<Item = BodyIndex> {
        let bodies = |rows: &SystemRows| {
            let system = rows.number;
            (0..rows.count).map(move |body| BodyIndex { system, body })
        };
        self.systems.iter().flat_map(bodies)
    }
}

impl fmt::Display for BlockLayout {
    /// Writes the number of bodies of each system: `5 bodies of system 0 and 1 body of system 1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of_system =
            |rows: &SystemRows| format!("{} of system {}", counted(rows.count, "body"), rows.number);
        let systems: Vec<String> = self.systems.iter().map(of_system).collect();
        f.write_str(if systems.is_empty() { "no bodies" } else { "" })?;
        f.write_str(&systems.join(" and "))
    }
}
