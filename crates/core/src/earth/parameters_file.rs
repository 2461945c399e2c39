//! Files of Earth-orientation parameters.

use super::precession::ARC_SECOND;
use super::{EarthError, EarthParameterRow, EarthParameters};

/// Columns of a table of ours, in its first line.
const HEADER: [&str; 4] = ["mjd", "x_arcsec", "y_arcsec", "ut1_minus_utc_s"];

impl EarthParameters {
    /// Reads a table: the IERS' `finals2000A` or `eopc04`, or lines of numbers between commas below the header
    /// `mjd,x_arcsec,y_arcsec,ut1_minus_utc_s`.
    ///
    /// Rows of `finals2000A` that hold no UT1 yet end the table.
    ///
    /// # Errors
    /// [`EarthError::Table`] with the line.
    pub fn read(text: &str) -> Result<Self, EarthError> {
        let is_data = |line: &&(usize, &str)| !line.1.trim().is_empty() && !line.1.starts_with('#');
        let lines: Vec<(usize, &str)> = text.lines().enumerate().collect();
        let mut lines = lines.iter().filter(is_data).copied().peekable();
        let Some((index, first)) = lines.peek().copied() else {
            return Err(EarthError::Table { line: 1, problem: "the file holds no rows".to_owned() });
        };
        let read = if first.contains(',') {
            let names: Vec<_> = first.split(',').map(str::trim).collect();
            if names != HEADER {
                let problem = format!("the header is '{first}', '{}' is needed", HEADER.join(","));
                return Err(EarthError::Table { line: index + 1, problem });
            }
            lines.next();
            between_commas
        } else if first.get(16..17).is_some_and(|flag| matches!(flag, "I" | "P")) {
            finals
        } else {
            c04
        };
        let mut rows = Vec::new();
        for (index, line) in lines {
            match read(line) {
                Ok(Some(row)) => rows.push(row),
                Ok(None) if !rows.is_empty() => break,
                Ok(None) | Err(()) => {
                    let problem = format!("'{}' is no row of MJD, pole and UT1 - UTC", line.trim_end());
                    return Err(EarthError::Table { line: index + 1, problem });
                }
            }
        }
        Ok(Self::Table(rows))
    }
}

/// A row; `None` where it holds nothing yet.
type Read = Result<Option<EarthParameterRow>, ()>;

fn number(text: &str) -> Result<f64, ()> {
    text.trim().parse().map_err(|_| ())
}

fn row(mjd: &str, x: &str, y: &str, ut1: &str) -> Read {
    let polar_motion = [number(x)? * ARC_SECOND, number(y)? * ARC_SECOND];
    Ok(Some(EarthParameterRow { mjd: number(mjd)?, polar_motion, ut1_minus_utc: number(ut1)? }))
}

fn between_commas(line: &str) -> Read {
    match line.split(',').collect::<Vec<_>>()[..] {
        [mjd, x, y, ut1] => row(mjd, x, y, ut1),
        _ => Err(()),
    }
}

/// Columns 8-15 MJD, 19-27 and 38-46 pole, 59-68 UT1 - UTC.
fn finals(line: &str) -> Read {
    let part = |from: usize, to: usize| line.get(from - 1..to.min(line.len())).unwrap_or("");
    let (x, y, ut1) = (part(19, 27), part(38, 46), part(59, 68));
    if [x, y, ut1].iter().any(|text| text.trim().is_empty()) {
        return number(part(8, 15)).map(|_| None);
    }
    row(part(8, 15), x, y, ut1)
}

/// Year, month, day, in newer files the hour, MJD, pole, UT1 - UTC, and more.
fn c04(line: &str) -> Read {
    let parts: Vec<_> = line.split_whitespace().collect();
    let has_hour = parts.get(3).and_then(|hour| hour.parse::<f64>().ok()).is_some_and(|hour| hour < 24.0);
    match parts.get(if has_hour { 4 } else { 3 }..) {
        Some([mjd, x, y, ut1, ..]) => row(mjd, x, y, ut1),
        _ => Err(()),
    }
}
