//! Kernels, with their inputs, outputs and evaluation.

use crate::dynamics::derivatives::{
    Derivatives, forward_dynamics_derivatives, free_floating_derivatives, inverse_dynamics_derivatives,
};
use crate::dynamics::{
    ClosedLoops, Data, FrameWrench, FreeFloating, bias_forces, center_of_mass, closure_errors,
    constrained_forward_dynamics, forward_dynamics, frame_jacobian, frame_pose, frame_velocity,
    free_floating, inverse_dynamics, kinematics, kinetic_energy, mass_matrix, momentum, positions,
};
use crate::model::{Closure, Model, difference, integrate};
use crate::spatial::{Force, Real, pose_rows};

/// Largest number of outputs that a kernel has.
pub(super) const OUTPUTS: usize = 5;

/// Quantity that is computed from a state. Frames are given by index. The inputs per state are `q` and `q2`,
/// `(nq,)`; `v`, `a`, `tau` and `dv`, `(nv,)`; and `joint_acceleration`, `(n,)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// `q` → `(4, 4)` pose of a frame in W, with the position in m.
    FramePose(usize),
    /// `q, v` → `(6,)` twist at the frame origin, W axes, m/s and rad/s.
    FrameVelocity(usize),
    /// `q` → `(6, nv)` Jacobian of the twist at the frame origin, W axes.
    FrameJacobian(usize),
    /// `q` → `(nv, nv)` mass matrix, kg, kg m and kg m².
    MassMatrix,
    /// `q, v` → `(nv,)` bias forces, N and N m.
    BiasForces,
    /// `q, v, a` → `(nv,)` generalized forces, N and N m.
    InverseDynamics,
    /// `q, v, tau` → `(nv,)` generalized accelerations, m/s² and rad/s².
    ForwardDynamics,
    /// `q, v, tau` → `(nv,)` generalized accelerations with closed loops and mimic joints, m/s² and rad/s²,
    /// and the `(m,)` constraint forces, N and N m.
    ConstrainedForwardDynamics,
    /// `q` → `(m,)` errors of closed loops and mimic joints, m and rad; `m` is the number of constraint
    /// equations.
    LoopErrors,
    /// `q, v, a` → derivatives `∂τ/∂q`, `∂τ/∂v`, `∂τ/∂a` of the generalized forces `τ`, each `(nv, nv)`. Here
    /// and below, `∂/∂q` is the derivative with respect to `δ` of `q ⊕ δ`.
    InverseDynamicsDerivatives,
    /// `q, v, tau` → derivatives `∂a/∂q`, `∂a/∂v`, `∂a/∂τ` of the generalized accelerations, each `(nv, nv)`.
    ForwardDynamicsDerivatives,
    /// `q, v` → `(6,)` linear momentum, kg m/s, and angular momentum about the centre of mass, kg m²/s, W
    /// axes.
    Momentum,
    /// `q, v` → `(1,)` kinetic energy, J.
    KineticEnergy,
    /// `q` → `(3,)` centre of mass in W, m.
    CenterOfMass,
    /// `q, v` → reduced model of the joints on a free-floating base ([`FreeFloating`]): mass matrix `M*`,
    /// `(n, n)`; bias `c*` and external forces `Q*`, `(n,)`, N m (N); generalized Jacobian `Jg` of a frame,
    /// `(6, n)`; and drift `d` of the frame, `(6,)`, m/s² and rad/s². The rows of `Jg` and `d` are in W axes.
    FreeFloating(usize),
    /// `q, v, joint_acceleration` → derivatives of the joint efforts, `∂τ/∂q`, `∂τ/∂v`, each `(n, nv)`, and
    /// of the acceleration `ẍ` and twist `ẋ` of a frame, `∂ẍ/∂q`, `∂ẍ/∂v`, `∂ẋ/∂q`, each `(6, nv)`.
    FreeFloatingDerivatives(usize),
    /// `q, dv` → `(nq,)` configuration `q ⊕ dv` ([`integrate`]).
    Integrate,
    /// `q, q2` → `(nv,)` difference `q2 ⊖ q`, m and rad ([`difference`]).
    Difference,
}

