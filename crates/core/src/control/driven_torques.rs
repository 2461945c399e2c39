//! Torques of driven joints whose motions depend on each other because of closed loops.

use crate::dynamics::{IndependentJoints, solve_semidefinite};
use crate::spatial::{cholesky_factor, cholesky_solve, dot};

/// Distribution of efforts to the driven joints `A`, with the symbols of `LoopedDynamics`.
pub(super) struct DrivenTorques {
    pub(super) driven: Vec<usize>,
    /// Indices of the columns of `G` that belong to the coordinates that these joints drive.
    pub(super) columns: Vec<usize>,
    /// `G_A`, `(a, c)`, for `a` driven joints and `c` columns.
    map: Vec<f64>,
    /// Factor of `G_Aᵀ G_A`, `(c, c)`.
    factor: Vec<f64>,
}

impl DrivenTorques {
    /// Factorizes `G_Aᵀ G_A` for the `driven` joints and the `columns` of `G` that they drive.
    pub(super) fn new(joints: &IndependentJoints, driven: Vec<usize>, columns: Vec<usize>) -> Self {
        let (f, k) = (joints.count(), columns.len());
        let rows = driven.iter().flat_map(|&j| columns.iter().map(move |&c| joints.map[j * f + c]));
        let map: Vec<f64> = rows.collect();
        let mut factor = vec![0.0; k * k];
        for row in map.chunks_exact(k.max(1)) {
            for (x, out) in row.iter().zip(factor.chunks_exact_mut(k)) {
                out.iter_mut().zip(row).for_each(|(out, y)| *out += x * y);
            }
        }
        cholesky_factor(&mut factor, k);
        Self { driven, columns, map, factor }
    }

    /// Computes `τ_A = G_A (G_Aᵀ G_A)⁻¹ u`, N m (N), and passes each torque to `write`, after the index of
    /// its joint in `driven`; `u`, `(c,)`, is overwritten.
    pub(super) fn apply(&self, u: &mut [f64], mut write: impl FnMut(usize, f64)) {
        let k = self.columns.len();
        cholesky_solve(&self.factor, k, u);
        (0..self.driven.len()).for_each(|place| write(place, dot(&self.map[place * k..(place + 1) * k], u)));
    }

    /// Computes the projection `P x = x − G_A (G_Aᵀ G_A)⁻¹ G_Aᵀ x` of `x`, `(a,)`, onto the torques that
    /// cause no motion, in place.
    fn project(&self, x: &mut [f64]) {
        let k = self.columns.len();
        let mut u = vec![0.0; k];
        for (x, row) in x.iter().zip(self.map.chunks_exact(k.max(1))) {
            u.iter_mut().zip(row).for_each(|(u, g)| *u += g * x);
        }
        self.apply(&mut u, |place, part| x[place] -= part);
    }

    /// Returns the smallest torques `t`, `(a,)`, with `G_Aᵀ t = 0` that change the constraint forces from
    /// `force`, N and N m, to the `commanded` ones, as far as torques can. `commanded` has the index and the
    /// force of each row.
    ///
    /// A torque `t` changes the commanded forces by `δλ = −Wᵀ t`, where `W` has a row per driven joint and a
    /// column per commanded row. With `(Wᵀ P W) μ = δλ`, the result is `t = −P W μ`.
    pub(super) fn internal(
        &self,
        joints: &IndependentJoints,
        commanded: &[(usize, f64)],
        force: &[f64],
    ) -> Vec<f64> {
        let (a, s) = (self.driven.len(), commanded.len());
        let share = |j: usize, i: usize| {
            let pivot = joints.dependent.iter().find(|(joint, _)| *joint == j);
            pivot.map_or(0.0, |&(_, row)| joints.share(row, i))
        };
        let shares: Vec<Vec<f64>> =
            commanded.iter().map(|&(i, _)| self.driven.iter().map(|&j| share(j, i)).collect()).collect();
        let projected: Vec<Vec<f64>> = shares
            .iter()
            .map(|w| {
                let mut w = w.clone();
                self.project(&mut w);
                w
            })
            .collect();
        let mut matrix: Vec<f64> = shares.iter().flat_map(|w| projected.iter().map(|p| dot(w, p))).collect();
        let sizes: Vec<f64> = shares.iter().map(|w| dot(w, w)).collect();
        let mut mu: Vec<f64> = commanded.iter().map(|&(i, value)| value - force[i]).collect();
        solve_semidefinite(&mut matrix, &sizes, &mut vec![0.0; s], &mut mu);
        let mut torques = vec![0.0; a];
        for (p, mu) in projected.iter().zip(mu) {
            torques.iter_mut().zip(p).for_each(|(t, p)| *t -= mu * p);
        }
        torques
    }
}
