//! Propagation of many orbits to many times.

use super::input::InputError;
use super::threads::{Threads, for_each};
use crate::orbit::{Orbit, OrbitError, StateRows};
use std::sync::{Arc, Mutex, PoisonError};

/// Simulation times of the states, s.
#[derive(Clone, Copy, Debug)]
pub enum Times<'a> {
    /// Times (T,) that all orbits share.
    Common(&'a [f64]),
    /// Times of each orbit, (N, T), row-major.
    Each(&'a [f64]),
}

/// Number of instants of an orbit that are computed between two checks of the stop flag, a multiple of the
/// number of SIMD lanes.
const INSTANTS: usize = 4096;
/// Number of integration steps of a numerical orbit between two checks of the stop flag.
const STEPS: usize = 16;

/// Computes positions (m) from the planet's centre and velocities (m/s) of `orbits`, each (N, T, 3),
/// row-major. The states of an orbit are in the inertial axes of that orbit.
///
/// The results are bit-identical for any number of threads. If `threads` is stopped, the function returns
/// early with incomplete results.
///
/// # Errors
/// [`InputError::NoThreads`], [`InputError::WrongTotal`] and [`InputError::UnevenTimes`] for invalid
/// arguments, and [`InputError::Orbit`] for the first orbit that has no state at one of its times.
pub fn propagate<'a>(
    orbits: &[Arc<dyn Orbit>],
    times: Times<'_>,
    positions: &mut [f64],
    velocities: &mut [f64],
    threads: impl Into<Threads<'a>>,
) -> Result<(), InputError> {
    let threads = threads.into();
    let count = match times {
        Times::Common(times) => times.len(),
        Times::Each(times) => {
            if !times.len().is_multiple_of(orbits.len().max(1)) {
                return Err(InputError::UnevenTimes { orbits: orbits.len(), got: times.len() });
            }
            times.len() / orbits.len().max(1)
        }
    };
    let expected = 3 * orbits.len() * count;
    for (name, got) in [("positions", positions.len()), ("velocities", velocities.len())] {
        if got != expected {
            return Err(InputError::WrongTotal { name, expected, got });
        }
    }
    if expected == 0 {
        return for_each(threads, [(); 0], || (), |(), ()| ());
    }
    let rows = positions.chunks_mut(3 * count).zip(velocities.chunks_mut(3 * count));
    let tasks = orbits.iter().zip(rows).enumerate();
    let first: Mutex<Option<(usize, OrbitError)>> = Mutex::new(None);
    for_each(
        threads,
        tasks,
        || (),
        |(), (index, (orbit, (positions, velocities)))| {
            let instants = match times {
                Times::Common(times) => times,
                Times::Each(times) => &times[index * count..][..count],
            };
            if let Err(error) = fill(&**orbit, instants, positions, velocities, threads) {
                let mut first = first.lock().unwrap_or_else(PoisonError::into_inner);
                if first.as_ref().is_none_or(|(earlier, _)| index < *earlier) {
                    *first = Some((index, error));
                }
            }
        },
    )?;
    match first.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some((orbit, source)) => Err(InputError::Orbit { orbit, source }),
        None => Ok(()),
    }
}

/// Computes the positions, m, and the velocities, m/s, of one orbit at `times`, each (T, 3). Returns early if
/// the batch is stopped.
fn fill(
    orbit: &dyn Orbit,
    times: &[f64],
    positions: &mut [f64],
    velocities: &mut [f64],
    threads: Threads<'_>,
) -> Result<(), OrbitError> {
    let rows = positions.chunks_mut(3 * INSTANTS).zip(velocities.chunks_mut(3 * INSTANTS));
    for (times, (positions, velocities)) in times.chunks(INSTANTS).zip(rows) {
        while !threads.is_stopped() && !orbit.prepare(times, STEPS) {}
        if threads.is_stopped() {
            return Ok(());
        }
        orbit.fill(times, StateRows::new(times.len(), positions, velocities)?)?;
    }
    Ok(())
}
