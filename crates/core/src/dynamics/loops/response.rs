//! Accelerations caused by constraint forces, from the articulated-body inertias of the preceding forward
//! dynamics.

use super::rows::Row;
use crate::dynamics::BodyData;
use crate::dynamics::subspace::{add_joint_motion, joint_effort};
use crate::model::Node;
use crate::spatial::{ColumnKernel, Force, InverseArticulated, Motion, Real, Vec3};
use std::any::Any;

/// Quantities of one body in the computation of the response to constraint forces.
#[derive(Clone, Copy, Debug, Default)]
struct Term<R> {
    /// Sum of the forces on the articulated body, about the origin of the body in base axes.
    force: Force<R>,
    /// Effort at the joint, then `u = τ + Sᵀ f`, and then `u − Uᵀ a_p`.
    effort: R,
    acceleration: Motion<R>,
    /// Acceleration of the joint.
    rate: R,
}

/// Buffers for the computation of responses to constraint forces.
#[derive(Debug)]
pub(super) struct Scratch<S> {
    single: Vec<Term<S>>,
    /// Terms with one right-hand side per lane of a scalar type that the kernel chooses.
    columns: Box<dyn Any + Send + Sync>,
    /// `J`, row major `(m, nv)`, of robots with dense forward dynamics; empty for other robots.
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
/// constraint force in row `c` causes at rest. `compliance`, `(m,)`, receives `Fᵀ IA_0⁻¹ F` with the force
/// `F` of each row on its second body, about the base origin, and the articulated inertia `IA_0` of the base.
#[inline(always)]
pub(super) fn inverse_apparent_mass<S: Real>(
    (nodes, bodies): (&[Node], &[BodyData<S>]),
    base: &InverseArticulated<S>,
    (rows, supported): (&[Row<S>], &[usize]),
    scratch: &mut Scratch<S>,
    (matrix, compliance): (&mut [S], &mut [S]),
) {
    let columns = &mut scratch.columns;
    S::solve_columns(UnitResponses { nodes, bodies, base, rows, supported, columns, matrix, compliance });
}

struct UnitResponses<'a, S> {
    nodes: &'a [Node],
    bodies: &'a [BodyData<S>],
    base: &'a InverseArticulated<S>,
    rows: &'a [Row<S>],
    supported: &'a [usize],
    columns: &'a mut Box<dyn Any + Send + Sync>,
    matrix: &'a mut [S],
    compliance: &'a mut [S],
}

impl<S: Real> ColumnKernel<S> for UnitResponses<'_, S> {
    #[inline(always)]
    fn run<R: Real>(self, lift: impl Fn(S) -> R + Copy) {
        let Self { nodes, bodies, base, rows, supported, columns, matrix, compliance } = self;
        // a scalar with several lanes holds one column per lane; otherwise each column is a scalar
        let width = if S::LANES == 1 { R::LANES } else { 1 };
        let groups = rows.len().div_ceil(width);
        if !columns.is::<Vec<Term<R>>>() {
            *columns = Box::new(vec![Term::<R>::default(); nodes.len() * groups]);
        }
        let Some(terms) = columns.downcast_mut::<Vec<Term<R>>>() else { return };
        let base = base.map(
            #[inline(always)]
            |x| lift(*x),
        );
        clear(&mut terms[..groups]);
        for &k in supported {
            clear(&mut terms[k * groups..(k + 1) * groups]);
        }
        for (group, rows) in rows.chunks(width).enumerate() {
            add_forces(terms, (group, groups), rows, lift);
        }
        respond((nodes, bodies), &base, (terms, groups), (supported, supported.iter().copied()), lift);
        for (group, columns) in rows.chunks(width).enumerate() {
            let first = group * width;
            // A is symmetric, so the rows above the group are not needed
            for (r, row) in rows.iter().enumerate().skip(first) {
                let accelerations = acceleration(terms, (group, groups), row, lift);
                for c in first..(first + columns.len()).min(r + 1) {
                    matrix[r * rows.len() + c] = of_column::<S, R>(accelerations, c - first);
                }
            }
            let force = second_forces(bodies, columns, lift);
            let accelerations = base.apply(force).dot(force);
            for (c, compliance) in compliance[first..].iter_mut().take(columns.len()).enumerate() {
                *compliance = of_column::<S, R>(accelerations, c);
            }
        }
    }
}

