//! Forces of a pair of pieces, one of each side of a contact, and their margins to the next changes of the
//! contact mode.

use super::mode::{Mode, Phase};
use super::pressure::{Pressure, Resultant};
use super::rigid::Rigid;
use super::side::{Side, SideMotion};
use crate::contact::{Bristle, ContactError, ContactLaw, Friction, FrictionForce};
use crate::geometry::{Points, Proximity, closest_of_valid, touching_points};
use crate::simulation::contact_state::{ContactRate, ContactState};
use crate::spatial::Vec3;

/// Pair of convex pieces, one of each side of a contact.
#[derive(Clone, Debug)]
pub(super) struct Touching {
    /// Index of the contact among those of the run.
    pub(super) contact: usize,
    /// Name of the contact.
    pub(super) name: String,
    pub(super) sides: [Side; 2],
    /// Law of the compliant forces; `None` if the contact exerts none.
    pub(super) law: Option<ContactLaw>,
    /// State of pieces with an impact law; `None` for other pieces.
    pub(super) rigid: Option<Rigid>,
    /// True if the pieces may overlap at the start.
    pub(super) may_start_overlapping: bool,
    /// True if the forces at several points are the gradient of their elastic energy.
    pub(super) is_conservative: bool,
    pub(super) mode: Mode,
    /// Distance, m, by which the pieces may approach each other before the gap must be computed again: the
    /// gap that was computed last, less a margin and less the distance that the pieces may have travelled
    /// since.
    pub(super) clearance: f64,
    /// True if a connection of an external engine holds both links together.
    pub(super) is_held: bool,
    /// Largest depth, m, that the motion at the start of the step will reach.
    pub(super) deepest: f64,
    /// Result of the last evaluation; `None` while the pieces are far apart.
    pub(super) last: Option<Loading>,
}

/// Geometry, motion and force of a contact at one instant. Vectors are in W unless stated otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::simulation) struct Loading {
    /// Depth `x`, m; negative while the pieces are apart.
    pub(super) depth: f64,
    /// Rate of the depth `ẋ`, m/s.
    pub(super) rate: f64,
    /// Unit normal from the first side to the second.
    pub(super) normal: Vec3<f64>,
    /// Point at which the forces act, m.
    pub(super) point: Vec3<f64>,
    /// Sums of the normal forces; `None` if the pieces neither overlap nor exert forces under an impact law.
    pub(super) pressure: Option<Pressure>,
    /// Force on the second side, N.
    pub(super) force: Vec3<f64>,
    /// Moment on the second side about `point`, without that of torsional friction, N m.
    pub(super) moment: Vec3<f64>,
    /// Sliding velocity of the second side relative to the first, in axes of the first side, m/s.
    pub(super) sliding: Vec3<f64>,
    /// Normal in axes of the first side.
    pub(super) normal_a: Vec3<f64>,
    /// Friction in axes of the first side; `None` without friction or while the pieces do not press on each
    /// other.
    pub(super) friction: Option<FrictionForce>,
    /// Rate at which the second side turns about the normal relative to the first, rad/s.
    pub(super) spin: f64,
    /// Moment about the normal on the second side, N m, in the first component; `None` without torsional
    /// friction or while the pieces do not press on each other.
    pub(super) torsion: Option<FrictionForce>,
}

impl Touching {
    /// Returns true if the pieces overlap, or rest on each other under an impact law.
    pub(super) fn has_touched(&self) -> bool {
        self.mode.phase.is_closed() || self.is_resting()
    }

    /// Computes the distance between the pieces and their forces, in the present mode and for the motions
    /// `motions` of both sides.
    #[inline]
    pub(super) fn evaluate(
        &self,
        motions: &[SideMotion; 2],
        state: &ContactState,
    ) -> Result<Loading, ContactError> {
        let phase = self.mode.phase;
        Ok(self.loading(phase, &self.geometry(phase, motions)?, motions, state))
    }

