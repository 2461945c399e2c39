//! Impulses at several points with unilateral constraints and Coulomb friction.

use super::impact::ImpactLaw;
use super::point_impulse::point_impulse;

/// Change of a velocity in one sweep, relative to the largest velocity, at or below which the iteration stops
/// because the change is a rounding error.
const EXACT: f64 = 4.0 * f64::EPSILON;
/// Largest number of sweeps over all points.
pub(crate) const MOST_SWEEPS: usize = 4000;
/// Largest change of a velocity in the last sweep, relative to the largest velocity, for which the impulses are
/// accepted although the iteration has not reached [`EXACT`].
const ACCEPTED: f64 = 1e-9;

/// Error: the iteration for the impulses did not converge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unsolved {
    /// Largest change of a velocity in the last sweep, m/s (rad/s at the stop of a revolute joint).
    pub(crate) change: f64,
}

/// Point of contact or joint stop in an impulse problem, with its rows and conditions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Block {
    /// Point of contact: one row along the normal and two across it.
    Point {
        /// Coefficient of friction.
        friction: f64,
        /// Smallest permitted normal velocity after the impulse, m/s.
        target: f64,
    },
    /// Joint stop: one row.
    Stop {
        /// Smallest permitted velocity away from the stop after the impulse, rad/s (m/s for a prismatic
        /// joint).
        target: f64,
    },
}

impl Block {
    /// Returns the number of rows.
    pub(crate) fn rows(&self) -> usize {
        match self {
            Self::Point { .. } => 3,
            Self::Stop { .. } => 1,
        }
    }

    fn target(&self) -> f64 {
        match *self {
            Self::Point { target, .. } | Self::Stop { target } => target,
        }
    }
}

/// Problem of finding the impulses `p` after which the relative velocities `u = b + W p` satisfy
/// `0 ≤ p_n ⟂ u_n − target ≥ 0` at every point and joint stop, and Coulomb's law of friction at every point.
#[derive(Clone, Debug, Default)]
pub(crate) struct ImpulseProblem {
    /// Matrix `W`, `(n, n)`, row major, symmetric and positive semidefinite.
    pub(crate) matrix: Vec<f64>,
    /// Velocities `b` without impulses, `(n,)`, m/s (rad/s at the stop of a revolute joint). For a point,
    /// the normal velocity comes first.
    pub(crate) free: Vec<f64>,
    pub(crate) blocks: Vec<Block>,
}

