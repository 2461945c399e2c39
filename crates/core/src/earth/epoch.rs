//! Epochs and time scales.

use hifitime::{Duration, Epoch as Instant, TimeScale, Unit};

use super::error::EarthError;

/// Length of a day, s.
pub(super) const DAY: f64 = 86_400.0;

const DAY_NS: i64 = 86_400_000_000_000;

/// Modified Julian date of 2000-01-01, days.
const MJD_2000: i64 = 51_544;

/// Difference between Terrestrial Time and atomic time, TT - TAI, s.
const TT_MINUS_TAI: f64 = 32.184;

/// First year in which UTC has whole leap seconds.
const UTC_YEAR: i32 = 1972;

/// Accepted years, which are those of the series for nutation, Sun and Moon.
const YEARS: std::ops::Range<i32> = 1900..2100;

/// Epoch: the instant of simulation time zero, stored to the nanosecond; by default 2000-01-01T12:00:00 TAI.
///
/// Simulation time counts the seconds of TAI (equal to those of TT) from this instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Epoch {
    /// Time since 2000-01-01T12:00:00 TAI, nanoseconds of TAI.
    tai: i64,
}

impl Epoch {
    /// Parses a text such as `2024-03-01T12:00:00 UTC`, which consists of a date, a time of day and a time
    /// scale. The time scale is UTC (or `Z`), TAI, TT or TDB.
    ///
    /// The seconds may be omitted, or have up to nine decimals. An instant in a leap second is written
    /// with 60 seconds.
    ///
    /// # Errors
    /// [`EarthError::Epoch`] for any other text and for years outside 1900 to 2099;
    /// [`EarthError::BeforeUtc`] for UTC before 1972.
    pub fn parse(text: &str) -> Result<Self, EarthError> {
        let invalid = |fault: String| EarthError::Epoch { text: text.to_owned(), fault };
        let (fields, scale) = split_scale(text.trim()).ok_or_else(|| invalid(without_scale(text)))?;
        if has_fractional_minute(fields) {
            return Err(invalid("the minutes have decimals; write whole minutes, and seconds".to_owned()));
        }
        let (date, nanoseconds) = numbers(fields).ok_or_else(|| invalid(OTHER_FORM.to_owned()))?;
        let [year, month, day, hour, minute, second] = date;
        let year = i32::from(year);
        if scale == TimeScale::UTC && YEARS.contains(&year) && year < UTC_YEAR {
            return Err(EarthError::BeforeUtc { text: text.to_owned() });
        }
        if let Some(fault) = fault(date) {
            return Err(invalid(fault));
        }
        let byte = |x: u16| u8::try_from(x).unwrap_or(u8::MAX); // fits, as checked above
        let is_leap = second == 60;
        let (month, day, hour, minute) = (byte(month), byte(day), byte(hour), byte(minute));
        let second = if is_leap { 59 } else { byte(second) };
        let instant =
            Instant::maybe_from_gregorian(year, month, day, hour, minute, second, nanoseconds, scale)
                .map_err(|error| invalid(error.to_string()))?
                .to_time_scale(TimeScale::TAI);
        let epoch = Self::of(instant);
        match is_leap {
            false => Ok(epoch),
            true if scale == TimeScale::UTC && epoch.after(1.0).is_leap_second() => Ok(epoch.after(1.0)),
            true => Err(invalid("the second is 60 in a minute without a leap second of UTC".to_owned())),
        }
    }

    fn of(instant: Instant) -> Self {
        let nanoseconds = (instant.to_time_scale(TimeScale::TAI) - noon_of_2000()).total_nanoseconds();
        Self { tai: nanoseconds as i64 } // fits in i64, because years are limited
    }

    /// Creates the epoch from UTC, given as days from 2000-01-01 and seconds since midnight. Leap seconds are
    /// counted from 1972 on.
    pub(crate) fn of_utc(day: i64, seconds: f64) -> Self {
        let midnight = Instant::from_gregorian_utc_at_midnight(2000, 1, 1);
        Self::of(midnight + Unit::Day * day + Unit::Second * seconds)
    }

