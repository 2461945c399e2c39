//! Computation of the rows of the contacts in the traces.

use super::Contacts;
use super::touches::Touch;
use super::touching::{Loading, Touching};
use crate::contact::ContactError;
use crate::simulation::contact_state::ContactState;
use crate::simulation::state::State;
use crate::simulation::tree::Tree;
use crate::spatial::{Real, Vec3};

/// Row of a contact: sums over its pairs of pieces, and the geometry of the pair with the smallest gap.
struct Row {
    gap: f64,
    force: Vec3<f64>,
    point: Vec3<f64>,
    normal: Vec3<f64>,
    sliding_speed: f64,
    power: f64,
    elastic: f64,
    dissipated: f64,
    impulse: Vec3<f64>,
}

impl Contacts {
    /// Returns the number of declared contacts.
    pub(in crate::simulation) fn count(&self) -> usize {
        self.names.len()
    }

    /// Returns the index of the system in whose trace a contact is recorded: that of its first side.
    pub(in crate::simulation) fn owner(&self, contact: usize) -> usize {
        let own = self.list.iter().find(|touching| touching.contact == contact);
        own.map_or(0, |touching| touching.sides[0].declared.system)
    }

    /// Returns the row of the contact with index `contact` at `state`, in the order of the parts of
    /// [`CONTACTS`](crate::simulation::CONTACTS). Requires the kinematics of `state` in the trees, and the
    /// loadings computed last.
    pub(in crate::simulation) fn row<S: Real>(
        &mut self,
        contact: usize,
        trees: &[Tree<'_, S>],
        state: &State<S>,
    ) -> Result<[f64; 19], ContactError> {
        let mut row = Row {
            gap: f64::INFINITY,
            force: Vec3::zero(),
            point: Vec3::zero(),
            normal: Vec3::zero(),
            sliding_speed: 0.0,
            power: 0.0,
            elastic: 0.0,
            dissipated: 0.0,
            impulse: Vec3::zero(),
        };
        self.frames.forget();
        self.keep(&state.contacts);
        let least = self.bound_gaps(contact, trees, state)?;
        let Self { list, states, has_touched, gaps, frames, .. } = self;
        let first = gaps.pairs[contact].start;
        for (bound, number) in gaps.bounds.iter().zip(first..) {
            if *bound > least && !has_touched[number] {
                continue;
            }
            let (touching, own) = (&list[number], &states[number]);
            match touching.last {
                Some(loading) => row.add(touching, &loading, own),
                None if *bound > least => row.add_integrals(own, [0.0; 2]),
                None => {
                    let motions = touching.motions(frames, trees, state);
                    row.add(touching, &touching.evaluate(&motions, own)?, own);
                }
            }
        }
        Ok(row.values(&self.touches[contact]))
    }
}

impl Row {
    fn add(&mut self, touching: &Touching, loading: &Loading, state: &ContactState) {
        if -loading.depth < self.gap {
            self.gap = -loading.depth;
            (self.point, self.normal) = (loading.point, loading.normal);
            self.sliding_speed = loading.sliding.norm();
        }
        self.force += loading.force;
        self.power += loading.pressure.map_or(0.0, |pressure| pressure.power) + loading.friction_power();
        let [normal, bristles] = touching.elastic_energies(loading);
        self.elastic += normal + bristles;
        self.add_integrals(state, [normal, bristles]);
    }

    /// Adds the integrals of a pair of pieces whose normal force and bristles store these elastic energies,
    /// J.
    fn add_integrals(&mut self, state: &ContactState, [normal, bristles]: [f64; 2]) {
        self.dissipated += (state.normal_work - normal) + (state.friction_work - bristles);
        self.impulse += state.impulse;
    }

    fn values(&self, touch: &Touch) -> [f64; 19] {
        let Self { gap, force, point, normal, sliding_speed, power, elastic, dissipated, impulse } = *self;
        let mut values = [0.0; 19];
        values[0] = gap;
        for (vector, start) in [(force, 1), (point, 4), (normal, 7), (impulse, 14)] {
            vector.write(&mut values[start..start + 3]);
        }
        values[10..14].copy_from_slice(&[sliding_speed, power, elastic, dissipated]);
        values[17..].copy_from_slice(&[touch.count as f64, touch.largest_force]);
        values
    }
}

impl Touching {
    /// Returns the elastic energies of the normal force and of the bristles, J.
    pub(super) fn elastic_energies(&self, loading: &Loading) -> [f64; 2] {
        let Some(law) = self.law.as_ref().filter(|_| self.mode.phase.is_closed()) else { return [0.0; 2] };
        let friction = law.friction.as_ref().zip(loading.friction.as_ref());
        let bristles =
            friction.map_or(0.0, |(friction, found)| friction.elastic_energy(found.bristle.deflection));
        let torsion = law.friction.and_then(|friction| friction.torsion()).zip(loading.torsion);
        let twist = torsion.map_or(0.0, |(torsion, found)| torsion.elastic_energy(found.bristle.deflection));
        [loading.pressure.map_or(0.0, |pressure| pressure.elastic), bristles + twist]
    }
}
