//! Torques of driven joints whose motions depend on each other because of closed loops.

use crate::dynamics::{IndependentJoints, solve_semidefinite};
use crate::spatial::{cholesky_factor, cholesky_solve, dot};

/// Distribution of the efforts of the independent coordinates to the driven joints `A`; the symbols are those
/// of [`LoopedDynamics`](super::looped_dynamics::LoopedDynamics). The buffers keep their capacity between
/// updates.
#[derive(Debug, Default)]
pub(super) struct DrivenTorques {
    pub(super) driven: Vec<usize>,
    /// Indices of the columns of `G` that belong to the coordinates that these joints drive.
    pub(super) columns: Vec<usize>,
    /// `G_A`, `(a, c)`, for `a` driven joints and `c` columns.
    map: Vec<f64>,
    /// Factor of `G_Aᵀ G_A`, `(c, c)`.
    factor: Vec<f64>,
    internal: Internal,
}

/// Buffers of [`DrivenTorques::internal`] for `s` commanded rows.
#[derive(Debug, Default)]
struct Internal {
    /// Matrix `Wᵀ`, row major `(s, a)`.
    shares: Vec<f64>,
    /// Matrix `(P W)ᵀ`, row major `(s, a)`.
    projected: Vec<f64>,
    /// Matrix `Wᵀ P W`, row major `(s, s)`.
    matrix: Vec<f64>,
    sizes: Vec<f64>,
    scale: Vec<f64>,
    mu: Vec<f64>,
    effort: Vec<f64>,
    /// Torques `t`, `(a,)`, N m (N).
    torques: Vec<f64>,
}

impl DrivenTorques {
    /// Sets the driven joints, and the columns of `G` that they drive: those of the independent joints that
    /// `is_driven` selects. Factorizes `G_Aᵀ G_A`.
    pub(super) fn set(
        &mut self,
        joints: &IndependentJoints,
        driven: impl Iterator<Item = usize>,
        is_driven: impl Fn(usize) -> bool,
    ) {
        let Self { driven: own, columns, map, factor, .. } = self;
        let f = joints.count();
        own.clear();
        own.extend(driven);
        columns.clear();
        columns.extend((0..f).filter(|&c| is_driven(joints.independent[c])));
        let k = columns.len();
        map.clear();
        map.extend(own.iter().flat_map(|&j| columns.iter().map(move |&c| joints.map[j * f + c])));
        factor.clear();
        factor.resize(k * k, 0.0);
        for row in map.chunks_exact(k.max(1)) {
            for (x, out) in row.iter().zip(factor.chunks_exact_mut(k)) {
                out.iter_mut().zip(row).for_each(|(out, y)| *out += x * y);
            }
        }
        cholesky_factor(factor, k);
    }

    /// Computes `τ_A = G_A (G_Aᵀ G_A)⁻¹ u`, N m (N), and passes each torque to `write`, after the index of
    /// its joint in `driven`; `u`, `(c,)`, is overwritten.
    pub(super) fn apply(&self, u: &mut [f64], mut write: impl FnMut(usize, f64)) {
        let k = self.columns.len();
        cholesky_solve(&self.factor, k, u);
        (0..self.driven.len()).for_each(|place| write(place, dot(&self.map[place * k..(place + 1) * k], u)));
    }

    /// Replaces `x`, `(a,)`, by its projection `P x = x − G_A (G_Aᵀ G_A)⁻¹ G_Aᵀ x` onto the torques that
    /// cause no motion. `u` is a buffer.
    fn project(&self, x: &mut [f64], u: &mut Vec<f64>) {
        let k = self.columns.len();
        u.clear();
        u.resize(k, 0.0);
        for (x, row) in x.iter().zip(self.map.chunks_exact(k.max(1))) {
            u.iter_mut().zip(row).for_each(|(u, g)| *u += g * x);
        }
        self.apply(u, |place, part| x[place] -= part);
    }

    /// Computes the smallest torques `t`, `(a,)`, N m (N), with `G_Aᵀ t = 0` that change the constraint
    /// forces from `force`, N and N m, to the commanded ones, as far as joint torques can change them.
    /// `commanded` has the index and the force of each commanded row. Calls `write(joint, torque)` for each
    /// driven joint.
    ///
    /// A torque `t` changes the commanded forces by `δλ = −Wᵀ t`, where `W` has a row per driven joint and a
    /// column per commanded row. With `(Wᵀ P W) μ = δλ`, the result is `t = −P W μ`.
    pub(super) fn internal(
        &mut self,
        joints: &IndependentJoints,
        commanded: &[(usize, f64)],
        force: &[f64],
        mut write: impl FnMut(usize, f64),
    ) {
        let mut work = std::mem::take(&mut self.internal);
        let Internal { shares, projected, matrix, sizes, scale, mu, effort, torques } = &mut work;
        let a = self.driven.len();
        let share = |j: usize, i: usize| {
            let pivot = joints.dependent.iter().find(|(joint, _)| *joint == j);
            pivot.map_or(0.0, |&(_, row)| joints.share(row, i))
        };
        shares.clear();
        shares.extend(commanded.iter().flat_map(|&(i, _)| self.driven.iter().map(move |&j| share(j, i))));
        projected.clone_from(shares);
        projected.chunks_exact_mut(a.max(1)).for_each(|w| self.project(w, effort));
        matrix.clear();
        for w in shares.chunks_exact(a.max(1)) {
            matrix.extend(projected.chunks_exact(a.max(1)).map(|p| dot(w, p)));
        }
        sizes.clear();
        sizes.extend(shares.chunks_exact(a.max(1)).map(|w| dot(w, w)));
        mu.clear();
        mu.extend(commanded.iter().map(|&(i, value)| value - force[i]));
        scale.clear();
        scale.resize(commanded.len(), 0.0);
        solve_semidefinite(matrix, sizes, scale, mu);
        torques.clear();
        torques.resize(a, 0.0);
        for (p, mu) in projected.chunks_exact(a.max(1)).zip(&*mu) {
            torques.iter_mut().zip(p).for_each(|(t, p)| *t -= mu * p);
        }
        self.driven.iter().zip(&*torques).for_each(|(&j, t)| write(j, *t));
        self.internal = work;
    }
}