    /// Creates the epoch from a modified Julian date of UTC.
    pub(super) fn of_mjd_utc(mjd: f64) -> Self {
        Self::of_utc(mjd.floor() as i64 - MJD_2000, (mjd - mjd.floor()) * DAY)
    }

    /// Returns the epoch that is `seconds` later.
    pub(super) fn after(self, seconds: f64) -> Self {
        Self { tai: self.tai.saturating_add((seconds * 1e9).round() as i64) }
    }

    /// Returns the time from `earlier` to this epoch, s.
    pub(crate) fn since(self, earlier: Self) -> f64 {
        (self.tai as i128 - earlier.tai as i128) as f64 * 1e-9
    }

    /// Returns the time from 2000-01-01T12:00:00 TAI to this epoch, as whole days of TAI and a fraction of
    /// a day.
    pub(super) fn tai_days(self) -> (f64, f64) {
        (self.tai.div_euclid(DAY_NS) as f64, self.tai.rem_euclid(DAY_NS) as f64 / DAY_NS as f64)
    }

    /// Returns the time from J2000.0 (2000-01-01T12:00:00 TT) to `t` s after this epoch, s of TT.
    pub(super) fn seconds_tt(self, t: f64) -> f64 {
        self.tai as f64 * 1e-9 + TT_MINUS_TAI + t
    }

    /// Returns the time from J2000.0 to `t` s after this epoch, Julian centuries of TT.
    pub(super) fn centuries(self, t: f64) -> f64 {
        self.seconds_tt(t) / (36_525.0 * DAY)
    }

    /// Returns the time from `other` to this epoch, s.
    pub fn seconds_since(self, other: Self) -> f64 {
        self.tai.saturating_sub(other.tai) as f64 * 1e-9
    }

    /// Returns UTC - TAI at this epoch, s, which is a whole number, and zero before 1972.
    pub fn utc_minus_tai(self) -> f64 {
        -f64::from(self.leap_seconds())
    }

    /// Returns TAI - UTC at this epoch, s.
    fn leap_seconds(self) -> i32 {
        // hifitime compares TAI seconds with UTC instants, so that a leap second takes effect too early by
        // TAI - UTC
        let early = self.instant().leap_seconds_iers();
        (self.instant() - Unit::Second * i64::from(early)).leap_seconds_iers()
    }

    /// Returns true if the epoch lies within a leap second.
    fn is_leap_second(self) -> bool {
        (1..self.after(1.0).leap_seconds()).contains(&self.leap_seconds())
    }

    /// Returns this epoch as the modified Julian date of UTC, whole days, and the seconds since midnight.
    pub(super) fn utc(self) -> (i64, f64) {
        let since_midnight = self.tai + DAY_NS / 2 + (self.utc_minus_tai() as i64) * 1_000_000_000;
        (MJD_2000 + since_midnight.div_euclid(DAY_NS), since_midnight.rem_euclid(DAY_NS) as f64 * 1e-9)
    }

    /// Returns the start and the end of the span of the series for nutation, Sun and Moon, 1900 to 2100, s
    /// after this epoch.
    pub(super) fn series_span(self) -> (f64, f64) {
        let since = self.since(Self::default());
        (-36_525.0 * DAY - since, 36_525.0 * DAY - since)
    }

    fn instant(self) -> Instant {
        noon_of_2000() + Duration::from_truncated_nanoseconds(self.tai)
    }
}

impl std::fmt::Display for Epoch {
    /// Writes a text such as `2024-03-01T12:00:00.000000 UTC`, to the microsecond. Epochs before 1972 are
    /// written in TAI.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let rounded = Self { tai: self.tai.saturating_add(500) };
        let (leap, is_leap_second) = (rounded.leap_seconds(), rounded.is_leap_second());
        let scale = if leap > 0 { "UTC" } else { "TAI" };
        let counted = rounded.instant() - Unit::Second * i64::from(leap + i32::from(is_leap_second));
        let (year, month, day, hour, minute, second, ns) = counted.to_gregorian_tai();
        let (second, micros) = (u32::from(second) + u32::from(is_leap_second), ns / 1000);
        write!(f, "{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{micros:06} {scale}")
    }
}

