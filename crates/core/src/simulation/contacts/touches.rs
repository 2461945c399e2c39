//! Touches of the declared contacts. A touch lasts from the instant at which the first pieces touch to the
//! instant at which the last pieces separate.

use super::side::SideMotion;
use super::touching::{Loading, Touching};
use crate::simulation::contact_state::ContactState;
use crate::simulation::recording::{EventKind, EventRecord};
use crate::spatial::Vec3;
use serde::{Deserialize, Serialize};

/// Largest number of touches of a contact that are recorded as events. Later touches are only counted.
const MOST_LISTED: usize = 1000;
/// Depth, relative to the rounding error of the distance, that a touch must reach to be counted. Rounding
/// errors make bodies that rest beside each other without a load touch and separate at random.
const LEAST_DEPTH: f64 = 1e3;
/// Largest ratio of the lengths of two steps for which a parabola through their ends is used.
const UNEQUAL: f64 = 8.0;

/// Present or last touch of a contact, and totals of all of its touches.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::simulation) struct Touch {
    /// True while pieces touch.
    pub(super) is_closed: bool,
    /// Number of touches so far.
    pub(super) count: usize,
    /// Largest normal force of all touches so far, N.
    pub(super) largest_force: f64,
    /// Largest normal force since the last touch-down, N.
    peak_force: f64,
    /// Indices in the group of the systems of the pieces that touched first.
    systems: [usize; 2],
    /// Point of the last touch-down, in W, m, about which the moments of the contact are integrated.
    pub(super) center: Vec3<f64>,
    /// Present or last point of contact, in W, m.
    point: Vec3<f64>,
    /// Integrals of the contact at the last touch-down.
    before: Integrals,
    /// Number of pairs of pieces that touched at the start of the last step.
    pieces: usize,
    /// Time, s, and normal force, N, at the starts of the last two steps.
    forces: [(f64, f64); 2],
}

/// Impulses and dissipated energy of a contact, summed over its pairs of pieces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Integrals {
    /// Impulse on the second side, N s.
    impulse: Vec3<f64>,
    /// Angular impulse on the second side, N m s.
    angular_impulse: Vec3<f64>,
    /// Energy that the forces have dissipated, J: the energy taken from the motion less the elastic energy.
    pub(super) loss: f64,
}

/// State of a contact at the start of a step, summed over its pieces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// Number of pairs of pieces that touch.
    pub(super) pieces: usize,
    /// Largest depth that the pieces reach in their present motion, relative to the rounding error of the
    /// distance.
    depth: f64,
    /// Sum of the normal forces, N.
    force: f64,
    /// Sum of the elastic energies, J.
    pub(super) elastic: f64,
    /// Smallest gap, m; `point` and `systems` are those of the pieces with this gap.
    gap: f64,
    point: Vec3<f64>,
    systems: [usize; 2],
}

impl Touch {
    /// State of a contact that has not touched.
    pub(super) const NONE: Self = {
        let zero = Vec3 { x: 0.0, y: 0.0, z: 0.0 };
        Self {
            is_closed: false,
            count: 0,
            largest_force: 0.0,
            peak_force: 0.0,
            systems: [0; 2],
            center: zero,
            point: zero,
            before: Integrals::ZERO,
            pieces: 0,
            forces: [(0.0, 0.0); 2],
        }
    };

    /// Returns the indices in the group of the systems of the pieces that touched first.
    pub(in crate::simulation) fn systems(&self) -> [usize; 2] {
        self.systems
    }

    /// Begins a touch at `t`, s, at which the integrals of the contact are `before`.
    pub(super) fn begin(&mut self, t: f64, sample: &Sample, before: Integrals) {
        let Sample { point, systems, pieces, force, .. } = *sample;
        let (is_closed, count, center) = (true, self.count + 1, point);
        let (largest_force, peak_force) = (self.largest_force.max(force), force);
        let forces = [(t, force); 2];
        *self = Self {
            is_closed,
            count,
            largest_force,
            peak_force,
            systems,
            center,
            point,
            before,
            pieces,
            forces,
        };
    }

    /// Updates the touch with the sample at the start of a step at `t`, s.
    pub(super) fn follow(&mut self, t: f64, sample: &Sample) {
        let now = (t, sample.force);
        let [before, last] = self.forces;
        self.add_force(now.1);
        if sample.pieces > 0 && sample.pieces != self.pieces {
            self.forces = [now; 2]; // the force may jump where pieces touch or separate
        } else if t > last.0 {
            self.add_force(vertex([before, last, now]));
            self.forces = [last, now];
        }
        self.pieces = sample.pieces;
        if sample.gap.is_finite() {
            self.point = sample.point;
        }
    }

    /// Returns true if the touch-down and the lift-off of the touch are recorded as events.
    pub(super) fn is_listed(&self) -> bool {
        self.count <= MOST_LISTED
    }

    fn add_force(&mut self, force: f64) {
        self.peak_force = self.peak_force.max(force);
        self.largest_force = self.largest_force.max(force);
    }

    /// Returns the record of the touch-down at `time`, s, of the contact `name`.
    pub(super) fn touch_down(&self, name: &str, time: f64) -> EventRecord {
        let Self { systems, center, .. } = *self;
        let mut point = [0.0; 3];
        center.write(&mut point);
        EventRecord {
            name: name.to_owned(),
            kind: EventKind::TouchDown,
            time,
            systems,
            impulse: [0.0; 6],
            point,
            energy_lost: 0.0,
            momentum_error: [0.0; 2],
            twist_left: [0.0; 2],
            energy_error: 0.0,
            peak_force: None,
        }
    }

