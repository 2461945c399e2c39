//! Output arrays for positions and velocities of one orbit at many instants.

use super::OrbitError;
use crate::spatial::{Real, Vec3};
use nalgebra::Vector3;

/// Output arrays for positions (m) and velocities (m/s), axes of `I`, with three numbers per row.
#[derive(Debug)]
pub struct StateRows<'a> {
    positions: &'a mut [f64],
    velocities: &'a mut [f64],
}

impl<'a> StateRows<'a> {
    /// Creates the rows from two output arrays with `count` rows each.
    ///
    /// # Errors
    /// [`OrbitError::WrongLength`] if an array does not hold `3 count` numbers.
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

    /// Writes a position, m, and a velocity, m/s, to row `index`.
    ///
    /// # Errors
    /// [`OrbitError::UnknownRow`] for a row beyond the last.
    pub fn set(
        &mut self,
        index: usize,
        position: &Vector3<f64>,
        velocity: &Vector3<f64>,
    ) -> Result<(), OrbitError> {
        let (count, end) = (self.positions.len() / 3, index.saturating_add(1));
        if end > count {
            return Err(OrbitError::UnknownRow { index, rows: count });
        }
        self.positions[3 * index..][..3].copy_from_slice(position.as_slice());
        self.velocities[3 * index..][..3].copy_from_slice(velocity.as_slice());
        Ok(())
    }

    /// Checks that the number of rows equals the number of `times`.
    pub(super) fn check(&self, times: &[f64]) -> Result<(), OrbitError> {
        let (expected, got) = (times.len(), self.positions.len() / 3);
        if expected == got { Ok(()) } else { Err(OrbitError::WrongRows { expected, got }) }
    }

    #[inline(always)]
    pub(super) fn set_lanes<S: Real>(
        &mut self,
        first: usize,
        count: usize,
        position: &Vec3<S>,
        velocity: &Vec3<S>,
    ) {
        for (to, from) in [(&mut *self.positions, position), (&mut *self.velocities, velocity)] {
            for (lane, row) in to[3 * first..][..3 * count].chunks_exact_mut(3).enumerate() {
                row.copy_from_slice(&[from.x.lane(lane), from.y.lane(lane), from.z.lane(lane)]);
            }
        }
    }
}
