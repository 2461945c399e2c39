//! Parser of two-line element sets (TLE).

use super::elements::{MeanElements, REV_DAY};
use super::epoch::{Epoch, days_of_year};
use super::error::ElementSetError;

/// Columns between the fields of line 1 and of line 2, counted from 1, which must be blank.
const GAPS: [&[usize]; 2] = [&[2, 9, 18, 33, 44, 53, 62, 64], &[2, 8, 17, 26, 34, 43, 52]];

/// Line of a TLE, with 69 ASCII characters.
struct Line<'a> {
    number: u8,
    text: &'a str,
}

impl<'a> Line<'a> {
    fn new(number: u8, text: &'a str, check_checksum: bool) -> Result<Self, ElementSetError> {
        let text = text.trim_end();
        let got = text.chars().count();
        if let Some((index, c)) = text.chars().enumerate().find(|(_, c)| !matches!(c, ' '..='~')) {
            let (column, got) = (index + 1, c.to_string());
            return Err(ElementSetError::Column {
                line: number,
                column,
                got,
                expected: "a printable ASCII character",
            });
        }
        if got != 69 {
            return Err(ElementSetError::Length { line: number, got });
        }
        let line = Self { number, text };
        if line.columns(1, 1).parse() != Ok(number) {
            return Err(line.wrong(
                1,
                1,
                if number == 1 { "the line number 1" } else { "the line number 2" },
            ));
        }
        if let Some(&gap) = GAPS[usize::from(number) - 1].iter().find(|&&gap| line.columns(gap, gap) != " ") {
            return Err(line.wrong(gap, gap, "a blank"));
        }
        if check_checksum {
            line.add_up()?;
        }
        Ok(line)
    }

    /// Returns the text in the columns `first..=last`, counted from 1.
    fn columns(&self, first: usize, last: usize) -> &'a str {
        &self.text[first - 1..last]
    }

    fn wrong(&self, first: usize, last: usize, expected: &'static str) -> ElementSetError {
        let got = self.columns(first, last).to_owned();
        ElementSetError::Column { line: self.number, column: first, got, expected }
    }

    /// Verifies the checksum: the sum of the digits modulo 10, where each minus sign counts as 1.
    fn add_up(&self) -> Result<(), ElementSetError> {
        let worth = |c: u8| {
            if c == b'-' { 1 } else { u32::from(c.is_ascii_digit()) * u32::from(c.wrapping_sub(b'0')) }
        };
        let expected = (self.text.bytes().take(68).map(worth).sum::<u32>() % 10) as u8;
        let got = self.columns(69, 69).parse().map_err(|_| self.wrong(69, 69, "the checksum digit"))?;
        if got == expected {
            Ok(())
        } else {
            Err(ElementSetError::Checksum { line: self.number, got, expected })
        }
    }

    /// Parses the number in the columns `first..=last`, such as ` 34.2682`.
    fn decimal(&self, first: usize, last: usize) -> Result<f64, ElementSetError> {
        let text = self.columns(first, last).trim();
        let is_plain = text
            .bytes()
            .enumerate()
            .all(|(i, c)| c.is_ascii_digit() || c == b'.' || (i == 0 && matches!(c, b'+' | b'-')));
        let number = if is_plain { text.parse().ok() } else { None };
        number.ok_or_else(|| self.wrong(first, last, "a decimal number"))
    }

    /// Parses the digits in the columns `first..=last`, which follow an implied decimal point.
    fn fraction(&self, first: usize, last: usize) -> Result<f64, ElementSetError> {
        let text = self.columns(first, last);
        let number =
            if text.bytes().all(|c| c.is_ascii_digit()) { format!("0.{text}").parse().ok() } else { None };
        number.ok_or_else(|| self.wrong(first, last, "only digits"))
    }

    /// Parses the eight columns from `first` on, which hold a sign, a fraction of five digits, and an
    /// exponent with its sign: ` 28098-4` is 0.28098e-4.
    fn with_exponent(&self, first: usize) -> Result<f64, ElementSetError> {
        let wrong = || {
            self.wrong(
                first,
                first + 7,
                "a sign or blank, five digits and a signed exponent (such as ' 28098-4')",
            )
        };
        let text = self.columns(first, first + 7);
        let (sign, digits, exponent) = (&text[..1], &text[1..6], &text[6..]);
        let sign = if sign == " " { "" } else { sign };
        let is_well_formed = matches!(sign, "" | "+" | "-")
            && digits.bytes().all(|c| c.is_ascii_digit())
            && exponent.starts_with(['+', '-', ' '])
            && exponent.ends_with(|c: char| c.is_ascii_digit());
        if !is_well_formed {
            return Err(wrong());
        }
        format!("{sign}0.{digits}e{}", exponent.trim_start()).parse().map_err(|_| wrong())
    }
}

