//! Detection of touch-downs and lift-offs at the starts of steps.

use super::Contacts;
use super::touches::Integrals;

impl Contacts {
    /// Finds the contacts that begin to touch or separate at `t`, s, and adds records of these events to
    /// `happened`. Requires the samples and the states of all pairs at `t`.
    pub(super) fn update_touches(&mut self, t: f64) {
        let Self { list, states, touches, samples, happened, names, .. } = self;
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
                    happened.push(touch.lift_off(&names[contact], t, &integrals()));
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
}
