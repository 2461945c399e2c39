//! Models of connected systems that the controllers of a system know.

use super::error::SimulationError;
use super::members::Place;
use super::run_state::RunState;
use super::run_system::RunSystem;
use crate::control::KnownTree;
use crate::model::{BASE_NQ, BASE_NV};
use crate::spatial::Scalar;
use crate::world::FrameIndex;

impl<S: Scalar> RunState<'_, S> {
    /// Assembles, for every system whose controllers know the models of other systems, the tree of that
    /// system and of the known systems that are connected to it.
    pub(super) fn find_known(&mut self) -> Result<(), SimulationError> {
        let Self { systems, connections, events, numbers, .. } = self;
        for (number, run) in systems.iter_mut().enumerate().filter(|(_, run)| !run.knows.is_empty()) {
            let found = connections.known_tree(number, &run.knows)?;
            let Some((model, members)) = found else {
                run.controllers.set.know(None);
                run.controllers.set.set_loads(|_, _| None);
                continue;
            };
            let frames = connections.frames_in(number, &model)?;
            run.controllers.set.set_loads(|tool, load| {
                let system = numbers.iter().position(|number| *number == load.system)?;
                let load = FrameIndex { system, frame: load.frame };
                connections.pose_in(&model, FrameIndex { system: number, frame: tool }, load)
            });
            let loops = connections.loops_in(number, &model, |capture| events.list[capture].name.clone());
            let count = run.controllers.set.controls().len();
            let own = members[0].joints.clone();
            run.controllers.set.know(Some(KnownTree::new(model, own, frames, loops, count)));
            run.known_members = members;
        }
        Ok(())
    }

    /// Writes the states of the connected systems to the tree that the controllers of the system with index
    /// `number` know. Adds the external wrenches if the controllers compensate them. Requires up-to-date
    /// states of the parts of trees.
    pub(super) fn update_known(&mut self, number: usize) {
        let members = &self.equations.members;
        let RunSystem { controllers, known_members, .. } = &mut self.systems[number];
        let compensates = controllers.set.compensates_environment();
        let Some(known) = controllers.set.known() else { return };
        let part = |system: usize| match members.places[system] {
            Place::Part(part) => Some(&members.parts[part]),
            Place::Tree(_) => None,
        };
        let copy =
            |to: &mut [f64], from: &[S]| to.iter_mut().zip(from).for_each(|(to, from)| *to = from.value());
        for member in &*known_members {
            let Some(part) = part(member.system) else { continue };
            if member.system == number {
                copy(&mut known.q[..BASE_NQ], &part.state.q);
                copy(&mut known.v[..BASE_NV], &part.state.v);
            }
            for (own, &joint) in member.joints.iter().enumerate() {
                known.q[BASE_NQ + joint] = part.state.q[BASE_NQ + own].value();
                known.v[BASE_NV + joint] = part.state.v[BASE_NV + own].value();
            }
        }
        known.update_kinematics();
        for member in known_members.iter().filter(|_| compensates) {
            if let Some(part) = part(member.system) {
                part.add_wrenches(member, &mut known.data);
            }
        }
    }
}
