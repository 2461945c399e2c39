//! Reciprocal effective mass of two bodies at a point of contact.

use super::side::Side;
use super::touching::Loading;
use crate::dynamics::{Data, frame_pose, frame_velocity, kinematics, positions};
use crate::simulation::tree::Tree;
use crate::simulation::tree_state::TreeState;
use crate::spatial::{Force, Motion, Real, Vec3};
use crate::world::impulse_response;

/// Returns the change of relative velocity per unit impulse, 1/kg, along the normal and in the tangential
/// direction with the largest change, and the change of the relative rate of turn about the normal per unit
/// angular impulse, 1/(kg m²): `nᵀ W n` for each direction `n`, with `W = J_A M_A⁻¹ J_Aᵀ + J_B M_B⁻¹ J_Bᵀ`,
/// the Jacobians `J` of both sides at the point of contact and their mass matrices `M`.
pub(super) fn mobility<S: Real>(
    sides: &[Side; 2],
    trees: &[Tree<'_, S>],
    states: &[TreeState<S>],
    loading: &Loading,
) -> [f64; 3] {
    let normal = loading.normal;
    let other = if normal.x.abs() < 0.7 { Vec3::new(1.0, 0.0, 0.0) } else { Vec3::new(0.0, 1.0, 0.0) };
    let across = normal.cross(other);
    let first = across * (1.0 / across.norm());
    let directions = [normal, first, normal.cross(first)];
    let along = directions.map(|direction| {
        let impulse = Force::new(direction, Vec3::zero());
        let [a, b] = [0, 1].map(|i| response(&sides[i], trees, states, loading.point, impulse));
        a.linear + b.linear
    });
    let [n, s, t] = [0, 1, 2].map(|i| along[i].dot(directions[i]));
    // the larger eigenvalue of the tangential block
    let mixed = along[1].dot(directions[2]);
    let tangential = 0.5 * (s + t) + (0.25 * (s - t) * (s - t) + mixed * mixed).sqrt();
    let turn = Force::new(Vec3::zero(), normal);
    let turns = [0, 1].map(|i| response(&sides[i], trees, states, loading.point, turn).angular.dot(normal));
    [n, tangential, turns[0] + turns[1]]
}

/// Returns the change of the twist of the body of `side`, at `point` in W axes, m/s and rad/s, that `impulse`
/// at this point causes, W axes, N s and N m s.
fn response<S: Real>(
    side: &Side,
    trees: &[Tree<'_, S>],
    states: &[TreeState<S>],
    point: Vec3<f64>,
    impulse: Force<f64>,
) -> Motion<f64> {
    let (number, frame) = side.place;
    let tree = &trees[number];
    let q: Vec<f64> = states[number].q.iter().map(|x| x.lane(0)).collect();
    let mut data = Data::<f64>::new(&tree.model);
    positions(&tree.model, &mut data, &q);
    let pose = frame_pose(&tree.model, &data, &q, frame);
    let arm = point - pose.pos_w;
    let [force, moment, offset] =
        [impulse.linear, impulse.angular, arm].map(|vector| pose.rot_wf.transpose_mul(vector));
    let impulse = Force::at(force, moment, offset);
    let given: Vec<usize> = tree.modes.given().iter().map(|given| given.joint).collect();
    let change = impulse_response(&tree.model, &q, frame, impulse, &given);
    kinematics(&tree.model, &mut data, &q, &change);
    frame_velocity(&tree.model, &data, &q, frame).referred_to(arm)
}
