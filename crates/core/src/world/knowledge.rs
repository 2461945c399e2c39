//! Detection of entries of [`System::knows`] that have no effect.

use super::event::{Action, Event};
use super::groups::Union;
use super::system::System;

/// Entry of [`System::knows`] that has no effect: no chain of captures connects the two systems, or every
/// such chain contains a system whose model is not known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IdleKnowledge {
    /// Index of the system whose controllers know the other system.
    pub system: usize,
    /// Index of the known system.
    pub known: usize,
    /// Indices of those systems on a shortest path of captures between the two that are not known; empty if
    /// no captures connect the two.
    pub through: Vec<usize>,
}

/// Returns the entries of [`System::knows`] that have no effect, whatever events happen.
pub fn idle_knowledge(systems: &[System], events: &[Event]) -> Vec<IdleKnowledge> {
    let pairs: Vec<[usize; 2]> = events
        .iter()
        .filter_map(|event| match event.action {
            Action::Capture { by, of, .. } => Some([by.system, of.system]),
            _ => None,
        })
        .collect();
    let mut found = Vec::new();
    for (system, System { knows, .. }) in systems.iter().enumerate() {
        let is_known = |other: &usize| *other == system || knows.contains(other);
        let mut reached = Union::new(systems.len());
        let known_pairs = pairs.iter().filter(|pair| pair.iter().all(is_known));
        known_pairs.for_each(|[a, b]| _ = reached.join(*a, *b));
        for &known in knows.iter().filter(|known| reached.first(**known) != reached.first(system)) {
            let mut through = path(systems.len(), &pairs, system, known);
            through.retain(|other| !is_known(other));
            found.push(IdleKnowledge { system, known, through });
        }
    }
    found
}

/// Returns the systems on a shortest path along `pairs` that starts at the system `from` and ends before the
/// system `to`, in order; empty if there is no path. `count` is the number of systems.
fn path(count: usize, pairs: &[[usize; 2]], from: usize, to: usize) -> Vec<usize> {
    let mut before = vec![None; count];
    let (mut queue, mut next) = (vec![from], 0);
    while let Some(&at) = queue.get(next) {
        next += 1;
        for &[a, b] in pairs.iter().filter(|pair| pair.contains(&at)) {
            let other = if a == at { b } else { a };
            if !queue.contains(&other) {
                before[other] = Some(at);
                queue.push(other);
            }
        }
    }
    let mut path: Vec<usize> = std::iter::successors(before[to], |at| before[*at]).collect();
    path.reverse();
    path
}
