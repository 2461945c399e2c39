//! Signed distances to the profile of a shape of revolution, in the half plane with the distance `ρ` from
//! the axis and the coordinate `z`.

/// Point of the half plane, `(ρ, z)`, m.
type Point = [f64; 2];

/// Signed distance, m, closest point of the boundary, and outward unit normal at this point.
pub(super) type Nearest2 = (f64, Point, Point);

/// Returns the nearest point of a convex profile to `p`. `corners` are the vertices from one end of the
/// shape's axis to the other; consecutive ones are joined by straight lines, along which the shape is on
/// the left side.
pub(super) fn nearest(corners: &[Point], p: Point) -> Nearest2 {
    let mut inside = (f64::NEG_INFINITY, p, [0.0, 0.0]);
    let mut outside = (f64::INFINITY, p, [0.0, 0.0]);
    for edge in corners.windows(2) {
        let (a, b) = (edge[0], edge[1]);
        let along = [b[0] - a[0], b[1] - a[1]];
        let length = along[0].hypot(along[1]);
        let u = [along[0] / length, along[1] / length];
        let normal = [u[1], -u[0]];
        let from = [p[0] - a[0], p[1] - a[1]];
        let height = from[0] * normal[0] + from[1] * normal[1];
        let at = (from[0] * u[0] + from[1] * u[1]).clamp(0.0, length);
        let foot = [a[0] + at * u[0], a[1] + at * u[1]];
        if height > inside.0 {
            inside = (height, foot, normal);
        }
        if height > 0.0 {
            let apart = [p[0] - foot[0], p[1] - foot[1]];
            let distance = apart[0].hypot(apart[1]);
            if distance < outside.0 {
                outside = (distance, foot, [apart[0] / distance, apart[1] / distance]);
            }
        }
    }
    if inside.0 > 0.0 { outside } else { inside }
}
