//! Changes of the velocities of the trees due to impulses at contact points and at joint stops.

use crate::dynamics::{ClosedLoops, Data, constrained_recursion, frame_jacobian, frame_pose, positions};
use crate::model::{BASE_NV, Model};
use crate::simulation::tree::Tree;
use crate::simulation::tree_state::TreeState;
use crate::spatial::{Real, Vec3, dot};

/// Point at which an impulse acts on two frames.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactAt {
    /// For both sides, the index of the tree and the index of the frame in its model.
    pub(super) places: [(usize, usize); 2],
    /// Position of the point in W, m.
    pub(super) at: Vec3<f64>,
    /// Unit vectors in W along which the three rows are measured: the normal from the first side to the
    /// second, and two tangents.
    pub(super) axes: [Vec3<f64>; 3],
}

/// Joint stop: indices of the tree and of the joint, and the sign of joint rates away from the stop.
#[derive(Clone, Copy, Debug)]
pub(super) struct StopAt {
    pub(super) tree: usize,
    pub(super) joint: usize,
    pub(super) away: f64,
}

/// Row `J` of the Jacobian of one tree, `(nv,)`, and the change of velocity that a unit impulse in this row
/// causes, `M⁻¹ Jᵀ`, `(nv,)`.
struct Part {
    tree: usize,
    jacobian: Vec<f64>,
    response: Vec<f64>,
}

/// Responses to unit impulses in all rows of an impulse problem.
pub(super) struct Responses {
    /// Parts of each row: one for each tree on which it acts, that is, two for a contact between two trees
    /// and otherwise one.
    rows: Vec<Vec<Part>>,
}

/// One tree at the configuration for which the responses are computed.
struct At<'a> {
    model: &'a Model,
    q: Vec<f64>,
    data: Data<f64>,
    loops: ClosedLoops<f64>,
    locked: Vec<bool>,
}

impl Responses {
    /// Computes the responses at the configurations in `states`. The rows are those of `points`, three for
    /// each, followed by those of `stops`. `locked` returns, for a tree (index), an array that is true for
    /// the joints whose rates do not change.
    pub(super) fn new<S: Real>(
        trees: &[Tree<'_, S>],
        states: &[TreeState<S>],
        points: &[ContactAt],
        stops: &[StopAt],
        locked: impl Fn(usize) -> Vec<bool>,
    ) -> Self {
        let mut known: Vec<Option<At<'_>>> = trees.iter().map(|_| None).collect();
        let start = |tree: usize| At::new(&trees[tree].model, &states[tree], locked(tree));
        let mut rows = Vec::new();
        for point in points {
            let mut lines: Vec<(usize, [Vec<f64>; 3])> = Vec::new();
            for ((tree, frame), sign) in point.places.into_iter().zip([-1.0, 1.0]) {
                let own = known[tree].get_or_insert_with(|| start(tree)).jacobian(frame, point, sign);
                match lines.iter_mut().find(|(other, _)| *other == tree) {
                    Some((_, sum)) => sum.iter_mut().zip(&own).for_each(|(sum, own)| add(sum, own)),
                    None => lines.push((tree, own)),
                }
            }
            for axis in 0..3 {
                let part = |(tree, lines): &(usize, [Vec<f64>; 3])| {
                    let at = known[*tree].get_or_insert_with(|| start(*tree));
                    at.part(*tree, lines[axis].clone())
                };
                rows.push(lines.iter().map(part).collect());
            }
        }
        for stop in stops {
            let mut line = vec![0.0; trees[stop.tree].model.nv()];
            line[BASE_NV + stop.joint] = stop.away;
            let at = known[stop.tree].get_or_insert_with(|| start(stop.tree));
            rows.push(vec![at.part(stop.tree, line)]);
        }
        Self { rows }
    }

    /// Returns `W = Σ J M⁻¹ Jᵀ` over all trees, `(n, n)`, row major.
    pub(super) fn matrix(&self) -> Vec<f64> {
        let n = self.rows.len();
        let mut matrix = vec![0.0; n * n];
        for (i, row) in self.rows.iter().enumerate() {
            for (j, column) in self.rows.iter().enumerate().take(i + 1) {
                let mut sum = 0.0;
                for part in row {
                    let other = column.iter().find(|other| other.tree == part.tree);
                    sum += other.map_or(0.0, |other| dot(&part.jacobian, &other.response));
                }
                (matrix[i * n + j], matrix[j * n + i]) = (sum, sum);
            }
        }
        matrix
    }

    /// Returns the change of velocity of each tree, `(nv,)`, that the impulses `p` cause. It is empty for
    /// trees on which no impulse acts.
    pub(super) fn changes(&self, trees: usize, p: &[f64]) -> Vec<Vec<f64>> {
        let mut changes = vec![Vec::new(); trees];
        for (row, p) in self.rows.iter().zip(p) {
            for part in row {
                let change: &mut Vec<f64> = &mut changes[part.tree];
                change.resize(part.response.len(), 0.0);
                change.iter_mut().zip(&part.response).for_each(|(sum, x)| *sum += x * p);
            }
        }
        changes
    }
}

fn add(sum: &mut [f64], line: &[f64]) {
    sum.iter_mut().zip(line).for_each(|(sum, x)| *sum += x);
}

impl<'a> At<'a> {
    fn new<S: Real>(model: &'a Model, state: &TreeState<S>, locked: Vec<bool>) -> Self {
        let q: Vec<f64> = state.q.iter().map(|x| x.lane(0)).collect();
        let mut data = Data::new(model);
        positions(model, &mut data, &q);
        Self { model, q, data, loops: ClosedLoops::new(model, model.closures()), locked }
    }

    /// Returns the Jacobian of the velocity of the material point of `frame` at `point`, times `sign`; one
    /// row for each of the three axes of the point.
    fn jacobian(&self, frame: usize, point: &ContactAt, sign: f64) -> [Vec<f64>; 3] {
        let nv = self.model.nv();
        let mut twist = vec![0.0; 6 * nv];
        frame_jacobian(self.model, &self.data, &self.q, frame, &mut twist);
        let arm = point.at - frame_pose(self.model, &self.data, &self.q, frame).pos_w;
        point.axes.map(|axis| {
            // n · (v + ω × r) = n · v + (r × n) · ω
            let turning = arm.cross(axis);
            let weights = [axis.x, axis.y, axis.z, turning.x, turning.y, turning.z];
            let entry = |j: usize| {
                sign * weights.iter().enumerate().map(|(i, weight)| weight * twist[i * nv + j]).sum::<f64>()
            };
            (0..nv).map(entry).collect()
        })
    }

    /// Returns the row `jacobian`, `(nv,)`, together with its response, which respects the locked joints and
    /// the closed loops.
    fn part(&mut self, tree: usize, jacobian: Vec<f64>) -> Part {
        let Self { model, data, loops, locked, .. } = self;
        let (at_rest, mut response) = (vec![0.0; model.nv()], vec![0.0; model.nv()]);
        let locked = locked.contains(&true).then_some((&locked[..], &[][..]));
        constrained_recursion(model, data, loops, (&at_rest, &jacobian), locked, &mut response);
        Part { tree, jacobian, response }
    }
}
