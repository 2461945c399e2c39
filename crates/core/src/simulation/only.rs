//! Access to the only system of a run of one robot.
//!
//! A [`Simulation`](super::Simulation) has one robot, to which its trace, the `q`, `v` and commands of its stepper,
//! and its external engine refer. Every run of a rollout also has one robot. Only these parts use the functions
//! below; all other code supports a list of systems.

/// Returns the only entry of a list with one entry per system.
pub(crate) fn only<T>(systems: &[T]) -> &T {
    assert_eq!(systems.len(), 1, "this part of a run requires exactly one robot");
    &systems[0]
}

/// Returns the only entry of a list with one entry per system, for modification.
pub(crate) fn only_mut<T>(systems: &mut [T]) -> &mut T {
    assert_eq!(systems.len(), 1, "this part of a run requires exactly one robot");
    &mut systems[0]
}
