//! Accelerations caused by constraint forces, from the articulated-body inertias of the preceding forward
//! dynamics.

use super::rows::Row;
use crate::dynamics::BodyData;
use crate::dynamics::subspace::{add_joint_motion, joint_effort};
use crate::model::Node;
use crate::spatial::{ColumnKernel, Force, InverseArticulated, Motion, Real, Vec3};
use std::any::Any;

/// Quantities of one body in the computation of a response.
#[derive(Clone, Copy, Debug, Default)]
struct Term<R> {
    /// Sum of the forces on the articulated body, about the origin of the body in base axes.
    force: Force<R>,
    /// Effort at the joint, and then `u = τ + Sᵀ f`.
    effort: R,
    acceleration: Motion<R>,
    /// Acceleration of the joint.
    rate: R,
}

/// Buffers of the responses.
#[derive(Debug)]
pub(super) struct Scratch<S> {
    single: Vec<Term<S>>,
    /// Terms with several right-hand sides in the lanes of a scalar that only the kernel knows.
    columns: Box<dyn Any + Send + Sync>,
    /// For robots with dense forward dynamics: `Jᵀ`, `(m, nv)`.
    pub(super) dense: Vec<S>,
}

impl<S: Clone> Clone for Scratch<S> {
    fn clone(&self) -> Self {
        // the columns are allocated again at their first use
        Self { single: self.single.clone(), columns: Box::new(()), dense: self.dense.clone() }
    }
}

impl<S: Real> Scratch<S> {
    pub(super) fn new(bodies: usize, dense: usize) -> Self {
        Self { single: vec![Term::default(); bodies], columns: Box::new(()), dense: vec![S::of(0.0); dense] }
    }
}

/// Computes the lower triangle of `A = J M⁻¹ Jᵀ`: column `c` holds the constraint accelerations that a unit
/// constraint force in row `c` causes at rest.
#[inline(always)]
pub(super) fn inverse_apparent_mass<S: Real>(
    (nodes, bodies): (&[Node], &[BodyData<S>]),
    base: &InverseArticulated<S>,
    rows: &[Row<S>],
    supported: &[usize],
    scratch: &mut Scratch<S>,
    matrix: &mut [S],
) {
    let columns = &mut scratch.columns;
    S::solve_columns(UnitResponses { nodes, bodies, base, rows, supported, columns, matrix });
}

struct UnitResponses<'a, S> {
    nodes: &'a [Node],
    bodies: &'a [BodyData<S>],
    base: &'a InverseArticulated<S>,
    rows: &'a [Row<S>],
    supported: &'a [usize],
    columns: &'a mut Box<dyn Any + Send + Sync>,
    matrix: &'a mut [S],
}

impl<S: Real> ColumnKernel<S> for UnitResponses<'_, S> {
    #[inline(always)]
    fn run<R: Real>(self, lift: impl Fn(S) -> R + Copy) {
        let Self { nodes, bodies, base, rows, supported, columns, matrix } = self;
        if !columns.is::<Vec<Term<R>>>() {
            *columns = Box::new(vec![Term::<R>::default(); nodes.len()]);
        }
        let Some(terms) = columns.downcast_mut::<Vec<Term<R>>>() else { return };
        let base = base.map(
            #[inline(always)]
            |x| lift(*x),
        );
        // a scalar with several lanes holds one column per lane; otherwise each column is a scalar
        let width = if S::LANES == 1 { R::LANES } else { 1 };
        for first in (0..rows.len()).step_by(width) {
            clear(terms, supported);
            let chunk = &rows[first..rows.len().min(first + width)];
            if width == 1 {
                add_forces(terms, &chunk[0], lift);
            } else {
                gather_forces(terms, chunk);
            }
            respond((nodes, bodies), &base, terms, (supported, supported.iter().copied()), lift);
            // A is symmetric, so the rows above the chunk are not needed
            for (r, row) in rows.iter().enumerate().skip(first) {
                let accelerations = acceleration(terms, row, lift);
                for c in first..rows.len().min(first + width).min(r + 1) {
                    matrix[r * rows.len() + c] = of_column::<S, R>(accelerations, c - first);
                }
            }
        }
    }
}

/// Returns the number of a right-hand side from a scalar of several right-hand sides.
#[inline(always)]
fn of_column<S: Real, R: Real>(x: R, column: usize) -> S {
    match S::LANES {
        1 => S::of(x.lane(column)),
        _ => S::from_lanes(|lane| x.lane(lane)),
    }
}

#[inline(always)]
fn clear<R: Real>(terms: &mut [Term<R>], supported: &[usize]) {
    terms[0].force = Force::zero();
    for &k in supported {
        (terms[k].force, terms[k].effort) = (Force::zero(), R::of(0.0));
    }
}

/// Adds the forces of one row.
#[inline(always)]
fn add_forces<S: Real, R: Real>(terms: &mut [Term<R>], row: &Row<S>, lift: impl Fn(S) -> R + Copy) {
    for side in 0..2 {
        let term = &mut terms[row.bodies[side]];
        term.force += force(row.forces[side], lift);
        term.effort += lift(row.efforts[side]);
    }
}