    /// Computes the distance between the pieces and their contact points. The contact points are the witness
    /// points while pieces without an impact law do not touch.
    #[inline]
    pub(super) fn geometry(
        &self,
        phase: Phase,
        [a, b]: &[SideMotion; 2],
    ) -> Result<(Proximity, Points), ContactError> {
        let [first, second] = [&self.sides[0].shape, &self.sides[1].shape];
        let failed = |source| ContactError::Geometry { contact: self.name.clone(), source };
        if !phase.is_closed() && self.rigid.is_none() {
            let proximity = closest_of_valid(first, &a.shape, second, &b.shape).map_err(failed)?;
            return Ok((proximity, Points::Witness));
        }
        let (proximity, points) = touching_points(first, &a.shape, second, &b.shape).map_err(failed)?;
        let points = if self.is_conservative { points } else { points.fixed(&proximity) };
        Ok((proximity, points))
    }

    /// Computes the forces in `phase` from the distance and the contact points of the pieces. If the pieces
    /// touch in this phase, [`Touching::geometry`] must have computed the contact points for it.
    pub(super) fn loading(
        &self,
        phase: Phase,
        (proximity, points): &(Proximity, Points),
        motions: &[SideMotion; 2],
        state: &ContactState,
    ) -> Loading {
        let [a, b] = motions;
        let normal = proximity.normal;
        let is_pressing = phase == Phase::Pressing;
        let law = self.law.as_ref().filter(|_| phase.is_closed());
        let resultant = law.map(|law| Resultant::of(&law.normal, points, proximity, motions, is_pressing));
        let witness = (proximity.point_a + proximity.point_b) * 0.5;
        // both forces act at one point, so that no moment remains
        let point = resultant.map_or(witness, |resultant| resultant.point);
        let relative = |point| b.velocity_at(point) - a.velocity_at(point);
        let across = |v: Vec3<f64>| v - normal * normal.dot(v);
        let mut loading = Loading {
            depth: -proximity.distance,
            rate: -normal.dot(relative(witness)),
            normal,
            point,
            pressure: resultant.map(|resultant| resultant.pressure),
            force: Vec3::zero(),
            moment: Vec3::zero(),
            sliding: a.frame.rot.transpose_mul(across(relative(point))),
            normal_a: a.frame.rot.transpose_mul(normal),
            friction: None,
            spin: normal.dot(b.angular_velocity - a.angular_velocity),
            torsion: None,
        };
        if let (Some(law), Some(resultant), true) = (law, resultant, is_pressing) {
            (loading.force, loading.moment) = (resultant.on_b, resultant.moment);
            self.add_friction(law, state, a, &mut loading);
        }
        if let Some(rigid) = &self.rigid
            && let Some(resultant) = rigid.resultant(&points.list(proximity), motions)
        {
            (loading.point, loading.force, loading.moment) =
                (resultant.point, resultant.on_b, resultant.moment);
            loading.pressure = Some(resultant.pressure);
        }
        loading
    }

    /// Adds the friction of pieces that press on each other.
    fn add_friction(&self, law: &ContactLaw, state: &ContactState, a: &SideMotion, loading: &mut Loading) {
        if let Some(friction) = &law.friction {
            let Mode { bristle, slip, normal: before, .. } = &self.mode;
            let tangential = |v: Vec3<f64>| v - loading.normal_a * loading.normal_a.dot(v);
            let deflection = tangential(transported(bristle.deflection, *before, loading.normal_a));
            let bristle = Bristle { deflection, is_slipping: bristle.is_slipping };
            let moved = tangential(state.slip - *slip);
            let damping = friction.damping_for(self.mode.mobility[1]);
            let found = friction.after(&bristle, moved, loading.sliding, loading.normal_force(), damping);
            loading.force += a.frame.rot * found.force;
            loading.friction = Some(found);
            self.add_torsion(friction, state, loading);
        }
    }

    /// Adds the moment about the normal, which obeys the same friction law in one dimension.
    fn add_torsion(&self, friction: &Friction, state: &ContactState, loading: &mut Loading) {
        let Some(torsion) = friction.torsion() else { return };
        let along = |x: f64| Vec3::new(x, 0.0, 0.0);
        let (moved, spin) = (along(state.turn - self.mode.turn), along(loading.spin));
        let damping = torsion.damping_for(self.mode.mobility[2]);
        let normal = loading.normal_force();
        loading.torsion = Some(torsion.after(&self.mode.twist, moved, spin, normal, damping));
    }

