//! What propagates an element set: this crate's SGP4, or the reference code as a check of it.

use super::error::Sgp4Error;
use super::propagate::Propagator;
use nalgebra::Vector3;
use std::sync::Arc;

/// The reference code, made ready with an element set by whoever has it.
pub trait Reference: Send + Sync + std::fmt::Debug {
    /// Position (km) and velocity (km/s), TEME, `minutes` from the epoch; below the surface too.
    ///
    /// # Errors
    /// The number of its error, but for 6, which says that the satellite has decayed.
    fn at(&self, minutes: f64) -> Result<[[f64; 3]; 2], u8>;
}

#[derive(Clone, Debug)]
pub(super) enum Theory {
    Own,
    Reference(Arc<dyn Reference>),
}

/// Where the satellite is, below the surface too.
pub(super) struct State {
    /// km.
    pub(super) position: Vector3<f64>,
    /// km/s.
    pub(super) velocity: Vector3<f64>,
    /// Distance from the Earth's centre, Earth radii.
    pub(super) distance: f64,
}

impl Theory {
    /// The state at `time`, s from the epoch; `own` is this crate's SGP4 for the same set.
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
