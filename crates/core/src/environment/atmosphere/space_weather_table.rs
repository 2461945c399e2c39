//! Table of space weather with one row per day.

use super::error::AtmosphereError;
use super::space_indices::{
    ACTIVITY, FLUX as FLUX_RANGE, MagneticActivity, SpaceIndices, is_activity, is_flux,
};
use crate::number_text::count;

/// Names of the columns, as in CelesTrak's files. The columns of the eight three-hourly indices are last.
const COLUMNS: [&str; 11] =
    ["F10.7_OBS", "F10.7_OBS_CENTER81", "AP_AVG", "AP1", "AP2", "AP3", "AP4", "AP5", "AP6", "AP7", "AP8"];
const FLUX: usize = 0;
const MEAN_FLUX: usize = 1;
const DAILY: usize = 2;
const THREE_HOURS: usize = 3;

/// Values of one day, one per column; `None` marks a gap.
type Day = [Option<f64>; COLUMNS.len()];

/// Observed solar flux and geomagnetic activity of consecutive days.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceWeatherTable {
    /// Modified Julian date of the first row.
    first: i64,
    days: Vec<Day>,
    has_history: bool,
    /// Name of the table in messages.
    name: String,
}

impl SpaceWeatherTable {
    /// Reads a table from CSV text. The header line contains `DATE` (`2024-03-01`), `F10.7_OBS`,
    /// `F10.7_OBS_CENTER81`, `AP_AVG` and, for the three-hourly history, `AP1` to `AP8`; other columns are
    /// ignored. CelesTrak's `SW-All.csv` has this form. Rows are consecutive days. An empty field is a
    /// gap, which is an error only if a run needs the value.
    ///
    /// # Errors
    /// [`AtmosphereError::Table`], with the number of the line, for a table without rows, a missing
    /// column, field or day, an invalid date, or a value that is not a number in its range.
    pub fn from_csv(text: &str) -> Result<Self, AtmosphereError> {
        let wrong = |line: usize, problem: String| AtmosphereError::Table { line: line + 1, problem };
        let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let (top, header) = lines.next().ok_or_else(|| {
            wrong(0, "the table is empty; expected a header line and one row per day".to_owned())
        })?;
        let names: Vec<&str> = header.split(',').map(str::trim).collect();
        let column = |name: &str| names.iter().position(|n| *n == name);
        let missing = |name: &str| wrong(top, format!("the header has no column {name}; add this column"));
        let date = column("DATE").ok_or_else(|| missing("DATE"))?;
        let has_history = column("AP1").is_some();
        let needed = if has_history { COLUMNS.len() } else { THREE_HOURS };
        let columns: Vec<usize> = COLUMNS[..needed]
            .iter()
            .map(|name| column(name).ok_or_else(|| missing(name)))
            .collect::<Result<_, _>>()?;
        let (mut first, mut days) = (0, Vec::new());
        for (line, row) in lines {
            let fields: Vec<&str> = row.split(',').map(str::trim).collect();
            if fields.len() < names.len() {
                let (has, needed) = (count(fields.len(), "field"), names.len());
                return Err(wrong(
                    line,
                    format!(
                        "the row has {has}, but the header has {needed}; add the missing fields, or download the \
                         file again if it is truncated"
                    ),
                ));
            }
            let field = |k: usize| fields.get(k).copied().unwrap_or("");
            let day = day_of(field(date)).ok_or_else(|| {
                wrong(line, format!("DATE is '{}'; expected a date such as 2024-03-01", field(date)))
            })?;
            if days.is_empty() {
                first = day;
            } else if day != first + days.len() as i64 {
                let before = date_of(first + days.len() as i64 - 1);
                return Err(wrong(
                    line,
                    format!("{} is not the day after {before}; give one row for every day", date_of(day)),
                ));
            }
            let mut numbers: Day = [None; COLUMNS.len()];
            for (k, &column) in columns.iter().enumerate() {
                let text = field(column);
                if text.is_empty() {
                    continue;
                }
                let (is_valid, expected): (fn(f64) -> bool, _) =
                    if k < DAILY { (is_flux, FLUX_RANGE) } else { (is_activity, ACTIVITY) };
                let number = text.parse::<f64>().ok().filter(|x| is_valid(*x));
                let wrong = || wrong(line, format!("{} is '{text}'; expected {expected}", COLUMNS[k]));
                numbers[k] = Some(number.ok_or_else(wrong)?);
            }
            days.push(numbers);
        }
        if days.is_empty() {
            return Err(wrong(top + 1, "the table has no rows; expected one row per day".to_owned()));
        }
        Ok(Self { first, days, has_history, name: "the table".to_owned() })
    }

