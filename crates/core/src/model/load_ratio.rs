//! Ratio of the inertia of a body to that of a body that supports it.

use super::tree::Node;
use crate::spatial::Vec3;

/// Largest ratio for which articulated-body inertias keep enough digits. Arms on a satellite and humanoids
/// reach 1e4.
const LARGEST: f64 = 1e5;

/// Returns true if the ratio of inertias shows that a light body supports a heavy one.
pub(super) fn is_heavy_on_light(nodes: &[Node]) -> bool {
    load_ratio(nodes) > LARGEST
}

/// Returns the largest ratio of the inertia of a body, about the origin of its parent, to the inertia of one of its
/// ancestors other than the base. The ratio is that of the traces of the inertias, with all joints at zero.
///
/// Single bodies are compared, not subtrees: long arms of similar links lose no digits. Bodies without
/// inertia are ignored.
fn load_ratio(nodes: &[Node]) -> f64 {
    let mut heaviest = vec![0.0_f64; nodes.len()]; // largest inertia that each body supports
    let mut largest = 0.0_f64;
    for (k, node) in nodes.iter().enumerate().rev() {
        let carrier = trace_about(node, node.com);
        if carrier > 0.0 {
            largest = largest.max(heaviest[k] / carrier);
        }
        let own = trace_about(node, node.pos_pk + node.rot_pk * node.com);
        heaviest[node.parent] = heaviest[node.parent].max(heaviest[k]).max(own);
    }
    largest
}

/// Returns `tr I = tr I_c + 2 m c²` about a point at the distance `c` from the centre of mass.
fn trace_about(node: &Node, c: Vec3<f64>) -> f64 {
    let inertia = &node.about_com;
    inertia.xx + inertia.yy + inertia.zz + 2.0 * node.mass * c.dot(c)
}
