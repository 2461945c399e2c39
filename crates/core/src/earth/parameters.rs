//! Earth-orientation parameters, which are measured and are supplied by the user.

use super::epoch::Epoch;
use super::error::EarthError;
use super::precession::ARC_SECOND;

/// UT1 and polar motion during a run.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Parameters {
    /// Constant UT1 - TAI, s, and polar motion `x_p, y_p`, rad.
    Constant { ut1_minus_tai: f64, polar_motion: [f64; 2] },
    /// Rows between which the parameters are interpolated linearly. UT1 - TAI is tabulated because it has no
    /// leap seconds.
    Table(Box<[Row]>),
}

/// Row of a table: UT1 - TAI, s, and polar motion `x_p, y_p`, rad, at the simulation time `time`, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    pub(super) time: f64,
    pub(super) ut1_minus_tai: f64,
    pub(super) polar_motion: [f64; 2],
}

/// Earth-orientation parameters supplied by the user.
#[derive(Clone, Debug, PartialEq)]
pub enum EarthParameters {
    /// Parameters that are constant during the run.
    Constant {
        /// UT1 - UTC at the epoch, s.
        ut1_minus_utc: f64,
        /// Polar motion `x_p, y_p`, rad.
        polar_motion: [f64; 2],
    },
    /// Rows in order of time, between which the parameters are interpolated linearly.
    Table(Vec<EarthParameterRow>),
}

/// Earth-orientation parameters at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EarthParameterRow {
    /// Modified Julian date of UTC, days.
    pub mjd: f64,
    /// Polar motion `x_p, y_p`, rad.
    pub polar_motion: [f64; 2],
    /// UT1 - UTC, s.
    pub ut1_minus_utc: f64,
}

impl Default for EarthParameters {
    fn default() -> Self {
        Self::Constant { ut1_minus_utc: 0.0, polar_motion: [0.0; 2] }
    }
}

impl EarthParameters {
    /// Creates a table from rows with the MJD (UTC), `x_p` and `y_p`, rad, and UT1 - UTC, s.
    pub fn from_rows(rows: &[[f64; 4]]) -> Self {
        let row = |&[mjd, x, y, ut1_minus_utc]: &[f64; 4]| EarthParameterRow {
            mjd,
            polar_motion: [x, y],
            ut1_minus_utc,
        };
        Self::Table(rows.iter().map(row).collect())
    }
}

/// Largest accepted polar motion, rad; observed values are below 0.8″.
const FARTHEST_POLE: f64 = 5.0 * ARC_SECOND;

impl Parameters {
    /// Prepares the parameters for a run whose time zero is `epoch`.
    ///
    /// # Errors
    /// [`EarthError::ShortTable`] for a table of fewer than two rows; [`EarthError::Parameter`] for a date
    /// that does not increase or is outside 1972 to 2100, and for an implausible UT1 - UTC or polar motion.
    pub(super) fn new(given: &EarthParameters, epoch: Epoch) -> Result<Self, EarthError> {
        match given {
            EarthParameters::Constant { ut1_minus_utc, polar_motion } => {
                check(None, epoch.utc().0 as f64, *ut1_minus_utc, polar_motion)?;
                let ut1_minus_tai = ut1_minus_utc + epoch.utc_minus_tai();
                Ok(Self::Constant { ut1_minus_tai, polar_motion: *polar_motion })
            }
            EarthParameters::Table(rows) => {
                if rows.len() < 2 {
                    return Err(EarthError::ShortTable { got: rows.len() });
                }
                let mut last = f64::NEG_INFINITY;
                let row = |(index, row): (usize, &EarthParameterRow)| {
                    if !(row.mjd > last && (MJD_1972..MJD_2100).contains(&row.mjd)) {
                        let expected = "increasing dates from 41317 (1972) to 88069 (2100)";
                        return Err(EarthError::Parameter {
                            name: "MJD",
                            value: row.mjd,
                            row: Some(index),
                            expected,
                        });
                    }
                    last = row.mjd;
                    check(Some(index), row.mjd, row.ut1_minus_utc, &row.polar_motion)?;
                    let at = Epoch::of_mjd_utc(row.mjd);
                    let ut1_minus_tai = row.ut1_minus_utc + at.utc_minus_tai();
                    Ok(Row { time: at.since(epoch), ut1_minus_tai, polar_motion: row.polar_motion })
                };
                Ok(Self::Table(rows.iter().enumerate().map(row).collect::<Result<_, _>>()?))
            }
        }
    }