/// Returns the result for the right-hand side `column`: lane `column` of `x` if `S` has one lane. Otherwise,
/// `x` holds a single right-hand side, and all of its lanes, which are different states, are returned.
#[inline(always)]
fn of_column<S: Real, R: Real>(x: R, column: usize) -> S {
    match S::LANES {
        1 => S::of(x.lane(column)),
        _ => S::from_lanes(|lane| x.lane(lane)),
    }
}

/// Returns a scalar that has the number returned by `of` for each row in the lane of its right-hand side; the
/// lane of the first row is `first`. The other lanes are zero. If `S` has several lanes, there is a single
/// row.
#[inline(always)]
fn to_columns<S: Real, R: Real>(
    rows: &[Row<S>],
    first: usize,
    of: impl Fn(&Row<S>) -> S,
    lift: impl Fn(S) -> R + Copy,
) -> R {
    if S::LANES > 1 {
        return lift(of(&rows[0]));
    }
    R::from_lanes(
        #[inline(always)]
        |lane| match lane.checked_sub(first) {
            Some(i) if i < rows.len() => of(&rows[i]).lane(0),
            _ => 0.0,
        },
    )
}

/// Returns the force that `of` returns for each row in the lane of its right-hand side, as [`to_columns`]
/// does for numbers.
#[inline(always)]
fn force_columns<S: Real, R: Real>(
    rows: &[Row<S>],
    first: usize,
    of: impl Fn(&Row<S>) -> Force<S>,
    lift: impl Fn(S) -> R + Copy,
) -> Force<R> {
    macro_rules! column {
        ($part:ident, $axis:ident) => {
            to_columns(
                rows,
                first,
                #[inline(always)]
                |row| of(row).$part.$axis,
                lift,
            )
        };
    }
    Force::new(
        Vec3::new(column!(linear, x), column!(linear, y), column!(linear, z)),
        Vec3::new(column!(angular, x), column!(angular, y), column!(angular, z)),
    )
}

/// Returns the forces of the rows on their second bodies, about the base origin in base axes, each in the
/// lane of its right-hand side.
#[inline(always)]
fn second_forces<S: Real, R: Real>(
    bodies: &[BodyData<S>],
    rows: &[Row<S>],
    lift: impl Fn(S) -> R + Copy,
) -> Force<R> {
    force_columns(
        rows,
        0,
        #[inline(always)]
        |row| row.forces[1].from_point(bodies[row.bodies[1]].pos_b),
        lift,
    )
}

#[inline(always)]
fn clear<R: Real>(terms: &mut [Term<R>]) {
    for term in terms {
        (term.force, term.effort) = (Force::zero(), R::of(0.0));
    }
}

/// Adds the constraint forces and joint efforts of the rows of a group to the terms of the bodies on which
/// they act, each in the lane of its column.
#[inline(always)]
fn add_forces<S: Real, R: Real>(
    terms: &mut [Term<R>],
    (group, groups): (usize, usize),
    rows: &[Row<S>],
    lift: impl Fn(S) -> R + Copy,
) {
    let mut first = 0;
    while first < rows.len() {
        // rows of one closure act on the same bodies
        let bodies = rows[first].bodies;
        let mut end = first + 1;
        while end < rows.len() && rows[end].bodies == bodies {
            end += 1;
        }
        let rows = &rows[first..end];
        for side in 0..2 {
            let term = &mut terms[bodies[side] * groups + group];
            term.force += force_columns(
                rows,
                first,
                #[inline(always)]
                |row| row.forces[side],
                lift,
            );
            term.effort += to_columns(
                rows,
                first,
                #[inline(always)]
                |row| row.efforts[side],
                lift,
            );
        }
        first = end;
    }
}

/// Returns the product of `row` and the accelerations of a response.
#[inline(always)]
fn acceleration<S: Real, R: Real>(
    terms: &[Term<R>],
    (group, groups): (usize, usize),
    row: &Row<S>,
    lift: impl Fn(S) -> R + Copy,
) -> R {
    let mut sum = R::of(0.0);
    for side in 0..2 {
        let term = &terms[row.bodies[side] * groups + group];
        sum = term.acceleration.dot_add(force(row.forces[side], lift), sum);
        sum = term.rate.mul_add(lift(row.efforts[side]), sum);
    }
    sum
}

