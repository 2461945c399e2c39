//! Events that change how the systems of a world are connected, and which joints their brakes hold.

use serde::{Deserialize, Serialize};

/// Frame of a system, identified by two indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FrameIndex {
    /// Index of the system in the world.
    pub system: usize,
    /// Index of the frame in the model of the system.
    pub frame: usize,
}

/// Brake of a system, identified by two indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BrakeIndex {
    /// Index of the system in the world.
    pub system: usize,
    /// Index of the brake among the brakes of the system.
    pub brake: usize,
}

/// Event of a world: an action, and the condition under which it occurs. Each event happens at most once in a
/// run.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Name, which is unique among the events.
    pub name: String,
    /// Condition under which the event happens.
    pub when: When,
    /// Action of the event.
    pub action: Action,
}

/// Condition under which an event happens.
#[derive(Clone, Debug, PartialEq)]
pub enum When {
    /// The event happens at the given simulation time, s.
    At(f64),
    /// The event happens after a delay that begins when another event happens.
    After {
        /// Index of the other event.
        event: usize,
        /// Delay after the other event, s.
        delay: f64,
    },
    /// The event happens when the caller of the stepper triggers it.
    OnCommand,
    /// The event, a capture, happens when its two frames have satisfied the conditions of an envelope for
    /// the time [`Envelope::held_for`].
    Latch(Envelope),
}

impl When {
    /// Returns the time at which an event is scheduled to happen, s; `None` if this time depends on the
    /// run or on other events.
    pub fn time(&self) -> Option<f64> {
        match self {
            Self::At(t) => Some(*t),
            _ => None,
        }
    }
}

/// Conditions under which a latch closes: limits of the distance, angle and relative velocity of the two
/// frames of its capture, and contacts that must touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// Largest distance and angle between the frames, m and rad.
    pub within: [f64; 2],
    /// Largest speed of the captured frame's origin as observed in the capturing frame, m/s, and largest
    /// relative angular speed, rad/s.
    pub slower_than: [f64; 2],
    /// Time for which all conditions must hold without interruption, s.
    pub held_for: f64,
    /// Names of the contacts that must touch, without interruption during `held_for`.
    pub touching: Vec<String>,
}

/// Action of an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Connects two frames rigidly, with the relative pose that they have when the event happens.
    Capture {
        /// Capturing frame. The base of the tree to which it belongs becomes the base of the connected tree.
        by: FrameIndex,
        /// Captured frame.
        of: FrameIndex,
        /// Motion of the captured frame to a nominal pose after the capture; `None` if the relative pose
        /// at the capture is kept.
        seat: Option<Seat>,
    },
    /// Removes the connection that a capture established.
    Release {
        /// Index of the capture among the events.
        capture: usize,
        /// Impulse of a spring on the system of the captured frame, N s and N m s, at the origin and in the
        /// axes of the capturing frame. The opposite impulse acts on the other system.
        impulse: [f64; 6],
    },
    /// Engages a brake.
    Engage(BrakeIndex),
    /// Disengages a brake.
    Disengage(BrakeIndex),
}

/// Motion of a captured frame to its nominal pose, as imposed by latches and grapple fixtures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seat {
    /// Duration of the motion, s.
    pub duration: f64,
    /// Nominal pose of the captured frame in the capturing frame.
    pub pose: RigidPose,
}

/// Pose of a frame relative to another frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidPose {
    /// Rotation from axes of this frame to axes of the other frame, as a quaternion (x, y, z, w).
    pub rotation: [f64; 4],
    /// Position of the origin of this frame in the other frame, m.
    pub position: [f64; 3],
}

/// Motion of a captured frame to its nominal pose, with the start time that the capture determined.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seating {
    /// Start of the motion, s.
    pub start: f64,
    /// Duration of the motion, s.
    pub duration: f64,
    /// Nominal pose of the captured frame in the capturing frame.
    pub pose: RigidPose,
}

/// Rigid connection of two frames of different systems.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Weld {
    /// Index, among the events, of the capture that established the connection.
    pub capture: usize,
    /// Capturing frame.
    pub by: FrameIndex,
    /// Captured frame.
    pub of: FrameIndex,
    /// Pose of the captured frame in the capturing frame; during a seating motion, the pose at the start of
    /// that motion.
    pub pose: RigidPose,
    /// Seating motion to the nominal pose; `None` without such a motion or after it has ended.
    pub seating: Option<Seating>,
}
