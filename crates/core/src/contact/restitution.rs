//! Dissipation of Hunt and Crossley's law from a coefficient of restitution.

use super::error::{ContactError, positive};

/// Returns the dissipation `d`, s/m, with which two bodies that approach each other at `speed`, m/s, separate
/// at `restitution` times that speed in a central, collinear impact.
///
/// `p = d v₀` is the root of `p (1 + e) = ln[(1 + p)/(1 − e p)]` in `0 < p < 1/e`, for every exponent,
/// stiffness and mass.
///
/// # Errors
/// [`ContactError::Parameter`] unless `0 < restitution ≤ 1` and `speed > 0`.
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

#[cfg(test)]
mod tests {
    use super::dissipation_for;

    /// Values of `e` for `d v₀` from the same equation, solved with 30 digits.
    const TABLE: [(f64, f64); 7] = [
        (0.01, 0.993377454399),
        (0.03, 0.980391402985),
        (0.1, 0.937475579950),
        (0.3, 0.832869792266),
        (1.0, 0.593624260040),
        (3.0, 0.306896798291),
        (10.0, 0.099981624753),
    ];

    #[test]
    fn dissipation_gives_the_restitution() {
        for (p, restitution) in TABLE {
            let found = dissipation_for(restitution, 0.2).expect("valid arguments") * 0.2;
            assert!((found / p - 1.0).abs() < 2e-10 / p.min(1.0), "{p}: {found}");
        }
        assert_eq!(dissipation_for(1.0, 0.2), Ok(0.0));
    }

    #[test]
    fn impossible_restitutions_are_refused() {
        for restitution in [0.0, -0.1, 1.1, f64::NAN] {
            assert!(dissipation_for(restitution, 1.0).is_err());
        }
        assert!(dissipation_for(0.5, 0.0).is_err());
    }
}
