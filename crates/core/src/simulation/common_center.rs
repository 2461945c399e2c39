//! Angular momenta of several trees about their common centre of mass during a step.
//!
//! At every stage, the total moment of the forces between trees about any common point is zero. Moments about
//! the centres of mass of the individual trees lack this property, because their arms `c_i − c` change during
//! the step. In a group with contacts, the angular impulses of all trees are therefore integrated about the
//! common centre of mass `c`, and referred to the centres of mass of the trees at the end of the step.

use super::state::{Rate, State};
use super::tree::Tree;
use super::tree_state::{TreeRate, TreeState};
use crate::dynamics::center_of_mass;
use crate::spatial::{Real, Vec3};

/// Returns the moment of the external forces about the common centre of mass `c`, with each force `F_i`
/// acting at the centre of mass `c_i` of its tree: `Σ (c_i − c) × F_i`, W axes, N m. Requires the kinematics
/// of `state` in the trees.
pub(super) fn orbital_moment<S: Real>(trees: &[Tree<'_, S>], state: &State<S>, rate: &Rate<S>) -> Vec3<S> {
    S::enter(
        #[inline(always)]
        || {
            let part = |i: usize| Part::of_force(&trees[i], &state.trees[i], &rate.trees[i]);
            let common = Common::of((0..trees.len()).map(part));
            let moments =
                (0..trees.len()).map(part).map(|Part { center, x, .. }| (center - common.center).cross(x));
            moments.fold(Vec3::zero(), |sum, moment| sum + moment)
        },
    )
}

/// Refers the moments of the external forces in `rate` to the common centre of mass `c`: adds
/// `(c_i − c) × (F_i − m_i ΣF/m)` to the moment on each tree, with the force `F_i` on the tree, its centre of
/// mass `c_i` and its mass `m_i`, and the total mass `m`. The second term is the inertial force in the frame
/// of the common centre of mass; its moments sum to zero. Requires the kinematics of `state` in the trees.
pub(super) fn refer_to_common_center<S: Real>(trees: &[Tree<'_, S>], state: &State<S>, rate: &mut Rate<S>) {
    S::enter(
        #[inline(always)]
        || {
            let part = |i: usize, rate: &TreeRate<S>| Part::of_force(&trees[i], &state.trees[i], rate);
            let common = Common::of(rate.trees.iter().enumerate().map(|(i, rate)| part(i, rate)));
            for (i, rate) in rate.trees.iter_mut().enumerate() {
                rate.wrench.angular += common.relative_moment(part(i, rate));
            }
        },
    );
}

/// Refers the angular impulses of the step from `start` to `state` to the centres of mass of the trees: moves
/// the changes of `(c_i − c) × (P_i − m_i v_c)` from the impulses of the trees to the common impulse. `P_i`
/// and `m_i` are the momentum and the mass of a tree, and `v_c` is the velocity of the common centre of mass.
pub(super) fn move_to_own_centers<S: Real>(trees: &[Tree<'_, S>], start: &State<S>, state: &mut State<S>) {
    S::enter(
        #[inline(always)]
        || {
            let parts = |state: &State<S>| Common::of(trees.iter().zip(&state.trees).map(Part::of_momentum));
            let (before, after) = (parts(start), parts(state));
            for ((tree, start), end) in trees.iter().zip(&start.trees).zip(&mut state.trees) {
                let [first, last] = [Part::of_momentum((tree, start)), Part::of_momentum((tree, end))];
                let change = after.relative_moment(last) - before.relative_moment(first);
                end.impulse.angular -= change;
                state.orbital += change;
            }
        },
    );
}

/// Mass, kg, and centre of mass in W, m, of a tree, with a vector `x` in W axes that is either the external
/// force on the tree, N, or its linear momentum, N s.
#[derive(Clone, Copy)]
struct Part<S> {
    mass: S,
    center: Vec3<S>,
    x: Vec3<S>,
}

impl<S: Real> Part<S> {
    #[inline(always)]
    fn of_force(tree: &Tree<'_, S>, state: &TreeState<S>, rate: &TreeRate<S>) -> Self {
        let center = center_of_mass(&tree.data, &state.q);
        Self { mass: S::of(tree.model.mass()), center, x: rate.wrench.linear }
    }

    #[inline(always)]
    fn of_momentum((tree, state): (&Tree<'_, S>, &TreeState<S>)) -> Self {
        let center = state.center.unwrap_or(Vec3::zero());
        Self { mass: S::of(tree.model.mass()), center, x: state.momentum().linear }
    }
}

/// Common centre of mass `c` in W, m, and the sum `Σx` of the forces or momenta of all trees divided by their
/// total mass `m`.
struct Common<S> {
    center: Vec3<S>,
    per_mass: Vec3<S>,
}

impl<S: Real> Common<S> {
    #[inline(always)]
    fn of(parts: impl Iterator<Item = Part<S>>) -> Self {
        let (mut mass, mut first_moment, mut total) = (S::of(0.0), Vec3::zero(), Vec3::zero());
        for part in parts {
            mass += part.mass;
            first_moment += part.center * part.mass;
            total += part.x;
        }
        let reciprocal = S::of(1.0) / mass;
        Self { center: first_moment * reciprocal, per_mass: total * reciprocal }
    }

    /// Returns `(c_i − c) × (x_i − m_i Σx/m)`, W axes, N m or N m s, for the tree `i` with the mass `m_i` and
    /// the centre of mass `c_i`.
    #[inline(always)]
    fn relative_moment(&self, Part { mass, center, x }: Part<S>) -> Vec3<S> {
        (center - self.center).cross(x - self.per_mass * mass)
    }
}
