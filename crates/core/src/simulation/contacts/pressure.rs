//! Normal force of a contact, summed over all of its points.

use super::side::SideMotion;
use crate::contact::NormalLaw;
use crate::geometry::{ContactPoint, Points, Proximity};
use crate::spatial::{Force, Motion, Vec3};

/// Sums of the normal forces, and of their powers and energies, over the points of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pressure {
    /// Sum of the normal forces, N.
    pub(super) force: f64,
    /// Power that the force removes from the motion, W.
    pub(super) power: f64,
    /// Power that the force dissipates, W.
    pub(super) loss: f64,
    /// Elastic energy that the force stores, J.
    pub(super) elastic: f64,
}

/// Resultant of the forces at the points of a contact: the normal forces and, for compliant contacts with
/// several points, the forces due to changes of the weights of the points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Resultant {
    pub(super) pressure: Pressure,
    /// Point at which the resultant acts, m, in W.
    pub(super) point: Vec3<f64>,
    /// Force on the second side, N, W axes. For a single point it is along the normal; for several points it
    /// may be inclined to the normal, because the surfaces at these points may be.
    pub(super) on_b: Vec3<f64>,
    /// Moment on the second side about `point`, N m, W axes.
    pub(super) moment: Vec3<f64>,
}

impl Resultant {
    /// Computes the forces that belong to the elastic energy `U = Σ w_i u(x_i)` of points with the depths
    /// `x_i` and the weights `w_i`, with the force `F` and the elastic energy `u` of the law. For a
    /// displacement `ξ` of the second side, the wrench `f` on it is given by
    ///
    /// `−f = Σ w_i F(x_i, ẋ_i) ∂x_i/∂ξ + Σ u(x_i) ∂w_i/∂ξ`,
    ///
    /// which is the gradient of `U` for an elastic law. The sum of the normal forces, `N = Σ w_i F_i`, acts
    /// at `Σ w_i F_i p_i/N`, where `p_i` is the midpoint between the points of both sides.
    ///
    /// The force at a single point may pull within a step, because the law is evaluated beyond lift-off; the
    /// step then ends at the lift-off. Pieces that separate without force (`is_pressing` is false) dissipate
    /// their elastic energy, and so does each of several points that would pull.
    pub(super) fn of(
        law: &NormalLaw,
        points: &Points,
        proximity: &Proximity,
        motions: &[SideMotion; 2],
        is_pressing: bool,
    ) -> Self {
        let normal = proximity.normal;
        let points = match points {
            Points::Witness => {
                let at = (proximity.center(), -proximity.distance);
                return Self::at_point(law, at, normal, motions, is_pressing);
            }
            Points::Many(points) => &points[..],
        };
        if let [point] = points {
            return Self::at_point(law, (middle(point), point.depth), normal, motions, is_pressing);
        }
        let (center, [a, b]) = (proximity.center(), motions);
        let twist = Motion::new(
            b.velocity_at(center) - a.velocity_at(center),
            b.angular_velocity - a.angular_velocity,
        );
        let (mut at, mut mean) = (Vec3::zero(), Vec3::zero());
        let (mut force, mut loss, mut elastic) = (0.0, 0.0, 0.0);
        let mut wrench = Force::zero();
        for point in points {
            let depth = point.depth;
            let rate = twist.dot(point.depth_gradient);
            let own = if is_pressing && depth > 0.0 { law.force(depth, rate).max(0.0) } else { 0.0 };
            let (share, energy) = (point.weight * own, law.elastic_energy(depth));
            elastic += point.weight * energy;
            force += share;
            loss += (share - point.weight * law.elastic_force(depth.max(0.0))) * rate;
            let arm = middle(point) - center;
            at += arm * share;
            mean += arm * point.weight;
            if is_pressing {
                wrench += point
                    .depth_gradient
                    .scale_add(-share, point.weight_gradient.scale_add(-energy, Force::zero()));
            }
        }
        let arm = if force > 0.0 { at * (1.0 / force) } else { mean };
        let loss = if is_pressing { loss } else { 0.0 };
        Self {
            pressure: Pressure { force, power: -twist.dot(wrench), loss, elastic },
            point: center + arm,
            on_b: wrench.linear,
            moment: wrench.angular - arm.cross(wrench.linear),
        }
    }

    /// Returns the resultant for a single point, given by its position, m, and its depth, m.
    fn at_point(
        law: &NormalLaw,
        (at, depth): (Vec3<f64>, f64),
        normal: Vec3<f64>,
        [a, b]: &[SideMotion; 2],
        is_pressing: bool,
    ) -> Self {
        let rate = -normal.dot(b.velocity_at(at) - a.velocity_at(at));
        let force = if is_pressing { law.force(depth, rate) } else { 0.0 };
        let loss = if is_pressing { (force - law.elastic_force(depth)) * rate } else { 0.0 };
        let pressure = Pressure { force, power: force * rate, loss, elastic: law.elastic_energy(depth) };
        Self { pressure, point: at, on_b: normal * force, moment: Vec3::zero() }
    }
}

fn middle(point: &ContactPoint) -> Vec3<f64> {
    (point.point_a + point.point_b) * 0.5
}
