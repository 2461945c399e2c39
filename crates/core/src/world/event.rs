//! Events that change how the systems of a world are connected.

use serde::{Deserialize, Serialize};

/// Index of a frame of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FrameIndex {
    /// Number of the system in the world.
    pub system: usize,
    /// Index of the frame in the model of the system.
    pub frame: usize,
}

/// An event: what happens, and when. Each event happens at most once in a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Name, unique among the events.
    pub name: String,
    /// Condition under which the event happens.
    pub when: When,
    /// What happens.
    pub action: Action,
}

/// Condition under which an event happens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    /// At this time, s.
    At(f64),
    /// A delay, s, after another event.
    After {
        /// Number of the other event.
        event: usize,
        /// Delay, s.
        delay: f64,
    },
    /// When the caller of the stepper triggers it.
    OnCommand,
    /// When the two frames of a capture have been within an envelope for long enough.
    Latch(Envelope),
}

impl When {
    /// Returns the time at which an event is declared to happen, s; `None` if it depends on the run or on other events.
    pub fn time(&self) -> Option<f64> {
        match *self {
            Self::At(t) => Some(t),
            _ => None,
        }
    }
}

/// Envelope of a latch: the frames must be close to each other and slow relative to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Envelope {
    /// Largest distance and angle between the frames, m and rad.
    pub within: [f64; 2],
    /// Largest speed of the captured frame's origin as observed in the capturing frame, m/s, and largest relative angular
    /// speed, rad/s.
    pub slower_than: [f64; 2],
    /// Time for which all conditions must hold, s.
    pub held_for: f64,
}

/// What an event does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Connects two frames rigidly at their relative pose of that instant.
    Capture {
        /// Capturing frame, whose tree keeps its base.
        by: FrameIndex,
        /// Captured frame.
        of: FrameIndex,
        /// Motion to a nominal pose after the capture, if any.
        seat: Option<Seat>,
    },
    /// Removes the connection that a capture made.
    Release {
        /// Number of the capture among the events.
        capture: usize,
        /// Impulse of a spring on the system of the captured frame, in the axes of the capturing frame at its origin,
        /// N s and N m s; the opposite impulse acts on the other system.
        impulse: [f64; 6],
    },
}

/// Motion of a captured frame to its nominal pose, as latches and grapple fixtures impose it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seat {
    /// Time that the motion takes, s.
    pub duration: f64,
    /// Nominal pose of the captured frame in the capturing frame.
    pub pose: RigidPose,
}

/// Pose of a frame in another one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidPose {
    /// Rotation to the axes of the other frame, as a quaternion (x, y, z, w).
    pub rotation: [f64; 4],
    /// Origin in the other frame, m.
    pub position: [f64; 3],
}

/// Motion of a captured frame to its nominal pose, once it has begun.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seating {
    /// Start, s.
    pub start: f64,
    /// Duration, s.
    pub duration: f64,
    /// Nominal pose of the captured frame in the capturing frame.
    pub pose: RigidPose,
}

/// Rigid connection of two frames of different systems.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Weld {
    /// Number of the capture that made the connection, among the events.
    pub capture: usize,
    /// Capturing frame.
    pub by: FrameIndex,
    /// Captured frame.
    pub of: FrameIndex,
    /// Pose of the captured frame in the capturing frame, at the start of a seating motion.
    pub pose: RigidPose,
    /// Motion to the nominal pose, until it ends.
    pub seating: Option<Seating>,
}
