//! Curvatures at the knots of quintic splines with given values and slopes at the knots.

/// Returns the curvatures (second derivatives), (K, n), with which the third derivative is continuous at all
/// inner knots, and the fourth derivative at the first and the last inner knot (not-a-knot condition).
/// `values` and `slopes` are (K, n) for K `times`, s, with n = `width`. The error of the spline is of order 6
/// in the spacing of the points. Two or three points define a single polynomial.
pub(super) fn curvatures(times: &[f64], width: usize, values: &[f64], slopes: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; values.len()];
    for i in 0..width {
        let column = |rows: &[f64]| -> Vec<f64> { rows.iter().skip(i).step_by(width).copied().collect() };
        let (x, v) = (column(values), column(slopes));
        let a = if times.len() > 3 {
            spline_curvatures(times, &x, &v)
        } else {
            hermite_curvatures(times, &x, &v)
        };
        a.into_iter().enumerate().for_each(|(k, a)| out[k * width + i] = a);
    }
    out
}

/// Returns the curvatures of the Hermite polynomial through all points `tᵢ` with values `xᵢ` and slopes `vᵢ`.
///
/// `aᵢ = Σⱼ 2 cᵢⱼ² [(1 - 2 cⱼⱼ (tᵢ - tⱼ)) (xⱼ - xᵢ) + (tᵢ - tⱼ) vⱼ] + 4 cᵢᵢ vᵢ` over `j ≠ i`, where `cᵢⱼ` is
/// the slope at `tᵢ` of the Lagrange polynomial that is 1 at `tⱼ`.
fn hermite_curvatures(t: &[f64], x: &[f64], v: &[f64]) -> Vec<f64> {
    let others = |i: usize, j: usize| (0..t.len()).filter(move |&m| m != i && m != j);
    let own = |j: usize| -> f64 { others(j, j).map(|m| 1.0 / (t[j] - t[m])).sum() };
    let at = |i: usize| {
        let part = |j: usize| {
            let c = others(i, j).map(|m| (t[i] - t[m]) / (t[j] - t[m])).product::<f64>() / (t[j] - t[i]);
            let h = t[i] - t[j];
            2.0 * c * c * ((1.0 - 2.0 * own(j) * h) * (x[j] - x[i]) + h * v[j])
        };
        others(i, i).map(part).sum::<f64>() + 4.0 * own(i) * v[i]
    };
    (0..t.len()).map(at).collect()
}

/// Returns the curvatures of the spline through four or more points.
fn spline_curvatures(t: &[f64], x: &[f64], v: &[f64]) -> Vec<f64> {
    let last = t.len() - 1;
    let gap = |i: usize| t[i + 1] - t[i];
    let chord = |i: usize| (x[i + 1] - x[i]) / gap(i);
    // jumps of the third and fourth derivative at a knot if all curvatures are zero
    let jerk_jump = |i: usize| {
        let (k, l) = (1.0 / gap(i - 1), 1.0 / gap(i));
        (chord(i) * 60.0 - v[i + 1] * 24.0 - v[i] * 36.0) * (l * l)
            - (chord(i - 1) * 60.0 - v[i] * 36.0 - v[i - 1] * 24.0) * (k * k)
    };
    let snap_jump = |i: usize| {
        let (k, l) = (1.0 / gap(i - 1), 1.0 / gap(i));
        (v[i + 1] * 168.0 + v[i] * 192.0 - chord(i) * 360.0) * (l * l * l)
            + (v[i] * 192.0 + v[i - 1] * 168.0 - chord(i - 1) * 360.0) * (k * k * k)
    };
    // -3k aᵢ₋₁ + 9 (k + l) aᵢ - 3l aᵢ₊₁ = j with k = 1/hᵢ₋₁, l = 1/hᵢ and the jump j of the third derivative
    let mut rows: Vec<[f64; 4]> = (1..last)
        .map(|i| {
            let (k, l) = (1.0 / gap(i - 1), 1.0 / gap(i));
            [-3.0 * k, 9.0 * (k + l), -3.0 * l, jerk_jump(i)]
        })
        .collect();
    // -24k² a₀ + 36 (k² - l²) a₁ + 24l² a₂ = s, the jump of the fourth derivative: a₀ = α a₁ + β a₂ - s/24k²;
    // the same holds at the end
    let end = |own: f64, next: f64, snap_jump: f64| {
        let r2 = (own / next) * (own / next);
        (1.5 * (1.0 - r2), r2, snap_jump * own * own / 24.0)
    };
    let start = end(gap(0), gap(1), snap_jump(1));
    let stop = end(gap(last - 1), gap(last - 2), -snap_jump(last - 1));
    let (k, l) = (3.0 / gap(0), 3.0 / gap(last - 1));
    rows[0][1] -= k * start.0;
    rows[0][2] -= k * start.1;
    rows[0][3] -= k * start.2;
    rows[last - 2][1] -= l * stop.0;
    rows[last - 2][0] -= l * stop.1;
    rows[last - 2][3] -= l * stop.2;
    let mut a = vec![0.0; t.len()];
    a[1..last].copy_from_slice(&solve(rows));
    a[0] = a[1] * start.0 + a[2] * start.1 - start.2;
    a[last] = a[last - 1] * stop.0 + a[last - 2] * stop.1 - stop.2;
    a
}

/// Solves the diagonally dominant tridiagonal system with the rows `below xᵢ₋₁ + middle xᵢ + above xᵢ₊₁ =
/// right`.
fn solve(mut rows: Vec<[f64; 4]>) -> Vec<f64> {
    for i in 1..rows.len() {
        let factor = rows[i][0] / rows[i - 1][1];
        rows[i][1] -= factor * rows[i - 1][2];
        rows[i][3] -= factor * rows[i - 1][3];
    }
    let mut x = vec![0.0; rows.len()];
    let mut next = 0.0;
    for (x, row) in x.iter_mut().zip(&rows).rev() {
        next = (row[3] - next * row[2]) / row[1];
        *x = next;
    }
    x
}