/// Computes the accelerations that the forces and efforts in `terms` cause at rest. Each body has `groups`
/// consecutive terms, one for each group of right-hand sides. Forces act only on the base and on the bodies
/// `loaded`. The accelerations are computed for the base and for the bodies `moved`, which must include all
/// of their parents. Both lists are in ascending order.
#[inline(always)]
fn respond<S: Real, R: Real>(
    (nodes, bodies): (&[Node], &[BodyData<S>]),
    base: &InverseArticulated<R>,
    (terms, groups): (&mut [Term<R>], usize),
    (loaded, moved): (&[usize], impl Iterator<Item = usize>),
    lift: impl Fn(S) -> R + Copy,
) {
    for &k in loaded.iter().rev() {
        let (node, body) = (&nodes[k], Lifted::of(&bodies[k], lift));
        let (parents, own) = terms.split_at_mut(k * groups);
        let parents = &mut parents[node.parent * groups..(node.parent + 1) * groups];
        for (term, parent) in own[..groups].iter_mut().zip(parents) {
            // u = τ + Sᵀ f;  f − U u/D acts on the parent
            let u = term.effort + joint_effort(node, body.axis, term.force);
            term.effort = u;
            let carried = body.u_force.scale_add(-u * body.d_inverse, term.force.from_point(body.offset));
            parent.force += carried;
        }
    }
    for term in &mut terms[..groups] {
        // a_0 = IA⁻¹ f
        term.acceleration = base.apply(term.force);
    }
    for k in moved {
        let (node, body) = (&nodes[k], Lifted::of(&bodies[k], lift));
        let (parents, own) = terms.split_at_mut(k * groups);
        let parents = &parents[node.parent * groups..(node.parent + 1) * groups];
        for (term, parent) in own[..groups].iter_mut().zip(parents) {
            let parent = parent.acceleration;
            // q̈ = (u − Uᵀ a_p)/D,  a = a_p + S q̈
            term.effort -= parent.dot(body.u_force);
            term.rate = term.effort * body.d_inverse;
            term.acceleration = add_joint_motion(node, body.axis, term.rate, parent.referred_to(body.offset));
        }
    }
}

/// Quantities of a body, converted to the scalar type of the right-hand sides.
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

/// Converts a vector to the scalar type of the right-hand sides.
#[inline(always)]
fn vector<S: Real, R: Real>(v: Vec3<S>, lift: impl Fn(S) -> R + Copy) -> Vec3<R> {
    v.map(
        #[inline(always)]
        |x| lift(*x),
    )
}

/// Converts a force to the scalar type of the right-hand sides.
#[inline(always)]
fn force<S: Real, R: Real>(f: Force<S>, lift: impl Fn(S) -> R + Copy) -> Force<R> {
    Force::new(vector(f.linear, lift), vector(f.angular, lift))
}

/// Adds the change of acceleration `M⁻¹ Jᵀ λ`, `(nv,)`, to `a`, and the changes of the accelerations of all
/// bodies and of the holding torques of locked joints to `bodies`.
#[inline(always)]
pub(super) fn add_response<S: Real>(
    (nodes, bodies): (&[Node], &mut [BodyData<S>]),
    base: &InverseArticulated<S>,
    (rows, lambda): (&[Row<S>], &[S]),
    (supported, locked): (&[usize], Option<&[bool]>),
    scratch: &mut Scratch<S>,
    a: &mut [S],
) {
    let terms = &mut scratch.single[..];
    clear(terms);
    for (row, &lambda) in rows.iter().zip(lambda) {
        for side in 0..2 {
            let term = &mut terms[row.bodies[side]];
            term.force = row.forces[side].scale_add(lambda, term.force);
            term.effort = row.efforts[side].mul_add(lambda, term.effort);
        }
    }
    respond(
        (nodes, bodies),
        base,
        (terms, 1),
        (supported, 1..nodes.len()),
        #[inline(always)]
        |x| x,
    );
    let base = terms[0].acceleration;
    bodies[0].acceleration += base;
    (Motion::from_slice(a) + base).write(a);
    for k in 1..nodes.len() {
        let (body, term) = (&mut bodies[k], &terms[k]);
        if locked.is_some_and(|locked| locked[k - 1]) {
            // λ = Uᵀ a_p − u
            body.holding_torque -= term.effort;
        }
        body.acceleration += term.acceleration;
        a[k + 5] += term.rate;
    }
}
