//! Selection of the pairs of pieces that can have the smallest gap of a contact.

use super::Contacts;
use crate::contact::ContactError;
use crate::simulation::state::State;
use crate::simulation::tree::Tree;
use crate::spatial::Real;

impl Contacts {
    /// Writes lower bounds of the gaps of all pairs of a contact to `self.gaps.bounds`, and returns an upper
    /// bound of the smallest gap, m. Pairs with larger lower bounds do not have the smallest gap. Without a
    /// broad phase, every pair must be evaluated, and the upper bound is infinite.
    pub(super) fn bound_gaps<S: Real>(
        &mut self,
        contact: usize,
        trees: &[Tree<'_, S>],
        state: &State<S>,
    ) -> Result<f64, ContactError> {
        let Self { list, near, states, gaps, frames, steps, .. } = self;
        if !steps.has_broad_phase {
            gaps.bounds.clear();
            gaps.bounds.resize(gaps.pairs[contact].len(), f64::NEG_INFINITY);
            return Ok(f64::INFINITY);
        }
        gaps.bound(contact, list, |side| frames.motion(side.number, trees, state).frame.compose(&side.pose));
        let (first, mut least) = (gaps.pairs[contact].start, f64::INFINITY);
        for &number in near.iter().filter(|number| gaps.pairs[contact].contains(*number)) {
            if let Some(loading) = &list[number].last {
                gaps.bounds[number - first] = f64::NEG_INFINITY;
                least = least.min(-loading.depth);
            }
        }
        let Some(at) = gaps.lowest().filter(|at| gaps.bounds[*at] <= least) else { return Ok(least) };
        let (touching, own) = (&list[first + at], &states[first + at]);
        let loading = touching.evaluate(&touching.motions(frames, trees, state), own)?;
        Ok(least.min(-loading.depth))
    }
}
