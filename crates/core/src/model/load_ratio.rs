//! Ratio of the inertia of a body to the inertia of a body that supports it.

use super::tree::Node;
use crate::spatial::Vec3;

/// Largest ratio at which articulated-body inertias still have enough digits. Arms on satellites and humanoid
/// robots reach ratios of 1e4.
const LARGEST: f64 = 1e5;

/// Returns true if a light body supports a heavy one, that is, if the ratio of their inertias exceeds
/// [`LARGEST`].
pub(super) fn is_heavy_on_light(nodes: &[Node]) -> bool {
    load_ratio(nodes) > LARGEST
}

/// Returns the largest ratio of the inertia of a body, about the origin of its parent, to the inertia of one
/// of its ancestors, about the ancestor's own origin. The inertias are compared by their traces, with all
/// joints at zero.
///
/// Single bodies are compared instead of subtrees, because long arms of similar links lose no digits. Bodies
/// without inertia are ignored.
fn load_ratio(nodes: &[Node]) -> f64 {
    let mut heaviest = vec![0.0_f64; nodes.len()]; // for each body, the largest inertia that it supports
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

/// Returns the trace of the inertia, kg m², about a point at the vector `c`, m, from the centre of mass: `tr
/// I = tr I_c + 2 m c²`.
fn trace_about(node: &Node, c: Vec3<f64>) -> f64 {
    let inertia = &node.about_com;
    inertia.xx + inertia.yy + inertia.zz + 2.0 * node.mass * c.dot(c)
}
