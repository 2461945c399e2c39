//! Runs that stop and resume.

use onorbit_core::simulation::{Checkpoint, Recording, Simulation, SimulationError, Trace};

/// Advances a run of `duration` to `stop`; returns a checkpoint, written and read back, and the rows so far.
pub fn stopped(simulation: &mut Simulation, duration: f64, stop: f64) -> (Checkpoint, Trace) {
    let mut stepper = simulation.start(Some(duration)).unwrap();
    stepper.advance_to(stop).unwrap();
    let checkpoint = stepper.checkpoint().unwrap();
    let read = Checkpoint::from_json(&checkpoint.to_json()).unwrap();
    assert_eq!(read, checkpoint);
    (read, stepper.rows(0).clone())
}

/// Resumes a run of `duration` and returns its whole trace.
pub fn resumed(
    simulation: &mut Simulation,
    duration: f64,
    from: &Checkpoint,
    rows: Trace,
) -> Result<Trace, SimulationError> {
    let mut stepper = simulation.resume(Some(duration), from.clone(), vec![rows])?;
    stepper.advance_to(duration)?;
    stepper.finish().map(Recording::only).map_err(|failure| failure.error)
}

/// Asserts that two traces have the same bits.
pub fn assert_same_bits(a: &Trace, b: &Trace) {
    for ((name, a), (_, b)) in a.columns().zip(b.columns()) {
        assert_eq!(a.len(), b.len(), "{name}");
        assert!(a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()), "{name}");
    }
    assert_eq!(a.work_done.to_bits(), b.work_done.to_bits());
    assert_eq!(a.attitude_step_doubling, b.attitude_step_doubling);
    assert_eq!(a.step_doubling, b.step_doubling);
    assert_eq!(a.rereferenced, b.rereferenced);
    assert_eq!(a.results, b.results);
}
