//! UTC epoch of an element set.

use std::f64::consts::{PI, TAU};

/// UTC epoch: a day and the seconds since its midnight. Every day has 86 400 s, as in SGP4, which ignores
/// leap seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Epoch {
    /// Days since 2000-01-01.
    day: i64,
    /// Seconds since midnight.
    seconds: f64,
}

impl Epoch {
    /// Creates the epoch from a year and a day of the year, which is 1.0 at the midnight that begins
    /// 1 January.
    pub(super) fn of_year(year: i64, day_of_year: f64) -> Self {
        let whole = day_of_year.floor();
        Self {
            day: days_since_2000(year, 1, 1) + whole as i64 - 1,
            seconds: (day_of_year - whole) * 86_400.0,
        }
    }

    /// Parses a text such as `2024-01-31T12:34:56.789` or `2024-031T12:34:56.789`, with `T` or a space, with
    /// or without a final `Z`. Returns `None` for a text of another form and for a date or time that does
    /// not exist.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let (date, time) = text.trim().trim_end_matches('Z').split_once(['T', ' '])?;
        let mut time = time.split(':');
        let (hour, minute) = (digits(time.next()?)?, digits(time.next()?)?);
        let second = time.next()?;
        let seconds: f64 =
            second.starts_with(|c: char| c.is_ascii_digit()).then(|| second.parse().ok())??;
        if date.find('-') != Some(4) {
            return None; // the year must have four digits
        }
        let parts = date.split('-').map(digits).collect::<Option<Vec<i64>>>()?;
        let day = match parts[..] {
            [year, month, day] if (1..=12).contains(&month) => {
                let (year_after, month_after) = if month == 12 { (year + 1, 1) } else { (year, month + 1) };
                let length = days_since_2000(year_after, month_after, 1) - days_since_2000(year, month, 1);
                (1..=length).contains(&day).then(|| days_since_2000(year, month, day))?
            }
            [year, day] if (1..=days_of_year(year)).contains(&day) => days_since_2000(year, 1, 1) + day - 1,
            _ => return None,
        };
        let is_time = time.next().is_none() && hour < 24 && minute < 60 && seconds < 61.0;
        is_time.then(|| Self { day, seconds: (hour * 3600 + minute * 60) as f64 + seconds })
    }

    /// Converts a Julian date given in two parts, such as a midnight and a fraction of a day. Returns `None`
    /// if a part is not finite, if the first is 1e7 days or more from the year 2000, or if the second is 1e7
    /// days or more.
    pub fn of_julian_date(whole: f64, part: f64) -> Option<Self> {
        const LONGEST: f64 = 1e7;
        let days = whole - 2_451_544.5;
        let midnight = days.floor();
        let since = (days - midnight) + part;
        (days.abs() < LONGEST && part.abs() < LONGEST).then(|| Self {
            day: (midnight + since.floor()) as i64,
            seconds: (since - since.floor()) * 86_400.0,
        })
    }

    /// Returns the Julian date as a single number, accurate to 20 µs, as in the reference implementation. For
    /// orbits with periods of two weeks, the resulting error of the Moon's perturbation is 4 mm.
    pub(super) fn julian_day(&self) -> f64 {
        let (midnight, part) = self.julian_date();
        midnight + part
    }

    /// Returns the Greenwich mean sidereal time by the formula of 1982, rad in [0, 2π), with UT1 replaced by
    /// UTC.
    ///
    /// Source: Aoki et al., Astronomy and Astrophysics 105, 1982, eq. 14.
    pub(super) fn sidereal_time(&self) -> f64 {
        let t = (self.julian_day() - 2_451_545.0) / 36_525.0;
        let seconds = -6.2e-6 * t * t * t
            + 0.093_104 * t * t
            + (876_600.0 * 3600.0 + 8_640_184.812_866) * t
            + 67_310.548_41;
        (seconds * (PI / 180.0) / 240.0).rem_euclid(TAU)
    }

    /// Returns the epoch on the atomic time scale; leap seconds are counted from 1972 on.
    pub(super) fn instant(&self) -> crate::earth::Epoch {
        crate::earth::Epoch::of_utc(self.day, self.seconds)
    }

    /// Returns the Julian date of the midnight before the epoch and the fraction of the day since then.
    pub fn julian_date(&self) -> (f64, f64) {
        (2_451_544.5 + self.day as f64, self.seconds / 86_400.0)
    }
}

fn digits(text: &str) -> Option<i64> {
    (!text.is_empty() && text.len() <= 4 && text.bytes().all(|c| c.is_ascii_digit()))
        .then(|| text.parse().ok())?
}

/// Returns the number of days from 2000-01-01 to a Gregorian date. In the computation, years begin in March,
/// so that leap days are at the end of a year.
fn days_since_2000(year: i64, month: i64, day: i64) -> i64 {
    let y = if month < 3 { year - 1 } else { year };
    let days_of_months = (153 * ((month + 9) % 12) + 2) / 5;
    365 * y + y.div_euclid(4) - y.div_euclid(100) + y.div_euclid(400) + days_of_months + day - 730_426
}

