//! What the Sun does to the upper air.

use super::error::positive;
use super::{AtmosphereError, SpaceWeatherTable};

/// Geomagnetic activity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MagneticActivity {
    /// Mean `Ap` of the day.
    Daily(f64),
    /// `Ap` of the day; `ap` of the three hours now, of those 3, 6 and 9 h ago; means of 12 to 33 h and of 36 to 57 h
    /// ago.
    History([f64; 7]),
}

/// Indices of one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceIndices {
    /// Solar flux at 10.7 cm of the previous day, 1e-22 W/(m² Hz).
    pub f107: f64,
    /// Its mean over 81 days about the day.
    pub f107a: f64,
    /// Geomagnetic activity.
    pub activity: MagneticActivity,
}

impl SpaceIndices {
    /// These indices, checked.
    ///
    /// # Errors
    /// [`AtmosphereError::Value`] for a flux that is not above zero or an `Ap` outside of 0 to 400.
    pub fn new(f107: f64, f107a: f64, activity: MagneticActivity) -> Result<Self, AtmosphereError> {
        positive("f107", f107)?;
        positive("f107a", f107a)?;
        let indices: &[f64] = match &activity {
            MagneticActivity::Daily(ap) => std::slice::from_ref(ap),
            MagneticActivity::History(ap) => ap,
        };
        match indices.iter().find(|ap| !(0.0..=400.0).contains(*ap)) {
            None => Ok(Self { f107, f107a, activity }),
            Some(&value) => {
                let expected = "an index from 0 to 400 (Ap, not Kp)";
                Err(AtmosphereError::Value { name: "ap", value, expected })
            }
        }
    }
}

/// Indices for a whole run.
#[derive(Clone, Debug, PartialEq)]
pub enum SpaceWeather {
    /// The same all the time.
    Constant(SpaceIndices),
    /// Day by day.
    Table(SpaceWeatherTable),
}
