//! Sun and Moon during a run.

use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

use super::epoch::{DAY, Epoch};
use super::kernel::Kernel;
use super::pieces::Pieces;
use super::{series, years};

/// Length of the pieces over which the Sun is kept, s; those of the Moon are half as long.
///
/// There the Moon's series is off by less than a centimetre and the Sun's by a metre.
const PIECE: f64 = 8.0 * DAY;

/// Sun and Moon, kept in the axes of `I`.
#[derive(Clone, Debug)]
pub(super) struct Sky {
    pub(super) epoch: Epoch,
    /// Where they are known, s of simulation.
    pub(super) span: (f64, f64),
    kernel: Option<Arc<Kernel>>,
    /// Modified Julian date of UTC and its seconds, at the epoch.
    utc: (i64, f64),
    sun: Pieces<10>,
    moon: Pieces<12>,
}

impl PartialEq for Sky {
    fn eq(&self, other: &Self) -> bool {
        (self.epoch, &self.kernel) == (other.epoch, &other.kernel)
    }
}

impl Sky {
    pub(super) fn new(epoch: Epoch, kernel: Option<Arc<Kernel>>) -> Self {
        let mut span = years(epoch);
        if let Some(kernel) = &kernel {
            let since = epoch.seconds_tt(0.0);
            let (from, to) = kernel.span();
            // whole pieces: nothing is known of one that reaches beyond the kernel
            let (from, to) = ((from - since).max(span.0), (to - since).min(span.1));
            span = (from, from + ((to - from) / PIECE).floor().max(0.0) * PIECE);
        }
        let (sun, moon) = (Pieces::new(span.0, span.1, PIECE), Pieces::new(span.0, span.1, 0.5 * PIECE));
        Self { epoch, span, kernel, utc: epoch.utc(), sun, moon }
    }

    /// The same sky, to be asked for in other axes.
    pub(super) fn anew(&self) -> Self {
        Self::new(self.epoch, self.kernel.clone())
    }

    /// Modified Julian date of UTC and its seconds, at `t`.
    pub(super) fn utc(&self, t: f64) -> (i64, f64) {
        let seconds = self.utc.1 + t;
        let days = (seconds / DAY).floor();
        (self.utc.0 + days as i64, seconds - days * DAY)
    }

    /// Position of the Sun at `t`; `rot_ig` takes GCRF components to `I`.
    pub(super) fn sun(&self, t: f64, rot_ig: impl Fn(f64) -> Matrix3<f64>) -> Vector3<f64> {
        self.sun.value(t, |t| {
            rot_ig(t)
                * match &self.kernel {
                    Some(kernel) => kernel.sun(self.epoch.seconds_tt(t)),
                    None => series::sun(self.epoch.centuries(t)),
                }
        })
    }

    /// Position of the Moon at `t`; likewise.
    pub(super) fn moon(&self, t: f64, rot_ig: impl Fn(f64) -> Matrix3<f64>) -> Vector3<f64> {
        self.moon.value(t, |t| {
            rot_ig(t)
                * match &self.kernel {
                    Some(kernel) => kernel.moon(self.epoch.seconds_tt(t)),
                    None => series::moon(self.epoch.centuries(t)),
                }
        })
    }
}
