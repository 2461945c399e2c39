//! Fingers of a gripper and the contact forces that act on them.

use super::gains::PerJoint;
use super::normal_force::NormalForce;
use crate::dynamics::{Data, base_rotation};
use crate::model::{Axis, Constraint, Model};
use crate::spatial::{Scalar, Vec3};

/// Finger of a gripper, moved by a joint of the group of a control or by a joint that mimics such a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Finger {
    /// Index in the group of the joint that moves the finger or, if the finger is moved by a mimic joint, of
    /// its leader.
    pub(crate) place: usize,
    /// Index in the model of the joint that moves the finger.
    pub(crate) joint: usize,
    /// Rate of the joint that moves the finger, divided by the rate of the joint of the group.
    pub(crate) ratio: f64,
}

/// Sums of the normal forces that oppose the closing motion of a finger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FingerForce {
    /// Sum of the magnitudes of the forces, N.
    pub(super) normal: f64,
    /// Sum of the efforts of the forces on the joint of the group: their virtual work per displacement of that
    /// joint, N m (N).
    pub(super) effort: f64,
}

/// Returns the fingers that a group of joints moves; `joints` has their indices in the model.
pub(crate) fn fingers_of(joints: &[usize], model: &Model) -> Vec<Finger> {
    let own = joints.iter().enumerate().map(|(place, &joint)| Finger { place, joint, ratio: 1.0 });
    let mut fingers: Vec<Finger> = own.collect();
    let mut number = 0;
    while number < fingers.len() {
        let lead = fingers[number];
        let followers = model.closures().iter().filter_map(|closure| match closure.constraint {
            Constraint::Mimic { joint, leader, ratio, .. } if leader == lead.joint => {
                Some(Finger { joint, ratio: ratio * lead.ratio, ..lead })
            }
            _ => None,
        });
        fingers.extend(followers);
        number += 1;
    }
    fingers
}

impl Finger {
    /// Returns true if the joint of the finger moves the body with the index `body`.
    pub(super) fn moves(&self, body: usize, model: &Model) -> bool {
        let first = self.joint + 1;
        (first..model.nodes()[first].end).contains(&body)
    }

    /// Returns true if a closed loop contains the joint of the finger.
    pub(super) fn is_in_loop(&self, model: &Model) -> bool {
        model.closures().iter().any(|closure| match &closure.constraint {
            Constraint::Frames { frames, .. } => {
                self.moves(frames[0].body, model) != self.moves(frames[1].body, model)
            }
            Constraint::Mimic { .. } => false,
        })
    }

    /// Returns the effort, N m (N), with which a force on a body that the finger moves acts on the joint of
    /// the group: `ρ e` with the ratio `ρ` of the finger and the effort `e` on its joint or, in a robot with
    /// closed loops, `Σ_j (∂q_j/∂q_g) e_j` with the rates in `loops` ([`FingerLoops`](super::finger_loops)).
    fn effort<S: Scalar>(
        &self,
        force: &NormalForce,
        fingers: &[Finger],
        loops: Option<(&[f64], usize)>,
        robot: (&Model, &Data<S>, &[f64]),
    ) -> f64 {
        let Some((rates, k)) = loops else { return self.ratio * joint_effort(self.joint, force, robot) };
        let own = joints_of(self, force.body, fingers, robot.0);
        own.map(|j| rates[j * k + self.place] * joint_effort(j, force, robot)).sum()
    }
}

/// Returns the joints on the path from a body to the base that are assigned to `finger`. Each joint is
/// assigned to the first finger on the path from this joint to the base; joints without such a finger are
/// assigned to the finger on the whole path that is nearest to the base.
fn joints_of<'a>(
    finger: &'a Finger,
    body: usize,
    fingers: &'a [Finger],
    model: &'a Model,
) -> impl Iterator<Item = usize> + 'a {
    let path = std::iter::successors(Some(body), |&k| Some(model.nodes()[k].parent)).take_while(|&k| k > 0);
    let owner = move |j: usize| {
        let above = fingers.iter().filter(|other| other.moves(j + 1, model)).map(|other| other.joint).max();
        above.or_else(|| {
            fingers.iter().filter(|other| other.moves(body, model)).map(|other| other.joint).min()
        })
    };
    path.map(|k| k - 1).filter(move |&j| owner(j) == Some(finger.joint))
}

/// Returns the effort, N m (N), with which a force acts on a joint (index) that moves its body: `aᵀ (r × F)`
/// about the axis `a` of a revolute joint, or `aᵀ F` along that of a prismatic joint. Requires the kinematics
/// of the configuration `q` in `data`.
fn joint_effort<S: Scalar>(
    joint: usize,
    force: &NormalForce,
    (model, data, q): (&Model, &Data<S>, &[f64]),
) -> f64 {
    let body = &data.bodies[joint + 1];
    let rot_wb = base_rotation(q);
    let axis = rot_wb * body.rot_bk.z.map(|x| x.value());
    let origin = rot_wb * body.pos_b.map(|x| x.value()) + Vec3::from_slice(q);
    match model.nodes()[joint + 1].axis {
        Axis::Revolute => axis.dot((force.point - origin).cross(force.force)),
        Axis::Prismatic => axis.dot(force.force),
    }
}

/// Computes the contact forces that oppose the closing motion of each finger. Contacts between fingers are
/// ignored. `closing_rate` has the sign of the closing motion for each joint of the group. `loops` has the
/// rates of all joints per rate of those of the group, and the number of the latter, for a robot with closed
/// loops. Requires the kinematics of the configuration `q` in `data`.
pub(super) fn measure<S: Scalar>(
    fingers: &[Finger],
    closing_rate: &PerJoint,
    forces: &[NormalForce],
    loops: Option<(&[f64], usize)>,
    robot: (&Model, &Data<S>, &[f64]),
    out: &mut [FingerForce],
) {
    out.fill(FingerForce::default());
    let is_finger = |body: usize| fingers.iter().any(|finger| finger.moves(body, robot.0));
    for force in forces.iter().filter(|force| !force.other.is_some_and(is_finger)) {
        for (finger, out) in fingers.iter().zip(&mut *out) {
            if finger.moves(force.body, robot.0) {
                let effort = finger.effort(force, fingers, loops, robot);
                if effort * closing_rate.at(finger.place) < 0.0 {
                    out.normal += force.force.norm();
                    out.effort += effort;
                }
            }
        }
    }
}

/// Returns the mean normal force of the fingers, N.
pub(super) fn mean_force(forces: &[FingerForce]) -> f64 {
    forces.iter().map(|force| force.normal).sum::<f64>() / forces.len().max(1) as f64
}