impl ImpulseProblem {
    /// Returns the number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.free.len()
    }

    /// Returns the velocities `b + W p` after the impulses `p`, `(n,)`.
    pub(crate) fn velocities(&self, p: &[f64]) -> Vec<f64> {
        (0..self.rows()).map(|row| self.velocity(row, p)).collect()
    }

    fn velocity(&self, row: usize, p: &[f64]) -> f64 {
        let n = self.rows();
        let products = self.matrix[row * n..(row + 1) * n].iter().zip(p);
        products.fold(self.free[row], |sum, (w, p)| w.mul_add(*p, sum))
    }

    /// Returns the change of the kinetic energy that the impulses `p`, `(n,)`, cause, J: `½ pᵀ (b + u)`.
    pub(crate) fn energy(&self, p: &[f64]) -> f64 {
        let u = self.velocities(p);
        0.5 * p.iter().zip(self.free.iter().zip(&u)).map(|(p, (b, u))| p * (b + u)).sum::<f64>()
    }

    /// Solves the problem by block Gauss-Seidel iteration, starting from the impulses in `p`, `(n,)`, which are
    /// overwritten by the solution. In each sweep, the impulse of every block in turn is replaced by the one
    /// that satisfies the conditions of this block for the current impulses of the other blocks. The iteration
    /// ends when a sweep changes no velocity by more than its rounding error.
    ///
    /// # Errors
    /// [`Unsolved`] if the last of [`MOST_SWEEPS`] sweeps changed a velocity by more than 1e-9 times the
    /// largest velocity or [`ImpactLaw::REST_SPEED`], whichever is larger.
    ///
    /// Source: Jean, The non-smooth contact dynamics method, Computer Methods in Applied Mechanics and
    /// Engineering 177, 1999.
    pub(crate) fn solve(&self, p: &mut [f64]) -> Result<(), Unsolved> {
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let targets = self.blocks.iter().fold(0.0_f64, |largest, block| largest.max(block.target().abs()));
        let speed = largest(&self.free).max(targets);
        let mut change = 0.0_f64;
        for _ in 0..MOST_SWEEPS {
            change = 0.0;
            let mut start = 0;
            for block in &self.blocks {
                change = change.max(self.improve(block, start, p));
                start += block.rows();
            }
            if change <= EXACT * speed {
                return Ok(());
            }
        }
        if change <= ACCEPTED * speed.max(ImpactLaw::REST_SPEED) { Ok(()) } else { Err(Unsolved { change }) }
    }

    /// Replaces the impulse of one block, whose first row is `start`, by the one that satisfies the conditions
    /// of the block for the other impulses in `p`. Returns the largest change of a velocity of the block,
    /// m/s or rad/s, that a component of the impulse causes in its own row.
    fn improve(&self, block: &Block, start: usize, p: &mut [f64]) -> f64 {
        let n = self.rows();
        let w = |i: usize, j: usize| self.matrix[(start + i) * n + start + j];
        match *block {
            Block::Stop { target } => {
                let before = std::mem::take(&mut p[start]);
                let lacking = target - self.velocity(start, p);
                p[start] = if lacking > 0.0 && w(0, 0) > 0.0 { lacking / w(0, 0) } else { 0.0 };
                (w(0, 0) * (p[start] - before)).abs()
            }
            Block::Point { friction, target } => {
                let before = [p[start], p[start + 1], p[start + 2]];
                p[start..start + 3].fill(0.0);
                let free = [0, 1, 2].map(|i| self.velocity(start + i, p));
                let own = [0, 1, 2].map(|i| [0, 1, 2].map(|j| w(i, j)));
                let impulse = point_impulse(&own, free, friction, target);
                p[start..start + 3].copy_from_slice(&impulse);
                let change = |i: usize| (w(i, i) * (impulse[i] - before[i])).abs();
                change(0).max(change(1)).max(change(2))
            }
        }
    }

    /// Solves the problem with all targets multiplied by `scale`, starting from zero impulses.
    fn scaled(&self, scale: f64) -> Result<Vec<f64>, Unsolved> {
        let blocks = self.blocks.iter().map(|block| match *block {
            Block::Point { friction, target } => Block::Point { friction, target: scale * target },
            Block::Stop { target } => Block::Stop { target: scale * target },
        });
        let problem = Self { blocks: blocks.collect(), ..self.clone() };
        let mut p = vec![0.0; self.rows()];
        problem.solve(&mut p).map(|()| p)
    }

    /// Returns the impulses of an impact that does not create energy, and the factor, from 0 to 1, by which
    /// the restitution is multiplied for this purpose.
    ///
    /// Together with friction, restitution can create energy if there are several points, or if the normal and
    /// tangential motions of a point are coupled. All targets are then multiplied by the largest factor below 1
    /// for which no energy is created. With the factor 0 the impulses always dissipate:
    /// `ΔT = pᵀ u⁺ − ½ pᵀ W p ≤ 0`, because `p_n u_n⁺ = 0` and `p_t · u_t⁺ ≤ 0` at every point.
    ///
    /// # Errors
    /// [`Unsolved`] if the impulses do not converge.
    pub(crate) fn impact(&self) -> Result<(Vec<f64>, f64), Unsolved> {
        let creates = |p: &[f64]| {
            let scale: f64 = p.iter().zip(&self.free).map(|(p, b)| (p * b).abs()).sum();
            self.energy(p) > 64.0 * f64::EPSILON * scale
        };
        let p = self.scaled(1.0)?;
        if !creates(&p) {
            return Ok((p, 1.0));
        }
        let (mut low, mut high) = (0.0, 1.0);
        let mut found = self.scaled(low)?;
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            let p = self.scaled(middle)?;
            if creates(&p) {
                high = middle;
            } else {
                (low, found) = (middle, p);
            }
        }
        Ok((found, low))
    }
}

#[cfg(test)]
mod tests {
    use super::{Block, ImpulseProblem, Unsolved};