    /// Returns the record of the lift-off at `time`, s, of the contact `name`, with the changes of the
    /// integrals since the touch-down.
    pub(super) fn lift_off(&self, name: &str, time: f64, now: &Integrals) -> EventRecord {
        let change = |of: fn(&Integrals) -> Vec3<f64>| of(now) - of(&self.before);
        let linear = change(|integrals| integrals.impulse);
        let about_center = change(|integrals| integrals.angular_impulse);
        let (mut impulse, mut point) = ([0.0; 6], [0.0; 3]);
        linear.write(&mut impulse);
        (about_center + (self.center - self.point).cross(linear)).write(&mut impulse[3..]);
        self.point.write(&mut point);
        EventRecord {
            kind: EventKind::LiftOff,
            impulse,
            point,
            energy_lost: now.loss - self.before.loss,
            peak_force: Some(self.peak_force),
            ..self.touch_down(name, time)
        }
    }
}

impl Integrals {
    pub(super) const ZERO: Self = {
        let zero = Vec3 { x: 0.0, y: 0.0, z: 0.0 };
        Self { impulse: zero, angular_impulse: zero, loss: 0.0 }
    };

    /// Returns the sum of these integrals and those of another pair of pieces.
    pub(super) fn with(mut self, state: &ContactState) -> Self {
        self.impulse += state.impulse;
        self.angular_impulse += state.angular_impulse;
        self.loss += state.normal_work + state.friction_work;
        self
    }
}

impl Sample {
    /// Sample of a contact whose pieces are far apart.
    pub(super) const FAR: Self = Self {
        pieces: 0,
        depth: 0.0,
        force: 0.0,
        elastic: 0.0,
        gap: f64::INFINITY,
        point: Vec3 { x: 0.0, y: 0.0, z: 0.0 },
        systems: [0; 2],
    };

    /// Returns the sample of a contact of which one pair of pieces touches at `point`, in W, m.
    pub(super) fn at(point: Vec3<f64>, systems: [usize; 2]) -> Self {
        Self { pieces: 1, gap: 0.0, point, systems, ..Self::FAR }
    }

    /// Returns true if pieces touch and their depth is not merely a rounding error.
    pub(super) fn is_noticeable(&self) -> bool {
        self.pieces > 0 && self.depth > LEAST_DEPTH
    }

    /// Reduces the number of touching pairs by one.
    pub(super) fn remove_piece(&mut self) {
        self.pieces = self.pieces.saturating_sub(1);
    }

    /// Adds a pair of pieces with these motions and this loading.
    pub(super) fn add(&mut self, touching: &Touching, motions: &[SideMotion; 2], loading: &Loading) {
        if -loading.depth < self.gap {
            (self.gap, self.point) = (-loading.depth, loading.point);
            self.systems = [0, 1].map(|side| touching.sides[side].declared.system);
        }
        if touching.is_resting() {
            (self.pieces, self.depth) = (self.pieces + 1, f64::INFINITY);
            self.force += loading.normal_force();
        }
        if touching.law.is_none() || !touching.mode.phase.is_closed() {
            return;
        }
        self.pieces += 1;
        self.depth = self.depth.max(touching.deepest / touching.rounding(motions));
        self.force += loading.normal_force();
        self.elastic += touching.elastic_energies(loading).iter().sum::<f64>();
    }
}

/// Returns the largest value of the parabola through three points `(t, F)` if the middle value is the largest
/// and the lengths of both steps differ by less than the factor [`UNEQUAL`]; otherwise the largest of the
/// three values.
fn vertex([a, b, c]: [(f64, f64); 3]) -> f64 {
    let (h, k) = (b.0 - a.0, c.0 - b.0);
    let (rise, fall) = ((b.1 - a.1) / h, (b.1 - c.1) / k);
    let is_usable = h > 0.0 && k > 0.0 && h.max(k) < UNEQUAL * h.min(k);
    if !is_usable || rise < 0.0 || fall < 0.0 || rise + fall <= 0.0 {
        return a.1.max(b.1).max(c.1);
    }
    // F(t) = F_b + s (t − t_b) − (rise + fall)/(h + k) (t − t_b)²
    let slope = (k * rise - h * fall) / (h + k);
    b.1 + slope * slope * (h + k) / (4.0 * (rise + fall))
}

#[cfg(test)]
mod tests {
    use super::vertex;

    #[test]
    fn the_vertex_of_a_parabola_is_found() {
        let parabola = |t: f64| (t, 3.0 - 2.0 * (t - 0.3) * (t - 0.3));
        for [a, b, c] in [[0.0, 0.2, 0.5], [0.1, 0.3, 0.6], [-0.5, 0.4, 0.6]] {
            assert!((vertex([a, b, c].map(parabola)) - 3.0).abs() < 1e-14);
        }
    }

    #[test]
    fn without_a_maximum_inside_or_with_very_unequal_steps_it_is_the_largest_value() {
        assert_eq!(vertex([(0.0, 1.0), (1.0, 2.0), (2.0, 4.0)]), 4.0);
        assert_eq!(vertex([(0.0, 4.0), (1.0, 2.0), (2.0, 1.0)]), 4.0);
        assert_eq!(vertex([(0.0, 1.0), (1.0, 2.0), (1.0 + 1e-12, 2.0 - 1e-15)]), 2.0);
        assert_eq!(vertex([(1.0, 2.0), (1.0, 2.0), (2.0, 1.0)]), 2.0);
        assert_eq!(vertex([(0.0, 2.0), (1.0, 2.0), (2.0, 2.0)]), 2.0);
    }
}
