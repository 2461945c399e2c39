//! Conversion of connections and engaged brakes to the form in which the external engine receives them.

use super::engine::{BodyWeld, EngagedBrake};
use super::error::SimulationError;
use super::mover::Mover;
use super::record::complete_rows;
use super::run_state::RunState;
use crate::environment::BodyIndex;
use crate::spatial::{Quat, Scalar, Vec3};
use crate::world::{FrameIndex, Weld};

impl<S: Scalar> RunState<'_, S> {
    /// Passes the active connections to the external engine, if there is one, and marks the pairs of contact
    /// pieces that the connections hold together.
    pub(super) fn pass_welds(&mut self) {
        let welds: Vec<_> = self.connections.active.welds.iter().map(|weld| self.body_weld(weld)).collect();
        let frames = |system: usize| self.equations.trees[system].model.frames();
        let bodies = welds.iter().map(|weld| weld.bodies.map(|body| (body.system, body.body))).collect();
        let held =
            self.equations.contacts.held_by(bodies, |(system, frame)| (system, frames(system)[frame].body));
        self.equations.contacts.set_held(&held);
        if let Mover::External(engine) = &mut self.mover {
            engine.welds = welds;
        }
    }

    /// Passes the engaged brakes to the external engine, if there is one.
    pub(super) fn pass_brakes(&mut self) {
        let Self { mover, systems, numbers, .. } = self;
        if let Mover::External(engine) = mover {
            let engaged = systems.iter().zip(numbers.iter()).flat_map(|(run, &system)| {
                let engaged = run.brakes.iter().filter(|brake| brake.is_engaged);
                engaged.map(move |brake| EngagedBrake {
                    system,
                    joint: brake.joint,
                    slip_torque: brake.slip_torque,
                })
            });
            engine.brakes = engaged.collect();
        }
    }

    /// Converts a connection of two frames to a connection of their bodies, in axes of their links.
    fn body_weld(&self, weld: &Weld) -> BodyWeld {
        let frame = |place: FrameIndex| {
            let model = self.model(place.system);
            let frame = &model.frames()[place.frame];
            (frame.body, model.pose_in_link(frame))
        };
        let [(by_body, (rot_by, pos_by)), (of_body, (rot_of, pos_of))] = [weld.by, weld.of].map(frame);
        let rot_by_of = Quat::from_xyzw(&weld.pose.rotation).matrix();
        let point = rot_by * Vec3::from_slice(&weld.pose.position) + pos_by;
        let body = |system: usize, body: usize| BodyIndex { system: self.numbers[system], body };
        BodyWeld {
            bodies: [body(weld.by.system, by_body), body(weld.of.system, of_body)],
            points: [point, pos_of],
            rotation: rot_by * rot_by_of * rot_of.transpose(),
        }
    }

    /// Adds a row of every system for the current state at `t`, s, before an event, with the accelerations
    /// that the external engine returns.
    pub(super) fn record_before_event(&mut self, t: f64) -> Result<(), SimulationError> {
        self.record(t)?;
        let Self { state, equations, mover, systems, row_states, .. } = self;
        let mut copy = state.clone();
        let asked = mover.advance(equations, &mut copy, (t, t)); // requests only the acceleration
        complete_rows(systems, mover, equations, row_states);
        asked.map(|_| ())
    }
}