    /// Impulse problem of the tip of a uniform rod of 1 kg, inclined by 1 rad, that hits a plane at 1 m/s
    /// and slides at 0.7 m/s.
    fn rod(friction: f64, restitution: f64) -> ImpulseProblem {
        let (s, c) = 1.0_f64.sin_cos();
        let (nn, nt, tt) = (1.0 + 3.0 * c * c, -3.0 * s * c, 1.0 + 3.0 * s * s);
        ImpulseProblem {
            matrix: vec![nn, nt, 0.0, nt, tt, 0.0, 0.0, 0.0, 1.0],
            free: vec![-1.0, 0.7, 0.0],
            blocks: vec![Block::Point { friction, target: restitution }],
        }
    }

    #[test]
    fn an_impact_creates_no_energy_although_newton_and_coulomb_together_would() {
        let problem = rod(0.5, 1.0);
        assert!(problem.energy(&problem.scaled(1.0).expect("it converges")) > 0.12);
        let (p, factor) = problem.impact().expect("it converges");
        assert!(problem.energy(&p).abs() < 1e-9 && factor > 0.0 && factor < 1.0, "{factor}");
        let u = problem.velocities(&p);
        assert!((u[0] - factor).abs() < 1e-14 && p[1].hypot(p[2]) <= 0.5 * p[0] * (1.0 + 1e-14), "{u:?}");
    }

    #[test]
    fn without_restitution_every_impact_dissipates() {
        for friction in [0.0, 0.1, 0.5, 2.0, 5.0] {
            let problem = rod(friction, 0.0);
            let (p, factor) = problem.impact().expect("it converges");
            assert!(factor == 1.0 && problem.energy(&p) < 0.0, "{friction} {:e}", problem.energy(&p));
            assert!(problem.velocities(&p)[0].abs() < 1e-15);
        }
    }

    /// At the four corners of a face, the normal impulses are not unique, but the velocities are.
    #[test]
    fn redundant_points_reach_their_targets() {
        // body of 1 kg with the radii of gyration 1 m, points at (±1, ±1) m
        let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let mut problem = ImpulseProblem::default();
        for [x, y] in corners {
            for axis in 0..3 {
                for [a, b] in corners {
                    let spin = if axis == 0 { x * a + y * b } else { 0.0 };
                    let own = |other: usize| if axis == other { 1.0 + spin } else { 0.0 };
                    problem.matrix.extend((0..3).map(own));
                }
            }
            problem.free.extend([-1.0 + 0.2 * x, 0.3, 0.0]);
            problem.blocks.push(Block::Point { friction: 0.1, target: 0.5 * (1.0 - 0.2 * x) });
        }
        let (p, factor) = problem.impact().expect("it converges");
        let u = problem.velocities(&p);
        assert_eq!(factor, 1.0);
        for (point, [x, _]) in corners.iter().enumerate() {
            let error = u[3 * point] - 0.5 * (1.0 - 0.2 * x);
            assert!(error.abs() < 1e-14, "{error:e}");
            let [n, s] = [p[3 * point], p[3 * point + 1]];
            assert!(n >= 0.0 && (s + 0.1 * n).abs() < 1e-15, "{n} {s}");
        }
        assert!(problem.energy(&p) < 0.0);
    }

    /// Impulse problem of a row of bodies of 1 kg between which `count` gaps close at 1 m/s. With its
    /// matrix `W = tridiag(-1, 2, -1)`, each sweep multiplies the error by `cos²(π/(count + 1))`.
    fn row(count: usize) -> ImpulseProblem {
        let entry = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        };
        let matrix = (0..count * count).map(|k| entry(k / count, k % count)).collect();
        let blocks = vec![Block::Stop { target: 0.0 }; count];
        ImpulseProblem { matrix, free: vec![-1.0; count], blocks }
    }

    #[test]
    fn impulses_that_do_not_converge_are_an_error() {
        // the exact impulses are p_k = k (count + 1 - k)/2
        let (p, _) = row(20).impact().expect("it converges");
        for (k, p) in p.iter().enumerate() {
            let exact = (k + 1) as f64 * (20 - k) as f64 / 2.0;
            assert!((p - exact).abs() < 1e-10 * exact, "{k} {p} {exact}");
        }
        let Err(Unsolved { change }) = row(400).impact() else { panic!("400 bodies need 300 000 sweeps") };
        assert!(change > 1e-6, "{change:e}");
    }
}
