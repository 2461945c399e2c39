//! Normal forces of the contacts on one system, as input to its controllers, and the touching contacts for
//! latches.

use super::Contacts;
use crate::control::NormalForce;

impl Contacts {
    /// Writes the normal forces on the system with index `system` in the group to `out`. They are those at
    /// the state for which [`Self::begin`] determined the modes. `body` maps the index of a frame of the
    /// system to the index of its body.
    pub(in crate::simulation) fn normal_forces(
        &self,
        system: usize,
        body: impl Fn(usize) -> usize,
        out: &mut Vec<NormalForce>,
    ) {
        out.clear();
        for touching in self.near.iter().map(|&number| &self.list[number]) {
            let Some(loading) = touching.last.as_ref().filter(|loading| loading.normal_force() > 0.0) else {
                continue;
            };
            let frames = [0, 1].map(|side| touching.sides[side].declared);
            let bodies = frames.map(|place| (place.system == system).then(|| body(place.frame)));
            let on_b = loading.normal * loading.normal_force();
            for (own, other, force) in [(bodies[0], bodies[1], -on_b), (bodies[1], bodies[0], on_b)] {
                if let Some(body) = own {
                    out.push(NormalForce { body, other, point: loading.point, force });
                }
            }
        }
    }

    /// Returns true if any pieces with a compliant normal force overlap during the step.
    pub(in crate::simulation) fn press(&self) -> bool {
        let is_pressing = |&number: &usize| {
            let touching = &self.list[number];
            touching.law.is_some() && touching.mode.phase.is_closed()
        };
        self.near.iter().any(is_pressing)
    }

    /// Returns the indices of the declared contacts with these names.
    pub(in crate::simulation) fn numbers_of(&self, names: &[String]) -> Vec<usize> {
        names.iter().filter_map(|name| self.names.iter().position(|own| own == name)).collect()
    }

    /// Returns true if the declared contacts with these indices all touch.
    pub(in crate::simulation) fn are_touching(&self, contacts: &[usize]) -> bool {
        contacts.iter().all(|&contact| self.touches[contact].is_closed)
    }
}
