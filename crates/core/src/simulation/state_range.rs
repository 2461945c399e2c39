//! How far and how fast a robot may be at the start of a run.

use super::error::SimulationError;
use crate::model::{Axis, Model};

/// Largest distance from the reference, m, a tenth of a light year, and largest angle of a joint, rad.
const FARTHEST: f64 = 1e15;
/// The speed of light, m/s: mechanics here is Newton's.
const LIGHT: f64 = 299_792_458.0;
/// Largest angular velocity and joint rate, rad/s: squares of those of absurd inputs overflow.
const FASTEST: f64 = 1e9;

/// Refuses positions and rates that no robot has, whose products would overflow in the first step.
pub(super) fn check_range(model: &Model, q: &[f64], v: &[f64]) -> Result<(), SimulationError> {
    let slides = |index: usize| match index {
        0..3 => true,
        3..6 => false,
        _ => matches!(model.nodes()[index - 5].axis, Axis::Prismatic), // the base is the first of the nodes
    };
    let what = |index: usize, quantity: &str| match index {
        0..6 => format!("{quantity} of the base along {}", ["x", "y", "z"][index % 3]),
        joint => format!("joint '{}'", model.joints()[joint - 6].name),
    };
    for (index, &value) in v.iter().enumerate() {
        let (unit, limit) = if slides(index) { ("m/s", LIGHT) } else { ("rad/s", FASTEST) };
        if value.abs() >= limit {
            let what = what(index, if index < 3 { "velocity" } else { "angular velocity" });
            return Err(SimulationError::OutOfRange { name: "v", index, what, value, unit, limit });
        }
    }
    // behind the quaternion, q[7] is the joint of v[6]
    for (index, &value) in q.iter().enumerate().filter(|(index, _)| !(3..7).contains(index)) {
        if value.abs() >= FARTHEST {
            let same = if index < 3 { index } else { index - 1 };
            let (what, unit) = (what(same, "position"), if slides(same) { "m" } else { "rad" });
            return Err(SimulationError::OutOfRange { name: "q", index, what, value, unit, limit: FARTHEST });
        }
    }
    Ok(())
}
