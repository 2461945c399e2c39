//! Closed kinematic loops and mimic joints as constraints on the motion of a tree.
//!
//! The constraints `φ(q) = 0` have the Jacobian `J`. With the constraint forces `λ`, the equations of motion
//! are `M a + c = τ + Σ Jᵀ F + Jᵀ λ` and `J a + J̇ v = 0`. Hence `A λ = −(J a_free + J̇ v)` with
//! `A = J M⁻¹ Jᵀ`, and `a = a_free + M⁻¹ Jᵀ λ`. Products with `M⁻¹` use the articulated-body inertias of the
//! preceding forward dynamics.

mod closing;
mod constrained;
mod constraint_force;
mod dense_response;
mod independent;
mod projection;
mod reduced;
mod refinement;
mod response;
mod rows;
mod unsatisfied;

pub use closing::close_loops;
pub use constrained::constrained_forward_dynamics;
pub(crate) use constrained::constrained_recursion;
pub(crate) use constraint_force::solve as solve_semidefinite;
pub use independent::IndependentJoints;
pub use projection::{close_velocity, closure_errors};
pub(crate) use projection::{project_configuration, project_velocity};

pub use reduced::{ConstrainedFreeFloating, constrained_free_floating};
pub(crate) use reduced::{add_leaders, length_joints};
pub use unsatisfied::UnsatisfiedConstraints;

use crate::dynamics::Data;
use crate::dynamics::kinematics::frame_offset;
use crate::model::{Closure, Constraint, Model, Node};
use crate::spatial::{Force, InverseArticulated, Real, Vec3};
use response::Scratch;
use rows::{JointRows, Row};

/// Constraints of the closed loops and mimic joints of a model, with the workspace to solve them.
#[derive(Clone, Debug)]
pub struct ClosedLoops<S> {
    closures: Vec<Closure>,
    /// Rows of `J`; those of one closure follow each other.
    rows: Vec<Row<S>>,
    /// Right-hand sides, `(m,)`, before the solution, and the constraint forces `λ` after it.
    force: Vec<S>,
    /// Constraint error `φ`, `(m,)`, m and rad.
    error: Vec<S>,
    /// `A = J M⁻¹ Jᵀ`, `(m, m)`, before the solution, and its factors after it.
    matrix: Vec<S>,
    /// Compliances of the base under the forces of the rows, `(m,)`.
    compliance: Vec<S>,
    /// Scales of the rows, `(m,)`.
    scale: Vec<S>,
    /// Bodies on the paths from the base to the bodies of the constraints, without the base, in ascending
    /// order.
    supported: Vec<usize>,
    /// Inverse of the articulated inertia of the whole robot.
    base: InverseArticulated<S>,
    scratch: Scratch<S>,
    joint_rows: JointRows<S>,
    buffers: Buffers<S>,
}

/// Buffers that the projections and the refinement use, so that a step allocates nothing.
#[derive(Clone, Debug)]
struct Buffers<S> {
    /// Change of a velocity or of a configuration, `(nv,)`.
    change: Vec<S>,
    /// Configuration after a change, `(nq,)`.
    moved: Vec<S>,
    /// Rates of the constraint errors, `(m,)`, m/s and rad/s.
    rates: Vec<S>,
    /// Constraint forces before a refinement, `(m,)`.
    before: Vec<S>,
    /// Generalized forces `τ + Jᵀ λ`, which include those of the constraints, `(nv,)`.
    applied: Vec<S>,
    /// Zeros, `(nv,)`: the velocity and the generalized forces of a robot at rest.
    zeros: Vec<S>,
}

impl<S: Real> Buffers<S> {
    fn new(model: &Model, m: usize) -> Self {
        let zeros = |count: usize| vec![S::of(0.0); count];
        let (nq, nv) = (model.nq(), model.nv());
        Self {
            change: zeros(nv),
            moved: zeros(nq),
            rates: zeros(m),
            before: zeros(m),
            applied: zeros(nv),
            zeros: zeros(nv),
        }
    }
}

impl<S: Real> ClosedLoops<S> {
    /// Allocates the workspace for `closures` of `model`.
    pub fn new(model: &Model, closures: &[Closure]) -> Self {
        let (m, zero) = (closures.iter().map(Closure::rows).sum::<usize>(), S::of(0.0));
        let rows: Vec<Row<S>> = closures.iter().flat_map(Row::of).collect();
        let supported = support(model.nodes(), rows.iter().flat_map(|row| row.bodies));
        let dense = if model.is_heavy_on_light() { m * model.nv() } else { 0 };
        Self {
            closures: closures.to_vec(),
            force: vec![zero; m],
            error: vec![zero; m],
            matrix: vec![zero; m * m],
            compliance: vec![zero; m],
            scale: vec![zero; m],
            base: InverseArticulated::default(),
            scratch: Scratch::new(model.nodes().len(), dense),
            joint_rows: JointRows::default(),
            rows,
            supported,
            buffers: Buffers::new(model, m),
        }
    }

