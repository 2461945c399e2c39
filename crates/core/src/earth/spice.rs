//! Positions of the Sun and the Moon from a SPICE kernel.

use nalgebra::Vector3;

use super::error::EarthError;

/// Largest accepted coefficient, km. It is far beyond the planets, but small enough that no series overflows.
const FARTHEST_KM: f64 = 1e12;

/// Positions of one body relative to another, as Chebyshev series on intervals of equal length (SPK types 2
/// and 3).
#[derive(Clone, Debug, PartialEq)]
pub struct SpiceSegment {
    /// Sign with which the positions enter the sum of segments: 1 or -1.
    pub sign: f64,
    /// Start of the first interval, s of TDB from J2000.0.
    pub start: f64,
    /// Length of an interval, s.
    pub length: f64,
    /// Number of coefficients of one component in one interval.
    pub count: usize,
    /// Coefficients of the three components, km: (3, intervals, count).
    pub coefficients: Vec<f64>,
}

/// Positions of the Sun and the Moon from the Earth's centre, GCRF axes. Each position is the sum of the
/// positions in one or more segments.
///
/// TT is used in place of TDB. They differ by less than 2 ms, during which the Moon moves by 2 m and the Sun
/// by 60 m.
#[derive(Clone, Debug, PartialEq)]
pub struct SpiceKernel {
    sun: Vec<SpiceSegment>,
    moon: Vec<SpiceSegment>,
}

impl SpiceKernel {
    /// Creates the kernel from the segments whose positions, with their signs, add up to those of the Sun
    /// and of the Moon from the Earth's centre.
    ///
    /// # Errors
    /// [`EarthError::SegmentLength`] for a segment without complete intervals, [`EarthError::NotFinite`]
    /// for an infinite number or NaN, and [`EarthError::Segment`] for a sign other than ±1, an interval whose
    /// length is not positive, or a coefficient above 1e12 km, with which positions could overflow.
    pub fn new(sun: Vec<SpiceSegment>, moon: Vec<SpiceSegment>) -> Result<Self, EarthError> {
        for segment in sun.iter().chain(&moon) {
            let (got, size) = (segment.coefficients.len(), segment.count.saturating_mul(3));
            if size == 0 || got == 0 || got % size != 0 {
                return Err(EarthError::SegmentLength { got, per_interval: segment.count });
            }
            let numbers = [segment.sign, segment.start, segment.length];
            if let Some(&value) = numbers.iter().chain(&segment.coefficients).find(|x| !x.is_finite()) {
                return Err(EarthError::NotFinite { name: "a number in a segment of the kernel", value });
            }
            segment.check()?;
        }
        Ok(Self { sun, moon })
    }

    /// Returns the span that all segments cover, s of TDB from J2000.0.
    pub(super) fn span(&self) -> (f64, f64) {
        let all = || self.sun.iter().chain(&self.moon);
        let start = all().map(|segment| segment.start).fold(f64::NEG_INFINITY, f64::max);
        (start, all().map(SpiceSegment::end).fold(f64::INFINITY, f64::min))
    }

    /// Returns the position of the Sun from the Earth's centre, GCRF axes, m, at `seconds` of TDB from
    /// J2000.0.
    pub(super) fn sun(&self, seconds: f64) -> Vector3<f64> {
        self.sun.iter().map(|segment| segment.position(seconds)).sum()
    }

    /// Returns the position of the Moon from the Earth's centre, GCRF axes, m, at `seconds` of TDB from
    /// J2000.0.
    pub(super) fn moon(&self, seconds: f64) -> Vector3<f64> {
        self.moon.iter().map(|segment| segment.position(seconds)).sum()
    }
}

impl SpiceSegment {
    fn check(&self) -> Result<(), EarthError> {
        let farthest = self.coefficients.iter().copied().find(|c| c.abs() > FARTHEST_KM);
        let (name, value, expected) = if self.sign.abs() != 1.0 {
            ("the sign", self.sign, "1 or -1")
        } else if self.length <= 0.0 {
            ("the length of an interval, in s,", self.length, "a positive number of seconds")
        } else if let Some(value) = farthest {
            ("a coefficient, in km,", value, "a magnitude of at most 1e12 km")
        } else {
            return Ok(());
        };
        Err(EarthError::Segment { name, value, expected })
    }

    fn intervals(&self) -> usize {
        self.coefficients.len() / (3 * self.count)
    }

    fn end(&self) -> f64 {
        self.start + self.length * self.intervals() as f64
    }

    fn position(&self, seconds: f64) -> Vector3<f64> {
        let position = (seconds - self.start) / self.length;
        let interval = (position as usize).min(self.intervals() - 1);
        let x = 2.0 * (position - interval as f64) - 1.0;
        let component = |axis: usize| {
            let from = (axis * self.intervals() + interval) * self.count;
            // Clenshaw's recursion: b_k = c_k + 2x b_{k+1} - b_{k+2},  f = c_0 + x b_1 - b_2
            let series = &self.coefficients[from..from + self.count];
            let add = |(b1, b2): (f64, f64), c: &f64| (c + 2.0 * x * b1 - b2, b1);
            let (b1, b2) = series[1..].iter().rev().fold((0.0, 0.0), add);
            series[0] + x * b1 - b2
        };
        Vector3::from_fn(|axis, _| component(axis)) * (1e3 * self.sign)
    }
}
