//! Checks of a simulation before it starts.

use super::check_references::{check_control_references, check_reference};
use super::error::SimulationError;
use super::modes::AT_LIMIT;
use super::settings::Simulation;
use super::state_range::{UNIT_NORM, attitude_norm, check_range, unit_of};
use crate::contact::{Contact, ContactError};
use crate::control::{ControlError, check_controls};
use crate::environment::BodyIndex;
use crate::model::{BASE_NQ, Model};
use crate::world::{
    Action, Event, LatchContact, Seat, System, When, WorldError, check_brakes, check_events, check_names,
};

/// Accepted time steps, s. A value outside this range was probably given in a wrong unit.
const STEPS: std::ops::RangeInclusive<f64> = 1e-12..=1e9;

impl Simulation {
    /// Checks all settings that can be checked before the run. Also sets the initial motion of the frames in
    /// which references are given.
    ///
    /// # Errors
    /// A [`SimulationError`] for the first invalid setting:
    ///
    /// - an initial state of the wrong length, outside its range, or with a quaternion that does not have
    ///   unit norm,
    /// - a joint that starts beyond its limits when these are enforced,
    /// - a time step, tolerance or other number outside its range,
    /// - an effect or a gravity field without the orbit that it requires, or a gravity field that does not
    ///   match the orbit,
    /// - an effect that acts on no system, or two effects that count the same force on a body twice,
    /// - an Earth whose epoch or axes differ from those of the orbit,
    /// - invalid names, brakes, events, contacts or controls,
    /// - a closed loop or mimic joint whose constraint the initial state violates,
    /// - a setting that an external engine does not support,
    /// - a tool or a tracked frame that does not exist, or a reference in an unknown frame,
    /// - a reference without a tool, or a controller that tracks a frame other than the tool,
    /// - a reference that starts too far from the frame or the joints that follow it,
    /// - a gripper without opposing fingers, or one whose opening is narrower than the object.
    pub fn check(&self) -> Result<(), SimulationError> {
        self.check_each(|system| check_state(&system.model, &system.q, &system.v))?;
        SimulationError::check_positive("time_step", self.time_step)?;
        self.check_each(|system| {
            let period = system.control_period;
            period.map_or(Ok(()), |period| SimulationError::check_positive("control_period", period))
        })?;
        if !STEPS.contains(&self.time_step) {
            return Err(SimulationError::TimeStep { value: self.time_step });
        }
        if !(1e-13..=0.1).contains(&self.tolerance) {
            return Err(SimulationError::Tolerance { value: self.tolerance });
        }
        if self.rereference_beyond.is_nan() || self.rereference_beyond < 1.0 {
            return Err(SimulationError::RereferenceBeyond { value: self.rereference_beyond });
        }
        self.check_each(check_stops)?;
        if self.record_every == 0 {
            return Err(SimulationError::RecordEvery);
        }
        let mu = self.orbit.as_ref().and_then(|orbit| orbit.mu());
        let has_planet = mu.is_some();
        if let Some(gravity) = &self.gravity {
            let missing = || SimulationError::NeedsOrbit { effect: "a gravity field".to_owned() };
            gravity.check_orbit(mu.ok_or_else(missing)?)?;
        }
        if let Some(effect) = self.effects.iter().find(|effect| effect.requires_orbit() && !has_planet) {
            return Err(SimulationError::NeedsOrbit { effect: format!("the effect '{}'", effect.name()) });
        }
        self.check_effects()?;
        if let (Some(orbit), Some(earth)) = (&self.orbit, &self.earth) {
            earth.check_orbit(orbit.axes(), orbit.epoch())?;
        }
        check_names(&self.systems)?;
        self.check_each(|system| Ok(check_brakes(system)?))?;
        check_events(&self.systems, &self.events)?;
        check_seats(&self.events, self.time_step)?;
        check_contacts(&self.contacts)?;
        check_latches(&self.events, &self.contacts)?;
        self.check_each(|system| system.closed_start().map(|_| ()))?;
        if self.engine.is_some() {
            self.check_engine()?;
        }
        self.place_moving_frames()?;
        self.check_each(check_system)?;
        self.check_each(|system| self.check_grips(system))?;
        self.check_loads()
    }

    /// Returns an error for a control that moves a load of a system that its own system does not know.
    fn check_loads(&self) -> Result<(), SimulationError> {
        for System { name: system, controls, knows, .. } in &self.systems {
            let loads = controls.iter().filter_map(|control| Some((control, control.load?.system)));
            if let Some((control, other)) = loads.into_iter().find(|(_, other)| !knows.contains(other)) {
                let (control, system) = (control.name.clone(), system.clone());
                let other =
                    self.systems.get(other).map_or_else(|| other.to_string(), |other| other.name.clone());
                return Err(ControlError::UnknownLoad { control, system, other }.into());
            }
        }
        Ok(())
    }

