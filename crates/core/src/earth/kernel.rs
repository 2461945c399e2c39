//! Sun and Moon as a SPICE kernel has them.

use nalgebra::Vector3;

use super::EarthError;

/// Largest coefficient accepted, km: far beyond the planets, and no series of them overflows.
const FARTHEST_KM: f64 = 1e12;

/// Positions of one body relative to another: Chebyshev series over pieces of equal length (types 2 and 3 of a kernel).
#[derive(Clone, Debug, PartialEq)]
pub struct KernelSegment {
    /// 1, or -1 where the positions are to be subtracted.
    pub sign: f64,
    /// Start of the first piece, s of TDB from J2000.0.
    pub start: f64,
    /// Length of a piece, s.
    pub length: f64,
    /// Number of coefficients of a series.
    pub count: usize,
    /// Three components of all pieces' coefficients, km: (3, pieces, count).
    pub coefficients: Vec<f64>,
}

/// Sun and Moon from the Earth's centre: each a sum of segments, GCRF axes.
///
/// TT is taken for TDB: they differ by less than 2 ms, in which the Moon moves 2 m and the Sun 60 m.
#[derive(Clone, Debug, PartialEq)]
pub struct Kernel {
    sun: Vec<KernelSegment>,
    moon: Vec<KernelSegment>,
}

impl Kernel {
    /// From the segments that lead from the Earth to each.
    ///
    /// # Errors
    /// [`EarthError::WrongLength`] for segments that hold no whole pieces, [`EarthError::NotFinite`], and
    /// [`EarthError::Segment`] for numbers that no ephemeris has and that positions could overflow by.
    pub fn new(sun: Vec<KernelSegment>, moon: Vec<KernelSegment>) -> Result<Self, EarthError> {
        for segment in sun.iter().chain(&moon) {
            let (got, piece) = (segment.coefficients.len(), segment.count.saturating_mul(3));
            if piece == 0 || got == 0 || got % piece != 0 {
                return Err(EarthError::WrongLength {
                    name: "a segment of the kernel",
                    expected: piece,
                    got,
                });
            }
            let numbers = [segment.sign, segment.start, segment.length];
            if let Some(&value) = numbers.iter().chain(&segment.coefficients).find(|x| !x.is_finite()) {
                return Err(EarthError::NotFinite { name: "a segment of the kernel", value });
            }
            segment.check()?;
        }
        Ok(Self { sun, moon })
    }

    /// What all segments cover, s of TDB from J2000.0.
    pub(super) fn span(&self) -> (f64, f64) {
        let all = || self.sun.iter().chain(&self.moon);
        let start = all().map(|segment| segment.start).fold(f64::NEG_INFINITY, f64::max);
        (start, all().map(KernelSegment::end).fold(f64::INFINITY, f64::min))
    }

    /// The Sun, m, `seconds` of TDB from J2000.0.
    pub(super) fn sun(&self, seconds: f64) -> Vector3<f64> {
        self.sun.iter().map(|segment| segment.position(seconds)).sum()
    }

    /// The Moon, m; likewise.
    pub(super) fn moon(&self, seconds: f64) -> Vector3<f64> {
        self.moon.iter().map(|segment| segment.position(seconds)).sum()
    }
}

impl KernelSegment {
    fn check(&self) -> Result<(), EarthError> {
        let farthest = self.coefficients.iter().copied().find(|c| c.abs() > FARTHEST_KM);
        let (name, value, expected) = if self.sign.abs() != 1.0 {
            ("sign", self.sign, "1 or -1 is needed")
        } else if self.length <= 0.0 {
            ("length of a piece", self.length, "a positive number of seconds is needed")
        } else if let Some(value) = farthest {
            ("coefficient", value, "at most 1e12 km is accepted")
        } else {
            return Ok(());
        };
        Err(EarthError::Segment { name, value, expected })
    }

    fn pieces(&self) -> usize {
        self.coefficients.len() / (3 * self.count)
    }

    fn end(&self) -> f64 {
        self.start + self.length * self.pieces() as f64
    }

    fn position(&self, seconds: f64) -> Vector3<f64> {
        let place = (seconds - self.start) / self.length;
        let piece = (place as usize).min(self.pieces() - 1);
        let x = 2.0 * (place - piece as f64) - 1.0;
        let component = |axis: usize| {
            let from = (axis * self.pieces() + piece) * self.count;
            // Clenshaw: b_k = c_k + 2x b_{k+1} - b_{k+2},  f = c_0 + x b_1 - b_2
            let series = &self.coefficients[from..from + self.count];
            let add = |(b1, b2): (f64, f64), c: &f64| (c + 2.0 * x * b1 - b2, b1);
            let (b1, b2) = series[1..].iter().rev().fold((0.0, 0.0), add);
            series[0] + x * b1 - b2
        };
        Vector3::from_fn(|axis, _| component(axis)) * (1e3 * self.sign)
    }
}
