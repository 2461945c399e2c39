//! Reference motions of joints.

use super::ReferenceError;
use super::error::check_numbers;
use std::fmt::Debug;
use std::sync::Arc;

/// Sample of a joint reference: positions, rates and accelerations, each `(n,)`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointSample {
    /// Positions, rad or m.
    pub q: Vec<f64>,
    /// Rates, rad/s or m/s.
    pub v: Vec<f64>,
    /// Accelerations, rad/s² or m/s².
    pub a: Vec<f64>,
}

impl JointSample {
    /// Creates a sample of zeros for `n` joints.
    pub fn new(n: usize) -> Self {
        Self { q: vec![0.0; n], v: vec![0.0; n], a: vec![0.0; n] }
    }
}

/// Positions, rates and accelerations of joints as functions of the time since the start of the path.
pub trait JointPath: Send + Sync + Debug {
    /// Returns the number of joints.
    fn count(&self) -> usize;

    /// Writes to `out` the desired motion `t` seconds after the start of the path. The first positions are
    /// held before the start, and the last positions after the end.
    fn sample(&self, t: f64, out: &mut JointSample);

    /// Returns the time at which the path comes to rest, s. It is 0 for a path that never moves and infinity
    /// for a path that never comes to rest.
    fn duration(&self) -> f64;
}

/// Joint path that several owners can share.
pub type JointReference = Arc<dyn JointPath>;

/// Returns the joint, as an index into the joint positions `q`, whose position differs most from the start of
/// `path`, and the magnitude of this difference, rad or m.
pub fn joint_start_offset(path: &dyn JointPath, q: &[f64]) -> (usize, f64) {
    let mut first = JointSample::new(path.count());
    path.sample(0.0, &mut first);
    let offsets = first.q.iter().zip(q).map(|(a, b)| (a - b).abs()).enumerate();
    offsets.fold((0, 0.0), |largest, next| if next.1 > largest.1 { next } else { largest })
}

/// Reference that holds constant joint positions.
#[derive(Clone, Debug, PartialEq)]
pub struct JointHold {
    q: Vec<f64>,
}

impl JointHold {
    /// Creates a reference at the constant positions `q`, rad or m.
    ///
    /// # Errors
    /// [`ReferenceError::NotFinite`] for positions that are not finite or exceed 1e60 in magnitude.
    pub fn new(q: Vec<f64>) -> Result<Self, ReferenceError> {
        check_numbers("q", &q)?;
        Ok(Self { q })
    }
}

impl JointPath for JointHold {
    fn count(&self) -> usize {
        self.q.len()
    }

    fn sample(&self, _: f64, out: &mut JointSample) {
        out.q.copy_from_slice(&self.q);
        out.v.fill(0.0);
        out.a.fill(0.0);
    }

    fn duration(&self) -> f64 {
        0.0
    }
}
