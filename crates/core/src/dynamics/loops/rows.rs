//! Rows of the constraint Jacobian `J`, the constraint errors `φ` and the drift `J̇ v`.

use crate::dynamics::Data;
use crate::model::{Closure, Constraint, Frame, LoopKind};
use crate::spatial::{Force, Mat3, Real, Vec3, log_rotation};

/// Row of `J`, which is also the generalized force per unit constraint force: a force on each of two bodies,
/// about the origin of the body in base axes, or an effort at the joint of each body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<S> {
    pub(super) bodies: [usize; 2],
    pub(super) forces: [Force<S>; 2],
    pub(super) efforts: [S; 2],
}

/// Buffers of [`ClosedLoops::joint_constraints`](super::ClosedLoops::joint_constraints), which allocates them
/// when it is first called.
#[derive(Clone, Debug, Default)]
pub(super) struct JointRows<S> {
    /// `J`, row major `(m, nv)`.
    pub(super) jacobian: Vec<S>,
    /// Zero accelerations, `(nv,)`.
    pub(super) at_rest: Vec<S>,
    /// `J̇ v`, `(m,)`.
    pub(super) drift: Vec<S>,
}

impl<S: Real> Row<S> {
    /// Returns the rows of a closure, of which [`update`] sets the forces.
    pub(super) fn of(closure: &Closure) -> Vec<Self> {
        let (bodies, efforts) = match &closure.constraint {
            Constraint::Frames { frames: [a, b], .. } => ([a.body, b.body], [0.0, 0.0]),
            Constraint::Mimic { joint, leader, ratio, .. } => ([leader + 1, joint + 1], [-ratio, 1.0]),
        };
        vec![Self { bodies, forces: [Force::zero(); 2], efforts: efforts.map(S::of) }; closure.rows()]
    }

    /// Returns the product of the row and the velocity `v`, `(nv,)`: `Σ Fᵀ v_k + Σ e q̇` with the forces `F`
    /// and the efforts `e` of the row.
    #[inline(always)]
    pub(super) fn rate(&self, data: &Data<S>, v: &[S]) -> S {
        let mut sum = S::of(0.0);
        for side in 0..2 {
            let body = self.bodies[side];
            sum = data.bodies[body].velocity.dot_add(self.forces[side], sum);
            if body > 0 {
                sum = v[body + 5].mul_add(self.efforts[side], sum);
            }
        }
        sum
    }

    /// Returns the product of the row and the accelerations of the bodies in `data` and of the joints in `a`,
    /// `(nv,)`.
    #[inline(always)]
    pub(super) fn acceleration(&self, data: &Data<S>, a: &[S]) -> S {
        let mut sum = S::of(0.0);
        for side in 0..2 {
            let body = self.bodies[side];
            sum = data.bodies[body].acceleration.dot_add(self.forces[side], sum);
            if body > 0 {
                sum = a[body + 5].mul_add(self.efforts[side], sum);
            }
        }
        sum
    }
}

/// Frame of a constraint in base axes, with its origin relative to the origin of its body.
#[derive(Clone, Copy)]
struct Placed<S> {
    rot: Mat3<S>,
    offset: Vec3<S>,
}

impl<S: Real> Placed<S> {
    #[inline(always)]
    fn of(frame: &Frame, data: &Data<S>) -> Self {
        let rot_bk = data.bodies[frame.body].rot_bk;
        Self { rot: rot_bk * Mat3::of(&frame.rot_kf), offset: rot_bk * Vec3::of(&frame.pos_kf) }
    }
}

/// Returns the vector from the origin of the first frame to that of the second, in base axes.
#[inline(always)]
fn gap<S: Real>(frames: &[Frame; 2], placed: &[Placed<S>; 2], data: &Data<S>) -> Vec3<S> {
    let [a, b] = [0, 1].map(
        #[inline(always)]
        |i: usize| data.bodies[frames[i].body].pos_b,
    );
    (b - a) + (placed[1].offset - placed[0].offset)
}

/// Returns whether a row (index) of a closure constrains a rotation; true also for mimic joints, even if they
/// are prismatic.
pub(super) fn is_angular(closure: &Closure, row: usize) -> bool {
    match &closure.constraint {
        Constraint::Frames { kind: LoopKind::Distance, .. } => false,
        Constraint::Frames { kind, .. } => kind.directions()[row].1,
        Constraint::Mimic { .. } => true,
    }
}

