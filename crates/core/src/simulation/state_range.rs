//! Check that the initial state is within the accepted ranges.

use super::error::SimulationError;
use crate::model::{Axis, BASE_NV, Model, QUATERNION};

/// Largest accepted difference between the norm of an initial quaternion and 1.
pub(super) const UNIT_NORM: f64 = 1e-6;
/// Magnitude below which each coordinate of the initial position in W, m (a tenth of a light year), and each
/// initial joint position, rad or m, must lie.
const FARTHEST: f64 = 1e15;
/// Speed of light, m/s. The components of the initial velocity and the initial rates of prismatic joints must
/// be smaller, because the equations of motion are Newtonian.
const LIGHT: f64 = 299_792_458.0;
/// Magnitude below which the components of the initial angular velocity and the initial rates of revolute
/// joints, rad/s, must lie; products of larger values may overflow.
const FASTEST: f64 = 1e9;

/// Returns an error for the first velocity that reaches the speed of light or [`FASTEST`], or the first
/// position that reaches [`FARTHEST`].
pub(super) fn check_range(model: &Model, q: &[f64], v: &[f64]) -> Result<(), SimulationError> {
    let slides = |index: usize| match index {
        0..3 => true,
        3..BASE_NV => false,
        joint => matches!(model.nodes()[joint - BASE_NV + 1].axis, Axis::Prismatic),
    };
    let what = |index: usize, [of_base, of_joint]: [&str; 2]| match (index, ["x", "y", "z"][index % 3]) {
        (0..3, axis) => format!("the {of_base} of the base along {axis}"),
        (3..BASE_NV, axis) => format!("the angular velocity of the base about {axis}"),
        (joint, _) => format!("the {of_joint} of joint '{}'", model.joints()[joint - BASE_NV].name),
    };
    for (index, &value) in v.iter().enumerate() {
        let (unit, limit) = if slides(index) { ("m/s", LIGHT) } else { ("rad/s", FASTEST) };
        if value.abs() >= limit {
            let what = what(index, ["velocity", "rate"]);
            return Err(SimulationError::OutOfRange { name: "v", index, what, value, unit, limit });
        }
    }
    // q has one more entry than v, the fourth component of the quaternion: q[7] belongs to the joint of v[6]
    for (index, &value) in q.iter().enumerate().filter(|(index, _)| !QUATERNION.contains(index)) {
        if value.abs() >= FARTHEST {
            let same = if index < 3 { index } else { index - 1 };
            let (what, unit) = (what(same, ["position"; 2]), if slides(same) { "m" } else { "rad" });
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
