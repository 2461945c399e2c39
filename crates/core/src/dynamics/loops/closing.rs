//! Search for a configuration that closes the loops, starting from a configuration given by the user.

use super::ClosedLoops;
use super::projection::{closure_errors, factorize};
use crate::dynamics::data::Data;
use crate::model::{Model, integrate};
use crate::spatial::{cholesky_factor, cholesky_solve};

/// Largest number of Newton steps.
const NEWTON: usize = 50;
/// Largest number of damped steps, including those that are rejected.
const DAMPED: usize = 300;
/// Largest component of a step, m and rad.
const LONGEST: f64 = 0.5;
/// Damping of the first damped step, relative to the largest entry of the diagonal of `A`.
const DAMPING: f64 = 1e-3;
/// Smallest damping, relative to the largest entry of the diagonal of `A`. It keeps `A + μ 1` positive
/// definite where rows are redundant.
const LEAST_DAMPING: f64 = 1e-12;
/// Sum of the squares of all errors, m² and rad², below which Newton's method is used again.
const CLOSE: f64 = 1e-12;

/// Moves the configuration `q`, `(nq,)`, to a nearby one that satisfies the constraints of `loops`, by
/// Newton's method in the metric of the kinetic energy. If this fails, which may happen far from a closed
/// configuration if there are more constraints than joints, the search starts again from the given `q` with
/// damped steps; once the errors are small, Newton's method is applied again. Afterwards
/// [`ClosedLoops::errors`] returns the remaining errors, which are not small if no closed configuration was
/// found.
pub fn close_loops(model: &Model, data: &mut Data<f64>, loops: &mut ClosedLoops<f64>, q: &mut [f64]) {
    let given = q.to_vec();
    if newton(model, data, loops, q) {
        return;
    }
    q.copy_from_slice(&given);
    if descend(model, data, loops, q) {
        newton(model, data, loops, q);
    }
    closure_errors(model, data, loops, q);
}

/// Performs Newton steps of limited length and returns true if they close the loops.
fn newton(model: &Model, data: &mut Data<f64>, loops: &mut ClosedLoops<f64>, q: &mut [f64]) -> bool {
    let (zeros, mut delta) = (vec![0.0; model.nv()], vec![0.0; model.nv()]);
    for _ in 0..NEWTON {
        factorize(model, data, q, None, (&zeros, &mut delta));
        loops.update_errors(data, q);
        if !loops.is_open(data) {
            return true;
        }
        loops.correction(model, data, None, |loops, i| loops.error[i], &mut delta);
        limit(&mut delta);
        step(q, &delta);
    }
    false
}

/// Reduces the sum of the squares of the constraint errors `φ` by steps `δ = −M⁻¹ Jᵀ (A + μ 1)⁻¹ φ`, each of
/// which minimizes `|φ + J δ|² + μ δᵀ M δ`. The damping `μ` is reduced after a step that reduces the errors,
/// and increased after any other step, which is undone. Returns true if the errors become small.
///
/// Source: Nocedal and Wright, Numerical Optimization, 2006, section 10.3 (Levenberg-Marquardt method).
fn descend(model: &Model, data: &mut Data<f64>, loops: &mut ClosedLoops<f64>, q: &mut [f64]) -> bool {
    let (zeros, mut delta) = (vec![0.0; model.nv()], vec![0.0; model.nv()]);
    let (mut kept, mut damping) = (q.to_vec(), DAMPING);
    closure_errors(model, data, loops, q);
    let mut least = loops.squared_errors();
    for _ in 0..DAMPED {
        if least < CLOSE {
            return true;
        }
        factorize(model, data, q, None, (&zeros, &mut delta));
        loops.update_errors(data, q);
        loops.damped_correction(model, data, damping, &mut delta);
        limit(&mut delta);
        kept.copy_from_slice(q);
        step(q, &delta);
        closure_errors(model, data, loops, q);
        let errors = loops.squared_errors();
        if errors < least {
            (least, damping) = (errors, (damping / 5.0).max(LEAST_DAMPING));
        } else {
            q.copy_from_slice(&kept);
            damping *= 4.0;
        }
    }
    false
}

/// Scales a step so that its largest component is at most [`LONGEST`].
fn limit(delta: &mut [f64]) {
    let longest = delta.iter().fold(0.0_f64, |longest, x| longest.max(x.abs()));
    let share = if longest > LONGEST { LONGEST / longest } else { 1.0 };
    delta.iter_mut().for_each(|x| *x *= share);
}

/// Adds the step `delta`, `(nv,)`, to the configuration `q`.
fn step(q: &mut [f64], delta: &[f64]) {
    let before = q.to_vec();
    integrate(&before, delta, q);
}

impl ClosedLoops<f64> {
    /// Returns the sum of squares `φᵀ φ`, m² and rad², of the errors that were computed last.
    fn squared_errors(&self) -> f64 {
        self.error.iter().map(|error| error * error).sum()
    }

    /// Computes the step `δ = −M⁻¹ Jᵀ (A + μ 1)⁻¹ φ`, `(nv,)`, with `μ` equal to `damping` times the largest
    /// entry of the diagonal of `A`. Requires the same results in `data` as
    /// [`correction`](Self::correction), and up-to-date errors.
    fn damped_correction(&mut self, model: &Model, data: &mut Data<f64>, damping: f64, delta: &mut [f64]) {
        let m = self.rows.len();
        self.update_rows(data);
        self.update_matrix(model, data, None);
        let largest = (0..m).map(|i| self.matrix[i * m + i]).fold(0.0, f64::max);
        (0..m).for_each(|i| self.matrix[i * m + i] += damping * largest);
        cholesky_factor(&mut self.matrix, m);
        self.force.iter_mut().zip(&self.error).for_each(|(force, error)| *force = -error);
        cholesky_solve(&self.matrix, m, &mut self.force);
        delta.fill(0.0);
        let zeros = vec![0.0; model.nv()];
        self.respond(model, data, (&zeros, &zeros, None), delta);
    }
}
