//! Angular momenta of several trees about their common centre of mass during a step.
//!
//! Forces between trees have no moment in total about any common point, at every stage. Moments about the
//! centres of mass of the single trees lack this property, because their arms `c_i − c` change during the
//! step. In a group with contacts, the angular impulses of all trees are therefore integrated about the
//! common centre of mass `c`, and referred to the centres of mass of the trees at the end of the step.

use crate::dynamics::center_of_mass;
use crate::simulation::state::{Rate, State};
use crate::simulation::tree::Tree;
use crate::spatial::{Real, Vec3};

/// Angular momentum of a tree about the common centre of mass less that about its own centre of mass.
pub(in crate::simulation) type Orbital<S> = Vec3<S>;

/// Refers the moments in `rate` to the common centre of mass: adds `(c_i − c) × (F_i − m_i ΣF/m)`. The second
/// term is the inertial force in the frame of the common centre of mass, and vanishes in the sum. Requires the
/// kinematics of `state` in the trees.
pub(in crate::simulation) fn refer_to_common_center<S: Real>(
    trees: &[Tree<'_, S>],
    state: &State<S>,
    rate: &mut Rate<S>,
) {
    let mass = |tree: &Tree<'_, S>| S::of(tree.model.mass());
    let centers: Vec<_> =
        trees.iter().zip(&state.trees).map(|(tree, state)| center_of_mass(&tree.data, &state.q)).collect();
    let (mut total, mut first_moment, mut force) = (S::of(0.0), Vec3::zero(), Vec3::zero());
    for ((tree, center), rate) in trees.iter().zip(&centers).zip(&rate.trees) {
        total += mass(tree);
        first_moment += *center * mass(tree);
        force += rate.wrench.linear;
    }
    let per_mass = S::of(1.0) / total;
    let (common, acceleration) = (first_moment * per_mass, force * per_mass);
    for ((tree, center), rate) in trees.iter().zip(&centers).zip(&mut rate.trees) {
        let relative = rate.wrench.linear - acceleration * mass(tree);
        rate.wrench.angular += (*center - common).cross(relative);
    }
}

/// Refers the angular impulses of the step from `start` to `state` to the centres of mass of the trees: moves
/// the changes of `(c_i − c) × (P_i − m_i v_c)` from the impulses of the trees to the common impulse.
pub(in crate::simulation) fn move_to_own_centers<S: Real>(
    trees: &[Tree<'_, S>],
    start: &State<S>,
    state: &mut State<S>,
) {
    let (before, after) = (orbital(trees, start), orbital(trees, state));
    for (number, tree) in state.trees.iter_mut().enumerate() {
        let change = after[number] - before[number];
        tree.impulse.angular -= change;
        state.orbital += change;
    }
}

/// Returns `(c_i − c) × (P_i − m_i v_c)` of every tree, N m s.
fn orbital<S: Real>(trees: &[Tree<'_, S>], state: &State<S>) -> Vec<Orbital<S>> {
    let masses: Vec<S> = trees.iter().map(|tree| S::of(tree.model.mass())).collect();
    let centers: Vec<Vec3<S>> = state.trees.iter().map(|tree| tree.center.unwrap_or(Vec3::zero())).collect();
    let momenta: Vec<Vec3<S>> = state.trees.iter().map(|tree| tree.momentum().linear).collect();
    let (mut total, mut first_moment, mut momentum) = (S::of(0.0), Vec3::zero(), Vec3::zero());
    for ((mass, center), own) in masses.iter().zip(&centers).zip(&momenta) {
        total += *mass;
        first_moment += *center * *mass;
        momentum += *own;
    }
    let per_mass = S::of(1.0) / total;
    let (common, velocity) = (first_moment * per_mass, momentum * per_mass);
    let parts = masses.iter().zip(&centers).zip(&momenta);
    parts.map(|((mass, center), own)| (*center - common).cross(*own - velocity * *mass)).collect()
}