fn noon_of_2000() -> Instant {
    Instant::from_gregorian_tai_at_noon(2000, 1, 1)
}

/// Message about a text that ends with a time scale but does not begin with a date and a time.
const OTHER_FORM: &str =
    "the part before the time scale is not a date and a time of the form YYYY-MM-DDThh:mm:ss.s";

/// Returns a message that says what is wrong with a text that does not end with a time scale.
fn without_scale(text: &str) -> String {
    let time = text.split_once(['T', ' ']).map_or("", |(_, time)| time);
    let fault = if time.contains(['+', '-']) {
        "an offset from UTC is not accepted (convert the time to UTC)"
    } else {
        "it does not end with a time scale, which is UTC (or Z), TAI, TT or TDB"
    };
    fault.to_owned()
}

/// Returns a message about the first field of `[year, month, day, hour, minute, second]` that is out of
/// range; `None` if all are valid.
fn fault([year, month, day, hour, minute, second]: [u16; 6]) -> Option<String> {
    let is_leap_year = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let days = match month {
        2 => 28 + u16::from(is_leap_year),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    };
    let outside = |name, value, first, last| {
        (value < first || value > last)
            .then(|| format!("the {name} is {value} and must be from {first} to {last}"))
    };
    let in_month = || {
        (day < 1 || day > days)
            .then(|| format!("the day is {day} and must be from 1 to {days} in {year:04}-{month:02}"))
    };
    outside("year", year, YEARS.start as u16, YEARS.end as u16 - 1)
        .or_else(|| outside("month", month, 1, 12))
        .or_else(in_month)
        .or_else(|| outside("hour", hour, 0, 23))
        .or_else(|| outside("minute", minute, 0, 59))
        .or_else(|| outside("second", second, 0, 60))
}

/// Separates the time scale at the end of a text from the date and time before it; returns `None` if the
/// text does not end with the name of a time scale.
fn split_scale(text: &str) -> Option<(&str, TimeScale)> {
    let scales = [
        ("Z", TimeScale::UTC),
        ("UTC", TimeScale::UTC),
        ("TAI", TimeScale::TAI),
        ("TT", TimeScale::TT),
        ("TDB", TimeScale::TDB),
    ];
    scales.iter().find_map(|(name, scale)| Some((text.strip_suffix(name)?.trim_end(), *scale)))
}

/// Parses the year, month, day, hour, minute, second and nanoseconds of a text such as
/// `2024-03-01T12:00:00`, in which the seconds may be omitted; returns `None` for a text of another form.
fn numbers(text: &str) -> Option<([u16; 6], u32)> {
    let (whole, fraction) = text.split_once('.').unwrap_or((text, "0"));
    let (date, time) = whole.split_once(['T', ' '])?;
    let mut fields = [0; 6];
    let mut parts = date.split('-').chain(time.split(':'));
    if date.split('-').count() != 3 || !(2..=3).contains(&time.split(':').count()) {
        return None;
    }
    for (field, part) in fields.iter_mut().zip(&mut parts) {
        *field = is_number(part, 4).then(|| part.parse().ok())??;
    }
    let nanoseconds = is_number(fraction, 9).then(|| format!("{fraction:0<9}").parse().ok())??;
    Some((fields, nanoseconds))
}

/// Returns true if a text such as `2024-03-01T12:00.5` has decimals, but no seconds.
fn has_fractional_minute(text: &str) -> bool {
    let whole = text.split_once('.').map_or("", |(whole, _)| whole);
    whole.matches(':').count() == 1
}

/// Returns true if the text consists of digits, at least 1 and at most `longest`.
fn is_number(text: &str, longest: usize) -> bool {
    (1..=longest).contains(&text.len()) && text.bytes().all(|c| c.is_ascii_digit())
}
