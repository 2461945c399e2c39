//! Kernels that are timed, with their states and results.

use onorbit_core::dynamics::{
    ClosedLoops, Data, FreeFloating, constrained_forward_dynamics, forward_dynamics, frame_drift,
    frame_jacobian, free_floating, inverse_dynamics, kinematics, mass_matrix,
};
use onorbit_core::model::Model;
use onorbit_core::spatial::Real;

/// Names of the kernels: forward dynamics, mass matrix, inverse dynamics, Jacobian and drift of the tool,
/// reduced model (`M*, c*, Jg, d` of the tool), and forward dynamics with the loops of the robot.
pub(crate) const KERNELS: [&str; 6] = ["aba", "crba", "rnea", "jacobian", "reduced", "constrained"];

/// Configuration `q`, velocity `v`, and generalized forces or accelerations `x` of one state.
struct State<S> {
    q: Vec<S>,
    v: Vec<S>,
    x: Vec<S>,
}

/// Robot, states and workspace of the kernels.
pub(crate) struct Kernels<'a, S> {
    model: &'a Model,
    tool: usize,
    states: Vec<State<S>>,
    data: Data<S>,
    loops: ClosedLoops<S>,
    reduced: FreeFloating<S>,
    out: Vec<S>,
    matrix: Vec<S>,
    jacobian: Vec<S>,
    drift: Vec<S>,
}

impl<'a, S: Real> Kernels<'a, S> {
    /// Creates the workspace. `tool` is the index of the tool frame, and `rows` holds `q, v, x` of one state
    /// after the other.
    pub(crate) fn new(model: &'a Model, tool: usize, rows: &[f64]) -> Self {
        let (nq, nv, o) = (model.nq(), model.nv(), S::of(0.0));
        let lift = |row: &[f64]| row.iter().map(|x| S::of(*x)).collect();
        let states = rows
            .chunks_exact(nq + 2 * nv)
            .map(|row| State { q: lift(&row[..nq]), v: lift(&row[nq..nq + nv]), x: lift(&row[nq + nv..]) })
            .collect();
        Self {
            model,
            tool,
            states,
            data: Data::new(model),
            loops: ClosedLoops::new(model, model.closures()),
            reduced: FreeFloating::new(model),
            out: vec![o; nv],
            matrix: vec![o; nv * nv],
            jacobian: vec![o; 6 * nv],
            drift: vec![o; 6],
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.states.len()
    }

    /// Runs the kernel with the index `kernel` in [`KERNELS`] on state `k`, and returns one number of the
    /// result, so that the compiler cannot omit the computation.
    #[inline(always)]
    pub(crate) fn run(&mut self, kernel: usize, k: usize) -> S {
        let Self { model, tool, states, data, loops, reduced, out, matrix, jacobian, drift } = self;
        let (State { q, v, x }, tool) = (&states[k], *tool);
        match kernel {
            0 => {
                forward_dynamics(model, data, q, v, x, &[], out);
                out[6]
            }
            1 => {
                mass_matrix(model, data, q, matrix);
                matrix[0]
            }
            2 => {
                inverse_dynamics(model, data, q, v, x, &[], out);
                out[6]
            }
            3 => {
                kinematics(model, data, q, v);
                frame_jacobian(model, data, q, tool, jacobian);
                frame_drift(model, data, q, v, tool).write(drift);
                drift[0]
            }
            4 => {
                free_floating(model, data, q, v, tool, &[], reduced);
                reduced.drift.write(drift);
                drift[0]
            }
            _ => {
                constrained_forward_dynamics((model, data, loops), q, v, x, &[], out);
                out[6]
            }
        }
    }

    /// Returns all numbers of the last result of the kernel with the index `kernel`, matrices row by row.
    pub(crate) fn output(&self, kernel: usize) -> impl Iterator<Item = S> {
        let reduced = &self.reduced;
        let parts: [&[S]; 4] = match kernel {
            0 | 2 | 5 => [&self.out, &[], &[], &[]],
            1 => [&self.matrix, &[], &[], &[]],
            3 => [&self.jacobian, &self.drift, &[], &[]],
            _ => [&reduced.inertia, &reduced.bias, &reduced.jacobian, &self.drift],
        };
        parts.into_iter().flatten().copied()
    }
}