impl MeanElements {
    /// Parses the two lines of a TLE; trailing blanks are ignored. The checksums are verified only if
    /// `check_checksum` is true.
    ///
    /// # Errors
    /// [`ElementSetError`] for a malformed line, with its number and, for an invalid field, the column; for
    /// lines of different satellites; and for an element outside its range.
    ///
    /// Source: the column table of CelesTrak's "NORAD Two-Line Element Set Format".
    pub fn from_tle(line1: &str, line2: &str, check_checksum: bool) -> Result<Self, ElementSetError> {
        let (one, two) = (Line::new(1, line1, check_checksum)?, Line::new(2, line2, check_checksum)?);
        let (first, second) = (one.columns(3, 7), two.columns(3, 7));
        if first != second {
            let (first, second) = (first.to_owned(), second.to_owned());
            return Err(ElementSetError::TwoSatellites { first, second });
        }
        let satellite = satellite_number(first)
            .ok_or_else(|| one.wrong(3, 7, "a satellite number: five digits, or a letter and four digits"))?;
        let year: i64 =
            one.columns(19, 20).trim().parse().map_err(|_| one.wrong(19, 20, "two digits of a year"))?;
        let day = one.decimal(21, 32)?;
        // two-digit years stand for 1957 to 2056
        let year = if year < 57 { 2000 + year } else { 1900 + year };
        let last = days_of_year(year);
        if !(1.0..(last + 1) as f64).contains(&day) {
            return Err(one.wrong(21, 32, "a day of the year, 1 to 365, or 366 in a leap year"));
        }
        let epoch = Epoch::of_year(year, day);
        one.decimal(34, 43)?; // SGP4 ignores the derivatives of the mean motion, but they must be valid
        one.with_exponent(45)?;
        Self {
            satellite,
            epoch,
            drag_term: one.with_exponent(54)?,
            inclination: two.decimal(9, 16)?.to_radians(),
            raan: two.decimal(18, 25)?.to_radians(),
            eccentricity: two.fraction(27, 33)?,
            argument_of_perigee: two.decimal(35, 42)?.to_radians(),
            mean_anomaly: two.decimal(44, 51)?.to_radians(),
            mean_motion: two.decimal(53, 63)? / REV_DAY,
        }
        .checked()
    }
}

/// Parses the catalogue number: up to five digits, or a letter and four digits (Alpha-5: A is 10; I and O
/// are not used).
fn satellite_number(text: &str) -> Option<u32> {
    const LETTERS: &str = "ABCDEFGHJKLMNPQRSTUVWXYZ";
    let text = text.trim();
    let (head, tail) = text.split_at_checked(1)?;
    match LETTERS.find(head) {
        Some(place) if tail.len() == 4 && tail.bytes().all(|c| c.is_ascii_digit()) => {
            Some((place as u32 + 10) * 10_000 + tail.parse::<u32>().ok()?)
        }
        _ => text.bytes().all(|c| c.is_ascii_digit()).then(|| text.parse().ok())?,
    }
}
