//! How much heavier a body is than one that carries it.

use super::tree::Node;
use crate::spatial::Vec3;

/// Bodies that carry one of more than this many times their own inertia are light. Arms on a satellite and humanoids
/// reach 1e4.
const LARGEST: f64 = 1e5;

/// Whether a light body carries a heavy one.
pub(super) fn is_heavy_on_light(nodes: &[Node]) -> bool {
    load_ratio(nodes) > LARGEST
}

/// Inertia of a body, about the origin of the one it hangs on, over that of a body which carries it on its own or through
/// others: the largest of all such pairs, by the traces, joints at zero.
///
/// Not of whole subtrees: long arms of like links lose no digits. Bodies without inertia have none to lose.
fn load_ratio(nodes: &[Node]) -> f64 {
    let mut heaviest = vec![0.0_f64; nodes.len()]; // that each body carries
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

/// `tr I = tr I_c + 2 m c²` about a point `c` away from the centre of mass.
fn trace_about(node: &Node, c: Vec3<f64>) -> f64 {
    let inertia = &node.about_com;
    inertia.xx + inertia.yy + inertia.zz + 2.0 * node.mass * c.dot(c)
}
