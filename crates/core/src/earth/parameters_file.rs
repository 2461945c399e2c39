//! Reader of files with Earth-orientation parameters.

use super::error::EarthError;
use super::parameters::{EarthParameterRow, EarthParameters};
use super::precession::ARC_SECOND;

/// Header of the CSV format.
const HEADER: [&str; 4] = ["mjd", "x_arcsec", "y_arcsec", "ut1_minus_utc_s"];

impl EarthParameters {
    /// Reads a table in the IERS format `finals2000A` or `eopc04`, or as CSV with the header
    /// `mjd,x_arcsec,y_arcsec,ut1_minus_utc_s`.
    ///
    /// Blank lines and lines that begin with `#` are ignored. A `finals2000A` table ends before the first
    /// row without polar motion or UT1.
    ///
    /// # Errors
    /// [`EarthError::Table`], with the number of the line, for an empty file, another CSV header, a row that
    /// cannot be parsed, or a `finals2000A` table without values in its first row.
    pub fn read(text: &str) -> Result<Self, EarthError> {
        let is_data = |line: &&(usize, &str)| !line.1.trim().is_empty() && !line.1.starts_with('#');
        let lines: Vec<(usize, &str)> = text.lines().enumerate().collect();
        let mut lines = lines.iter().filter(is_data).copied().peekable();
        let Some((index, first)) = lines.peek().copied() else {
            return Err(EarthError::Table {
                line: 1,
                problem: "the file has no rows; expected one row per instant".to_owned(),
            });
        };
        let read = if first.contains(',') {
            let names: Vec<_> = first.split(',').map(str::trim).collect();
            if names != HEADER {
                let problem = format!("the header is '{first}'; expected '{}'", HEADER.join(","));
                return Err(EarthError::Table { line: index + 1, problem });
            }
            lines.next();
            csv_row
        } else if first.get(16..17).is_some_and(|flag| matches!(flag, "I" | "P")) {
            finals_row
        } else {
            c04_row
        };
        let mut rows = Vec::new();
        for (index, line) in lines {
            match read(line) {
                Ok(Some(row)) => rows.push(row),
                Ok(None) if !rows.is_empty() => break,
                Ok(None) | Err(()) => {
                    let problem = format!(
                        "the row is '{}'; expected numbers for the MJD, the polar motion x and y (arcsec) and \
                         UT1 - UTC (s); correct or remove the row",
                        line.trim_end()
                    );
                    return Err(EarthError::Table { line: index + 1, problem });
                }
            }
        }
        Ok(Self::Table(rows))
    }
}

/// Result of parsing a row: `Ok(None)` for a row without values, and `Err` for a row that cannot be
/// parsed.
type ParsedRow = Result<Option<EarthParameterRow>, ()>;

fn number(text: &str) -> Result<f64, ()> {
    text.trim().parse().map_err(|_| ())
}

fn row(mjd: &str, x: &str, y: &str, ut1: &str) -> ParsedRow {
    let polar_motion = [number(x)? * ARC_SECOND, number(y)? * ARC_SECOND];
    Ok(Some(EarthParameterRow { mjd: number(mjd)?, polar_motion, ut1_minus_utc: number(ut1)? }))
}

fn csv_row(line: &str) -> ParsedRow {
    match line.split(',').collect::<Vec<_>>()[..] {
        [mjd, x, y, ut1] => row(mjd, x, y, ut1),
        _ => Err(()),
    }
}

/// Parses a row of `finals2000A`, with the MJD in columns 8-15, the polar motion x and y (arcsec) in 19-27
/// and 38-46, and UT1 - UTC (s) in 59-68.
fn finals_row(line: &str) -> ParsedRow {
    let part = |from: usize, to: usize| line.get(from - 1..to.min(line.len())).unwrap_or("");
    let (x, y, ut1) = (part(19, 27), part(38, 46), part(59, 68));
    if [x, y, ut1].iter().any(|text| text.trim().is_empty()) {
        return number(part(8, 15)).map(|_| None);
    }
    row(part(8, 15), x, y, ut1)
}

/// Parses a row of `eopc04`: year, month, day, hour (in newer files), MJD, polar motion x and y (arcsec),
/// UT1 - UTC (s), and further columns.
fn c04_row(line: &str) -> ParsedRow {
    let parts: Vec<_> = line.split_whitespace().collect();
    let has_hour = parts.get(3).and_then(|hour| hour.parse::<f64>().ok()).is_some_and(|hour| hour < 24.0);
    match parts.get(if has_hour { 4 } else { 3 }..) {
        Some([mjd, x, y, ut1, ..]) => row(mjd, x, y, ut1),
        _ => Err(()),
    }
}
