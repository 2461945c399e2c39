//! Computation of the dissipation of Hunt and Crossley's law from a coefficient of restitution.

use super::error::{ContactError, positive};

/// Returns the dissipation `d`, s/m, of the law `F = k xⁿ (1 + d ẋ)` with which two bodies that approach each
/// other at `speed`, m/s, separate at `restitution` times that speed in a central, collinear impact.
///
/// With the restitution `e` and the speed `v₀`, `p = d v₀` is the root of `p (1 + e) = ln[(1 + p)/(1 − e p)]`
/// in `0 < p < 1/e`, for every exponent, stiffness and mass; for `e = 1`, the dissipation is 0.
///
/// # Errors
/// [`ContactError::Parameter`] unless `0 < restitution ≤ 1` and `speed` is positive and finite.
pub fn dissipation_for(restitution: f64, speed: f64) -> Result<f64, ContactError> {
    if !(restitution > 0.0 && restitution <= 1.0) {
        let range = "more than 0 and at most 1".to_owned();
        return Err(ContactError::Parameter { name: "restitution", got: restitution, range, unit: "" });
    }
    positive("speed", speed, "m/s")?;
    if restitution == 1.0 {
        return Ok(0.0);
    }
    // negative between 0 and the root, positive beyond it
    let excess = |p: f64| p.ln_1p() - (-restitution * p).ln_1p() - p * (1.0 + restitution);
    let (mut low, mut high) = (0.0, 1.0 / restitution);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if excess(middle) < 0.0 { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high) / speed)
}
