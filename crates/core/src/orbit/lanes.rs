//! Evaluation of an orbit at several instants at once, on SIMD lanes.

use super::{Orbit, OrbitError, StateRows};
use crate::spatial::{Real, Vec3};

/// Fills `rows` with states computed by `kernel` on the SIMD lanes of `S`. `kernel` converts one time per
/// lane, s, to positions (m) and velocities (m/s). If it returns `None`, the instants of that call are
/// evaluated individually.
pub(super) fn fill_lanes<S: Real>(
    orbit: &impl Orbit,
    times: &[f64],
    mut rows: StateRows<'_>,
    kernel: impl Fn(S) -> Option<(Vec3<S>, Vec3<S>)>,
) -> Result<(), OrbitError> {
    rows.check(times)?;
    let mut done = 0;
    while done < times.len() {
        // one call of `enter` processes as many blocks as possible
        done = S::enter(
            #[inline(always)]
            || {
                let mut from = done;
                while from < times.len() {
                    let count = S::LANES.min(times.len() - from);
                    // lanes after the last instant repeat that instant
                    let t = S::from_lanes(|lane| times[from + lane.min(count - 1)]);
                    let Some((position, velocity)) = kernel(t) else { break };
                    rows.set_lanes(from, count, &position, &velocity);
                    from += count;
                }
                from
            },
        );
        for index in done..times.len().min(done + S::LANES) {
            let (position, velocity) = orbit.position_velocity(times[index])?;
            rows.set(index, &position, &velocity)?;
        }
        done = times.len().min(done + S::LANES);
    }
    Ok(())
}
