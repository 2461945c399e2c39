//! The kernels by name, with the widths of their rows.

use crate::model::Model;

/// Most outputs that a kernel has.
pub(super) const OUTPUTS: usize = 5;

/// What to compute from a state; frames by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// `q` → `(4, 4)` pose in W.
    FramePose(usize),
    /// `q, v` → `(6,)` twist at the frame's origin, W axes.
    FrameVelocity(usize),
    /// `q` → `(6, nv)`, W axes at the frame's origin.
    FrameJacobian(usize),
    /// `q` → `(nv, nv)`.
    MassMatrix,
    /// `q, v` → `(nv,)`.
    BiasForces,
    /// `q, v, a` → `(nv,)`.
    InverseDynamics,
    /// `q, v, tau` → `(nv,)`.
    ForwardDynamics,
    /// `q, v, a` → `∂τ/∂q`, `∂τ/∂v`, `∂τ/∂a`, each `(nv, nv)`.
    InverseDynamicsDerivatives,
    /// `q, v, tau` → `∂a/∂q`, `∂a/∂v`, `∂a/∂τ`, each `(nv, nv)`.
    ForwardDynamicsDerivatives,
    /// `q, v` → `(6,)`.
    Momentum,
    /// `q, v` → `(1,)`.
    KineticEnergy,
    /// `q` → `(3,)`.
    CenterOfMass,
    /// `q, v` → `M* (n, n)`, `c* (n,)`, `Q* (n,)`, `Jg (6, n)`, `d (6,)`.
    FreeFloating(usize),
    /// `q, v, joint_acceleration` → `∂τ/∂q`, `∂τ/∂v` `(n, nv)`, `∂ẍ/∂q`, `∂ẍ/∂v`, `∂ẋ/∂q` `(6, nv)`.
    FreeFloatingDerivatives(usize),
    /// `q, dv` → `(nq,)`.
    Integrate,
    /// `q, q2` → `(nv,)`.
    Difference,
}

impl Kernel {
    /// Names of the inputs.
    pub fn inputs(self) -> &'static [&'static str] {
        match self {
            Self::FramePose(_) | Self::FrameJacobian(_) | Self::MassMatrix | Self::CenterOfMass => &["q"],
            Self::InverseDynamics | Self::InverseDynamicsDerivatives => &["q", "v", "a"],
            Self::ForwardDynamics | Self::ForwardDynamicsDerivatives => &["q", "v", "tau"],
            Self::FreeFloatingDerivatives(_) => &["q", "v", "joint_acceleration"],
            Self::Integrate => &["q", "dv"],
            Self::Difference => &["q", "q2"],
            _ => &["q", "v"],
        }
    }

    /// Width of the rows of an input: configurations are called `q`.
    pub(super) fn width(name: &str, model: &Model) -> usize {
        match name {
            "joint_acceleration" => model.joint_count(),
            _ if name.starts_with('q') => model.nq(),
            _ => model.nv(),
        }
    }

    /// Whether it divides by what a joint feels: its first output is not finite where that is nothing.
    pub(super) fn divides(self) -> bool {
        matches!(self, Self::ForwardDynamics | Self::ForwardDynamicsDerivatives)
    }

    /// The frame it is about, if it is about one.
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

    /// Widths of the outputs' rows.
    pub fn outputs(self, model: &Model) -> Vec<usize> {
        let (widths, count) = self.widths(model);
        widths[..count].to_vec()
    }

    /// Widths of the outputs' rows, and how many outputs there are.
    pub(super) fn widths(self, model: &Model) -> ([usize; OUTPUTS], usize) {
        let (nq, nv, n) = (model.nq(), model.nv(), model.joint_count());
        let given: &[usize] = match self {
            Self::FramePose(_) => &[16],
            Self::FrameVelocity(_) | Self::Momentum => &[6],
            Self::FrameJacobian(_) => &[6 * nv],
            Self::MassMatrix => &[nv * nv],
            Self::BiasForces | Self::InverseDynamics | Self::ForwardDynamics | Self::Difference => &[nv],
            Self::KineticEnergy => &[1],
            Self::CenterOfMass => &[3],
            Self::FreeFloating(_) => &[n * n, n, n, 6 * n, 6],
            Self::InverseDynamicsDerivatives | Self::ForwardDynamicsDerivatives => &[nv * nv; 3],
            Self::FreeFloatingDerivatives(_) => &[n * nv, n * nv, 6 * nv, 6 * nv, 6 * nv],
            Self::Integrate => &[nq],
        };
        let mut widths = [0; OUTPUTS];
        widths[..given.len()].copy_from_slice(given);
        (widths, given.len())
    }
}