    /// Applies `check` to each system. If there are several systems, an error contains the name of the system
    /// that it concerns.
    fn check_each(
        &self,
        check: impl Fn(&System) -> Result<(), SimulationError>,
    ) -> Result<(), SimulationError> {
        self.systems.iter().try_for_each(|system| {
            check(system).map_err(|source| match self.systems.len() {
                1 => source,
                _ => SimulationError::OfSystem { system: system.name.clone(), source: Box::new(source) },
            })
        })
    }

    /// Returns an error for settings that an external engine does not support, for contacts, loops and mimic
    /// joints that were not passed to it, and for contacts that it computes but the world does not declare.
    fn check_engine(&self) -> Result<(), SimulationError> {
        let cannot = |name: &str, what, remedy| {
            Err(SimulationError::EngineOfWorld { name: name.to_owned(), what, remedy })
        };
        let computed = self.engine.as_ref().map_or_else(Vec::new, |engine| engine.contacts());
        if let Some(contact) = self.contacts.iter().find(|contact| contact.impact.is_some()) {
            let remedy = "use a compliant normal force, such as HuntCrossley";
            return cannot(&contact.name, "a contact with an impact law", remedy);
        }
        let with_forces = self.contacts.iter().filter(|contact| contact.law.is_some());
        if let Some(contact) = with_forces.clone().find(|contact| !computed.contains(&contact.name)) {
            let what = "a contact with forces that was not passed to it";
            return cannot(&contact.name, what, "pass the contacts of the world to the engine");
        }
        if let Some(name) =
            computed.iter().find(|name| with_forces.clone().all(|contact| contact.name != **name))
        {
            let what = "a contact that the world does not declare";
            return cannot(name, what, "pass the contacts of the world to the engine");
        }
        for event in &self.events {
            match event.action {
                Action::Capture { seat: Some(_), .. } => {
                    return cannot(&event.name, "a capture that seats its frames", "remove the seat");
                }
                Action::Release { impulse, .. } if impulse != [0.0; 6] => {
                    return cannot(&event.name, "a release with an impulse", "remove the impulse");
                }
                _ => {}
            }
        }
        let satisfied = self.engine.as_ref().map_or_else(Vec::new, |engine| engine.loops());
        for System { name: system, model, .. } in &self.systems {
            let is_satisfied =
                |name: &String| satisfied.contains(name) || satisfied.contains(&format!("{system}/{name}"));
            if let Some(closure) = model.closures().iter().find(|closure| !is_satisfied(&closure.name)) {
                let what = "a closed loop or mimic joint that was not passed to it";
                return cannot(&closure.name, what, "create the engine from the models with their loops");
            }
        }
        let has_brakes = self.engine.as_ref().is_some_and(|engine| engine.supports_brakes());
        let braked = self.systems.iter().find(|system| !system.brakes.is_empty());
        if let Some(system) = braked.filter(|_| !has_brakes) {
            let name = &system.brakes[0].name;
            return cannot(name, "a brake", "replace the brake by joint friction");
        }
        match self.systems.iter().find(|system| !system.knows.is_empty()) {
            Some(system) => {
                cannot(&system.name, "a system whose controllers know other systems", "remove 'knows'")
            }
            None => Ok(()),
        }
    }

    /// Returns an error for effects that act on none of the systems, and for pairs of effects that would
    /// count the same force on a body twice. The effects include the gravity that an orbit around a planet
    /// adds.
    fn check_effects(&self) -> Result<(), SimulationError> {
        let (effects, count) = (self.all_effects(), self.systems.len());
        for (k, effect) in effects.iter().enumerate() {
            if !(0..count).any(|system| effect.acts_on(system)) {
                return Err(SimulationError::EffectOnNoSystem { effect: effect.name().to_owned(), count });
            }
            for before in effects[..k].iter().filter(|before| before.name() == effect.name()) {
                let both = |body: &BodyIndex| before.counts_once_on(*body) && effect.counts_once_on(*body);
                if let Some(body) = self.bodies().find(both) {
                    let (effect, body) = (effect.name().to_owned(), self.body_path(body));
                    return Err(SimulationError::EffectTwice { effect, body });
                }
            }
        }
        Ok(())
    }

    /// Returns the indices of all bodies of all systems.
    fn bodies(&self) -> impl Iterator<Item = BodyIndex> {
        let bodies = |(system, declared): (usize, &System)| {
            (0..declared.model.nodes().len()).map(move |body| BodyIndex { system, body })
        };
        self.systems.iter().enumerate().flat_map(bodies)
    }

    /// Returns the name of a body, preceded by the name of its system if there are several systems.
    fn body_path(&self, BodyIndex { system, body }: BodyIndex) -> String {
        let System { name, model, .. } = &self.systems[system];
        let body = &model.body_frame(body).name;
        if self.systems.len() == 1 { body.clone() } else { format!("{name}/{body}") }
    }
}

