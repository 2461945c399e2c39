//! How much heavier than a body that is which it carries.

use super::tree::Node;
use crate::spatial::Vec3;

/// Mass, first moment and twice the second moment of a subtree about its body's origin, in the body's axes.
#[derive(Clone, Copy)]
struct Moments {
    mass: f64,
    first: Vec3<f64>,
    trace: f64,
}

impl Moments {
    /// Of a body alone: `tr I_o = tr I_c + 2 m c²`.
    fn of(node: &Node) -> Self {
        let inertia = &node.about_com;
        let trace = inertia.xx + inertia.yy + inertia.zz + 2.0 * node.mass * node.com.dot(node.com);
        Self { mass: node.mass, first: node.com * node.mass, trace }
    }

    /// Adds those of what hangs on the body: `tr I' = tr I + 4 h · p + 2 m p²`.
    fn carry(&mut self, load: Self, node: &Node) {
        let (first, p) = (node.rot_pk * load.first, node.pos_pk);
        self.mass += load.mass;
        self.first += first + p * load.mass;
        self.trace += load.trace + 4.0 * first.dot(p) + 2.0 * load.mass * p.dot(p);
    }
}

/// Inertia of a body with all it carries, joints at zero, over its own: the largest of all bodies that carry something.
pub(super) fn load_ratio(nodes: &[Node]) -> f64 {
    let mut moments: Vec<_> = nodes.iter().map(Moments::of).collect();
    let mut largest = 0.0_f64;
    for k in (0..nodes.len()).rev() {
        let load = moments[k];
        if nodes[k].end > k + 1 {
            largest = largest.max(load.trace / Moments::of(&nodes[k]).trace);
        }
        if k > 0 {
            moments[nodes[k].parent].carry(load, &nodes[k]);
        }
    }
    largest
}
