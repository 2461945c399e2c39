//! Velocity of a tree immediately after its systems have been connected, impulses of its closed loops, and
//! the response of a robot to an impulse.

use super::assembly::Member;
use crate::dynamics::{
    ClosedLoops, Data, FrameWrench, apply_external, base_rotation, constrained_recursion, kinematics,
    positions,
};
use crate::model::{BASE_NV, Model};
use crate::spatial::{Force, Vec3};

/// System in motion, with its place in a tree.
pub struct Moving<'a> {
    /// Place of the system in the tree.
    pub member: &'a Member,
    /// Model of the system alone.
    pub model: &'a Model,
    /// Configuration, `(nq,)`, m and rad.
    pub q: &'a [f64],
    /// Velocity, `(nv,)`, m/s and rad/s.
    pub v: &'a [f64],
}

/// Returns the velocity `(nv,)`, m/s and rad/s, of a tree at `q` immediately after its systems have been
/// rigidly connected; the first system is the root. Also returns the closed loops of the tree, with impulses
/// in place of forces. `given` are the indices and the rates, rad/s or m/s, of the joints with prescribed
/// motion and, with rate 0, of the joints that brakes hold.
///
/// The impulses of the connections do no work on motions that the tree permits, so the generalized momentum
/// of the tree, less the impulses that close its loops, equals that of the systems: `M v⁺ = Σ J_kᵀ I_k V_k⁻`,
/// summed over all bodies and rotors, with the mass matrix `M` and velocity `v⁺` of the tree, and the
/// Jacobian `J_k`, inertia `I_k` and previous twist `V_k⁻` of a body. By Gauss's principle, `v⁺` is, of all
/// motions that the tree and its closed loops permit, the one closest to the previous motion `v⁻` of the
/// systems in the metric of the kinetic energy. Without closed loops, in the coordinates of the systems, it
/// equals `v⁻ − M⁻¹ Jᵀ Λ J v⁻` with their mass matrix `M`, the relative twist `J v` at the connection, and
/// `Λ = (J M⁻¹ Jᵀ)⁻¹`.
pub fn connected_velocity(
    tree: &Model,
    q: &[f64],
    systems: &[Moving<'_>],
    given: &[(usize, f64)],
) -> (Vec<f64>, ClosedLoops<f64>) {
    let mut data = Data::<f64>::new(tree);
    positions(tree, &mut data, q);
    let rot_bw = base_rotation(q).transpose();
    // velocities are taken relative to the root, so that a common velocity costs no precision
    let common = base_rotation(systems[0].q) * Vec3::from_slice(systems[0].v);
    let mut momentum = vec![0.0; tree.nv()];
    for Moving { member, model, q, v } in systems {
        let rot_wb = base_rotation::<f64>(q);
        let mut relative = v.to_vec();
        (Vec3::from_slice(v) - rot_wb.transpose_mul(common)).write(&mut relative);
        let mut own = Data::<f64>::new(model);
        kinematics(model, &mut own, q, &relative);
        let to_tree = rot_bw * rot_wb;
        for (body, place) in own.bodies.iter().zip(&member.bodies) {
            let (h, to) = (body.inertia.momentum(body.velocity), &mut data.bodies[place.body]);
            to.external += Force::at(to_tree * h.linear, to_tree * h.angular, to.rot_bk * place.pos_kb);
        }
        for (joint, &in_tree) in member.joints.iter().enumerate() {
            momentum[BASE_NV + in_tree] = model.nodes()[joint + 1].rotor_inertia * v[BASE_NV + joint];
        }
    }
    // at zero velocity the bias vanishes; with momenta in place of the wrenches F, the accelerations of ABA
    // are velocities
    let (at_rest, mut v) = (vec![0.0; tree.nv()], vec![0.0; tree.nv()]);
    let (mut locked, mut rates) = (vec![false; tree.joint_count()], vec![0.0; tree.joint_count()]);
    given.iter().for_each(|&(joint, rate)| (locked[joint], rates[joint]) = (true, rate));
    let locked = (!given.is_empty()).then_some((&locked[..], &rates[..]));
    let mut loops = ClosedLoops::new(tree, tree.closures());
    constrained_recursion(tree, &mut data, &mut loops, (&at_rest, &momentum), locked, &mut v);
    (Vec3::from_slice(&v) + rot_bw * common).write(&mut v);
    (v, loops)
}

/// Returns, for each closed loop of a tree at `q`, its name and its impulse on the body of its second frame,
/// N s and N m s, in the axes of W. The angular part is about the point at which the loop is attached to that
/// frame. Mimic joints are included, with an impulse of zero. `loops` are those of [`connected_velocity`].
pub fn loop_impulses(tree: &Model, q: &[f64], loops: &ClosedLoops<f64>) -> Vec<(String, [f64; 6])> {
    let (mut data, rot_wb) = (Data::<f64>::new(tree), base_rotation::<f64>(q));
    positions(tree, &mut data, q);
    let impulse = |closure: usize| {
        let (_, wrench) = loops.wrench(closure, &data);
        let mut impulse = [0.0; 6];
        Force::new(rot_wb * wrench.linear, rot_wb * wrench.angular).write(&mut impulse);
        (loops.closures()[closure].name.clone(), impulse)
    };
    (0..loops.closures().len()).map(impulse).collect()
}

/// Returns the change of velocity `(nv,)`, m/s and rad/s, that an impulse `i` at the origin of `frame` causes
/// in a robot at `q`: `Δv = M⁻¹ Jᵀ i`, with the mass matrix `M` and the Jacobian `J` of the frame. The
/// impulse, N s and N m s, is in the axes of the frame. The rates of the joints `held`, whose motion is
/// prescribed or which brakes hold, do not change, and the response keeps loops closed; `M` and `J` are those
/// of the remaining free coordinates.
pub fn impulse_response(
    model: &Model,
    q: &[f64],
    frame: usize,
    impulse: Force<f64>,
    held: &[usize],
) -> Vec<f64> {
    let mut data = Data::<f64>::new(model);
    let (at_rest, mut change) = (vec![0.0; model.nv()], vec![0.0; model.nv()]);
    positions(model, &mut data, q);
    apply_external(model, &mut data, &[FrameWrench { frame, wrench: impulse }]);
    let mut locked = vec![false; model.joint_count()];
    held.iter().for_each(|&joint| locked[joint] = true);
    let locked = (!held.is_empty()).then_some((&locked[..], &[][..]));
    let mut loops = ClosedLoops::new(model, model.closures());
    constrained_recursion(model, &mut data, &mut loops, (&at_rest, &at_rest), locked, &mut change);
    change
}
