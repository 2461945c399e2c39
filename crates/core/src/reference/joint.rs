//! What joints should follow.

use super::ReferenceError;
use super::error::is_number;
use std::fmt::Debug;
use std::sync::Arc;

/// One instant of a joint reference, `(n,)` each: rad or m, and rates.
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
    /// Room for `n` joints.
    pub fn new(n: usize) -> Self {
        Self { q: vec![0.0; n], v: vec![0.0; n], a: vec![0.0; n] }
    }
}

/// Positions, rates and accelerations of joints as functions of time, from zero on.
pub trait JointPath: Send + Sync + Debug {
    /// Number of joints.
    fn count(&self) -> usize;

    /// Where the joints should be at `t`, s since the path began; the ends are held outside.
    fn sample(&self, t: f64, out: &mut JointSample);

    /// When it comes to rest, s; 0 for one that never moves, infinite for one that never rests.
    fn duration(&self) -> f64;
}

/// A joint path, shared.
pub type JointReference = Arc<dyn JointPath>;

/// Largest distance, rad or m, of joints at `q` from the first instant of `path`.
pub fn joint_start_offset(path: &dyn JointPath, q: &[f64]) -> f64 {
    let mut first = JointSample::new(path.count());
    path.sample(0.0, &mut first);
    first.q.iter().zip(q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Joints that stay where they are.
#[derive(Clone, Debug, PartialEq)]
pub struct JointHold {
    q: Vec<f64>,
}

impl JointHold {
    /// At `q`, rad or m.
    ///
    /// # Errors
    /// [`ReferenceError::NotFinite`].
    pub fn new(q: Vec<f64>) -> Result<Self, ReferenceError> {
        match q.iter().all(is_number) {
            true => Ok(Self { q }),
            false => Err(ReferenceError::NotFinite { name: "q" }),
        }
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
