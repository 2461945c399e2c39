//! Nodes and weights of a collocation step.
//!
//! The acceleration is interpolated at Lobatto nodes. These include both ends of the step, so the
//! acceleration is continuous from step to step. Velocity and position are its integrals. The Legendre basis
//! avoids cancellation.
//!
//! Source: Hairer, Lubich and Wanner, Geometric Numerical Integration, Springer 2006, section II.1.4 (Lobatto
//! IIIA: symmetric, of order `2 S - 2` at the ends of steps).

use nalgebra::Vector3;
use std::sync::LazyLock;

/// Number of nodes of a step, `S`.
pub(super) const NODES: usize = 9;

/// Array with one vector per node or per Legendre polynomial.
pub(super) type Samples = [Vector3<f64>; NODES];

/// Lobatto's quadrature rule on [-1, 1].
pub(super) struct Rule {
    pub(super) nodes: [f64; NODES],
    /// `twice[i][j]`: double integral, from -1 to node `i`, of the polynomial that is one at node `j` and
    /// zero at the other nodes.
    pub(super) twice: [[f64; NODES]; NODES],
    /// `spectrum[k][j]`: Legendre coefficient of degree `k` of the polynomial that is one at node `j` and
    /// zero at the other nodes.
    pub(super) spectrum: [[f64; NODES]; NODES],
}

/// Quadrature rule of all steps, computed on first use.
pub(super) static RULE: LazyLock<Rule> = LazyLock::new(Rule::new);

/// Values of the Legendre polynomials at a point, with their single and double integrals from -1, by degree.
pub(super) struct Legendre {
    pub(super) value: [f64; NODES + 2],
    pub(super) once: [f64; NODES + 1],
    pub(super) twice: [f64; NODES],
}

impl Legendre {
    #[inline(always)]
    pub(super) fn at(x: f64) -> Self {
        let p = legendre(x);
        // ∫ Pₖ = (Pₖ₊₁ - Pₖ₋₁)/(2k + 1), applied twice for the double integral
        let (mut once, mut twice) = ([x + 1.0; NODES + 1], [0.5 * (x + 1.0) * (x + 1.0); NODES]);
        for k in 1..=NODES {
            once[k] = (p[k + 1] - p[k - 1]) * INVERSE_ODD[k];
        }
        for k in 1..NODES {
            twice[k] = (once[k + 1] - once[k - 1]) * INVERSE_ODD[k];
        }
        Self { value: p, once, twice }
    }
}

/// Factors `1/(2k + 1)` of the integrals of Legendre polynomials.
const INVERSE_ODD: [f64; NODES + 1] = {
    let mut inverse = [1.0; NODES + 1];
    let mut k = 1;
    while k <= NODES {
        inverse[k] = 1.0 / (2 * k + 1) as f64;
        k += 1;
    }
    inverse
};

/// Returns `P₀(x)` to `P_{NODES+1}(x)` by the recursion `(k + 1) Pₖ₊₁ = (2k + 1) x Pₖ - k Pₖ₋₁`.
#[inline(always)]
fn legendre(x: f64) -> [f64; NODES + 2] {
    let mut p = [1.0; NODES + 2];
    p[1] = x;
    for k in 1..=NODES {
        let share = k as f64 / (k + 1) as f64;
        p[k + 1] = (1.0 + share) * x * p[k] - share * p[k - 1];
    }
    p
}

impl Rule {
    fn new() -> Self {
        const LAST: usize = NODES - 1;
        // inner nodes are the roots of P'ₗ, found by Newton's method from Chebyshev nodes: (1 - x²) P' = l
        // (Pₗ₋₁ - x Pₗ); P″ follows from Legendre's equation
        let nodes = std::array::from_fn(|i| {
            let mut x = -(std::f64::consts::PI * i as f64 / LAST as f64).cos();
            if i == 0 || i == LAST {
                return x.signum();
            }
            let l = LAST as f64;
            for _ in 0..8 {
                let p = legendre(x);
                let slope = l * (p[LAST - 1] - x * p[LAST]);
                x += slope / (l * (l + 1.0) * p[LAST]);
            }
            x
        });
        // wⱼ = 2/(l (l + 1) Pₗ(xⱼ)²)
        let weights = nodes.map(|x| {
            let p = legendre(x)[LAST];
            2.0 / ((LAST * NODES) as f64 * p * p)
        });
        // cₖ = wⱼ Pₖ(xⱼ)/γₖ with γₖ = 2/(2k + 1), except γ = 2/l for the last coefficient
        let at = nodes.map(Legendre::at);
        let spectrum = std::array::from_fn(|k| {
            let gamma = if k == LAST { 2.0 / LAST as f64 } else { 2.0 * INVERSE_ODD[k] };
            std::array::from_fn(|j| weights[j] * at[j].value[k] / gamma)
        });
        let row = |i: usize, j: usize| (0..NODES).map(|k| at[i].twice[k] * spectrum[k][j]).sum();
        let twice = std::array::from_fn(|i| std::array::from_fn(|j| row(i, j)));
        Self { nodes, twice, spectrum }
    }
}

/// Returns the weighted sum `Σ wⱼ xⱼ`.
#[inline(always)]
pub(super) fn weighted(weights: &[f64], vectors: &[Vector3<f64>]) -> Vector3<f64> {
    let mut sum = Vector3::zeros();
    for (w, x) in weights.iter().zip(vectors) {
        sum += x * *w;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_of_powers_are_exact() {
        let rule = &*RULE;
        // ∫ is twice the first Legendre coefficient, exact up to degree 2S - 3: xⁿ gives (1 - (-1)ⁿ⁺¹)/(n +
        // 1)
        let integral = |power: i32| -> f64 {
            rule.nodes.iter().zip(&rule.spectrum[0]).map(|(x, w)| 2.0 * w * x.powi(power)).sum()
        };
        let exact = |power: i32| if power % 2 == 0 { 2.0 / f64::from(power + 1) } else { 0.0 };
        for power in 0..(2 * NODES - 2) as i32 {
            assert!((integral(power) - exact(power)).abs() < 1e-15, "x^{power}");
        }
        let beyond = 2 * NODES as i32 - 2;
        assert!((integral(beyond) - exact(beyond)).abs() > 1e-6, "the order ends here");
        for power in 0..NODES as i32 {
            for (x, row) in rule.nodes.iter().zip(&rule.twice) {
                // ∫∫ xⁿ from -1
                let sum: f64 = rule.nodes.iter().zip(row).map(|(y, a)| a * y.powi(power)).sum();
                let (n, sign) = (f64::from(power), if power % 2 == 0 { 1.0 } else { -1.0 });
                let exact =
                    (x.powi(power + 2) - sign) / ((n + 1.0) * (n + 2.0)) + sign * (x + 1.0) / (n + 1.0);
                assert!((sum - exact).abs() < 1e-15, "x^{power} at {x}: {sum} {exact}");
            }
        }
    }
}