/// Adds the forces of several rows, each in its own lane.
#[inline(always)]
fn gather_forces<S: Real, R: Real>(terms: &mut [Term<R>], rows: &[Row<S>]) {
    for (lane, row) in rows.iter().enumerate() {
        for side in 0..2 {
            let (term, force) = (&mut terms[row.bodies[side]], &row.forces[side]);
            let to = &mut term.force;
            let parts = [
                (&mut to.linear.x, force.linear.x),
                (&mut to.linear.y, force.linear.y),
                (&mut to.linear.z, force.linear.z),
                (&mut to.angular.x, force.angular.x),
                (&mut to.angular.y, force.angular.y),
                (&mut to.angular.z, force.angular.z),
                (&mut term.effort, row.efforts[side]),
            ];
            for (to, x) in parts {
                to.set_lane(lane, to.lane(lane) + x.lane(0));
            }
        }
    }
}

/// Returns the row times the accelerations of a response.
#[inline(always)]
fn acceleration<S: Real, R: Real>(terms: &[Term<R>], row: &Row<S>, lift: impl Fn(S) -> R + Copy) -> R {
    let mut sum = R::of(0.0);
    for side in 0..2 {
        let term = &terms[row.bodies[side]];
        sum = term.acceleration.dot_add(force(row.forces[side], lift), sum);
        sum = term.rate.mul_add(lift(row.efforts[side]), sum);
    }
    sum
}

/// Computes the accelerations that the forces and efforts in `terms` cause at rest. Forces act only on the
/// bodies `loaded`. The accelerations of the bodies `moved`, which must contain all of their parents, are
/// computed. Both are in ascending order.
#[inline(always)]
fn respond<S: Real, R: Real>(
    (nodes, bodies): (&[Node], &[BodyData<S>]),
    base: &InverseArticulated<R>,
    terms: &mut [Term<R>],
    (loaded, moved): (&[usize], impl Iterator<Item = usize>),
    lift: impl Fn(S) -> R + Copy,
) {
    for &k in loaded.iter().rev() {
        let (node, body) = (&nodes[k], Lifted::of(&bodies[k], lift));
        let Term { force, effort, .. } = terms[k];
        // u = τ + Sᵀ f;  the parent carries f − U u/D
        let u = effort + joint_effort(node, body.axis, force);
        terms[k].effort = u;
        let carried = body.u_force.scale_add(-u * body.d_inverse, force.from_point(body.offset));
        terms[node.parent].force += carried;
    }
    // a_0 = IA⁻¹ f
    terms[0].acceleration = base.apply(terms[0].force);
    for k in moved {
        let (node, body) = (&nodes[k], Lifted::of(&bodies[k], lift));
        let parent = terms[node.parent].acceleration;
        // q̈ = (u − Uᵀ a_p)/D,  a = a_p + S q̈
        let rate = (terms[k].effort - parent.dot(body.u_force)) * body.d_inverse;
        terms[k].rate = rate;
        terms[k].acceleration = add_joint_motion(node, body.axis, rate, parent.referred_to(body.offset));
    }
}

/// Quantities of a body in the scalar of the right-hand sides.
struct Lifted<R> {
    axis: Vec3<R>,
    offset: Vec3<R>,
    u_force: Force<R>,
    d_inverse: R,
}

impl<R: Real> Lifted<R> {
    #[inline(always)]
    fn of<S: Real>(body: &BodyData<S>, lift: impl Fn(S) -> R + Copy) -> Self {
        Self {
            axis: vector(body.axis(), lift),
            offset: vector(body.offset, lift),
            u_force: force(body.u_force, lift),
            d_inverse: lift(body.d_inverse),
        }
    }
}

/// Returns a vector in the scalar of the right-hand sides.
#[inline(always)]
fn vector<S: Real, R: Real>(v: Vec3<S>, lift: impl Fn(S) -> R + Copy) -> Vec3<R> {
    v.map(
        #[inline(always)]
        |x| lift(*x),
    )
}

/// Returns a force in the scalar of the right-hand sides.
#[inline(always)]
fn force<S: Real, R: Real>(f: Force<S>, lift: impl Fn(S) -> R + Copy) -> Force<R> {
    Force::new(vector(f.linear, lift), vector(f.angular, lift))
}

/// Adds the change of acceleration `M⁻¹ Jᵀ λ`, `(nv,)`, to `a`, and the changes of the accelerations of all
/// bodies and of the holding torques of locked joints to `bodies`.
#[inline(always)]
pub(super) fn add_response<S: Real>(
    (nodes, bodies): (&[Node], &mut [BodyData<S>]),
    (rows, lambda): (&[Row<S>], &[S]),
    supported: &[usize],
    scratch: &mut Scratch<S>,
    a: &mut [S],
) {
    let terms = &mut scratch.single[..];
    for term in &mut *terms {
        (term.force, term.effort) = (Force::zero(), S::of(0.0));
    }
    for (row, &lambda) in rows.iter().zip(lambda) {
        for side in 0..2 {
            let term = &mut terms[row.bodies[side]];
            term.force = row.forces[side].scale_add(lambda, term.force);
            term.effort = row.efforts[side].mul_add(lambda, term.effort);
        }
    }
    let base = bodies[0].articulated.inverse();
    respond(
        (nodes, bodies),
        &base,
        terms,
        (supported, 1..nodes.len()),
        #[inline(always)]
        |x| x,
    );
    let base = terms[0].acceleration;
    bodies[0].acceleration += base;
    (Motion::from_slice(a) + base).write(a);
    for k in 1..nodes.len() {
        let (body, term) = (&mut bodies[k], &terms[k]);
        // λ = Uᵀ a_p − u of a locked joint
        body.holding_torque += terms[nodes[k].parent].acceleration.dot(body.u_force) - term.effort;
        body.acceleration += term.acceleration;
        a[k + 5] += term.rate;
    }
}
