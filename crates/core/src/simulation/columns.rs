//! Table of the recorded quantities, with the name, path, shape, unit, frame and meaning of each.
//!
//! The recorder, the Python bindings, `trace.npz` and its reader, the viewer, the figures and the
//! documentation use this table.

use crate::model::{BASE_NQ, BASE_NV, Model};
use std::fmt;

/// Length of one axis of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Length {
    /// One entry per row of the trace, `T`.
    Rows,
    /// One entry per change of the reference orbit, `K`.
    Events,
    /// Constant length, equal for all robots.
    Fixed(usize),
    /// Number of coordinates of the robot, `nq`.
    Nq,
    /// Number of velocity components of the robot, `nv`.
    Nv,
    /// Number of joints of the robot, `n`.
    Joints,
    /// Number of bodies of the robot.
    Bodies,
    /// Number of components of the tracking error of a control, `k`: 6 if the control tracks a frame, 1 if it
    /// controls a grip force, otherwise one per joint of the control.
    Errors,
}

impl Length {
    /// Returns the length for the robot `model`; 1 for rows, events and tracking errors, whose number does
    /// not follow from the model.
    fn of(self, model: &Model) -> usize {
        match self {
            Self::Fixed(length) => length,
            Self::Nq => model.nq(),
            Self::Nv => model.nv(),
            Self::Joints => model.joint_count(),
            Self::Bodies => model.nodes().len(),
            Self::Rows | Self::Events | Self::Errors => 1,
        }
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rows => f.write_str("T"),
            Self::Events => f.write_str("K"),
            Self::Fixed(length) => write!(f, "{length}"),
            Self::Nq => f.write_str("nq"),
            Self::Nv => f.write_str("nv"),
            Self::Joints => f.write_str("n"),
            Self::Bodies => f.write_str("bodies"),
            Self::Errors => f.write_str("k"),
        }
    }
}

/// Condition under which a quantity is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// The quantity is recorded in every run.
    Always,
    /// A joint of the system has a spring.
    Springs,
    /// A controller compensates Coulomb friction, a joint of the system has such friction, and the native
    /// engine is used.
    FrictionCompensation,
    /// The system has a tool.
    Tool,
    /// The system has a tool, and the tool or a control of the tool has a reference.
    Reference,
    /// The run has an orbit.
    Orbit,
    /// The gravity mode is `carried` and the orbit is around a planet.
    Carried,
    /// The system has a list of controls.
    Controls,
    /// The option `record_wrenches` is set.
    Wrenches,
    /// The system is the first side of a contact.
    Contacts,
    /// The system has closed loops, or a capture by the system may close one.
    Loops,
}

impl Condition {
    /// Returns the text that describes the condition in the documentation.
    pub fn text(self) -> &'static str {
        match self {
            Self::Always => "always",
            Self::Springs => "with springs at joints",
            Self::FrictionCompensation => "with a controller that compensates friction",
            Self::Tool => "with a tool",
            Self::Reference => "with a tool that follows a reference",
            Self::Orbit => "with an orbit",
            Self::Carried => "with gravity_mode \"carried\" around a planet",
            Self::Controls => "with a list of controls",
            Self::Wrenches => "with record_wrenches",
            Self::Contacts => "for the system of the first link of a contact",
            Self::Loops => "for the system of the first frame of a closed loop",
        }
    }
}

/// Part of the last axis of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Name of the part.
    pub name: &'static str,
    /// Index of the first value.
    pub start: usize,
    /// Index after the last value; `None` if the part extends to the end of the axis.
    pub end: Option<usize>,
}

/// Description of a recorded quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name of the attribute of a trace that holds the column.
    pub name: &'static str,
    /// Name of the column in files; `*` stands for the name of a control, an effect, a contact or a loop.
    pub path: &'static str,
    /// Length of each axis, beginning with the rows.
    pub shape: &'static [Length],
    /// Unit of the values. If there are parts, the units of the parts are listed in order, separated by
    /// semicolons. The unit of dimensionless values is `1`.
    pub unit: &'static str,
    /// Letter of the frame in which the values are expressed: `W`, `B` or `I`; empty if the values do not
    /// depend on a frame.
    pub frame: &'static str,
    /// Description of the quantity.
    pub meaning: &'static str,
    /// Condition under which the quantity is recorded.
    pub condition: Condition,
    /// Parts of the last axis; empty if the column holds a single quantity.
    pub parts: &'static [Part],
}

impl Column {
    /// Returns the shape of one row for the robot `model`.
    pub fn row_shape(&self, model: &Model) -> Vec<usize> {
        self.shape[1..].iter().map(|length| length.of(model)).collect()
    }

