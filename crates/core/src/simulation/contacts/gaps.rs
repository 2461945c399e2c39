//! Bounding spheres of the pieces of every contact, which exclude pairs from the search for the smallest gap.

use super::side::Side;
use super::touching::Touching;
use crate::geometry::{BoundingSphere, Pose};
use crate::spatial::Vec3;
use std::collections::HashMap;
use std::ops::Range;

/// Uncertainty of a distance, relative to all lengths from which it is computed.
const UNCERTAIN: f64 = 1e-9;

/// Bounding spheres of all pieces, and lower bounds of the gaps of the pairs of one contact.
#[derive(Clone, Debug, Default)]
pub(super) struct Gaps {
    /// Range of the indices of the pairs of each contact.
    pub(super) pairs: Vec<Range<usize>>,
    /// For each piece of each contact: the index of a pair with this piece, the side of the piece (0 or 1),
    /// and its bounding sphere.
    pieces: Vec<Vec<(usize, usize, BoundingSphere)>>,
    /// For each pair, the indices of the pieces of its two sides among the pieces of its contact.
    sides: Vec<[usize; 2]>,
    /// Centres of the spheres of one contact in W, m.
    centers: Vec<Vec3<f64>>,
    /// Lower bounds of the gaps of the pairs of one contact, m; negative infinity for pairs that are
    /// evaluated.
    pub(super) bounds: Vec<f64>,
}

impl Gaps {
    /// Creates the workspace with the bounding spheres of the pieces in `list`, which is sorted by contact;
    /// `count` is the number of contacts.
    pub(super) fn new(list: &[Touching], count: usize) -> Self {
        let mut new = Self { pieces: vec![Vec::new(); count], ..Self::default() };
        for contact in 0..count {
            let first = list.partition_point(|touching| touching.contact < contact);
            new.pairs.push(first..list.partition_point(|touching| touching.contact <= contact));
        }
        let mut known = HashMap::new();
        for (number, touching) in list.iter().enumerate() {
            let pieces = &mut new.pieces[touching.contact];
            new.sides.push([0, 1].map(|i| {
                let side = &touching.sides[i];
                *known.entry((touching.contact, i, side.piece)).or_insert_with(|| {
                    pieces.push((number, i, side.shape.bounding_sphere()));
                    pieces.len() - 1
                })
            }));
        }
        new
    }

    /// Writes `|c_b − c_a| − r_a − r_b`, m, less a bound on the rounding error, for each pair of a contact to
    /// `bounds`, with the centres `c` and radii `r` of the spheres of both pieces. `pose` returns the pose of
    /// a piece in W.
    pub(super) fn bound(&mut self, contact: usize, list: &[Touching], mut pose: impl FnMut(&Side) -> Pose) {
        let Self { pairs, pieces, sides, centers, bounds } = self;
        let pieces = &pieces[contact];
        let center = |(pair, side, sphere): &(usize, usize, BoundingSphere)| {
            pose(&list[*pair].sides[*side]).to_common(sphere.center)
        };
        centers.clear();
        centers.extend(pieces.iter().map(center));
        let bound = |[a, b]: &[usize; 2]| {
            let apart = (centers[*b] - centers[*a]).norm();
            let radii = pieces[*a].2.radius + pieces[*b].2.radius;
            let uncertain = UNCERTAIN * (apart + radii + centers[*a].norm() + centers[*b].norm());
            apart - radii - uncertain
        };
        bounds.clear();
        bounds.extend(sides[pairs[contact].clone()].iter().map(bound));
    }

    /// Returns the index in `bounds` of the pair with the lowest finite bound; `None` if no bound is finite.
    pub(super) fn lowest(&self) -> Option<usize> {
        let open = (0..self.bounds.len()).filter(|at| self.bounds[*at].is_finite());
        open.min_by(|a, b| self.bounds[*a].total_cmp(&self.bounds[*b]))
    }
}
