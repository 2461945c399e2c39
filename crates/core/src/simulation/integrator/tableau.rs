//! Coefficients of the pair 5(4) of Dormand and Prince and of its fourth-order dense output.
//!
//! Source: Dormand and Prince, J. Computational and Applied Mathematics 6(1), 1980; Hairer, Nørsett
//! and Wanner, Solving Ordinary Differential Equations I, 1993, II.5 and II.6.

/// Nodes `c` of the second to seventh stages, as fractions of the step.
pub(super) const C: [f64; 6] = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];

/// Weights of the earlier stages in the second to seventh stages, one row per stage; the last row is [`B`].
pub(super) const A: [[f64; 6]; 6] = [
    [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    B,
];

/// Weights of the first six stages in the fifth-order solution; the weight of the seventh stage is zero.
const B: [f64; 6] = [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];

/// Weights of the seven stages in the error estimate: fifth-order weights less fourth-order weights.
pub(super) const E: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];

/// Weights of the seven stages in the quartic term of the dense output.
const D: [f64; 7] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    0.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
];

/// Returns the weights of the seven stages in the dense output at the fraction `x` of the step.
pub(super) fn dense(x: f64) -> [f64; 7] {
    let y = 1.0 - x;
    std::array::from_fn(|i| {
        let (b, first, last) = (B.get(i).copied().unwrap_or(0.0), f64::from(i == 0), f64::from(i == 6));
        // cubic Hermite polynomial through both ends, plus a quartic polynomial whose value and slope vanish
        // at both ends
        x * (b + y * (first - b + x * (2.0 * b - last - first + y * D[i])))
    })
}

#[cfg(test)]
mod tests {
    use super::{A, C, E, dense};

    /// Returns `Σ_i w_i f(c_i)` over the seven stages.
    fn sum(w: &[f64; 7], f: impl Fn(f64) -> f64) -> f64 {
        w.iter().zip([0.0].iter().chain(&C)).map(|(w, c)| w * f(*c)).sum()
    }

    /// Checks the quadrature conditions `Σ w_i c_i^k` and the order conditions of the trees
    /// `Σ w_i a_ij c_j^k`.
    #[test]
    fn the_dense_output_is_of_fourth_order_everywhere() {
        for x in [0.1, 0.3, 0.5, 0.77, 1.0_f64] {
            let w = dense(x);
            for k in 0..4 {
                let exact = x.powi(k + 1) / f64::from(k + 1);
                assert!((sum(&w, |c| c.powi(k)) - exact).abs() < 1e-14, "{x} {k}");
            }
            let stage = |i: usize, k: i32| -> f64 {
                (0..i).map(|j| A[i - 1][j] * if j == 0 { 0.0_f64 } else { C[j - 1] }.powi(k)).sum()
            };
            let inner = |k: i32| -> f64 { (1..7).map(|i| w[i] * stage(i, k)).sum() };
            assert!((inner(1) - x.powi(3) / 6.0).abs() < 1e-14, "{x}");
            assert!((inner(2) - x.powi(4) / 12.0).abs() < 1e-14, "{x}");
        }
    }

    #[test]
    fn the_error_is_that_of_a_fourth_order_solution() {
        for k in 0..4 {
            assert!(sum(&E, |c| c.powi(k)).abs() < 1e-15);
        }
        assert!(sum(&E, |c| c.powi(4)).abs() > 1e-4); // the order is no higher
        for (row, c) in A.iter().zip(C) {
            assert!((row.iter().sum::<f64>() - c).abs() < 1e-14);
        }
    }
}
