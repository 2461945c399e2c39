//! Solar and geomagnetic indices at one instant.

use super::error::AtmosphereError;

/// Geomagnetic activity, as a daily mean or as a recent history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MagneticActivity {
    /// Mean of the index `Ap` over the day.
    Daily(f64),
    /// Recent history: `Ap` of the day, `ap` of the current three-hour interval and of the intervals 3, 6
    /// and 9 h earlier, and the means of `ap` over the intervals from 12 to 33 h and from 36 to 57 h
    /// earlier.
    History([f64; 7]),
}

/// Solar and geomagnetic indices at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceIndices {
    /// Solar flux at 10.7 cm of the previous day, 1e-22 W/(m² Hz).
    pub f107: f64,
    /// Mean of the flux over 81 days centred on the day, 1e-22 W/(m² Hz).
    pub f107a: f64,
    /// Geomagnetic activity at the instant.
    pub activity: MagneticActivity,
}

impl SpaceIndices {
    /// Creates the indices from fluxes, 1e-22 W/(m² Hz), and a geomagnetic activity, whose ranges are
    /// checked.
    ///
    /// # Errors
    /// [`AtmosphereError::Value`] unless each flux is above 0 and below 999.9 and each index is from 0 to
    /// 400.
    pub fn new(f107: f64, f107a: f64, activity: MagneticActivity) -> Result<Self, AtmosphereError> {
        for (name, value) in [("f107", f107), ("f107a", f107a)] {
            if !is_flux(value) {
                return Err(AtmosphereError::Value { name, value, expected: FLUX });
            }
        }
        let indices: &[f64] = match &activity {
            MagneticActivity::Daily(ap) => std::slice::from_ref(ap),
            MagneticActivity::History(ap) => ap,
        };
        match indices.iter().find(|ap| !is_activity(**ap)) {
            None => Ok(Self { f107, f107a, activity }),
            Some(&value) => Err(AtmosphereError::Value { name: "ap", value, expected: ACTIVITY }),
        }
    }
}

pub(super) const FLUX: &str = "a flux above 0 and below 999.9 (999.9 marks a gap), in 1e-22 W/(m² Hz)";
pub(super) const ACTIVITY: &str = "an index from 0 to 400 (Ap, not Kp)";

/// Returns true if a value is a plausible flux. Observed daily values are below 500, and 999.9 marks a gap
/// in tables.
pub(super) fn is_flux(value: f64) -> bool {
    value > 0.0 && value < 999.9
}

/// Returns true if a value is in the range of the indices `ap` and `Ap`.
pub(super) fn is_activity(value: f64) -> bool {
    (0.0..=400.0).contains(&value)
}
