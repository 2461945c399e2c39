//! Detection of touch-downs and lift-offs at the starts of steps.

use super::Contacts;
use super::strike::TouchedPoint;
use super::touches::{Integrals, Sample};
use crate::contact::ImpactLaw;
use crate::simulation::recording::EventRecord;

impl Contacts {
    /// Finds the contacts that begin to touch or separate at `t`, s, and adds records of these events to
    /// `happened`, except for touches after the first 1000 of a contact. Requires the samples and the states
    /// of all pairs at `t`.
    pub(super) fn update_touches(&mut self, t: f64) {
        let Self { list, states, touches, samples, happened, names, rigid, .. } = self;
        for (contact, (touch, sample)) in touches.iter_mut().zip(samples).enumerate() {
            let integrals = || {
                let own = list.iter().zip(&*states).filter(|(touching, _)| touching.contact == contact);
                let mut sum = own.fold(Integrals::ZERO, |sum, (_, state)| sum.with(state));
                sum.loss -= sample.elastic;
                sum
            };
            if touch.is_closed {
                touch.follow(t, sample);
                if sample.pieces == 0 && touch.is_listed() {
                    let mut record = touch.lift_off(&names[contact], t, &integrals());
                    record.peak_force = record.peak_force.filter(|_| !rigid[contact]);
                    happened.push(record);
                }
                touch.is_closed = sample.pieces > 0;
            } else if sample.is_noticeable() {
                touch.begin(t, sample, integrals());
                if touch.is_listed() {
                    happened.push(touch.touch_down(&names[contact], t));
                }
            }
        }
    }

    /// Begins the touches of those contacts with an impact law that touch at `t`, s, without separating, but
    /// did not touch before, and adds records of their touch-downs to `happened`. `points` has all points at
    /// which such contacts touch.
    pub(super) fn begin_touches(&mut self, t: f64, points: &[TouchedPoint]) {
        for point in points.iter().filter(|point| point.velocity[0] <= ImpactLaw::REST_SPEED) {
            let touching = &self.list[point.number];
            let contact = touching.contact;
            if self.touches[contact].is_closed {
                continue;
            }
            let systems = [0, 1].map(|side: usize| touching.sides[side].declared.system);
            let before = self.integrals(contact);
            let touch = &mut self.touches[contact];
            touch.begin(t, &Sample::at(point.place.at, systems), before);
            if touch.is_listed() {
                self.happened.push(touch.touch_down(&self.names[contact], t));
            }
        }
    }

    /// Ends the touches of those contacts in `points` whose pieces no longer rest on each other, and adds
    /// records of their lift-offs at `t`, s, to `happened`.
    pub(super) fn end_touches(&mut self, t: f64, points: &[TouchedPoint]) {
        for point in points {
            let contact = self.list[point.number].contact;
            let mut own = self.list.iter().filter(|touching| touching.contact == contact);
            if !self.touches[contact].is_closed || own.any(|touching| touching.is_resting()) {
                continue;
            }
            let now = self.integrals(contact);
            let touch = &mut self.touches[contact];
            if touch.is_listed() {
                let record = touch.lift_off(&self.names[contact], t, &now);
                self.happened.push(EventRecord { peak_force: None, ..record });
            }
            touch.is_closed = false;
        }
    }

    /// Returns the integrals of a contact with an impact law, summed over its pairs of pieces.
    fn integrals(&self, contact: usize) -> Integrals {
        let own = self.list.iter().zip(&self.states).filter(|(touching, _)| touching.contact == contact);
        own.fold(Integrals::ZERO, |sum, (_, state)| sum.with(state))
    }
}
