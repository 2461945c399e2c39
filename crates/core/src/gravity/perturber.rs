//! Sun and Moon as third bodies.

use std::sync::Arc;

use nalgebra::Vector3;

use super::error::GravityError;
use super::third_body::ThirdBody;
use crate::earth::Earth;

/// Body whose position [`Earth`] provides: the Sun or the Moon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Luminary {
    /// The Sun.
    Sun,
    /// The Moon.
    Moon,
}

impl Luminary {
    /// All bodies whose positions [`Earth`] provides.
    pub const ALL: [Self; 2] = [Self::Sun, Self::Moon];

    /// Returns the lower-case name, `sun` or `moon`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sun => "sun",
            Self::Moon => "moon",
        }
    }

    /// Returns the gravitational parameter, m³/s².
    ///
    /// Source: DE440; Park, Folkner, Williams and Boggs, Astronomical Journal 161:105, 2021, table 2.
    pub fn mu(self) -> f64 {
        match self {
            Self::Sun => 1.327_124_400_412_794_2e20,
            Self::Moon => 4.902_800_118e12,
        }
    }
}

/// Sun or Moon as a third body, with its position relative to the Earth.
#[derive(Clone, Debug)]
pub struct Perturber {
    body: Luminary,
    earth: Arc<Earth>,
}

impl Perturber {
    /// Creates the third body, whose position relative to `earth` depends on the epoch.
    ///
    /// # Errors
    /// [`GravityError::Earth`] without an epoch or if the position is not known at time zero.
    pub fn new(body: Luminary, earth: Arc<Earth>) -> Result<Self, GravityError> {
        let perturber = Self { body, earth };
        perturber.position(0.0).map(|_| perturber)
    }
}

impl ThirdBody for Perturber {
    fn name(&self) -> &str {
        self.body.name()
    }

    fn mu(&self) -> f64 {
        self.body.mu()
    }

    fn position(&self, t: f64) -> Result<Vector3<f64>, GravityError> {
        Ok(match self.body {
            Luminary::Sun => self.earth.sun(t),
            Luminary::Moon => self.earth.moon(t),
        }?)
    }
}