    /// Returns the number of values in one row for the robot `model`.
    pub fn row_width(&self, model: &Model) -> usize {
        self.shape[1..].iter().map(|length| length.of(model)).product()
    }

    /// Returns the path of the column of the control, effect, contact or loop with the name `owner`.
    pub fn path_of(&self, owner: &str) -> String {
        self.path.replace('*', owner)
    }

    /// Returns the name of the control, effect, contact or loop whose column has this path; `None` for paths
    /// of other columns.
    pub fn owner_of<'a>(&self, path: &'a str) -> Option<&'a str> {
        self.path.strip_suffix('*').and_then(|prefix| path.strip_prefix(prefix))
    }
}

const fn part(name: &'static str, start: usize, end: Option<usize>) -> Part {
    Part { name, start, end }
}

const WHOLE: &[Part] = &[];
const CONFIGURATION: &[Part] =
    &[part("position", 0, Some(3)), part("quaternion", 3, Some(BASE_NQ)), part("joints", BASE_NQ, None)];
const VELOCITY: &[Part] =
    &[part("linear", 0, Some(3)), part("angular", 3, Some(BASE_NV)), part("joints", BASE_NV, None)];
const LINEAR_ANGULAR: &[Part] = &[part("linear", 0, Some(3)), part("angular", 3, Some(6))];
const FORCE_TORQUE: &[Part] = &[part("force", 0, Some(3)), part("torque", 3, Some(6))];

const CONTACT: &[Part] = &[
    part("gap", 0, Some(1)),
    part("force", 1, Some(4)),
    part("point", 4, Some(7)),
    part("normal", 7, Some(10)),
    part("sliding_speed", 10, Some(11)),
    part("power", 11, Some(12)),
    part("elastic", 12, Some(13)),
    part("dissipated", 13, Some(14)),
    part("impulse", 14, Some(17)),
    part("touches", 17, Some(18)),
    part("largest_force", 18, Some(19)),
];

const LOOP: &[Part] = &[
    part("force", 0, Some(3)),
    part("moment", 3, Some(6)),
    part("point", 6, Some(9)),
    part("opening", 9, Some(11)),
];

/// Converts one axis of a shape in the table to a [`Length`].
macro_rules! length {
    (T) => {
        Length::Rows
    };
    (K) => {
        Length::Events
    };
    (nq) => {
        Length::Nq
    };
    (nv) => {
        Length::Nv
    };
    (n) => {
        Length::Joints
    };
    (bodies) => {
        Length::Bodies
    };
    (k) => {
        Length::Errors
    };
    ($length:literal) => {
        Length::Fixed($length)
    };
}

/// Declares the static table [`COLUMNS`].
macro_rules! table {
    ($($name:ident ($($axis:tt),+), $unit:literal, $frame:literal, $condition:ident, $parts:ident,
        $meaning:literal;)+) => {
        /// Columns that are fields of a trace, in the order of these fields.
        pub static COLUMNS: &[Column] = &[
            $(column!($name, stringify!($name), ($($axis),+), $unit, $frame, $condition, $parts, $meaning)),+
        ];
    };
}

/// Converts one row of the table to a [`Column`].
macro_rules! column {
    (
        $name:ident, $path:expr, ($($axis:tt),+), $unit:literal, $frame:literal, $condition:ident,
        $parts:ident, $meaning:literal
    ) => {
        Column {
            name: stringify!($name),
            path: $path,
            shape: &[$(length!($axis)),+],
            unit: $unit,
            frame: $frame,
            meaning: $meaning,
            condition: Condition::$condition,
            parts: $parts,
        }
    };
}