impl Kernel {
    /// Returns the names of the inputs, in the order of the arguments.
    pub fn inputs(self) -> &'static [&'static str] {
        match self {
            Self::FramePose(_) | Self::FrameJacobian(_) | Self::MassMatrix => &["q"],
            Self::CenterOfMass | Self::LoopErrors => &["q"],
            Self::InverseDynamics | Self::InverseDynamicsDerivatives => &["q", "v", "a"],
            Self::ForwardDynamics | Self::ForwardDynamicsDerivatives | Self::ConstrainedForwardDynamics => {
                &["q", "v", "tau"]
            }
            Self::FreeFloatingDerivatives(_) => &["q", "v", "joint_acceleration"],
            Self::Integrate => &["q", "dv"],
            Self::Difference => &["q", "q2"],
            _ => &["q", "v"],
        }
    }

    /// Returns the row width of the input `name`: the number of values per state. Names of configurations
    /// begin with `q`.
    pub(super) fn width(name: &str, model: &Model) -> usize {
        match name {
            "joint_acceleration" => model.joint_count(),
            _ if name.starts_with('q') => model.nq(),
            _ => model.nv(),
        }
    }

    /// Returns true if the kernel divides by the inertia at the joints, in which case its first output is not
    /// finite if the mass matrix is singular.
    pub(super) fn divides(self) -> bool {
        matches!(
            self,
            Self::ForwardDynamics | Self::ForwardDynamicsDerivatives | Self::ConstrainedForwardDynamics
        )
    }

    /// Returns the index of the kernel's frame; `None` if the kernel has none.
    pub(super) fn frame(self) -> Option<usize> {
        match self {
            Self::FramePose(frame)
            | Self::FrameVelocity(frame)
            | Self::FrameJacobian(frame)
            | Self::FreeFloating(frame)
            | Self::FreeFloatingDerivatives(frame) => Some(frame),
            _ => None,
        }
    }

    /// Returns the row width of each output: the number of values per state.
    pub fn outputs(self, model: &Model) -> Vec<usize> {
        let (widths, count) = self.widths(model);
        widths[..count].to_vec()
    }

    /// Returns the row widths of the outputs and the number of outputs.
    pub(super) fn widths(self, model: &Model) -> ([usize; OUTPUTS], usize) {
        let (nq, nv, n) = (model.nq(), model.nv(), model.joint_count());
        let m = || model.closures().iter().map(Closure::rows).sum();
        let used: &[usize] = match self {
            Self::FramePose(_) => &[16],
            Self::FrameVelocity(_) | Self::Momentum => &[6],
            Self::FrameJacobian(_) => &[6 * nv],
            Self::MassMatrix => &[nv * nv],
            Self::BiasForces | Self::InverseDynamics | Self::ForwardDynamics | Self::Difference => &[nv],
            Self::KineticEnergy => &[1],
            Self::ConstrainedForwardDynamics => &[nv, m()],
            Self::LoopErrors => &[m()],
            Self::CenterOfMass => &[3],
            Self::FreeFloating(_) => &[n * n, n, n, 6 * n, 6],
            Self::InverseDynamicsDerivatives | Self::ForwardDynamicsDerivatives => &[nv * nv; 3],
            Self::FreeFloatingDerivatives(_) => &[n * nv, n * nv, 6 * nv, 6 * nv, 6 * nv],
            Self::Integrate => &[nq],
        };
        let mut widths = [0; OUTPUTS];
        widths[..used.len()].copy_from_slice(used);
        (widths, used.len())
    }

    /// Computes the outputs for one state per lane of `S`.
    pub(super) fn evaluate<S: Real>(
        self,
        model: &Model,
        kernel_data: &mut KernelData<S>,
        inputs: &[Vec<S>],
        out: &mut [Vec<S>],
    ) {
        let KernelData { data, reduced, derivatives, external, loops } = kernel_data;
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
            Self::ConstrainedForwardDynamics => {
                let (v, tau, a) = (&inputs[1], &inputs[2], &mut out[0]);
                constrained_forward_dynamics((model, data, loops), q, v, tau, external, a);
                out[1].copy_from_slice(loops.forces());
            }
            Self::LoopErrors => S::enter(
                #[inline(always)]
                || {
                    closure_errors(model, data, loops, q);
                    out[0].copy_from_slice(loops.errors());
                },
            ),
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

/// Workspace of all kernels for one scalar type.
#[derive(Clone, Debug)]
pub(super) struct KernelData<S> {
    pub(super) data: Data<S>,
    pub(super) reduced: FreeFloating<S>,
    pub(super) derivatives: Derivatives<S>,
    pub(super) external: Vec<FrameWrench<S>>,
    pub(super) loops: ClosedLoops<S>,
}

impl<S: Real> KernelData<S> {
    pub(super) fn new(model: &Model) -> Self {
        Self {
            data: Data::new(model),
            reduced: FreeFloating::new(model),
            derivatives: Derivatives::new(model),
            external: Vec::new(),
            loops: ClosedLoops::new(model, model.closures()),
        }
    }
}

/// Returns the first `N` outputs as slices.
fn slices<S, const N: usize>(out: &mut [Vec<S>]) -> [&mut [S]; N] {
    let mut rows = out.iter_mut();
    std::array::from_fn(|_| rows.next().map(Vec::as_mut_slice).unwrap_or_default())
}
