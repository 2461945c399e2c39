//! Iterative refinement of the constraint forces of nearly redundant rows.

use super::ClosedLoops;
use crate::dynamics::data::Data;
use crate::model::Model;
use crate::spatial::{Real, cholesky_solve};

/// Pivot of the scaled matrix `A` of an independent row below which the constraint forces are refined.
/// Without refinement, the accelerations have a relative error of about the machine epsilon divided by the
/// smallest pivot.
const NEARLY_DEPENDENT: f64 = 1e-5;

impl<S: Real> ClosedLoops<S> {
    /// Returns true for each lane in which an independent row is nearly dependent on the rows before it.
    /// Requires the factors of [`solve`](Self::solve).
    #[inline(always)]
    pub(super) fn is_nearly_dependent(&self) -> S::Mask {
        let m = self.rows.len();
        let mut largest = S::of(0.0);
        for i in 0..m {
            let reciprocal = self.matrix[i * m + i]; // zero for dependent rows
            largest = S::select(largest.less(reciprocal), reciprocal, largest);
        }
        S::of(1.0 / NEARLY_DEPENDENT).less(largest)
    }

    /// Adds one step of iterative refinement, `A δ = −(J a + J̇ v)`, to the constraint forces `λ`, the
    /// accelerations `a`, `(nv,)`, and those in `data`, in the lanes in which rows are nearly dependent; the
    /// numbers in other lanes do not change. The residual is computed from the accelerations of the bodies,
    /// so that it does not have the rounding errors of `A`. Requires the results of [`solve`](Self::solve)
    /// and [`respond`](Self::respond), and the velocity `v` and the generalized forces `tau`, `(nv,)`.
    ///
    /// Source: Higham, Accuracy and Stability of Numerical Algorithms, 2002, section 12.1.
    pub(super) fn refine(
        &mut self,
        model: &Model,
        data: &mut Data<S>,
        (v, tau, locked): (&[S], &[S], Option<&[bool]>),
        a: &mut [S],
    ) {
        let is_refined = self.is_nearly_dependent();
        if !S::any(is_refined) {
            return;
        }
        let mut before = std::mem::take(&mut self.buffers.before);
        let mut applied = std::mem::take(&mut self.buffers.applied);
        before.copy_from_slice(&self.force);
        S::enter(
            #[inline(always)]
            || {
                self.constraint_accelerations(data, a);
                let Self { force, scale, matrix, .. } = self;
                let scaled = |x: &mut [S]| x.iter_mut().zip(&*scale).for_each(|(x, scale)| *x *= *scale);
                scaled(force);
                cholesky_solve(matrix, force.len(), force);
                scaled(force);
                for change in force {
                    *change = S::select(is_refined, *change, S::of(0.0));
                }
            },
        );
        applied.copy_from_slice(tau);
        for (row, &before) in self.scratch.dense.chunks_exact(model.nv()).zip(&before) {
            applied.iter_mut().zip(row).for_each(|(sum, x)| *sum += *x * before); // τ + Jᵀ λ
        }
        self.respond(model, data, (v, &applied, locked), a);
        self.force.iter_mut().zip(&before).for_each(|(force, before)| *force += *before);
        (self.buffers.before, self.buffers.applied) = (before, applied);
    }
}