/// Passes the rows of the table of columns to the macro `then`, which declares a field, a getter or a
/// description for each row. A row consists of name, shape, unit, frame, condition, parts and meaning.
///
/// The path of each of these columns is the name of the column.
#[macro_export]
macro_rules! trace_columns {
    ($then:ident) => {
        $then! {
            time (T), "s", "", Always, WHOLE, "Time since the start of the run.";
            q (T, nq), "m; 1; rad or m", "W", Always, CONFIGURATION,
                "Configuration: position and quaternion (x, y, z, w) of the base, then joint positions.";
            v (T, nv), "m/s; rad/s; rad/s or m/s", "B", Always, VELOCITY,
                "Velocity: linear and angular velocity of the base, then joint rates.";
            tau (T, n), "N m or N", "", Always, WHOLE,
                "Joint torque (force of a prismatic joint), held from the time of this row to the next step.";
            friction_compensation (T, n), "N m or N", "", FrictionCompensation, WHOLE,
                "Part of tau that compensates Coulomb friction.";
            acceleration (T, nv), "m/s²; rad/s²; rad/s² or m/s²", "B", Always, VELOCITY,
                "Time derivative of v just after the time of this row.";
            momentum (T, 6), "N s; N m s", "W", Always, LINEAR_ANGULAR,
                "Linear momentum, and angular momentum about the centre of mass of the system.";
            impulse (T, 6), "N s; N m s", "W", Always, LINEAR_ANGULAR,
                "Time integral, since the start, of the external forces and of their moments about the centre of mass.";
            kinetic_energy (T), "J", "W", Always, WHOLE, "Kinetic energy of the system in W.";
            work (T), "J", "W", Always, WHOLE,
                "Work done on the robot by motors, springs and external wrenches, less the energy dissipated in the joints.";
            dissipated (T), "J", "", Always, WHOLE,
                "Energy dissipated by the damping, friction, brakes and stops of the joints.";
            spring_energy (T), "J", "", Springs, WHOLE,
                "Elastic energy of the springs at the joints, a function of their positions.";
            center_of_mass (T, 3), "m", "W", Always, WHOLE, "Position of the centre of mass of the system.";
            tool_pose (T, 4, 4), "m", "W", Tool, WHOLE, "Pose of the tool as a homogeneous matrix.";
            reference_pose (T, 4, 4), "m", "W", Reference, WHOLE,
                "Desired pose of the tool as a homogeneous matrix.";
            position_error (T, 3), "m", "W", Reference, WHOLE, "Desired minus actual position of the tool.";
            attitude_error (T, 3), "rad", "W", Reference, WHOLE,
                "Rotation vector from the actual to the desired attitude of the tool.";
            position_eci (T, 3), "m", "I", Orbit, WHOLE,
                "Position of the origin of the base from the planet's centre.";
            velocity_eci (T, 3), "m/s", "I", Orbit, WHOLE,
                "Velocity of the origin of the base relative to the planet's centre.";
            reference_position_eci (T, 3), "m", "I", Orbit, WHOLE,
                "Position of the origin of W, on the reference orbit, from the planet's centre.";
            reference_velocity_eci (T, 3), "m/s", "I", Orbit, WHOLE,
                "Velocity of the reference orbit at the origin of W relative to the planet's centre.";
            reference_residual (T, 3), "m/s²", "I", Carried, WHOLE,
                "Acceleration of gravity less that of the reference orbit, a difference that the motion omits.";
        }
    };
}

trace_columns!(table);

/// Tracking errors, one column per control.
pub static TRACKING: Column = column!(
    tracking,
    "tracking_*",
    (T, k),
    "m and rad, or rad and m of the joints, or N",
    "W",
    Controls,
    WHOLE,
    "Desired minus actual: position and rotation vector of a task (axes of B if its reference is relative \
     to the base), one number per joint, or the force of a grip (N); zero while the control is inactive."
);

/// Wrenches on the bodies: one column per effect and, if a control follows external commands, one column for
/// the commanded wrenches.
pub static WRENCHES: Column = column!(
    wrenches,
    "wrench_*",
    (T, bodies, 6),
    "N; N m",
    "W",
    Wrenches,
    FORCE_TORQUE,
    "Force of an effect on each body, and its torque about the body's centre of mass."
);

/// Distances and forces of the contacts, one column per contact.
pub static CONTACTS: Column = column!(
    contacts,
    "contact_*",
    (T, 19),
    "m; N; m; 1; m/s; W; J; J; N s; 1; N",
    "W",
    Contacts,
    CONTACT,
    "Smallest distance between the two sides (negative: depth), force on the second side, point and normal (from the \
     first side to the second) of the nearest pair of pieces, sliding speed at this point, power removed from the \
     motion, elastic energy, and, since the start of the run, dissipated energy, impulse on the second side, number of \
     touches and largest normal force."
);

/// Forces of the closed loops, one column per loop.
pub static LOOPS: Column = column!(
    loops,
    "loop_*",
    (T, 11),
    "N; N m; m; m and rad",
    "W",
    Loops,
    LOOP,
    "Force on the second frame of a loop, moment on this frame about its origin, position of this origin, and \
     distance and angle by which the loop is open; zeros while the loop is not closed."
);

/// Times, s, at which the run changed to a new reference orbit.
pub static REREFERENCED: Column = column!(
    rereferenced,
    "rereferenced",
    (K),
    "s",
    "",
    Always,
    WHOLE,
    "Times at which integration changed to a new reference orbit, because the robot had drifted too far from \
     the previous one; recorded quantities still refer to W."
);

/// Returns the descriptions of all recorded quantities.
pub fn columns() -> impl Iterator<Item = &'static Column> {
    COLUMNS.iter().chain([&TRACKING, &WRENCHES, &CONTACTS, &LOOPS, &REREFERENCED])
}