    /// Returns the work of the normal force, J, that is neither stored nor dissipated while polyhedra press
    /// on each other. An error of the integrator or a jump of the elastic energy causes such work. It is 0
    /// for other shapes, in other phases, and if the forces are not the gradient of the elastic energy.
    pub(super) fn open_energy(&self, loading: &Loading, state: &ContactState) -> f64 {
        let is_exact = self.is_conservative
            && self.mode.phase == Phase::Pressing
            && self.sides.iter().all(|side| side.shape.is_polyhedral());
        let pressure = loading.pressure.filter(|_| is_exact);
        pressure.map_or(0.0, |pressure| state.normal_work - state.normal_loss - pressure.elastic)
    }

    /// Returns the margins to the next changes of mode, each negative beyond the change: that of the gap or
    /// depth, m, that of the normal force, and that of friction.
    pub(super) fn margins(&self, loading: &Loading) -> [f64; 3] {
        let Loading { depth, rate, .. } = *loading;
        let Some(law) = &self.law else {
            let is_near = self.rigid.is_some() && self.mode.phase != Phase::Far;
            let margin = if is_near { self.rigid_margin(depth) } else { f64::INFINITY };
            return [margin, f64::INFINITY, f64::INFINITY];
        };
        let pressing = law.normal.pressing(depth, rate);
        match self.mode.phase {
            Phase::Far => [f64::INFINITY; 3],
            Phase::Apart => [-depth, f64::INFINITY, f64::INFINITY],
            Phase::Separating => [depth, -pressing, f64::INFINITY],
            Phase::Pressing => {
                let forces = [loading.friction, loading.torsion].into_iter().flatten();
                let margins = forces.filter(|_| loading.normal_force() > 0.0).map(|force| force.margin);
                [depth, pressing, margins.fold(f64::INFINITY, f64::min)]
            }
        }
    }
}

impl Loading {
    /// Returns the magnitude of the normal force, N; zero while the law gives a pulling force.
    pub(super) fn normal_force(&self) -> f64 {
        self.pressure.map_or(0.0, |pressure| pressure.force.max(0.0))
    }

    /// Returns the moment of torsional friction about the normal on the second side, N m.
    fn torque(&self) -> f64 {
        self.torsion.map_or(0.0, |torsion| torsion.force.x)
    }

    /// Returns the moment on the second side about the point of contact, W axes, N m, including torsional
    /// friction.
    pub(super) fn total_moment(&self) -> Vec3<f64> {
        self.normal.scale_add(self.torque(), self.moment)
    }

    /// Returns the power that friction removes from the motion, W.
    pub(super) fn friction_power(&self) -> f64 {
        let friction = self.friction.map_or(0.0, |friction| friction.force.dot(self.sliding));
        -friction - self.torque() * self.spin
    }

    /// Returns the time derivative of the state of the contact. Its angular impulse is about the point
    /// `center`, in W, m.
    pub(super) fn rates(&self, center: Vec3<f64>) -> ContactRate {
        ContactRate {
            slip: self.friction.map_or(self.sliding, |friction| friction.elastic_rate),
            turn: self.torsion.map_or(self.spin, |torsion| torsion.elastic_rate.x),
            normal_work: self.pressure.map_or(0.0, |pressure| pressure.power),
            normal_loss: self.pressure.map_or(0.0, |pressure| pressure.loss),
            friction_work: self.friction_power(),
            impulse: self.force,
            angular_impulse: (self.point - center).cross(self.force) + self.total_moment(),
        }
    }
}

/// Returns `v` after the smallest rotation that takes the unit vector `from` to the unit vector `to`, or `v`
/// unchanged if that rotation is 120° or more.
fn transported(v: Vec3<f64>, from: Vec3<f64>, to: Vec3<f64>) -> Vec3<f64> {
    // R v = v + w × v + w × (w × v)/(1 + cos),  w = from × to
    let (w, cosine) = (from.cross(to), from.dot(to));
    if cosine <= -0.5 {
        return v; // the normal has jumped to another face
    }
    let turned = w.cross(v);
    v + turned + w.cross(turned) * (1.0 / (1.0 + cosine))
}
