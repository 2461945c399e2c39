//! The orbit that a robot is integrated about, at the instants asked for last.

use super::error::SimulationError;
use crate::environment::Heavens;
use crate::orbit::{Orbit, OrbitState};
use std::sync::Arc;

/// An orbit, if the run has one, and what is known of it: the stages of a step share their instants.
#[derive(Debug)]
pub(super) struct Guide {
    orbit: Option<Arc<dyn Orbit>>,
    known: [Box<Known>; 5],
}

/// An instant, with the state of the orbit there.
#[derive(Clone, Debug)]
pub(super) struct Known {
    time: f64,
    pub(super) state: Option<OrbitState>,
    pub(super) heavens: Heavens,
}

impl Guide {
    pub(super) fn new(orbit: Option<Arc<dyn Orbit>>) -> Self {
        let nothing = |_| Box::new(Known { time: f64::NAN, state: None, heavens: Heavens::default() });
        Self { orbit, known: std::array::from_fn(nothing) }
    }

    /// The orbit itself.
    pub(super) fn orbit(&self) -> Option<&dyn Orbit> {
        self.orbit.as_deref()
    }

    /// What is known at `t`, in a step that ends at `end`.
    pub(super) fn at(&mut self, t: f64, end: f64) -> Result<&Known, SimulationError> {
        if let Some(place) = self.known.iter().position(|known| known.time == t) {
            self.known[..=place].rotate_right(1);
            return Ok(&self.known[0]);
        }
        let Some(orbit) = &self.orbit else { return Ok(self.remember(t, None)) };
        // the end of the step is asked for next: two cost little more than one
        let is_ahead = t < end && self.known.iter().all(|known| known.time != end);
        if let Some([now, then]) = is_ahead.then(|| orbit.two_states([t, end])).flatten() {
            self.remember(end, Some(then));
            return Ok(self.remember(t, Some(now)));
        }
        let state = orbit.state(t).map_err(|source| SimulationError::Orbit { time: t, source })?;
        Ok(self.remember(t, Some(state)))
    }

    fn remember(&mut self, t: f64, state: Option<OrbitState>) -> &Known {
        self.known.rotate_right(1);
        let known = &mut self.known[0];
        (known.time, known.state) = (t, state);
        known.heavens.forget();
        known
    }
}
