//! Mode of a contact, which is constant during a step.

use crate::contact::Bristle;
use crate::spatial::Vec3;
use serde::{Deserialize, Serialize};

/// Phase of a contact: whether the bodies touch, and whether they may touch during the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Phase {
    /// The bodies are too far apart to touch within the step.
    Far,
    /// The bodies do not touch, but may touch within the step.
    Apart,
    /// The bodies press on each other.
    Pressing,
    /// The bodies overlap, but separate so fast that the force would pull.
    Separating,
}

impl Phase {
    /// Returns true if the bodies overlap in this phase.
    pub(super) fn is_closed(self) -> bool {
        matches!(self, Self::Pressing | Self::Separating)
    }
}

/// Mode of a contact during a step, with the friction at the start of the step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::simulation) struct Mode {
    pub(super) phase: Phase,
    /// Bristles at the start of the step, in axes of the first side.
    pub(super) bristle: Bristle,
    /// Bristles of torsional friction at the start of the step; the first component of the deflection is the
    /// angle about the normal, rad.
    pub(super) twist: Bristle,
    /// Elastic angle about the normal at the start of the step, rad.
    pub(super) turn: f64,
    /// Elastic sliding displacement at the start of the step, in axes of the first side, m.
    pub(super) slip: Vec3<f64>,
    /// Normal at the start of the step, in axes of the first side.
    pub(super) normal: Vec3<f64>,
    /// Reciprocals of the effective masses in the normal and in the tangential directions, 1/kg, and of the
    /// effective inertia about the normal, 1/(kg m²); zero before the bodies touch.
    pub(super) mobility: [f64; 3],
    /// Amplitude of the recent oscillation of the contact relative to its largest depth; at most 1.
    pub(super) activity: f64,
    /// Numbers that are added to the margins of the gap or depth, m, of the force and of friction, so that a
    /// step can begin at a change of mode.
    pub(super) slack: [f64; 3],
    /// Instant at which the mode was determined, s; negative before the first step, and [`Self::REPEATED`]
    /// after a step of length zero.
    pub(super) since: f64,
}

impl Mode {
    /// Value of [`Self::since`] for a mode that must be determined again at the same instant.
    pub(super) const REPEATED: f64 = -2.0;

    /// Mode before the first step.
    pub(super) const START: Self = {
        let zero = Vec3 { x: 0.0, y: 0.0, z: 0.0 };
        Self {
            phase: Phase::Far,
            bristle: Bristle { deflection: zero, is_slipping: false },
            twist: Bristle { deflection: zero, is_slipping: false },
            turn: 0.0,
            slip: zero,
            normal: zero,
            mobility: [0.0; 3],
            activity: 1.0,
            slack: [0.0; 3],
            since: -1.0,
        }
    };
}
