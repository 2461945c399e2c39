//! Passes over the tree: from the root to the leaves and from the leaves to the root.
//!
//! In most robots the parent of a body is the body with the preceding number. Values between such bodies are
//! passed in registers; they are stored in the memory of the parent only where a tree forks. On a chain of
//! bodies, the memory accesses would cost more than the arithmetic.

use super::data::BodyData;
use crate::model::Node;
use crate::spatial::{ArticulatedInertia, Force, Real, SpatialInertia};

/// Calls `visit` for every body except the base, parents first, with the value that the call for its parent
/// returned. `parent_value` reads this value from the data of the parent if the parent is the base or a fork.
#[inline(always)]
pub(super) fn root_to_leaf<S: Real, T: Copy>(
    nodes: &[Node],
    bodies: &mut [BodyData<S>],
    parent_value: impl Fn(&BodyData<S>) -> T,
    mut visit: impl FnMut(usize, &Node, &mut BodyData<S>, T) -> T,
) {
    let bodies = &mut bodies[..nodes.len()];
    let mut previous = parent_value(&bodies[0]);
    for k in 1..nodes.len() {
        let (before, after) = bodies.split_at_mut(k);
        let node = &nodes[k];
        let parent = if node.parent + 1 == k { previous } else { parent_value(&before[node.parent]) };
        previous = visit(k, node, &mut after[0], parent);
    }
}

/// Calls `visit` for every body except the base, children first, with the sum of the values that the calls
/// for its children returned. Returns the sum for the base.
#[inline(always)]
pub(super) fn leaf_to_root<S: Real, T: Accumulated<S>>(
    nodes: &[Node],
    bodies: &mut [BodyData<S>],
    mut visit: impl FnMut(usize, &Node, &mut BodyData<S>, T) -> T,
) -> T {
    let bodies = &mut bodies[..nodes.len()];
    for (node, body) in nodes.iter().zip(&mut *bodies) {
        if node.is_fork {
            T::zero().store(body);
        }
    }
    let mut next = T::zero();
    for k in (1..nodes.len()).rev() {
        let (before, after) = bodies.split_at_mut(k);
        let (node, body) = (&nodes[k], &mut after[0]);
        let children = if node.is_fork { next.plus(T::stored(body)) } else { next };
        let value = visit(k, node, body, children);
        next = if node.parent + 1 == k {
            value
        } else {
            let parent = &mut before[node.parent];
            T::stored(parent).plus(value).store(parent);
            T::zero()
        };
    }
    if nodes[0].is_fork { next.plus(T::stored(&bodies[0])) } else { next }
}

/// Quantity that is summed over the children of a body. Where a tree forks, the sum is stored in
/// [`BodyData`].
pub(super) trait Accumulated<S>: Copy {
    /// Returns the zero value, which is the sum for a body without children.
    fn zero() -> Self;
    /// Returns the sum of two values.
    fn plus(self, other: Self) -> Self;
    /// Returns the value that is stored in `body`.
    fn stored(body: &BodyData<S>) -> Self;
    /// Stores this value in `body`.
    fn store(self, body: &mut BodyData<S>);
}

/// Implements [`Accumulated`] from the zero value and the field that stores the value.
macro_rules! accumulated {
    ($type:ty, $zero:expr, |$from:ident| $stored:expr, |$this:ident, $to:ident| $store:expr) => {
        impl<S: Real> $crate::dynamics::passes::Accumulated<S> for $type {
            #[inline(always)]
            fn zero() -> Self {
                $zero
            }
            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                self + other
            }
            #[inline(always)]
            fn stored($from: &$crate::dynamics::BodyData<S>) -> Self {
                $stored
            }
            #[inline(always)]
            fn store(self, $to: &mut $crate::dynamics::BodyData<S>) {
                let $this = self;
                $store;
            }
        }
    };
}
pub(super) use accumulated;
accumulated!(Force<S>, Force::zero(), |body| body.force, |this, body| body.force = this);
accumulated!(SpatialInertia<S>, Self::zero(), |body| body.composite, |this, body| body.composite = this);
accumulated!(ArticulatedInertia<S>, Self::zero(), |body| body.articulated, |this, body| body.articulated =
    this);

impl<S: Real, A: Accumulated<S>, B: Accumulated<S>> Accumulated<S> for (A, B) {
    #[inline(always)]
    fn zero() -> Self {
        (A::zero(), B::zero())
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        (self.0.plus(other.0), self.1.plus(other.1))
    }
    #[inline(always)]
    fn stored(body: &BodyData<S>) -> Self {
        (A::stored(body), B::stored(body))
    }
    #[inline(always)]
    fn store(self, body: &mut BodyData<S>) {
        self.0.store(body);
        self.1.store(body);
    }
}