/// Sets the forces of the rows of a closure. Requires up-to-date poses in `data`.
///
/// The two forces (or moments) of a row are opposite and act along the same line, so that the constraint does
/// not change the momentum.
#[inline(always)]
pub(super) fn update<S: Real>(closure: &Closure, data: &Data<S>, rows: &mut [Row<S>]) {
    let Constraint::Frames { kind, frames, .. } = &closure.constraint else { return };
    let placed = [Placed::of(&frames[0], data), Placed::of(&frames[1], data)];
    let gap = gap(frames, &placed, data);
    if *kind == LoopKind::Distance {
        let distance = gap.norm();
        // two origins that coincide may move apart in any direction
        let coincide = S::less(distance, S::of(f64::MIN_POSITIVE));
        let (x, n) = (placed[0].rot.x, gap * (S::of(1.0) / distance));
        let n = Vec3::new(
            S::select(coincide, x.x, n.x),
            S::select(coincide, x.y, n.y),
            S::select(coincide, x.z, n.z),
        );
        rows[0].forces =
            [Force::at(-n, Vec3::zero(), placed[0].offset), Force::at(n, Vec3::zero(), placed[1].offset)];
        return;
    }
    // common point of both forces: the origin of the first frame, or of the second frame if it slides along
    // the first one, so that the rows are the rates of the errors
    let points = match kind {
        LoopKind::Prismatic => [placed[0].offset + gap, placed[1].offset],
        _ => [placed[0].offset, placed[1].offset - gap],
    };
    let axes = [placed[0].rot.x, placed[0].rot.y, placed[0].rot.z];
    for (row, &(axis, is_moment)) in rows.iter_mut().zip(kind.directions()) {
        let axis = axes[axis];
        row.forces = match is_moment {
            true => [Force::new(Vec3::zero(), -axis), Force::new(Vec3::zero(), axis)],
            false => [Force::at(-axis, Vec3::zero(), points[0]), Force::at(axis, Vec3::zero(), points[1])],
        };
    }
}

/// Writes the constraint errors `φ` of a closure, m and rad; their rates are `J v` up to terms of order `φ`.
/// Requires up-to-date poses in `data`; `q` is `(nq,)`.
#[inline(always)]
pub(super) fn errors<S: Real>(closure: &Closure, data: &Data<S>, q: &[S], out: &mut [S]) {
    let (kind, frames, length) = match &closure.constraint {
        Constraint::Frames { kind, frames, length } => (kind, frames, length),
        Constraint::Mimic { joint, leader, ratio, offset } => {
            // φ = q − ratio q_leader − offset
            out[0] = q[joint + 7] - (q[leader + 7].mul_add(S::of(*ratio), S::of(*offset)));
            return;
        }
    };
    let placed = [Placed::of(&frames[0], data), Placed::of(&frames[1], data)];
    let gap = gap(frames, &placed, data);
    if *kind == LoopKind::Distance {
        out[0] = gap.norm() - S::of(*length);
        return;
    }
    let distance = placed[0].rot.transpose_mul(gap);
    let rot_ab = placed[0].rot.transpose() * placed[1].rot;
    let angle = match kind {
        LoopKind::Revolute => Vec3::new(-rot_ab.z.y, rot_ab.z.x, S::of(0.0)), // z_a × z_b
        LoopKind::Spherical => Vec3::zero(),
        _ => log_rotation(&rot_ab),
    };
    let (distance, angle) = ([distance.x, distance.y, distance.z], [angle.x, angle.y, angle.z]);
    for (out, &(axis, is_moment)) in out.iter_mut().zip(kind.directions()) {
        *out = if is_moment { angle[axis] } else { distance[axis] };
    }
}

/// Adds the terms that are quadratic in the velocities to `out`, which contains `J a` with spatial
/// accelerations; the sum is the constraint acceleration `J a + J̇ v`. Requires up-to-date poses and twists
/// in `data`.
#[inline(always)]
pub(super) fn add_drift<S: Real>(closure: &Closure, data: &Data<S>, rows: &[Row<S>], out: &mut [S]) {
    let Constraint::Frames { kind, frames: [a, b], .. } = &closure.constraint else { return };
    let (first, second) = (&data.bodies[a.body], &data.bodies[b.body]);
    if *kind == LoopKind::Distance {
        let [Force { linear: minus_n, .. }, Force { linear: n, .. }] = rows[0].forces;
        let placed = [Placed::of(a, data), Placed::of(b, data)];
        let [u, w] = [first.velocity.at(placed[0].offset), second.velocity.at(placed[1].offset)];
        // n·(ω_b × w − ω_a × u) + |(w − u) − n n·(w − u)|²/d
        let relative = w - u;
        let across = relative - n * n.dot(relative);
        let distance = (second.pos_b - first.pos_b + (placed[1].offset - placed[0].offset)).norm();
        let centripetal =
            minus_n.dot(first.velocity.angular.cross(u)) + n.dot(second.velocity.angular.cross(w));
        out[0] += centripetal + across.dot(across) / distance;
        return;
    }
    // the row F is fixed in the first body: Ḟᵀ v_r = (v_a ×* F)ᵀ v_r = −Fᵀ (v_a × v_r)
    let carried = first.velocity.referred_to(second.pos_b - first.pos_b);
    let turning = carried.cross(second.velocity - carried);
    for (out, row) in out.iter_mut().zip(rows) {
        *out -= turning.dot(row.forces[1]);
    }
}
