//! Access to the only tree or the only system of a run with one robot.
//!
//! Some parts of a run support only one robot: the trace of such a run, the `q`, `v` and commands of its
//! stepper, and its external engine. Each run of a rollout also has one robot. These parts use the functions
//! below; all other code supports a list of trees.

/// Returns the only entry of a list with one entry per tree or system.
pub(crate) fn only<T>(trees: &[T]) -> &T {
    assert_eq!(trees.len(), 1, "this part of a run requires exactly one robot");
    &trees[0]
}

/// Returns the only entry, as a mutable reference, of a list with one entry per tree or system.
pub(crate) fn only_mut<T>(trees: &mut [T]) -> &mut T {
    assert_eq!(trees.len(), 1, "this part of a run requires exactly one robot");
    &mut trees[0]
}
