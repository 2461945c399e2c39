//! What cannot be computed of the Earth's rotation: it is measured, and given by the user.

use super::EarthError;
use super::epoch::Epoch;
use super::precession::ARC_SECOND;

/// UT1 and the pole's place during a run.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Parameters {
    /// The same throughout: UT1 less TAI, s, and `x_p, y_p`, rad.
    Constant { ut1_minus_tai: f64, polar_motion: [f64; 2] },
    /// Piecewise linear in between rows: seconds of simulation, UT1 less TAI (which knows no leap seconds), pole.
    Table(Box<[Row]>),
}

/// One row of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    pub(super) time: f64,
    pub(super) ut1_minus_tai: f64,
    pub(super) polar_motion: [f64; 2],
}

/// Earth-orientation parameters as the user gives them.
#[derive(Clone, Debug, PartialEq)]
pub enum EarthParameters {
    /// UT1 less UTC at the epoch, s, and the pole's `x_p, y_p`, rad.
    Constant {
        /// UT1 less UTC, s.
        ut1_minus_utc: f64,
        /// The pole in the Earth, rad.
        polar_motion: [f64; 2],
    },
    /// Rows in the order of time, linear in between.
    Table(Vec<EarthParameterRow>),
}

/// Earth-orientation parameters at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EarthParameterRow {
    /// Modified Julian date, UTC.
    pub mjd: f64,
    /// The pole in the Earth, `x_p, y_p`, rad.
    pub polar_motion: [f64; 2],
    /// UT1 less UTC, s.
    pub ut1_minus_utc: f64,
}

impl Default for EarthParameters {
    fn default() -> Self {
        Self::Constant { ut1_minus_utc: 0.0, polar_motion: [0.0; 2] }
    }
}

impl EarthParameters {
    /// A table from rows of four numbers: MJD (UTC), `x_p, y_p`, rad, UT1 less UTC, s.
    pub fn from_rows(rows: &[[f64; 4]]) -> Self {
        let row = |&[mjd, x, y, ut1_minus_utc]: &[f64; 4]| EarthParameterRow {
            mjd,
            polar_motion: [x, y],
            ut1_minus_utc,
        };
        Self::Table(rows.iter().map(row).collect())
    }
}

/// Largest pole distance that is believed, rad: the pole has stayed within 0.8″.
const FARTHEST_POLE: f64 = 5.0 * ARC_SECOND;

impl Parameters {
    /// For a run from `epoch`.
    pub(super) fn new(given: &EarthParameters, epoch: Epoch) -> Result<Self, EarthError> {
        match given {
            EarthParameters::Constant { ut1_minus_utc, polar_motion } => {
                check(0, epoch.utc().0 as f64, *ut1_minus_utc, polar_motion)?;
                let ut1_minus_tai = ut1_minus_utc + epoch.utc_minus_tai();
                Ok(Self::Constant { ut1_minus_tai, polar_motion: *polar_motion })
            }
            EarthParameters::Table(rows) => {
                if rows.len() < 2 {
                    return Err(EarthError::WrongLength { name: "the table", expected: 2, got: rows.len() });
                }
                let mut last = f64::NEG_INFINITY;
                let row = |(index, row): (usize, &EarthParameterRow)| {
                    if !(row.mjd > last && (MJD_1972..MJD_2100).contains(&row.mjd)) {
                        let expected = "rows must be in the order of time, from 41317 (1972) to 88069 (2100)";
                        return Err(EarthError::Parameter {
                            name: "MJD",
                            value: row.mjd,
                            row: index,
                            expected,
                        });
                    }
                    last = row.mjd;
                    check(index, row.mjd, row.ut1_minus_utc, &row.polar_motion)?;
                    let at = Epoch::of_mjd_utc(row.mjd);
                    let ut1_minus_tai = row.ut1_minus_utc + at.utc_minus_tai();
                    Ok(Row { time: at.since(epoch), ut1_minus_tai, polar_motion: row.polar_motion })
                };
                Ok(Self::Table(rows.iter().enumerate().map(row).collect::<Result<_, _>>()?))
            }
        }
    }

    /// First and last second of simulation that are known.
    pub(super) fn span(&self) -> Option<(f64, f64)> {
        match self {
            Self::Constant { .. } => None,
            Self::Table(rows) => Some((rows[0].time, rows[rows.len() - 1].time)),
        }
    }

    /// UT1 less TAI, s, and its rate.
    pub(super) fn ut1_minus_tai(&self, t: f64) -> (f64, f64) {
        match self {
            Self::Constant { ut1_minus_tai, .. } => (*ut1_minus_tai, 0.0),
            Self::Table(rows) => {
                let (a, b, share) = around(rows, t);
                let step = b.ut1_minus_tai - a.ut1_minus_tai;
                (a.ut1_minus_tai + share * step, step / (b.time - a.time))
            }
        }
    }

    /// `x_p, y_p`, rad.
    pub(super) fn polar_motion(&self, t: f64) -> [f64; 2] {
        match self {
            Self::Constant { polar_motion, .. } => *polar_motion,
            Self::Table(rows) => {
                let (a, b, share) = around(rows, t);
                [0, 1].map(|i| a.polar_motion[i] + share * (b.polar_motion[i] - a.polar_motion[i]))
            }
        }
    }
}

/// The rows before and after `t`, and where it lies between them; the ends' own beyond them.
fn around(rows: &[Row], t: f64) -> (&Row, &Row, f64) {
    let after = rows.partition_point(|row| row.time <= t).clamp(1, rows.len() - 1);
    let (a, b) = (&rows[after - 1], &rows[after]);
    (a, b, ((t - a.time) / (b.time - a.time)).clamp(0.0, 1.0))
}

/// Largest difference accepted, s: UTC's own bound while it has leap seconds. Before 1972 UT1 less TAI stands for it, and
/// by 2035 the bound is to rise.
///
/// Source: General Conference on Weights and Measures, 27th meeting (2022), resolution 4.
fn largest_ut1(mjd: f64) -> f64 {
    if (MJD_1972..MJD_2035).contains(&mjd) { 0.9 } else { 60.0 }
}

const MJD_1972: f64 = 41_317.0;
const MJD_2035: f64 = 64_328.0;
const MJD_2100: f64 = 88_069.0;

fn check(row: usize, mjd: f64, ut1_minus_utc: f64, polar_motion: &[f64; 2]) -> Result<(), EarthError> {
    let largest = largest_ut1(mjd);
    if !(-largest..=largest).contains(&ut1_minus_utc) {
        let expected =
            "it stays within 0.9 s, and is given in seconds (are these milliseconds, or UT1 - TAI?)";
        return Err(EarthError::Parameter { name: "UT1 - UTC", value: ut1_minus_utc, row, expected });
    }
    if let Some(&value) = polar_motion.iter().find(|x| !(-FARTHEST_POLE..=FARTHEST_POLE).contains(*x)) {
        let expected = "rad are needed, and within 2.4e-5 (are these arc seconds?)";
        return Err(EarthError::Parameter { name: "polar motion", value, row, expected });
    }
    Ok(())
}
