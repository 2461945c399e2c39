//! Mean elements of SGP4, independent of the format from which they were read.

use super::epoch::Epoch;
use super::error::ElementSetError;
use std::f64::consts::TAU;

/// Conversion factor from rad/min to revolutions per day.
pub(super) const REV_DAY: f64 = 1440.0 / TAU;

/// Mean elements of one satellite at one epoch, in the units of SGP4.
///
/// The elements are valid only with SGP4 and must not be used with another theory.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanElements {
    /// Catalogue number of the satellite.
    pub satellite: u32,
    /// Epoch of the elements.
    pub epoch: Epoch,
    /// Drag term `B*`, 1/Earth radii.
    pub drag_term: f64,
    /// Inclination, rad.
    pub inclination: f64,
    /// Right ascension of the ascending node, rad.
    pub raan: f64,
    /// Eccentricity.
    pub eccentricity: f64,
    /// Argument of perigee, rad.
    pub argument_of_perigee: f64,
    /// Mean anomaly, rad.
    pub mean_anomaly: f64,
    /// Mean motion according to Kozai, rad/min.
    pub mean_motion: f64,
}

impl MeanElements {
    /// Reads the entries of a CCSDS Orbit Mean-Elements Message (OMM); `entry` returns the text for a
    /// keyword, or `None` if the message has no such entry. Angles are in deg and the mean motion in rev/day.
    ///
    /// The entries for the theory, the centre, the frame and the time system may be missing. If they are
    /// given, they must be SGP4 (or SGP/SGP4), EARTH, TEME and UTC.
    ///
    /// # Errors
    /// [`ElementSetError::Missing`], [`ElementSetError::Entry`] and [`ElementSetError::Range`] for a missing
    /// or invalid entry.
    ///
    /// Source: CCSDS 502.0-B-3, section 4.
    pub fn from_omm(entry: impl Fn(&str) -> Option<String>) -> Result<Self, ElementSetError> {
        let text = |key: &'static str| entry(key).ok_or(ElementSetError::Missing { key });
        let wrong = |key, got, expected| ElementSetError::Entry { key, got, expected };
        let number = |key: &'static str| {
            let got = text(key)?;
            let value = got.trim().parse::<f64>().ok().filter(|x| x.is_finite());
            value.ok_or_else(|| wrong(key, got, "a finite number"))
        };
        let optional = [
            ("MEAN_ELEMENT_THEORY", ["SGP4", "SGP/SGP4"], "SGP4"),
            ("CENTER_NAME", ["EARTH", "EARTH"], "EARTH"),
            ("REF_FRAME", ["TEME", "TEME"], "TEME"),
            ("TIME_SYSTEM", ["UTC", "UTC"], "UTC"),
        ];
        for (key, accepted, expected) in optional {
            if let Some(got) =
                entry(key).filter(|got| !accepted.contains(&got.trim().to_uppercase().as_str()))
            {
                return Err(wrong(key, got, expected));
            }
        }
        let epoch = text("EPOCH")?;
        let satellite = text("NORAD_CAT_ID")?;
        Self {
            satellite: satellite
                .trim()
                .parse()
                .map_err(|_| wrong("NORAD_CAT_ID", satellite, "a non-negative whole number"))?,
            epoch: Epoch::parse(&epoch)
                .ok_or_else(|| wrong("EPOCH", epoch, "a UTC date such as 2024-01-31T12:34:56.789"))?,
            drag_term: number("BSTAR")?,
            inclination: number("INCLINATION")?.to_radians(),
            raan: number("RA_OF_ASC_NODE")?.to_radians(),
            eccentricity: number("ECCENTRICITY")?,
            argument_of_perigee: number("ARG_OF_PERICENTER")?.to_radians(),
            mean_anomaly: number("MEAN_ANOMALY")?.to_radians(),
            mean_motion: number("MEAN_MOTION")? / REV_DAY,
        }
        .checked()
    }

    /// Returns these elements, or an error if one is outside its accepted range.
    ///
    /// # Errors
    /// [`ElementSetError::Range`], with values in the units of published element sets.
    pub fn checked(self) -> Result<Self, ElementSetError> {
        let within = |name, got: f64, range: std::ops::RangeInclusive<f64>, unit| {
            if range.contains(&got) { Ok(()) } else { Err(ElementSetError::Range { name, got, range, unit }) }
        };
        let turn = -360.0..=360.0;
        within("inclination", self.inclination.to_degrees(), 0.0..=180.0, " deg")?;
        within("right ascension of the node", self.raan.to_degrees(), turn.clone(), " deg")?;
        within("eccentricity", self.eccentricity, 0.0..=1.0 - f64::EPSILON, "")?;
        within("argument of perigee", self.argument_of_perigee.to_degrees(), turn.clone(), " deg")?;
        within("mean anomaly", self.mean_anomaly.to_degrees(), turn, " deg")?;
        within("mean motion", self.mean_motion * REV_DAY, f64::MIN_POSITIVE..=18.0, " rev/day")?;
        Ok(self)
    }
}
