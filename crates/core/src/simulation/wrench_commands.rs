//! Wrenches that the caller of a stepper commands.

use crate::environment::{Bodies, BodyIndex, EnvironmentError, Wrench, Wrenches};
use crate::model::Frame;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Name of the column of the commanded wrenches in the trace.
pub(super) const WRENCH_COMMAND: &str = "wrench_command";

/// Wrench that the caller of a stepper commands at the origin of a frame. The wrench is held until the next
/// command for the same frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WrenchCommand {
    /// Force at the origin of the frame, N.
    pub force: Vector3<f64>,
    /// Torque in addition to the moment of the force, N m.
    pub torque: Vector3<f64>,
    /// Axes of the force and of the torque.
    pub axes: WrenchAxes,
}

/// Axes in which the components of a commanded wrench are constant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum WrenchAxes {
    /// Axes of W.
    #[default]
    World,
    /// Axes of the frame on which the wrench acts.
    Body,
}

/// Commanded wrenches of a run. A wrench that has been set to zero remains in the list.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct WrenchCommands {
    held: Vec<Held>,
    /// Time of the last command, s; `None` before the first.
    changed_at: Option<f64>,
}

/// Commanded wrench that is held: a force, N, at `point`, m, in the axes of `body`, and a torque, N m. Force
/// and torque are in W axes or in the axes of `body`, according to `axes`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Held {
    /// Index of the system in the world, and index of the frame.
    place: (usize, usize),
    body: usize,
    point: [f64; 3],
    force: [f64; 3],
    torque: [f64; 3],
    axes: WrenchAxes,
}

impl WrenchCommands {
    pub(super) fn is_empty(&self) -> bool {
        self.held.is_empty()
    }

    /// Returns the time of the last command, s; `None` before the first.
    pub(super) fn changed_at(&self) -> Option<f64> {
        self.changed_at
    }

    /// Sets the wrench on a frame, effective from `t`, s; `place` consists of the index of the system in the
    /// world and the index of the frame.
    pub(super) fn set(&mut self, t: f64, place: (usize, usize), frame: &Frame, command: WrenchCommand) {
        let WrenchCommand { force, torque, axes } = command;
        let turned = |vector: Vector3<f64>| match axes {
            WrenchAxes::World => vector.into(),
            WrenchAxes::Body => (frame.rot_kf.to_nalgebra() * vector).into(),
        };
        let point = frame.pos_kf.to_nalgebra().into();
        let held =
            Held { place, body: frame.body, point, force: turned(force), torque: turned(torque), axes };
        match self.held.iter_mut().find(|held| held.place == place) {
            Some(before) => *before = held,
            None => self.held.push(held),
        }
        self.changed_at = Some(t);
    }

    /// Adds the commanded wrenches to `wrenches`; `bodies` contains the present states of all bodies of the
    /// run.
    pub(super) fn add_to(&self, bodies: &Bodies, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        for Held { place, body, point, force, torque, axes } in &self.held {
            let index = BodyIndex { system: place.0, body: *body };
            let unknown = || EnvironmentError::UnknownBody { body: index, known: bodies.known(index.system) };
            let body = bodies.get(index).ok_or_else(unknown)?;
            let in_w = |vector: &[f64; 3]| match axes {
                WrenchAxes::World => Vector3::from(*vector),
                WrenchAxes::Body => body.rot_wk * Vector3::from(*vector),
            };
            // T = τ + (o + R p - c) × F
            let force = in_w(force);
            let arm = body.origin + body.rot_wk * Vector3::from(*point) - body.com;
            wrenches.add(index, Wrench { force, torque: in_w(torque) + arm.cross(&force) })?;
        }
        Ok(())
    }

    /// Returns true if all forces, torques and points are finite.
    pub(super) fn is_finite(&self) -> bool {
        let finite =
            |held: &Held| held.force.iter().chain(&held.torque).chain(&held.point).all(|x| x.is_finite());
        self.held.iter().all(finite)
    }
}