/// Returns the number of days of a Gregorian year.
pub(super) fn days_of_year(year: i64) -> i64 {
    days_since_2000(year + 1, 1, 1) - days_since_2000(year, 1, 1)
}

/// Returns the Gregorian year, month and day for a number of days since 2000-01-01.
fn civil(days: i64) -> (i64, i64, i64) {
    // a lower bound of the year, for days before and after 2000
    let mut year = 2000 + days.div_euclid(if days < 0 { 365 } else { 366 });
    while days_since_2000(year + 1, 1, 1) <= days {
        year += 1;
    }
    let month = (1..=12).rev().find(|&m| days_since_2000(year, m, 1) <= days).unwrap_or(1);
    (year, month, days - days_since_2000(year, month, 1) + 1)
}

impl std::fmt::Display for Epoch {
    /// Writes the epoch as ISO 8601 to the microsecond: `2000-06-27T18:50:19.733568Z`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let micros = (self.seconds * 1e6).round() as i64;
        let (year, month, day) = civil(self.day + micros.div_euclid(86_400_000_000));
        let of_day = micros.rem_euclid(86_400_000_000);
        let (seconds, micros) = (of_day / 1_000_000, of_day % 1_000_000);
        let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
        write!(f, "{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{micros:06}Z")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn day_numbers_and_texts_agree() {
        for (text, epoch) in [
            ("2000-06-27T18:50:19.733568Z", Epoch::of_year(2000, 179.784_950_62)),
            ("2000-01-01T00:00:00.000000Z", Epoch::of_year(2000, 1.0)),
            ("1999-12-31T12:00:00.000000Z", Epoch::of_year(1999, 365.5)),
            ("2024-02-29T06:00:00.000000Z", Epoch::of_year(2024, 60.25)),
            ("1957-10-04T00:00:00.000000Z", Epoch::of_year(1957, 277.0)),
            ("2056-12-31T00:00:00.000000Z", Epoch::of_year(2056, 366.0)),
        ] {
            assert_eq!(epoch.to_string(), text);
            let read = Epoch::parse(text).expect("a text of to_text can be parsed");
            assert_eq!(read.day, epoch.day, "{text}");
            assert!((read.seconds - epoch.seconds).abs() < 1e-6, "{text}");
        }
        assert_eq!(Epoch::parse("2024-366T00:00:00"), Epoch::parse("2024-12-31T00:00:00"));
        assert_eq!(Epoch::parse("2024-060T06:00:00"), Epoch::parse("2024-02-29T06:00:00.0Z"));
        assert_eq!(Epoch::of_year(2000, 1.5).julian_date(), (2_451_544.5, 0.5));
        for (whole, part) in
            [(2_451_544.5, 0.5), (2_451_545.0, 0.0), (2_451_543.5, 1.5), (2_451_545.25, -0.25)]
        {
            assert_eq!(Epoch::of_julian_date(whole, part), Some(Epoch::of_year(2000, 1.5)));
        }
        assert_eq!(Epoch::of_julian_date(f64::NAN, 0.0), None);
        assert_eq!(Epoch::of_julian_date(2_451_544.5, f64::INFINITY), None);
    }

    #[test]
    fn every_day_of_a_century_is_restored() {
        let first = days_since_2000(1957, 1, 1);
        for days in first..days_since_2000(2057, 1, 1) {
            let (year, month, day) = civil(days);
            assert_eq!(days_since_2000(year, month, day), days);
            assert!((1..=12).contains(&month) && (1..=31).contains(&day), "{year}-{month}-{day}");
        }
        assert_eq!(civil(first), (1957, 1, 1));
        assert_eq!(civil(-3660), (1989, 12, 24));
    }

    #[test]
    fn sidereal_time_is_the_published_one() {
        // Vallado, Fundamentals of Astrodynamics and Applications, example 3-5: 152.5788°
        let epoch = Epoch::parse("1992-08-20T12:14:00").expect("a date");
        assert!((epoch.sidereal_time().to_degrees() - 152.578_788).abs() < 1e-6);
    }

    #[test]
    fn invalid_dates_are_rejected() {
        for text in [
            "",
            "2024-02-30T00:00:00",
            "2024-13-01T00:00:00",
            "2024-01-01",
            "2024-01-01T25:00:00",
            "2024-01-01T00:00:-1",
            "2024-01-01T00:00:nan",
            "2024-01-01T00:00:00:00",
            "2024-1e1-01T00:00:00",
            "2023-366T00:00:00",
            "2024-367T00:00:00",
            "1900-366T00:00:00",
            "24-01-01T00:00:00",
            "06-27T18:50:19",
        ] {
            assert_eq!(Epoch::parse(text), None, "{text}");
        }
    }
}
