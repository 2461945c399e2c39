//! Angular momenta of several trees about their common centre of mass during a step.
//!
//! Forces between trees have no moment in total about any common point, at every stage. Moments about the
//! centres of mass of the single trees lack this property, because their arms `c_i − c` change during the
//! step. In a group with contacts, the angular impulses of all trees are therefore integrated about the
//! common centre of mass `c`, and referred to the centres of mass of the trees at the end of the step.

use super::state::{Rate, State};
use super::tree::Tree;
use crate::dynamics::center_of_mass;
use crate::spatial::{Real, Vec3};

/// Returns the moment of the external forces about the common centre of mass `c`, with each force `F_i` acting
/// at the centre of mass `c_i` of its tree: `Σ (c_i − c) × F_i`, W axes, N m. Requires the kinematics of
/// `state` in the trees.
pub(super) fn orbital_moment<S: Real>(trees: &[Tree<'_, S>], state: &State<S>, rate: &Rate<S>) -> Vec3<S> {
    let centers = centers_of(trees, state);
    let (_, common) = mass_and_center(trees, &centers);
    let moments = centers.iter().zip(&rate.trees);
    let moments = moments.map(|(center, rate)| (*center - common).cross(rate.wrench.linear));
    moments.fold(Vec3::zero(), |sum, moment| sum + moment)
}

/// Refers the moments in `rate` to the common centre of mass: adds `(c_i − c) × (F_i − m_i ΣF/m)`. The second
/// term is the inertial force in the frame of the common centre of mass, and vanishes in the sum. Requires the
/// kinematics of `state` in the trees.
pub(super) fn refer_to_common_center<S: Real>(trees: &[Tree<'_, S>], state: &State<S>, rate: &mut Rate<S>) {
    let forces: Vec<_> = rate.trees.iter().map(|rate| rate.wrench.linear).collect();
    let moments = relative_moments(trees, &centers_of(trees, state), &forces);
    for (rate, moment) in rate.trees.iter_mut().zip(moments) {
        rate.wrench.angular += moment;
    }
}

/// Refers the angular impulses of the step from `start` to `state` to the centres of mass of the trees: moves
/// the changes of `(c_i − c) × (P_i − m_i v_c)` from the impulses of the trees to the common impulse.
pub(super) fn move_to_own_centers<S: Real>(trees: &[Tree<'_, S>], start: &State<S>, state: &mut State<S>) {
    let orbital = |state: &State<S>| {
        let centers: Vec<_> = state.trees.iter().map(|tree| tree.center.unwrap_or(Vec3::zero())).collect();
        let momenta: Vec<_> = state.trees.iter().map(|tree| tree.momentum().linear).collect();
        relative_moments(trees, &centers, &momenta)
    };
    let (before, after) = (orbital(start), orbital(state));
    for (number, tree) in state.trees.iter_mut().enumerate() {
        let change = after[number] - before[number];
        tree.impulse.angular -= change;
        state.orbital += change;
    }
}

/// Returns `(c_i − c) × (x_i − m_i Σx/m)` of every tree, for forces or momenta `x_i` at the centres `c_i`.
fn relative_moments<S: Real>(trees: &[Tree<'_, S>], centers: &[Vec3<S>], x: &[Vec3<S>]) -> Vec<Vec3<S>> {
    let (mass, common) = mass_and_center(trees, centers);
    let total = x.iter().fold(Vec3::zero(), |sum: Vec3<S>, x| sum + *x);
    let per_mass = total * (S::of(1.0) / mass);
    let parts = trees.iter().zip(centers).zip(x);
    let moment = |((tree, center), x): ((&Tree<'_, S>, &Vec3<S>), &Vec3<S>)| {
        (*center - common).cross(*x - per_mass * S::of(tree.model.mass()))
    };
    parts.map(moment).collect()
}

/// Returns the centres of mass of the trees, whose kinematics are those of `state`.
fn centers_of<S: Real>(trees: &[Tree<'_, S>], state: &State<S>) -> Vec<Vec3<S>> {
    let pairs = trees.iter().zip(&state.trees);
    pairs.map(|(tree, state)| center_of_mass(&tree.data, &state.q)).collect()
}

/// Returns the mass of all trees and their common centre of mass.
fn mass_and_center<S: Real>(trees: &[Tree<'_, S>], centers: &[Vec3<S>]) -> (S, Vec3<S>) {
    let (mut mass, mut first_moment) = (S::of(0.0), Vec3::zero());
    for (tree, center) in trees.iter().zip(centers) {
        mass += S::of(tree.model.mass());
        first_moment += *center * S::of(tree.model.mass());
    }
    (mass, first_moment * (S::of(1.0) / mass))
}
