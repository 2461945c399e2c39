//! Least distance between two sets of shapes.

use super::bounding_sphere::BoundingSphere;
use super::closest::closest;
use super::error::GeometryError;
use super::pose::Pose;
use super::proximity::Proximity;
use super::shape::Shape;

/// Set of shapes with their bounding spheres.
#[derive(Clone, Debug, Default)]
pub struct ShapeSet {
    shapes: Vec<(Shape, BoundingSphere)>,
}

/// Least distance between two sets of shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastDistance {
    /// Distance, witness points and normal of the nearest pair.
    pub proximity: Proximity,
    /// Index of the nearest shape in each set.
    pub pair: [usize; 2],
}

impl ShapeSet {
    /// Creates a set of shapes.
    pub fn new(shapes: impl IntoIterator<Item = Shape>) -> Self {
        let with_sphere = |shape: Shape| {
            let sphere = shape.bounding_sphere();
            (shape, sphere)
        };
        Self { shapes: shapes.into_iter().map(with_sphere).collect() }
    }

    /// Returns the number of shapes.
    pub fn len(&self) -> usize {
        self.shapes.len()
    }

    /// Returns true if the set has no shapes.
    pub fn is_empty(&self) -> bool {
        self.shapes.is_empty()
    }

    /// Returns the least distance to the shapes of another set, given the poses of the shapes of both sets in
    /// common axes. Only the pairs of indices that `permitted` accepts are considered; without such a pair,
    /// returns `None`. Pairs whose bounding spheres are farther apart than the nearest pair are skipped.
    ///
    /// # Errors
    /// The error of [`closest`] for the first pair whose distance cannot be computed.
    pub fn least_distance(
        &self,
        poses: &[Pose],
        other: &Self,
        other_poses: &[Pose],
        permitted: impl Fn(usize, usize) -> bool,
    ) -> Result<Option<LeastDistance>, GeometryError> {
        let centers = |set: &Self, poses: &[Pose]| -> Vec<_> {
            set.shapes.iter().zip(poses).map(|((_, sphere), pose)| pose.to_common(sphere.center)).collect()
        };
        let (own, others) = (centers(self, poses), centers(other, other_poses));
        let mut pairs = Vec::new();
        for (i, (_, a)) in self.shapes.iter().enumerate() {
            for (j, (_, b)) in other.shapes.iter().enumerate().filter(|(j, _)| permitted(i, *j)) {
                pairs.push(((others[j] - own[i]).norm() - a.radius - b.radius, i, j));
            }
        }
        pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut least: Option<LeastDistance> = None;
        for (bound, i, j) in pairs {
            if least.is_some_and(|least| bound > least.proximity.distance) {
                break;
            }
            let [(a, _), (b, _)] = [&self.shapes[i], &other.shapes[j]];
            let proximity = closest(a, &poses[i], b, &other_poses[j])?;
            if least.is_none_or(|least| proximity.distance < least.proximity.distance) {
                least = Some(LeastDistance { proximity, pair: [i, j] });
            }
        }
        Ok(least)
    }
}

#[cfg(test)]
mod tests {
    use super::{Pose, Shape, ShapeSet};
    use crate::spatial::Vec3;

    #[test]
    fn the_nearest_permitted_pair_is_found() {
        let set = || ShapeSet::new([Shape::Sphere { radius: 0.25 }, Shape::Box { half_edges: [0.5; 3] }]);
        let at = |x: f64| Pose::at(Vec3::new(x, 0.0, 0.0));
        let (own, others) = ([at(0.0), at(-3.0)], [at(5.0), at(2.0)]);
        let least = |permitted: fn(usize, usize) -> bool| {
            set().least_distance(&own, &set(), &others, permitted).expect("valid shapes")
        };
        let found = least(|_, _| true).expect("a pair");
        assert_eq!((found.pair, found.proximity.distance), ([0, 1], 1.25));
        let found = least(|_, j| j == 0).expect("a pair");
        assert_eq!((found.pair, found.proximity.distance), ([0, 0], 4.5));
        assert_eq!(least(|_, _| false), None);
    }
}
