//! Groups of systems that may interact during a run. Systems of different groups never interact, so each
//! group is integrated as a separate run.

use super::event::{Action, Event, When};

/// Union-find structure: disjoint sets of the numbers from 0 to `count − 1`, which are joined two at a
/// time.
pub(super) struct Union {
    parent: Vec<usize>,
}

impl Union {
    pub(super) fn new(count: usize) -> Self {
        Self { parent: (0..count).collect() }
    }

    /// Returns the smallest number of the set that contains `i`.
    pub(super) fn first(&self, mut i: usize) -> usize {
        while self.parent[i] != i {
            i = self.parent[i];
        }
        i
    }

    /// Joins the set that contains `a` with the set that contains `b`. Returns false if both numbers are
    /// already in the same set.
    pub(super) fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.first(a), self.first(b));
        self.parent[a.max(b)] = a.min(b);
        a != b
    }
}

/// Returns the indices of the systems that the event `number` involves, possibly with repetitions: both
/// systems of a capture or of the capture that a release ends, or the system of a brake. For an event that
/// waits for another event, they include the systems of that event and of the events for which it waits in
/// turn.
pub fn systems_of(events: &[Event], number: usize) -> Vec<usize> {
    let (mut all, mut at) = (Vec::new(), number);
    for _ in 0..=events.len() {
        let changed = match events[at].action {
            Action::Release { capture, .. } => capture,
            _ => at,
        };
        match events[changed].action {
            Action::Capture { by, of, .. } => all.extend([by.system, of.system]),
            Action::Engage(brake) | Action::Disengage(brake) => all.push(brake.system),
            Action::Release { .. } => {}
        }
        match events[at].when {
            When::After { event, .. } => at = event,
            _ => break,
        }
    }
    all
}

/// Returns the groups of `count` systems, each as the indices of its systems in ascending order. `links` are
/// pairs of systems that interact for reasons other than `events`.
pub fn groups(count: usize, events: &[Event], links: &[(usize, usize)]) -> Vec<Vec<usize>> {
    let mut union = Union::new(count);
    for number in 0..events.len() {
        systems_of(events, number).windows(2).for_each(|pair| _ = union.join(pair[0], pair[1]));
    }
    links.iter().for_each(|(a, b)| _ = union.join(*a, *b));
    let mut groups: Vec<Vec<usize>> = vec![Vec::new(); count];
    for system in 0..count {
        groups[union.first(system)].push(system);
    }
    groups.retain(|group| !group.is_empty());
    groups
}
