//! The two ways over a tree: outward from the base, inward to it.
//!
//! Most bodies hang on the one before them. What these hand to each other is passed on in registers; only where a tree
//! forks does it go by way of the parent's memory, which on a chain would cost more than the arithmetic.

use super::data::BodyData;
use crate::model::Node;
use crate::spatial::{ArticulatedInertia, Force, Real, SpatialInertia};

/// Calls `visit` for every body but the base, parents first, with what it returned for the parent; `look` finds that in
/// the parent's data.
#[inline(always)]
pub(super) fn outward<S: Real, T: Copy>(
    nodes: &[Node],
    bodies: &mut [BodyData<S>],
    look: impl Fn(&BodyData<S>) -> T,
    mut visit: impl FnMut(usize, &Node, &mut BodyData<S>, T) -> T,
) {
    let bodies = &mut bodies[..nodes.len()];
    let mut previous = look(&bodies[0]);
    for k in 1..nodes.len() {
        let (done, rest) = bodies.split_at_mut(k);
        let node = &nodes[k];
        let carrier = if node.parent + 1 == k { previous } else { look(&done[node.parent]) };
        previous = visit(k, node, &mut rest[0], carrier);
    }
}

/// Calls `visit` for every body but the base, children first, with the sum of what it returned for them; returns that of
/// the base.
#[inline(always)]
pub(super) fn inward<S: Real, T: Load<S>>(
    nodes: &[Node],
    bodies: &mut [BodyData<S>],
    mut visit: impl FnMut(usize, &Node, &mut BodyData<S>, T) -> T,
) -> T {
    let bodies = &mut bodies[..nodes.len()];
    for (node, body) in nodes.iter().zip(&mut *bodies) {
        if node.is_fork {
            T::none().write(body);
        }
    }
    let mut next = T::none();
    for k in (1..nodes.len()).rev() {
        let (before, rest) = bodies.split_at_mut(k);
        let (node, body) = (&nodes[k], &mut rest[0]);
        let load = if node.is_fork { next.plus(T::read(body)) } else { next };
        let handed = visit(k, node, body, load);
        next = if node.parent + 1 == k {
            handed
        } else {
            let parent = &mut before[node.parent];
            T::read(parent).plus(handed).write(parent);
            T::none()
        };
    }
    if nodes[0].is_fork { next.plus(T::read(&bodies[0])) } else { next }
}

/// What bodies hand to those that carry them, and where it waits in the data of those with several.
pub(super) trait Load<S>: Copy {
    /// That of a body on which nothing hangs.
    fn none() -> Self;
    /// The sum of two.
    fn plus(self, other: Self) -> Self;
    /// What waits.
    fn read(body: &BodyData<S>) -> Self;
    /// Lets it wait.
    fn write(self, body: &mut BodyData<S>);
}

/// A kind of load: that of nothing, and how it is read and written.
macro_rules! load {
    ($load:ty, $none:expr, |$from:ident| $read:expr, |$this:ident, $to:ident| $write:expr) => {
        impl<S: Real> $crate::dynamics::walk::Load<S> for $load {
            #[inline(always)]
            fn none() -> Self {
                $none
            }
            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                self + other
            }
            #[inline(always)]
            fn read($from: &$crate::dynamics::BodyData<S>) -> Self {
                $read
            }
            #[inline(always)]
            fn write(self, $to: &mut $crate::dynamics::BodyData<S>) {
                let $this = self;
                $write;
            }
        }
    };
}
pub(super) use load;
load!(Force<S>, Force::zero(), |body| body.force, |this, body| body.force = this);
load!(SpatialInertia<S>, Self::zero(), |body| body.composite, |this, body| body.composite = this);
load!(ArticulatedInertia<S>, Self::zero(), |body| body.articulated, |this, body| body.articulated = this);

impl<S: Real, A: Load<S>, B: Load<S>> Load<S> for (A, B) {
    #[inline(always)]
    fn none() -> Self {
        (A::none(), B::none())
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        (self.0.plus(other.0), self.1.plus(other.1))
    }
    #[inline(always)]
    fn read(body: &BodyData<S>) -> Self {
        (A::read(body), B::read(body))
    }
    #[inline(always)]
    fn write(self, body: &mut BodyData<S>) {
        self.0.write(body);
        self.1.write(body);
    }
}
