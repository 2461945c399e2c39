//! Access to the only tree, or system, of a run of one robot.
//!
//! A [`Simulation`](super::Simulation) has one robot, to which its trace, the `q`, `v` and commands of its stepper,
//! and its external engine refer. Every run of a rollout also has one robot. Only these parts use the functions
//! below; all other code supports a list of trees.

/// Returns the only entry of a list with one entry per tree or system.
pub(crate) fn only<T>(trees: &[T]) -> &T {
    assert_eq!(trees.len(), 1, "this part of a run requires exactly one robot");
    &trees[0]
}

/// Returns the only entry of a list with one entry per tree or system, for modification.
pub(crate) fn only_mut<T>(trees: &mut [T]) -> &mut T {
    assert_eq!(trees.len(), 1, "this part of a run requires exactly one robot");
    &mut trees[0]
}