    /// Returns true if there are no constraints.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Returns the constraints.
    pub fn closures(&self) -> &[Closure] {
        &self.closures
    }

    /// Returns the constraint forces `λ` computed last, `(m,)`, N and N m. Those of a loop are the force and
    /// the moment on its second body about the origin of the second frame, along the constrained directions
    /// of the first frame. The force of a distance constraint acts along the line between the two origins and
    /// is positive if it pushes them apart. A mimic joint has one entry, the torque (force) on this joint.
    pub fn forces(&self) -> &[S] {
        &self.force
    }

    /// Returns the origin of the second frame of a loop (index) relative to the base origin, m, and the
    /// wrench of the constraint forces computed last on the second body about this origin, N and N m, both in
    /// base axes; zeros for a mimic joint. Requires up-to-date poses in `data`.
    pub(crate) fn wrench(&self, closure: usize, data: &Data<S>) -> (Vec3<S>, Force<S>) {
        let Constraint::Frames { frames: [_, frame], .. } = &self.closures[closure].constraint else {
            return (Vec3::zero(), Force::zero());
        };
        let offset = frame_offset(data, frame);
        let mut wrench = Force::zero();
        for i in self.range_of(closure) {
            wrench = self.rows[i].forces[1].scale_add(self.force[i], wrench);
        }
        (data.bodies[frame.body].pos_b + offset, wrench.from_point(-offset))
    }

    /// Returns the magnitudes of the linear and of the angular entries of `x`, `(m,)`, that belong to a
    /// closure (index): m and rad for errors, N and N m for forces. The entry of a mimic joint counts as
    /// angular. If `S` has several SIMD lanes, the magnitudes are those of the first lane.
    pub fn magnitudes(&self, closure: usize, x: &[S]) -> [f64; 2] {
        let own = &x[self.range_of(closure)];
        let mut squares = [0.0; 2];
        for (row, x) in own.iter().map(|x| x.lane(0)).enumerate() {
            squares[usize::from(rows::is_angular(&self.closures[closure], row))] += x * x;
        }
        squares.map(f64::sqrt)
    }

    /// Returns the rates of the constraint errors, `J v`, `(m,)`, m/s and rad/s, at a velocity `v`, `(nv,)`,
    /// whose kinematics are in `data`.
    pub fn rates(&mut self, data: &Data<S>, v: &[S]) -> &[S] {
        self.update_rows(data);
        let Self { rows, buffers: Buffers { rates, .. }, .. } = self;
        rates.iter_mut().zip(rows).for_each(|(rate, row)| *rate = row.rate(data, v));
        rates
    }

    /// Returns the pivots of the scaled matrix `A` in the last solution, `(m,)`, in the first SIMD lane. The
    /// pivot of a row is zero if the row depends on the rows before it, and small if it nearly depends on
    /// them.
    pub(crate) fn pivots(&self) -> impl Iterator<Item = f64> + '_ {
        let m = self.rows.len();
        (0..m)
            .map(move |i| self.matrix[i * m + i].lane(0))
            .map(|inverse| if inverse > 0.0 { 1.0 / inverse } else { 0.0 })
    }

    /// Returns the range of the rows of a closure (index).
    pub fn range_of(&self, closure: usize) -> std::ops::Range<usize> {
        let start = self.closures[..closure].iter().map(Closure::rows).sum::<usize>();
        start..start + self.closures[closure].rows()
    }

    /// Updates the rows of `J`. Requires up-to-date [`positions`](super::positions) in `data`.
    #[inline(always)]
    fn update_rows(&mut self, data: &Data<S>) {
        let mut start = 0;
        for closure in &self.closures {
            let end = start + closure.rows();
            rows::update(closure, data, &mut self.rows[start..end]);
            start = end;
        }
    }
}

/// Returns all bodies on the paths from the base to `bodies`, without the base, in ascending order.
fn support(nodes: &[Node], bodies: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut is_supported = vec![false; nodes.len()];
    for mut body in bodies {
        while body > 0 {
            is_supported[body] = true;
            body = nodes[body].parent;
        }
    }
    (1..nodes.len()).filter(|&body| is_supported[body]).collect()
}
