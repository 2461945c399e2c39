//! Many instants of one orbit: rows of position and velocity.

use super::{Orbit, OrbitError};
use crate::spatial::{Real, Vec3};
use nalgebra::Vector3;

/// Where positions and velocities go, m and m/s, axes of `I`: rows of three numbers, row after row.
#[derive(Debug)]
pub struct StateRows<'a> {
    positions: &'a mut [f64],
    velocities: &'a mut [f64],
}

impl<'a> StateRows<'a> {
    /// Room for `count` rows.
    ///
    /// # Errors
    /// [`OrbitError::WrongLength`].
    pub fn new(
        count: usize,
        positions: &'a mut [f64],
        velocities: &'a mut [f64],
    ) -> Result<Self, OrbitError> {
        for (name, got) in [("positions", positions.len()), ("velocities", velocities.len())] {
            if got != 3 * count {
                return Err(OrbitError::WrongLength { name, expected: 3 * count, got });
            }
        }
        Ok(Self { positions, velocities })
    }

    /// Writes row `index`.
    ///
    /// # Errors
    /// [`OrbitError::WrongLength`] for a row beyond the last.
    pub fn set(
        &mut self,
        index: usize,
        position: &Vector3<f64>,
        velocity: &Vector3<f64>,
    ) -> Result<(), OrbitError> {
        let (count, end) = (self.positions.len() / 3, index.saturating_add(1));
        if end > count {
            return Err(OrbitError::WrongLength { name: "rows", expected: end, got: count });
        }
        self.positions[3 * index..][..3].copy_from_slice(position.as_slice());
        self.velocities[3 * index..][..3].copy_from_slice(velocity.as_slice());
        Ok(())
    }

    /// Refuses another number of rows than there are `times`.
    fn check(&self, times: &[f64]) -> Result<(), OrbitError> {
        let (expected, got) = (times.len(), self.positions.len() / 3);
        if expected == got { Ok(()) } else { Err(OrbitError::WrongLength { name: "rows", expected, got }) }
    }

    #[inline(always)]
    fn set_lanes<S: Real>(&mut self, first: usize, count: usize, position: &Vec3<S>, velocity: &Vec3<S>) {
        for (to, from) in [(&mut *self.positions, position), (&mut *self.velocities, velocity)] {
            for (lane, row) in to[3 * first..][..3 * count].chunks_exact_mut(3).enumerate() {
                row.copy_from_slice(&[from.x.lane(lane), from.y.lane(lane), from.z.lane(lane)]);
            }
        }
    }
}

/// One instant after another.
pub(super) fn one_by_one(
    orbit: &(impl Orbit + ?Sized),
    times: &[f64],
    mut rows: StateRows<'_>,
) -> Result<(), OrbitError> {
    rows.check(times)?;
    for (index, &t) in times.iter().enumerate() {
        let (position, velocity) = orbit.position_velocity(t)?;
        rows.set(index, &position, &velocity)?;
    }
    Ok(())
}

/// As many instants at once as `S` has lanes; one after another where `kernel` has nothing to say.
pub(super) fn in_lanes<S: Real>(
    orbit: &impl Orbit,
    times: &[f64],
    mut rows: StateRows<'_>,
    kernel: impl Fn(S) -> Option<(Vec3<S>, Vec3<S>)>,
) -> Result<(), OrbitError> {
    rows.check(times)?;
    let mut done = 0;
    while done < times.len() {
        // as far as the lanes go, within their instruction set
        done = S::enter(
            #[inline(always)]
            || {
                let mut from = done;
                while from < times.len() {
                    let count = S::LANES.min(times.len() - from);
                    // lanes beyond the end repeat the last instant
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
