//! Impulse at a single point with a unilateral constraint and Coulomb friction.

/// Number of sectors of the full circle in which the direction of sliding is searched for.
const DIRECTIONS: usize = 64;

/// Returns the impulse `p`, N s (normal, then two tangential components), at one point, after which the
/// velocity `u = b + W p`, m/s, satisfies `0 ≤ p_n ⟂ u_n − target ≥ 0`, `|p_t| ≤ μ p_n`, and
/// `p_t = −μ p_n u_t/|u_t|` where the point slides.
///
/// The impulse is zero if `b_n ≥ target` or `W_nn ≤ 0`. Otherwise the point sticks if the impulse that stops
/// it, `W p = (target − b_n, −b_t)`, is inside the cone. Otherwise it slides. If no sliding impulse
/// satisfies the conditions, friction is omitted. The result does not depend on the choice of the
/// tangential axes.
pub(super) fn point_impulse(w: &[[f64; 3]; 3], b: [f64; 3], friction: f64, target: f64) -> [f64; 3] {
    let lacking = target - b[0];
    if lacking.is_nan() || lacking <= 0.0 || w[0][0] <= 0.0 {
        return [0.0; 3];
    }
    if friction == 0.0 {
        return [lacking / w[0][0], 0.0, 0.0];
    }
    let stick = solve(w, [lacking, -b[1], -b[2]]);
    if stick.is_some_and(|p| p[1].hypot(p[2]) <= friction * p[0]) {
        return stick.unwrap_or_default();
    }
    let sliding = Sliding { w, b, friction, lacking };
    sliding.solve().unwrap_or_else(|| {
        // neither sticking nor sliding satisfies the conditions: omit friction, which does not create energy
        [lacking / w[0][0], 0.0, 0.0]
    })
}

/// Solves `W p = r` for a symmetric positive definite matrix `W`; `None` if `W` is singular up to rounding
/// errors.
fn solve(w: &[[f64; 3]; 3], r: [f64; 3]) -> Option<[f64; 3]> {
    // W = L D Lᵀ
    let d0 = w[0][0];
    let (l1, l2) = (w[1][0] / d0, w[2][0] / d0);
    let d1 = w[1][1] - l1 * w[1][0];
    let m = w[2][1] - l2 * w[1][0];
    let l3 = m / d1;
    let d2 = w[2][2] - l2 * w[2][0] - l3 * m;
    let least = 1e-14 * (w[0][0] + w[1][1] + w[2][2]);
    if !(d0 > least && d1 > least && d2 > least) {
        return None;
    }
    let y1 = r[1] - l1 * r[0];
    let y2 = r[2] - l2 * r[0] - l3 * y1;
    let p2 = y2 / d2;
    let p1 = y1 / d1 - l3 * p2;
    Some([r[0] / d0 - l1 * p1 - l2 * p2, p1, p2])
}

/// Impulse problem of a single point that slides after the impulse.
struct Sliding<'a> {
    w: &'a [[f64; 3]; 3],
    b: [f64; 3],
    friction: f64,
    /// Normal velocity that the impulse must add, m/s.
    lacking: f64,
}

/// Impulse for an assumed direction of sliding.
#[derive(Clone, Copy)]
struct Trial {
    impulse: [f64; 3],
    /// Component of the sliding velocity across the assumed direction, which is zero at a solution, m/s.
    across: f64,
    /// Component of the sliding velocity along the assumed direction, m/s.
    along: f64,
}

impl Sliding<'_> {
    /// Returns the impulse for the direction `d` of sliding at the angle `angle`, rad; `None` if a normal
    /// impulse with this friction cannot reach the target.
    ///
    /// `p_n = (target − b_n)/(W_nn − μ W_nt d)`, `p_t = −μ p_n d`
    fn trial(&self, angle: f64) -> Option<Trial> {
        let Self { w, b, friction, lacking } = self;
        let d = [angle.cos(), angle.sin()];
        let mobility = w[0][0] - friction * (w[0][1] * d[0] + w[0][2] * d[1]);
        if mobility <= 0.0 {
            return None;
        }
        let normal = lacking / mobility;
        let impulse = [normal, -friction * normal * d[0], -friction * normal * d[1]];
        let velocity = |i: usize| b[i] + (0..3).map(|j| w[i][j] * impulse[j]).sum::<f64>();
        let u = [velocity(1), velocity(2)];
        Some(Trial { impulse, across: d[0] * u[1] - d[1] * u[0], along: d[0] * u[0] + d[1] * u[1] })
    }

    /// Returns the impulse whose direction of sliding is that of the tangential velocity after it; `None` if
    /// there is no such direction.
    fn solve(&self) -> Option<[f64; 3]> {
        let speed = self.b[1].hypot(self.b[2]);
        let first = if speed > 0.0 { self.b[2].atan2(self.b[1]) } else { 0.0 };
        if let Some(trial) = self.trial(first)
            && trial.along >= 0.0
            && trial.across.abs() <= 2.0 * f64::EPSILON * (speed + trial.along)
        {
            return Some(trial.impulse);
        }
        let step = std::f64::consts::TAU / DIRECTIONS as f64;
        // search from the direction of the velocity before the impulse to both sides
        let offsets = (0..=DIRECTIONS as i32 / 2).flat_map(|k| [k, -k - 1]);
        offsets.into_iter().find_map(|k| {
            let start = first + f64::from(k) * step;
            self.between(start, start + step)
        })
    }

    /// Returns the impulse for the direction of sliding between two angles, rad; `None` if [`Trial::across`]
    /// has no change of sign between them, if there is no trial for one of the angles, or if the velocity
    /// that is found is opposite to the assumed direction.
    fn between(&self, mut low: f64, mut high: f64) -> Option<[f64; 3]> {
        let (mut before, mut after) = (self.trial(low)?.across, self.trial(high)?.across);
        if before * after > 0.0 {
            return None;
        }
        // regula falsi (Illinois variant), then bisection
        for round in 0..120 {
            let secant = (low * after - high * before) / (after - before);
            let is_inside = secant > low && secant < high && round < 60;
            let middle = if is_inside { secant } else { 0.5 * (low + high) };
            if middle <= low || middle >= high {
                break;
            }
            let across = self.trial(middle)?.across;
            if across == 0.0 {
                (low, high) = (middle, middle);
                break;
            }
            if (across > 0.0) == (after > 0.0) {
                (high, after) = (middle, across);
                before *= 0.5;
            } else {
                (low, before) = (middle, across);
                after *= 0.5;
            }
        }
        let trial = self.trial(0.5 * (low + high))?;
        (trial.along >= 0.0).then_some(trial.impulse)
    }
}
