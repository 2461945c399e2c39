//! Sun and Moon during a run.

use nalgebra::{Matrix3, Vector3};

use super::epoch::{DAY, Epoch};
use super::pieces::Pieces;
use super::series;

/// Sun and Moon, kept in the axes of `I`.
///
/// Over such pieces their series are off by less than a centimetre (Moon) and a metre (Sun).
#[derive(Clone, Debug)]
pub(super) struct Sky {
    epoch: Epoch,
    /// Modified Julian date of UTC and its seconds, at the epoch.
    utc: (i64, f64),
    sun: Pieces<10>,
    moon: Pieces<12>,
}

impl Sky {
    pub(super) fn new(epoch: Epoch, span: (f64, f64)) -> Self {
        let (from, to) = span;
        let (sun, moon) = (Pieces::new(from, to, 8.0 * DAY), Pieces::new(from, to, 4.0 * DAY));
        Self { epoch, utc: epoch.utc(), sun, moon }
    }

    /// Modified Julian date of UTC and its seconds, at `t`.
    pub(super) fn utc(&self, t: f64) -> (i64, f64) {
        let seconds = self.utc.1 + t;
        let days = (seconds / DAY).floor();
        (self.utc.0 + days as i64, seconds - days * DAY)
    }

    /// Position of the Sun at `t`; `rot_ig` takes GCRF components to `I`.
    pub(super) fn sun(&self, t: f64, rot_ig: impl Fn(f64) -> Matrix3<f64>) -> Vector3<f64> {
        self.sun.value(t, |t| rot_ig(t) * series::sun(self.epoch.centuries(t)))
    }

    /// Position of the Moon at `t`; likewise.
    pub(super) fn moon(&self, t: f64, rot_ig: impl Fn(f64) -> Matrix3<f64>) -> Vector3<f64> {
        self.moon.value(t, |t| rot_ig(t) * series::moon(self.epoch.centuries(t)))
    }
}
