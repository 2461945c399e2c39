//! Implementation that propagates an element set: this crate's SGP4, or the reference code as a check.

use super::error::Sgp4Error;
use super::propagate::Propagator;
use nalgebra::Vector3;
use std::sync::Arc;

/// The reference code, initialized with an element set by the caller.
pub trait Reference: Send + Sync + std::fmt::Debug {
    /// Returns position (km) and velocity (km/s), TEME, `minutes` after the epoch, also below the surface.
    ///
    /// # Errors
    /// The error code of the reference code, except 6 (decayed), for which the state is returned.
    fn at(&self, minutes: f64) -> Result<[[f64; 3]; 2], u8>;
}

#[derive(Clone, Debug)]
pub(super) enum Theory {
    Own,
    Reference(Arc<dyn Reference>),
}

/// State of the satellite, TEME, also below the surface.
pub(super) struct State {
    /// Position, km.
    pub(super) position: Vector3<f64>,
    /// Velocity, km/s.
    pub(super) velocity: Vector3<f64>,
    /// Distance from the Earth's centre, Earth radii.
    pub(super) distance: f64,
}

impl Theory {
    /// Returns the state at `time`, s after the epoch; `own` is this crate's SGP4 for the same set.
    pub(super) fn at(&self, own: &Propagator, time: f64) -> Result<State, Sgp4Error> {
        match self {
            Self::Own => {
                let flight = own.at(time)?;
                let (position, velocity) = (flight.position.to_nalgebra(), flight.velocity.to_nalgebra());
                Ok(State { position, velocity, distance: flight.distance })
            }
            Self::Reference(code) => {
                let [r, v] = code.at(time / 60.0).map_err(|code| Sgp4Error::OfReference { time, code })?;
                let (position, velocity) = (Vector3::from(r), Vector3::from(v));
                Ok(State { position, velocity, distance: position.norm() / own.earth.radius_km })
            }
        }
    }
}
