//! Point of a simplex that is nearest to the origin.

use crate::spatial::Vec3;

/// Corner of a simplex: the difference `apart` between the point `on_a` of the first shape and the point
/// `on_b` of the second, m.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub(super) on_a: Vec3<f64>,
    pub(super) on_b: Vec3<f64>,
    pub(super) apart: Vec3<f64>,
}

/// Simplex with up to four corners, the newest last, and the barycentric coordinates `weights` of its point that
/// is nearest to the origin.
pub(super) struct Simplex {
    corners: [Corner; 4],
    weights: [f64; 4],
    count: usize,
}

impl Simplex {
    pub(super) fn new(corner: Corner) -> Self {
        Self { corners: [corner; 4], weights: [1.0, 0.0, 0.0, 0.0], count: 1 }
    }

    pub(super) fn push(&mut self, corner: Corner) {
        self.corners[self.count] = corner;
        self.count += 1;
    }

    pub(super) fn contains(&self, corner: &Corner) -> bool {
        self.corners[..self.count].iter().any(|known| known.apart == corner.apart)
    }

    /// Returns the weighted mean of the vectors that `of` returns for the corners.
    pub(super) fn mean(&self, of: impl Fn(&Corner) -> Vec3<f64>) -> Vec3<f64> {
        let used = self.corners[..self.count].iter().zip(&self.weights);
        used.fold(Vec3::zero(), |sum, (corner, weight)| of(corner).scale_add(*weight, sum))
    }

    /// Returns the point that is nearest to the origin, and keeps only the corners that determine this point.
    /// Returns `None` if the simplex is a tetrahedron that contains the origin, or if a coordinate is NaN.
    /// The newest corner is always kept, because it is nearer to the origin than the plane of the other
    /// corners.
    ///
    /// All subsets with the newest corner are compared. This requires no thresholds on areas, which would end
    /// the search too early for curved shapes.
    pub(super) fn reduce(&mut self) -> Option<Vec3<f64>> {
        if self.count == 4 && self.contains_origin() {
            return None;
        }
        let newest = self.count - 1;
        let mut best = (f64::INFINITY, [newest; 3], [0.0; 3], 0, Vec3::zero());
        for subset in 0..1_usize << newest {
            let mut chosen = [newest; 3];
            let mut count = 1;
            for i in (0..newest).filter(|i| subset >> i & 1 == 1) {
                if count < 3 {
                    chosen[count] = i;
                }
                count += 1;
            }
            if count > 3 {
                continue;
            }
            let points = chosen.map(|i| self.corners[i].apart);
            let Some(weights) = weights(points, count) else { continue };
            let point =
                (1..count).fold(points[0] * weights[0], |sum, i| points[i].scale_add(weights[i], sum));
            let squared = point.dot(point);
            if squared < best.0 {
                best = (squared, chosen, weights, count, point);
            }
        }
        let (_, chosen, weights, count, point) = best;
        let kept = chosen.map(|i| self.corners[i]);
        self.corners[..3].copy_from_slice(&kept);
        self.weights[..3].copy_from_slice(&weights);
        self.count = count;
        (count > 0).then_some(point)
    }

    fn contains_origin(&self) -> bool {
        let [a, b, c, d] = self.corners.map(|corner| corner.apart);
        let volume = |p: Vec3<f64>, q: Vec3<f64>, r: Vec3<f64>| p.dot(q.cross(r));
        let parts = [volume(b, c, d), -volume(a, c, d), volume(a, b, d), -volume(a, b, c)];
        parts.iter().all(|x| *x > 0.0) || parts.iter().all(|x| *x < 0.0)
    }
}

/// Returns the weights of the point that is nearest to the origin on the plane (or the line) through the
/// first `count` points; `None` if a weight is negative or NaN.
fn weights([a, b, c]: [Vec3<f64>; 3], count: usize) -> Option<[f64; 3]> {
    let found = match count {
        1 => [1.0, 0.0, 0.0],
        2 => {
            let u = b - a;
            let t = -a.dot(u) / u.dot(u);
            [1.0 - t, t, 0.0]
        }
        _ => {
            let (u, v) = (b - a, c - a);
            let along = v.dot(u) / u.dot(u);
            let w = u.scale_add(-along, v);
            let t = -a.dot(w) / w.dot(w);
            let s = -a.dot(u) / u.dot(u) - t * along;
            [1.0 - s - t, s, t]
        }
    };
    found.iter().all(|x| *x >= 0.0).then_some(found)
}
