//! Events of a run, and the times at which they are due.

use super::error::SimulationError;
use super::recording::EventRecord;
use super::schedule::Schedule;
use crate::world::{Event, FrameIndex, When, WorldError};
use serde::{Deserialize, Serialize};

/// State of one event during a run: whether it has happened, and when it is due.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct EventState {
    /// Time at which the event happened, s; `None` until then. A release of frames that are not connected has
    /// no effect, but is also marked as having happened.
    pub(super) happened: Option<f64>,
    /// Time at which the event is due, s; `None` while it is unknown.
    pub(super) due: Option<f64>,
    /// True while the conditions of a latch hold.
    pub(super) is_held: bool,
}

/// Control whose frame a capture has rigidly connected to the frame that the control follows. All indices
/// are relative to the group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Attached {
    pub(super) control: usize,
    pub(super) frame: FrameIndex,
    pub(super) followed: FrameIndex,
    pub(super) capture: usize,
}

/// Events of a group of systems, with the state of each.
#[derive(Debug, Default)]
pub(super) struct Events {
    pub(super) list: Vec<Event>,
    /// Index of each event among all events of the world.
    pub(super) numbers: Vec<usize>,
    pub(super) states: Vec<EventState>,
    /// Records of the captures, releases, changes of brakes, touch-downs and lift-offs that have happened.
    pub(super) records: Vec<EventRecord>,
    /// Controls that follow a frame to which their own frame has been rigidly connected.
    pub(super) attached: Vec<Attached>,
}

impl Events {
    /// Creates the events at the start of a run.
    pub(super) fn new(list: Vec<Event>, numbers: Vec<usize>) -> Self {
        let states = list.iter().map(|event| EventState { due: event.when.time(), ..EventState::default() });
        Self { states: states.collect(), list, numbers, records: Vec::new(), attached: Vec::new() }
    }

    /// Returns the index of the first event, in the order of declaration, that is due at `t`, s; `None` if
    /// there is none.
    pub(super) fn next_due(&self, t: f64, schedule: &Schedule) -> Option<usize> {
        let is_due = |state: &EventState| {
            state.happened.is_none() && state.due.is_some_and(|due| !schedule.is_later(due, t))
        };
        self.states.iter().position(is_due)
    }

    /// Records that the event with index `number` happened at `t`, s, and sets the due times of the events
    /// that wait for it.
    pub(super) fn happen(&mut self, number: usize, t: f64) {
        self.states[number].happened = Some(t);
        for (event, state) in self.list.iter().zip(&mut self.states) {
            if let When::After { event, delay } = event.when
                && event == number
            {
                state.due = Some(t + delay);
            }
        }
    }

    /// Returns the times, s, at which events that have not yet happened are due.
    pub(super) fn due_times(&self) -> Vec<f64> {
        let open = self.states.iter().filter(|state| state.happened.is_none());
        open.filter_map(|state| state.due).collect()
    }

    /// Returns the indices in the world of the events that have happened.
    pub(super) fn happened(&self) -> Vec<usize> {
        let states = self.states.iter().zip(&self.numbers);
        states.filter(|(state, _)| state.happened.is_some()).map(|(_, number)| *number).collect()
    }

    /// Returns the index in the group of the event `name`; `None` if this group has no such event.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.list.iter().position(|event| event.name == name)
    }

    /// Checks that the event with index `number` happens on command and has not happened yet.
    pub(super) fn check_trigger(&self, number: usize) -> Result<(), SimulationError> {
        let (event, state) = (&self.list[number], &self.states[number]);
        let reason = match event.when {
            _ if state.happened.is_some() => {
                "it has already happened and happens only once; declare another event"
            }
            When::OnCommand => return Ok(()),
            _ => "it does not happen on command; declare it with on_command",
        };
        Err(WorldError::NotTriggered { name: event.name.clone(), reason }.into())
    }
}