/// Checks the laws and shapes of the contacts, and that the names of the contacts are unique.
fn check_contacts(contacts: &[Contact]) -> Result<(), ContactError> {
    for (number, contact) in contacts.iter().enumerate() {
        if contacts[..number].iter().any(|before| before.name == contact.name) {
            return Err(ContactError::DuplicateName { name: contact.name.clone() });
        }
        contact.check()?;
    }
    Ok(())
}

/// Checks that the contacts on which latches depend exist, have compliant normal forces and act between the
/// two systems of the capture.
fn check_latches(events: &[Event], contacts: &[Contact]) -> Result<(), WorldError> {
    for Event { name, when, action } in events {
        let (When::Latch(envelope), Action::Capture { by, of, .. }) = (when, action) else { continue };
        for contact in &envelope.touching {
            let problem = match contacts.iter().find(|declared| declared.name == *contact) {
                None => LatchContact::Unknown {
                    known: contacts.iter().map(|contact| contact.name.clone()).collect(),
                },
                Some(declared) if declared.law.is_none() => LatchContact::NoForce,
                Some(declared) => {
                    let systems = declared.systems();
                    if [by, of].iter().all(|place| systems.contains(&place.system)) && systems.len() == 2 {
                        continue;
                    }
                    LatchContact::OtherSystems
                }
            };
            let (event, contact) = (name.clone(), contact.clone());
            return Err(WorldError::LatchContact { event, contact, problem });
        }
    }
    Ok(())
}

/// Checks that every seating motion lasts at least a thousandth of `time_step`, so that the schedule can
/// resolve it.
fn check_seats(events: &[Event], time_step: f64) -> Result<(), SimulationError> {
    for Event { name, action, .. } in events {
        let Action::Capture { seat: Some(Seat { duration, .. }), .. } = action else { continue };
        if *duration < 1e-3 * time_step {
            let (event, what, unit) = (name.clone(), "the duration of the seat", "s");
            let expected = "at least a thousandth of time_step";
            return Err(WorldError::Number { event, what, value: *duration, unit, expected }.into());
        }
    }
    Ok(())
}

/// Checks the controls and the reference of a system.
fn check_system(system: &System) -> Result<(), SimulationError> {
    check_system_controls(system)?;
    match (system.tool, &system.reference) {
        (None, Some(_)) => Err(SimulationError::NeedsTool),
        (Some(tool), Some(reference)) => {
            check_reference(&system.model, &system.q, tool, reference, system.reference_start_tolerance)
        }
        _ => Ok(()),
    }
}

/// Checks the controls of a system, the frames that they track, and the initial values of their references.
fn check_system_controls(system: &System) -> Result<(), SimulationError> {
    let System { model, q, controls, .. } = system;
    let count = model.frames().len();
    let tracked = || controls.iter().filter_map(|control| Some((control, control.law.task()?.0)));
    let frames = tracked().map(|(_, frame)| frame);
    if let Some(frame) = system.tool.into_iter().chain(frames).find(|&frame| frame >= count) {
        return Err(SimulationError::UnknownFrame { frame, count });
    }
    check_controls(controls, model)?;
    for (_, frame) in tracked().filter(|(control, _)| !control.has_column) {
        let tool = system.tool.ok_or(SimulationError::NeedsTool)?;
        if tool != frame {
            let name = |frame: usize| model.frames()[frame].name.clone();
            return Err(SimulationError::OtherTool { controller: name(frame), tool: name(tool) });
        }
    }
    check_control_references(model, q, controls, system.reference_start_tolerance)
}

/// If the joint limits are enforced, checks that the coefficient of restitution is between 0 and 1 and that
/// the joints start within their limits.
fn check_stops(system: &System) -> Result<(), SimulationError> {
    let Some(restitution) = system.stops else { return Ok(()) };
    if !(0.0..=1.0).contains(&restitution) {
        return Err(SimulationError::Restitution { value: restitution });
    }
    let joints = system.model.joints().iter().zip(&system.q[BASE_NQ..]);
    for (number, (joint, &value)) in joints.enumerate() {
        let Some((lower, upper)) = joint.limits.position else { continue };
        if value < lower - AT_LIMIT || value > upper + AT_LIMIT {
            let (joint, unit) = (joint.name.clone(), unit_of(&system.model, number));
            return Err(SimulationError::OutsideLimits { joint, value, unit, lower, upper });
        }
    }
    Ok(())
}

fn check_state(model: &Model, q: &[f64], v: &[f64]) -> Result<(), SimulationError> {
    for (name, values, expected) in [("q", q, model.nq()), ("v", v, model.nv())] {
        if values.len() != expected {
            return Err(SimulationError::WrongLength { name, expected, got: values.len() });
        }
        if let Some(index) = values.iter().position(|x| !x.is_finite()) {
            return Err(SimulationError::NotFinite { name, index, value: values[index] });
        }
    }
    check_range(model, q, v)?;
    let norm = attitude_norm(q);
    if (norm - 1.0).abs() > UNIT_NORM { Err(SimulationError::QuaternionNorm { norm }) } else { Ok(()) }
}
