//! Positions of the Sun and the Moon during a run.

use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

use super::chebyshev::PiecewiseChebyshev;
use super::epoch::{DAY, Epoch};
use super::spice::SpiceKernel;
use super::sun_moon_series;

/// Length of the intervals of the Sun's Chebyshev series, s; the intervals of the Moon are half as long.
///
/// The interpolation error is below 1 cm for the Moon and 1 m for the Sun.
const INTERVAL: f64 = 8.0 * DAY;

/// Interpolated positions of the Sun and the Moon, axes of `I`.
#[derive(Clone, Debug)]
pub(super) struct SunMoon {
    pub(super) epoch: Epoch,
    /// First and last simulation time at which the positions are known, s.
    pub(super) span: (f64, f64),
    kernel: Option<Arc<SpiceKernel>>,
    /// Epoch as the modified Julian date of UTC and the seconds since midnight.
    utc: (i64, f64),
    sun: PiecewiseChebyshev<10>,
    moon: PiecewiseChebyshev<12>,
}

impl PartialEq for SunMoon {
    fn eq(&self, other: &Self) -> bool {
        (self.epoch, &self.kernel) == (other.epoch, &other.kernel)
    }
}

impl SunMoon {
    pub(super) fn new(epoch: Epoch, kernel: Option<Arc<SpiceKernel>>) -> Self {
        let mut span = epoch.series_span();
        if let Some(kernel) = &kernel {
            let since = epoch.seconds_tt(0.0);
            let (from, to) = kernel.span();
            // the span is a whole number of intervals, because no interval may extend beyond the kernel
            let (from, to) = ((from - since).max(span.0), (to - since).min(span.1));
            span = (from, from + ((to - from) / INTERVAL).floor().max(0.0) * INTERVAL);
        }
        let (sun, moon) = (
            PiecewiseChebyshev::new(span.0, span.1, INTERVAL),
            PiecewiseChebyshev::new(span.0, span.1, 0.5 * INTERVAL),
        );
        Self { epoch, span, kernel, utc: epoch.utc(), sun, moon }
    }

    /// Returns a copy with an empty cache, for use with other axes.
    pub(super) fn with_empty_cache(&self) -> Self {
        Self::new(self.epoch, self.kernel.clone())
    }

    /// Returns the modified Julian date of UTC and the seconds since midnight at simulation time `t`, s.
    pub(super) fn utc(&self, t: f64) -> (i64, f64) {
        let seconds = self.utc.1 + t;
        let days = (seconds / DAY).floor();
        (self.utc.0 + days as i64, seconds - days * DAY)
    }

    /// Returns the position of the Sun from the Earth's centre at simulation time `t`, s, in m, axes of `I`.
    /// `rot_ig` computes the rotation from GCRF to `I`.
    pub(super) fn sun(&self, t: f64, rot_ig: impl Fn(f64) -> Matrix3<f64>) -> Vector3<f64> {
        self.sun.value(t, |t| {
            rot_ig(t)
                * match &self.kernel {
                    Some(kernel) => kernel.sun(self.epoch.seconds_tt(t)),
                    None => sun_moon_series::sun(self.epoch.centuries(t)),
                }
        })
    }

    /// Returns the position of the Moon from the Earth's centre at simulation time `t`, s, in m, axes of `I`.
    /// `rot_ig` computes the rotation from GCRF to `I`.
    pub(super) fn moon(&self, t: f64, rot_ig: impl Fn(f64) -> Matrix3<f64>) -> Vector3<f64> {
        self.moon.value(t, |t| {
            rot_ig(t)
                * match &self.kernel {
                    Some(kernel) => kernel.moon(self.epoch.seconds_tt(t)),
                    None => sun_moon_series::moon(self.epoch.centuries(t)),
                }
        })
    }
}
