//! Cache of the states of the reference orbit at the instants used most recently.

use super::error::SimulationError;
use crate::environment::Ephemeris;
use crate::orbit::{Orbit, OrbitState};
use std::sync::Arc;

/// Reference orbit about which a robot is integrated, with its states at the five instants used most
/// recently.
///
/// Stages of the same step or of successive steps often have the same instant. Without an orbit, the states
/// are `None`.
#[derive(Debug)]
pub(super) struct ReferenceCache {
    orbit: Option<Arc<dyn Orbit>>,
    instants: [Box<Instant>; 5],
}

/// State of the reference orbit at one instant, and cached quantities that depend on the instant and this
/// state, such as the position of the Sun.
#[derive(Clone, Debug)]
pub(super) struct Instant {
    time: f64,
    pub(super) state: Option<OrbitState>,
    pub(super) ephemeris: Ephemeris,
}

impl ReferenceCache {
    pub(super) fn new(orbit: Option<Arc<dyn Orbit>>) -> Self {
        let unused = |_| Box::new(Instant { time: f64::NAN, state: None, ephemeris: Ephemeris::default() });
        Self { orbit, instants: std::array::from_fn(unused) }
    }

    pub(super) fn orbit(&self) -> Option<&dyn Orbit> {
        self.orbit.as_deref()
    }

    /// Returns the state of the orbit and the ephemeris at `t`, s, during a step that ends at `end`, s.
    pub(super) fn at(&mut self, t: f64, end: f64) -> Result<&Instant, SimulationError> {
        if let Some(found) = self.instants.iter().position(|instant| instant.time == t) {
            self.instants[..=found].rotate_right(1);
            return Ok(&self.instants[0]);
        }
        let Some(orbit) = &self.orbit else { return Ok(self.store(t, None)) };
        // The end of the step will be needed next, and computing two states costs little more than computing
        // one.
        let end_is_needed = t < end && self.instants.iter().all(|instant| instant.time != end);
        if let Some([now, then]) = end_is_needed.then(|| orbit.two_states([t, end])).flatten() {
            self.store(end, Some(then));
            return Ok(self.store(t, Some(now)));
        }
        let state = orbit.state(t).map_err(|source| SimulationError::Orbit { time: t, source })?;
        Ok(self.store(t, Some(state)))
    }

    /// Stores the state at `t`, s, in place of the instant that has not been used for the longest time.
    fn store(&mut self, t: f64, state: Option<OrbitState>) -> &Instant {
        self.instants.rotate_right(1);
        let instant = &mut self.instants[0];
        (instant.time, instant.state) = (t, state);
        instant.ephemeris.clear();
        instant
    }
}
