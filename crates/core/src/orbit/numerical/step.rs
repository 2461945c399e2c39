//! Integration step, and the motion during the step.

use super::collocation::{Legendre, NODES, RULE, Rule, Samples, weighted};
use crate::orbit::{OrbitError, OrbitState};
use nalgebra::Vector3;

/// Largest number of iterations of a step; a step that needs more is repeated with a smaller length.
const MOST_SWEEPS: usize = 16;
/// Change of the node positions, as a fraction of the distance from the planet's centre, up to which the
/// iteration counts as converged.
const SETTLED: f64 = 1e-15;

/// Time (s), position (m) and velocity (m/s) at the start of a step. Position and velocity are accumulated
/// over the steps by compensated summation and stored as `[sum, rounding error]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Start {
    pub(super) time: f64,
    pub(super) position: [Vector3<f64>; 2],
    pub(super) velocity: [Vector3<f64>; 2],
}

/// Motion during one step; the acceleration is a polynomial in the Legendre basis.
#[derive(Clone, Debug)]
pub(super) struct Step {
    pub(super) start: Start,
    /// Length, s; negative for steps before `t₀`.
    pub(super) length: f64,
    spectrum: Samples,
}

impl Start {
    pub(super) fn new(time: f64, position: Vector3<f64>, velocity: Vector3<f64>) -> Self {
        Self { time, position: [position, Vector3::zeros()], velocity: [velocity, Vector3::zeros()] }
    }

    /// Computes the step of `length` s from this state, and estimates the error, m, of positions within the
    /// step. Returns `None` if the iteration does not converge because the step is too long. `before` is the
    /// preceding step, from which the initial guess is extrapolated; `field(t, r)` is the acceleration, m/s².
    pub(super) fn step(
        &self,
        length: f64,
        before: Option<&Step>,
        mut field: impl FnMut(f64, &Vector3<f64>) -> Result<Vector3<f64>, OrbitError>,
    ) -> Result<Option<(Step, f64)>, OrbitError> {
        let (rule, half) = (&*RULE, 0.5 * length);
        let times = rule.nodes.map(|x| self.time + half * (x + 1.0));
        let free = rule.nodes.map(|x| self.position[0] + self.velocity[0] * (half * (x + 1.0)));
        let first = field(self.time, &self.position[0])?;
        let mut a = [first; NODES];
        if let Some(before) = before {
            for (a, t) in a.iter_mut().zip(times).skip(1) {
                *a = before.acceleration(t);
            }
        }
        let mut r = [self.position[0]; NODES];
        let settled = SETTLED * self.position[0].norm();
        for _ in 0..MOST_SWEEPS {
            let mut moved: f64 = 0.0;
            for i in 1..NODES {
                // rᵢ = r₀ + (xᵢ + 1) h/2 v₀ + (h/2)² Σ Aᵢⱼ aⱼ, with the most recent aⱼ
                let place = free[i] + weighted(&rule.twice[i], &a) * (half * half);
                moved = moved.max((place - r[i]).amax());
                r[i] = place;
                a[i] = field(times[i], &place)?;
            }
            if moved <= settled {
                let step = Step { start: *self, length, spectrum: spectrum(rule, &a) };
                let error = step.truncation();
                return Ok(Some((step, error)));
            }
        }
        Ok(None)
    }
}

fn spectrum(rule: &Rule, a: &Samples) -> Samples {
    std::array::from_fn(|k| weighted(&rule.spectrum[k], a))
}

impl Step {
    /// Returns the time `t`, s, mapped to -1 at the start and 1 at the end of the step.
    fn place(&self, t: f64) -> f64 {
        2.0 * ((t - self.start.time) / self.length) - 1.0
    }

    /// Returns the acceleration, m/s², at time `t`, s, which may lie outside the step.
    fn acceleration(&self, t: f64) -> Vector3<f64> {
        weighted(&Legendre::at(self.place(t)).value, &self.spectrum)
    }

    /// Returns position, velocity and acceleration at `t`, s, which lies within the step.
    pub(super) fn state(&self, t: f64) -> OrbitState {
        let (p, half, dt) = (Legendre::at(self.place(t)), 0.5 * self.length, t - self.start.time);
        let ([r, r_lost], [v, v_lost]) = (self.start.position, self.start.velocity);
        // v = v₀ + h/2 ∫ a,  r = r₀ + v₀ (t - t₀) + (h/2)² ∫∫ a
        let twice = weighted(&p.twice, &self.spectrum) * (half * half);
        OrbitState {
            position: r + (v * dt + (twice + (r_lost + v_lost * dt))),
            velocity: v + (weighted(&p.once, &self.spectrum) * half + v_lost),
            acceleration: weighted(&p.value, &self.spectrum),
        }
    }

    /// Returns the contribution of the last polynomial to the position, m, which estimates the truncated
    /// terms.
    fn truncation(&self) -> f64 {
        let half = 0.5 * self.length;
        self.spectrum[NODES - 1].norm() * half * half / ((NODES - 1) * (NODES - 1)) as f64
    }

    /// Returns the state at the end of the step.
    pub(super) fn end(&self) -> Start {
        let (length, half) = (self.length, 0.5 * self.length);
        let ([r, r_lost], [v, v_lost]) = (self.start.position, self.start.velocity);
        // ∫ a = 2 α₀ and ∫∫ a = 2 α₀ - ⅔ α₁ by Lobatto's rule, of order 2 S - 2
        let once = self.spectrum[0] * length;
        let twice = (self.spectrum[0] * 2.0 - self.spectrum[1] * (2.0 / 3.0)) * (half * half);
        Start {
            time: self.start.time + length,
            position: exactly(r, v * length, r_lost + v_lost * length + twice),
            velocity: exactly(v, once, v_lost),
        }
    }
}

/// Returns `a + b + c` and the rounding error of the sum.
fn exactly(a: Vector3<f64>, b: Vector3<f64>, c: Vector3<f64>) -> [Vector3<f64>; 2] {
    let two_sum = |a: f64, b: f64| {
        let sum = a + b;
        let share = sum - a;
        (sum, (a - (sum - share)) + (b - share))
    };
    let mut out = [Vector3::zeros(); 2];
    for i in 0..3 {
        let (sum, lost) = two_sum(a[i], b[i]);
        let (sum, more) = two_sum(sum, c[i]);
        out[0][i] = sum;
        out[1][i] = lost + more;
    }
    out
}
