//! What the kernels compute, and where.

use super::kernel::Kernel;
use crate::dynamics::derivatives::{
    Derivatives, forward_dynamics_derivatives, free_floating_derivatives, inverse_dynamics_derivatives,
};
use crate::dynamics::{
    Data, FrameWrench, FreeFloating, bias_forces, center_of_mass, forward_dynamics, frame_jacobian,
    frame_pose, frame_velocity, free_floating, inverse_dynamics, kinematics, kinetic_energy, mass_matrix,
    momentum, positions,
};
use crate::model::{Model, difference, integrate};
use crate::spatial::{Force, Real, pose_rows};

/// Workspace of all kernels for one scalar.
#[derive(Clone, Debug)]
pub(super) struct Work<S> {
    pub(super) data: Data<S>,
    pub(super) reduced: FreeFloating<S>,
    pub(super) derivatives: Derivatives<S>,
    pub(super) external: Vec<FrameWrench<S>>,
}

impl<S: Real> Work<S> {
    pub(super) fn new(model: &Model) -> Self {
        Self {
            data: Data::new(model),
            reduced: FreeFloating::new(model),
            derivatives: Derivatives::new(model),
            external: Vec::new(),
        }
    }
}

impl Kernel {
    /// One state, or one set of lanes.
    pub(super) fn run<S: Real>(
        self,
        model: &Model,
        work: &mut Work<S>,
        inputs: &[Vec<S>],
        out: &mut [Vec<S>],
    ) {
        let Work { data, reduced, derivatives, external } = work;
        let q = &inputs[0];
        match self {
            Self::FramePose(frame) => {
                positions(model, data, q);
                let pose = S::enter(
                    #[inline(always)]
                    || frame_pose(model, data, q, frame),
                );
                out[0].copy_from_slice(&pose_rows(&pose.rot_wf, pose.pos_w));
            }
            Self::FrameVelocity(frame) => {
                kinematics(model, data, q, &inputs[1]);
                let velocity = S::enter(
                    #[inline(always)]
                    || frame_velocity(model, data, q, frame),
                );
                velocity.write(&mut out[0]);
            }
            Self::FrameJacobian(frame) => {
                positions(model, data, q);
                frame_jacobian(model, data, q, frame, &mut out[0]);
            }
            Self::MassMatrix => mass_matrix(model, data, q, &mut out[0]),
            Self::BiasForces => bias_forces(model, data, q, &inputs[1], external, &mut out[0]),
            Self::InverseDynamics => {
                inverse_dynamics(model, data, q, &inputs[1], &inputs[2], external, &mut out[0])
            }
            Self::ForwardDynamics => {
                forward_dynamics(model, data, q, &inputs[1], &inputs[2], external, &mut out[0])
            }
            Self::Momentum => {
                kinematics(model, data, q, &inputs[1]);
                let h = momentum(data, q);
                Force::new(h.linear, h.angular).write(&mut out[0]);
            }
            Self::KineticEnergy => {
                kinematics(model, data, q, &inputs[1]);
                out[0][0] = kinetic_energy(model, data, &inputs[1]);
            }
            Self::CenterOfMass => {
                positions(model, data, q);
                center_of_mass(data, q).write(&mut out[0]);
            }
            Self::FreeFloating(frame) => {
                free_floating(model, data, q, &inputs[1], frame, external, reduced);
                out[0].copy_from_slice(&reduced.inertia);
                out[1].copy_from_slice(&reduced.bias);
                out[2].copy_from_slice(&reduced.external);
                out[3].copy_from_slice(&reduced.jacobian);
                reduced.drift.write(&mut out[4]);
            }
            Self::InverseDynamicsDerivatives => {
                let (v, a, out) = (&inputs[1], &inputs[2], slices(out));
                inverse_dynamics_derivatives(model, data, derivatives, q, v, a, external, out);
            }
            Self::ForwardDynamicsDerivatives => {
                let (v, tau, out) = (&inputs[1], &inputs[2], slices(out));
                forward_dynamics_derivatives(model, data, derivatives, q, v, tau, external, out);
            }
            Self::FreeFloatingDerivatives(frame) => {
                let (v, a, out) = (&inputs[1], &inputs[2], slices(out));
                free_floating_derivatives(model, data, derivatives, q, v, a, frame, external, out);
            }
            Self::Integrate => S::enter(
                #[inline(always)]
                || integrate(q, &inputs[1], &mut out[0]),
            ),
            Self::Difference => S::enter(
                #[inline(always)]
                || difference(q, &inputs[1], &mut out[0]),
            ),
        }
    }
}

/// The first `N` outputs.
fn slices<S, const N: usize>(out: &mut [Vec<S>]) -> [&mut [S]; N] {
    let mut rows = out.iter_mut();
    std::array::from_fn(|_| rows.next().map(Vec::as_mut_slice).unwrap_or_default())
}
