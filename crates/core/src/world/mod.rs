//! World of one or more systems, the events that connect and separate them, and the trees that welds form.

mod assembly;
mod audit;
mod brake;
mod check;
mod error;
mod event;
mod groups;
mod impulse;
mod knowledge;
mod layout;
mod seating;
mod system;

pub use assembly::{Assembly, BodyPlace, Member, assemble};
pub use audit::{Balance, energy, energy_of_change};
pub use brake::Brake;
pub use check::{check_brakes, check_events, check_names};
pub use error::{LatchContact, WorldError};
pub use event::{Action, BrakeIndex, Envelope, Event, FrameIndex, RigidPose, Seat, Seating, Weld, When};
pub use groups::{groups, systems_of};
pub use impulse::{Moving, connected_velocity, impulse_response, loop_impulses};
pub use knowledge::{IdleKnowledge, idle_knowledge};
pub use layout::{Layout, SystemPlace};
pub use seating::GivenJoint;
pub use system::System;
