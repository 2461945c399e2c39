//! Choice between the SGP4 of this crate and the reference implementation, which serves as an independent
//! check.

use super::error::Sgp4Error;
use super::propagate::Propagator;
use nalgebra::Vector3;
use std::sync::Arc;

/// Interface of the reference implementation, which the caller has initialised with an element set.
pub trait ExternalSgp4: Send + Sync + std::fmt::Debug {
    /// Returns position (km) and velocity (km/s) in TEME axes, `minutes` after the epoch, even if the
    /// satellite is below the surface of the Earth.
    ///
    /// # Errors
    /// The error code of the reference implementation. For code 6 (decayed), the state is returned instead;
    /// if there is no state, the error is a code that the reference implementation does not use.
    fn at(&self, minutes: f64) -> Result<[[f64; 3]; 2], u8>;
}

#[derive(Clone, Debug)]
pub(super) enum Theory {
    Native,
    External(Arc<dyn ExternalSgp4>),
}

/// State of the satellite in TEME axes. The satellite may be below the surface of the Earth.
pub(super) struct State {
    /// Position, km.
    pub(super) position: Vector3<f64>,
    /// Velocity, km/s.
    pub(super) velocity: Vector3<f64>,
    /// Distance from the Earth's centre, Earth radii.
    pub(super) distance: f64,
}

impl Theory {
    /// Returns the state `time` s after the epoch; `own` is the propagator of this crate for the same element
    /// set.
    pub(super) fn at(&self, own: &Propagator, time: f64) -> Result<State, Sgp4Error> {
        match self {
            Self::Native => {
                let state = own.at(time)?;
                let (position, velocity) = (state.position.to_nalgebra(), state.velocity.to_nalgebra());
                Ok(State { position, velocity, distance: state.distance })
            }
            Self::External(code) => {
                let [r, v] = code.at(time / 60.0).map_err(|code| Sgp4Error::External { time, code })?;
                let (position, velocity) = (Vector3::from(r), Vector3::from(v));
                Ok(State { position, velocity, distance: position.norm() / own.earth.radius_km })
            }
        }
    }
}