    /// Returns the first and the last simulation time of the table, s; `None` for constant parameters.
    pub(super) fn span(&self) -> Option<(f64, f64)> {
        match self {
            Self::Constant { .. } => None,
            Self::Table(rows) => Some((rows[0].time, rows[rows.len() - 1].time)),
        }
    }

    /// Returns UT1 - TAI, s, and its rate, s/s, at simulation time `t`, s. Outside a table, the value is that
    /// at the nearest end.
    pub(super) fn ut1_minus_tai(&self, t: f64) -> (f64, f64) {
        match self {
            Self::Constant { ut1_minus_tai, .. } => (*ut1_minus_tai, 0.0),
            Self::Table(rows) => {
                let (a, b, fraction) = around(rows, t);
                let step = b.ut1_minus_tai - a.ut1_minus_tai;
                (a.ut1_minus_tai + fraction * step, step / (b.time - a.time))
            }
        }
    }

    /// Returns the polar motion `x_p, y_p`, rad, at simulation time `t`, s. Outside a table, it is that at
    /// the nearest end.
    pub(super) fn polar_motion(&self, t: f64) -> [f64; 2] {
        match self {
            Self::Constant { polar_motion, .. } => *polar_motion,
            Self::Table(rows) => {
                let (a, b, fraction) = around(rows, t);
                [0, 1].map(|i| a.polar_motion[i] + fraction * (b.polar_motion[i] - a.polar_motion[i]))
            }
        }
    }
}

/// Returns the rows before and after simulation time `t`, s, and the position of `t` between the two, clamped
/// to [0, 1]. For a time outside the table, the rows are the two at its nearest end.
fn around(rows: &[Row], t: f64) -> (&Row, &Row, f64) {
    let after = rows.partition_point(|row| row.time <= t).clamp(1, rows.len() - 1);
    let (a, b) = (&rows[after - 1], &rows[after]);
    (a, b, ((t - a.time) / (b.time - a.time)).clamp(0.0, 1.0))
}

/// Returns the largest accepted |UT1 - UTC|, s, at a modified Julian date: from 1972 to 2034, 0.9 s, which
/// leap seconds guarantee; otherwise 60 s.
///
/// Before 1972, the value is UT1 - TAI, which leap seconds do not limit; by 2035, the limit of |UT1 - UTC|
/// will be raised.
///
/// Source: General Conference on Weights and Measures, 27th meeting (2022), resolution 4.
fn largest_ut1(mjd: f64) -> f64 {
    if (MJD_1972..MJD_2035).contains(&mjd) { 0.9 } else { 60.0 }
}

const MJD_1972: f64 = 41_317.0;
const MJD_2035: f64 = 64_328.0;
const MJD_2100: f64 = 88_069.0;

fn check(
    row: Option<usize>,
    mjd: f64,
    ut1_minus_utc: f64,
    polar_motion: &[f64; 2],
) -> Result<(), EarthError> {
    let largest = largest_ut1(mjd);
    if !(-largest..=largest).contains(&ut1_minus_utc) {
        let expected = if largest < 1.0 {
            "a magnitude of at most 0.9 s (are these milliseconds, or UT1 - TAI?)"
        } else {
            "a magnitude of at most 60 s before 1972 and from 2035 (are these milliseconds?)"
        };
        return Err(EarthError::Parameter { name: "UT1 - UTC", value: ut1_minus_utc, row, expected });
    }
    if let Some(&value) = polar_motion.iter().find(|x| !(-FARTHEST_POLE..=FARTHEST_POLE).contains(*x)) {
        let expected = "a magnitude of at most 2.4e-5 rad (are these arc seconds?)";
        return Err(EarthError::Parameter { name: "polar motion", value, row, expected });
    }
    Ok(())
}
