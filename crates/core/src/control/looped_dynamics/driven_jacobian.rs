//! Jacobian of a frame with respect to the driven joints of a robot with closed loops.

use super::LoopedDynamics;
use crate::control::pseudo_inverse::ROWS;
use crate::spatial::Scalar;

impl LoopedDynamics {
    /// Computes the Jacobian `J_A = J G_c (G_Aᵀ G_A)⁻¹ G_Aᵀ`, row major `(6, a)`, of a frame with respect to
    /// the `driven` joints `A`, and writes it to `out`. `jacobian` is `J`, as for
    /// [`add_task`](Self::add_task); `driven` has the indices of the joints in the robot. `G_c` has the
    /// columns of `G` whose independent joints are driven, and `G_A` its rows of the driven joints. Passive
    /// joints become dependent first, so that their motion is included as far as the driven joints determine
    /// it.
    ///
    /// While the loops are closed, `J_A q̇_A` is the velocity of the frame that the driven joints cause, and
    /// the torques `J_Aᵀ F` do the work of a wrench `F` on the frame. Requires
    /// [`Looped::update`](super::Looped::update). Replaces the independent joints that
    /// [`eliminate`](Self::eliminate) chose.
    pub(in crate::control) fn driven_jacobian<S: Scalar>(
        &mut self,
        jacobian: &[S],
        driven: &[usize],
        out: &mut [f64],
    ) {
        self.set_jacobian(jacobian);
        let Self { n, m, own, jacobian, right, is_length, leader, joints, torques, work, .. } = self;
        jacobian.truncate(*m * *n);
        right.truncate(*m);
        let [rows, columns] = is_length;
        rows.truncate(*m);
        work.class.clear();
        work.class.extend_from_slice(leader);
        driven.iter().for_each(|&i| work.class[own[i]] += 2);
        joints.solve((jacobian, right), &work.class, [rows, columns]);
        let is_driven = |j: usize| driven.iter().any(|&i| own[i] == j);
        torques.set(joints, driven.iter().map(|&i| own[i]), is_driven);
        let [all, reduced] = &mut work.jacobians;
        let (f, a) = (joints.count(), driven.len());
        reduced.clear();
        reduced.resize(ROWS * f, 0.0);
        joints.reduce_rows(all, reduced);
        out.fill(0.0);
        for (row, out) in reduced.chunks_exact(f.max(1)).zip(out.chunks_exact_mut(a)) {
            let along = &mut work.loads;
            along.clear();
            along.extend(torques.columns.iter().map(|&c| row[c]));
            torques.apply(along, |place, x| out[place] = x);
        }
    }
}
