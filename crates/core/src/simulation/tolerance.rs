//! How far off a step of the embedded pair is, against what it may be.

use super::integrator::Stages;
use super::pair::{LARGEST_TURN, combine};
use super::plant::{Plant, World};
use super::tableau::E;
use crate::model::Axis;
use crate::spatial::{Real, Vec3};

/// Below this share of the fastest rate of the run, errors of rates are as small as they need be.
const SLOW: f64 = 1e-3;

impl<S: Real> Stages<S> {
    /// Error of the last step as a share of what is allowed, and that of its attitude, rad.
    ///
    /// Allowed are `ε` of a radian in attitude and joints, of the robot's radius of gyration (or of the
    /// distance from W's origin) in lengths, of their own size in rates.
    pub(super) fn error(&mut self, plant: &Plant<'_, S, impl World<S>>, h: f64) -> (f64, f64) {
        let Self { start, trial, sum, pair, .. } = self;
        let Some(pair) = pair else { return (0.0, 0.0) };
        combine(sum, &pair.k, &E);
        let norm = |v: Vec3<S>| v.norm().lane(0);
        let vector = |x: &[S]| norm(Vec3::from_slice(x));
        let (turn, size) = (h * norm(sum.turn), pair.memory.size);
        let carried = norm(plant.carried());
        let spin = vector(&start.v[3..]).max(vector(&trial.v[3..]));
        let speed = carried.max(vector(&trial.v));
        let prismatic = |j: usize| plant.model.nodes()[j + 1].axis == Axis::Prismatic;
        let rate = |j: usize| start.v[j + 6].lane(0).abs().max(trial.v[j + 6].lane(0).abs());
        let n = start.v.len() - 6;

        let [fastest, highest] = pair.memory.fastest;
        let turning = |j: usize| if prismatic(j) { rate(j) / size } else { rate(j) };
        let fastest = (0..n).map(turning).fold(fastest.max(spin), f64::max);
        let highest = highest.max(speed).max(size * fastest);
        // rounding of what does not turn must not stop the run: drifts of ε/1000 until its end will do
        let slow = SLOW * fastest.max(vector(&trial.v) / size).max(1.0 / pair.horizon);
        let crawl = SLOW * highest.max(size / pair.horizon);

        let share =
            |error: f64, scale: f64| if error == 0.0 { 0.0 } else { error / (pair.tolerance * scale) };
        let mut worst = [
            pair.attitude * share(turn, 1.0),
            share(h * norm(sum.origin), size.max(vector(&start.q))),
            pair.attitude * share(h * vector(&sum.a[3..]), spin + slow),
            share(h * vector(&sum.a), speed + size * spin + crawl),
        ]
        .into_iter()
        .fold(0.0, worse);
        for j in 0..n {
            let scale = if prismatic(j) { size } else { 1.0 };
            worst = worse(worst, share(h * sum.v[j + 6].lane(0).abs(), scale));
            worst = worse(worst, share(h * sum.a[j + 6].lane(0).abs(), rate(j) + slow * scale));
        }
        let is_folded = vector(&trial.q[3..]).is_nan() || h * norm(pair.k[6].turn) > 2.0 * LARGEST_TURN;
        if worst <= 1.0 {
            pair.memory.fastest = [fastest, highest]; // what is tried in vain does not count
        }
        (if is_folded { f64::NAN } else { worst }, turn)
    }
}

/// The larger of two, and not a number if either is.
fn worse(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