    /// Returns the same table without the three-hourly history, so that only daily means are used.
    pub fn daily(self) -> Self {
        Self { has_history: false, ..self }
    }

    /// Returns the same table with the name that messages use for it, such as the name of its file.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// Returns the indices `seconds` after the start of the UTC day with the modified Julian date `day`.
    ///
    /// # Errors
    /// [`AtmosphereError::OutsideTable`] if the day, or one of the up to three days before it whose values
    /// are required, is not in the table; [`AtmosphereError::MissingSpaceWeather`] if a required value is
    /// a gap.
    pub fn at(&self, day: i64, seconds: f64) -> Result<SpaceIndices, AtmosphereError> {
        let daily = self.number(day, DAILY)?;
        let activity = if self.has_history {
            // intervals of three hours are counted back from the current interval
            let now = 8 * day + ((seconds / 10_800.0).floor() as i64).clamp(0, 7);
            let back = |k: i64| {
                let interval = now - k;
                self.number(interval.div_euclid(8), THREE_HOURS + interval.rem_euclid(8) as usize)
            };
            let mean = |from: i64| (from..from + 8).map(back).sum::<Result<f64, _>>().map(|sum| sum / 8.0);
            MagneticActivity::History([daily, back(0)?, back(1)?, back(2)?, back(3)?, mean(4)?, mean(12)?])
        } else {
            MagneticActivity::Daily(daily)
        };
        SpaceIndices::new(self.number(day - 1, FLUX)?, self.number(day, MEAN_FLUX)?, activity)
    }

    /// Returns the value of a column on a day, which must not be a gap.
    fn number(&self, day: i64, column: usize) -> Result<f64, AtmosphereError> {
        let row = usize::try_from(day - self.first).ok().and_then(|k| self.days.get(k));
        let outside = || AtmosphereError::OutsideTable {
            table: self.name.clone(),
            date: date_of(day),
            first: date_of(self.first),
            last: date_of(self.first + self.days.len() as i64 - 1),
        };
        let missing = || AtmosphereError::MissingSpaceWeather {
            table: self.name.clone(),
            name: COLUMNS[column],
            date: date_of(day),
        };
        row.ok_or_else(outside)?[column].ok_or_else(missing)
    }
}

/// Modified Julian date of 1 March 2000. In years that begin in March, the leap day is the last day.
const MARCH_2000: i64 = 51_604;

/// Returns the year, month and day (Gregorian) of a modified Julian date.
fn calendar(day: i64) -> (i64, i64, i64) {
    let since = day - MARCH_2000;
    let (cycle, in_cycle) = (since.div_euclid(146_097), since.rem_euclid(146_097));
    let century = (in_cycle / 36_524).min(3);
    let in_century = in_cycle - century * 36_524;
    let four = in_century / 1461;
    let in_four = in_century - four * 1461;
    let year = (in_four / 365).min(3);
    let in_year = in_four - year * 365;
    let month = (5 * in_year + 2) / 153; // month counted from March
    let day = in_year - (153 * month + 2) / 5 + 1;
    let year = 2000 + 400 * cycle + 100 * century + 4 * four + year;
    if month < 10 { (year, month + 3, day) } else { (year + 1, month - 9, day) }
}

/// Returns the modified Julian date of a text such as `2024-03-01`; `None` if the text is not a date.
fn day_of(text: &str) -> Option<i64> {
    let mut parts = text.split('-').map(|part| part.parse::<i64>().ok());
    let (year, month, day) = (parts.next()??, parts.next()??, parts.next()??);
    let is_date = (0..=9999).contains(&year) && (1..=12).contains(&month) && (1..=31).contains(&day);
    if parts.next().is_some() || !is_date {
        return None;
    }
    let date = modified_julian_date(year, month, day);
    (calendar(date) == (year, month, day)).then_some(date)
}

/// Returns the modified Julian date of a calendar date.
fn modified_julian_date(year: i64, month: i64, day: i64) -> i64 {
    let (year_of_march, from_march) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let years = year_of_march - 2000;
    let leaps = years.div_euclid(4) - years.div_euclid(100) + years.div_euclid(400);
    MARCH_2000 + 365 * years + leaps + (153 * from_march + 2) / 5 + day - 1
}

/// Returns a modified Julian date as a text such as `2024-03-01`.
fn date_of(day: i64) -> String {
    let (year, month, day) = calendar(day);
    format!("{year:04}-{month:02}-{day:02}")
}

/// Returns the day of the year, counted from 1, of a modified Julian date.
pub(super) fn day_of_year(day: i64) -> i32 {
    let (year, ..) = calendar(day);
    (day - modified_julian_date(year, 1, 1) + 1) as i32 // at most 366
}
