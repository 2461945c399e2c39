//! The one system of a run of one robot.
//!
//! A [`Simulation`](super::Simulation) is of one robot: its trace, the `q`, `v` and commands of its stepper, and the
//! robot that an external engine moves. So are the runs of a rollout. Only these use the functions below; everything
//! else is of a list of systems.

/// Returns the only entry of a list with one per system.
pub(crate) fn only<T>(systems: &[T]) -> &T {
    assert_eq!(systems.len(), 1, "this part of a run is of one robot");
    &systems[0]
}

/// Returns the only entry of a list with one per system.
pub(crate) fn only_mut<T>(systems: &mut [T]) -> &mut T {
    assert_eq!(systems.len(), 1, "this part of a run is of one robot");
    &mut systems[0]
}
