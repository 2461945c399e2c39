//! Check that the initial state is within the accepted ranges.

use super::error::SimulationError;
use crate::model::{Axis, BASE_NV, Model, QUATERNION};

/// Largest accepted difference between the norm of an initial quaternion and 1.
pub(super) const UNIT_NORM: f64 = 1e-6;
/// Largest accepted distance from the reference orbit, m (a tenth of a light year), and largest accepted
/// joint position, rad or m.
const FARTHEST: f64 = 1e15;
/// Speed of light, m/s. It is the largest accepted speed, because the equations of motion are Newtonian.
const LIGHT: f64 = 299_792_458.0;
/// Largest accepted angular velocity and joint rate, rad/s; products of larger values may overflow.
const FASTEST: f64 = 1e9;

/// Returns an error for the first velocity that reaches the speed of light or [`FASTEST`], or the first
/// position that reaches [`FARTHEST`].
pub(super) fn check_range(model: &Model, q: &[f64], v: &[f64]) -> Result<(), SimulationError> {
    let slides = |index: usize| match index {
        0..3 => true,
        3..BASE_NV => false,
        joint => matches!(model.nodes()[joint - BASE_NV + 1].axis, Axis::Prismatic),
    };
    let what = |index: usize, quantity: &str| match index {
        0..BASE_NV => format!("{quantity} of the base along {}", ["x", "y", "z"][index % 3]),
        joint => format!("joint '{}'", model.joints()[joint - BASE_NV].name),
    };
    for (index, &value) in v.iter().enumerate() {
        let (unit, limit) = if slides(index) { ("m/s", LIGHT) } else { ("rad/s", FASTEST) };
        if value.abs() >= limit {
            let what = what(index, if index < 3 { "velocity" } else { "angular velocity" });
            return Err(SimulationError::OutOfRange { name: "v", index, what, value, unit, limit });
        }
    }
    // q has one more entry than v, the fourth component of the quaternion: q[7] belongs to the joint of v[6]
    for (index, &value) in q.iter().enumerate().filter(|(index, _)| !QUATERNION.contains(index)) {
        if value.abs() >= FARTHEST {
            let same = if index < 3 { index } else { index - 1 };
            let (what, unit) = (what(same, "position"), if slides(same) { "m" } else { "rad" });
            return Err(SimulationError::OutOfRange { name: "q", index, what, value, unit, limit: FARTHEST });
        }
    }
    Ok(())
}

/// Returns the unit of the position of the joint with index `joint`.
pub(super) fn unit_of(model: &Model, joint: usize) -> &'static str {
    if matches!(model.nodes()[joint + 1].axis, Axis::Prismatic) { "m" } else { "rad" }
}

/// Returns the norm of the quaternion of a configuration.
pub(super) fn attitude_norm(q: &[f64]) -> f64 {
    q[QUATERNION].iter().map(|x| x * x).sum::<f64>().sqrt()
}
