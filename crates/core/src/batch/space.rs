//! Workspace and rows of as many states as stand side by side.

use super::input::{UNIT_NORM, Wrenches};
use super::kernel::{Kernel, OUTPUTS};
use super::side_by_side::{Places, gather, scatter};
use super::work::Work;
use crate::dynamics::FrameWrench;
use crate::model::{Model, Node};
use crate::spatial::{Force, Quat, Real, Sym3, Vec3};
use std::ops::Range;

/// Rows of an input: all numbers, and how many a row has.
#[derive(Clone, Copy, Debug)]
pub struct Rows<'a> {
    /// Row after row.
    pub data: &'a [f64],
    /// Numbers per row.
    pub width: usize,
}

/// An output, row after row.
pub type RowsMut<'a> = &'a mut [f64];

/// What to compute, of what.
#[derive(Clone, Copy)]
pub(super) struct Call<'a> {
    pub(super) kernel: Kernel,
    pub(super) model: &'a Model,
    pub(super) inputs: &'a [Rows<'a>],
    pub(super) external: &'a [Wrenches<'a>],
}

impl Call<'_> {
    /// Number of states.
    pub(super) fn count(&self) -> usize {
        self.inputs[0].data.len() / self.inputs[0].width.max(1)
    }
}

/// Workspace and rows of one state, or one set of lanes.
#[derive(Clone, Debug)]
pub(super) struct Space<S> {
    work: Work<S>,
    /// Of the robot it is room for: mass, centre of mass and inertia of the base, which are placed once.
    base: (f64, Vec3<f64>, Sym3<f64>),
    inputs: [Vec<S>; 3],
    outputs: [Vec<S>; OUTPUTS],
    /// Whether no input is so large that products of it may overflow.
    is_tame: bool,
}

impl<S: Real> Space<S> {
    pub(super) fn new(model: &Model) -> Self {
        let (inputs, outputs) = (Default::default(), Default::default());
        Self { work: Work::new(model), base: base_of(model), inputs, outputs, is_tame: true }
    }

    /// Whether it is room for this robot.
    pub(super) fn fits(&self, model: &Model) -> bool {
        self.work.data.bodies.len() == model.nodes().len() && self.base == base_of(model)
    }

    /// Computes the states `range` (at most one per lane) into rows of their own; whether inputs and outputs are
    /// as they should be. If inputs are not, nothing is written.
    ///
    /// Lanes beyond the range repeat its last state and are thrown away.
    pub(super) fn states(
        &mut self,
        call: &Call<'_>,
        range: Range<usize>,
        outputs: &mut [RowsMut<'_>],
    ) -> bool {
        let Call { kernel, model, .. } = *call;
        if !S::enter(
            #[inline(always)]
            || self.read(call, &range),
        ) {
            return false;
        }
        for (space, out) in self.outputs.iter_mut().zip(outputs.iter()) {
            space.resize(out.len() / range.len(), S::of(0.0));
        }
        kernel.run(model, &mut self.work, &self.inputs, &mut self.outputs);
        S::enter(
            #[inline(always)]
            || {
                for (out, space) in outputs.iter_mut().zip(&self.outputs) {
                    scatter(space, Places { first: 0, stride: space.len(), count: range.len() }, out);
                }
                match self.is_tame {
                    true => !kernel.divides() || is_finite(&self.outputs[0]),
                    false => self.outputs.iter().all(|out| is_finite(out)),
                }
            },
        )
    }

    /// Takes the states in; whether all numbers are finite and all quaternions of unit norm.
    #[inline(always)]
    fn read(&mut self, call: &Call<'_>, range: &Range<usize>) -> bool {
        let mut is_fine = true;
        self.is_tame = true;
        for ((to, from), name) in self.inputs.iter_mut().zip(call.inputs).zip(call.kernel.inputs()) {
            to.resize(from.width, S::of(0.0));
            gather(from.data, places(from.width, range), to);
            is_fine &= is_usable(to, &mut self.is_tame);
            if name.starts_with('q') {
                is_fine &= normalise(&mut to[3..7]);
            }
        }
        self.work.external.clear();
        for Wrenches { frame, rows } in call.external {
            let mut numbers = [S::of(0.0); 6];
            let range = if rows.len() == 6 { &(0..1) } else { range }; // one for all
            gather(rows, places(6, range), &mut numbers);
            is_fine &= is_usable(&numbers, &mut self.is_tame);
            let wrench = Force::from_slice(&numbers);
            self.work.external.push(FrameWrench { frame: *frame, wrench });
        }
        is_fine
    }
}

fn base_of(model: &Model) -> (f64, Vec3<f64>, Sym3<f64>) {
    let Node { mass, com, about_com, .. } = model.nodes()[0];
    (mass, com, about_com)
}

fn places(width: usize, range: &Range<usize>) -> Places {
    Places { first: range.start * width, stride: width, count: range.len() }
}

/// Whether all numbers are.
#[inline(always)]
fn is_finite<S: Real>(numbers: &[S]) -> bool {
    is_finite_times(S::of(1.0), numbers)
}

/// Whether all numbers are small enough, below 1e58, that no kernel's products overflow.
#[inline(always)]
fn is_tame<S: Real>(numbers: &[S]) -> bool {
    is_finite_times(S::of(1e250), numbers)
}

/// Whether all numbers are finite; `all_tame` stays so if they are small, too.
#[inline(always)]
fn is_usable<S: Real>(numbers: &[S], all_tame: &mut bool) -> bool {
    let is_tame = is_tame(numbers);
    *all_tame &= is_tame;
    is_tame || is_finite(numbers)
}

#[inline(always)]
fn is_finite_times<S: Real>(factor: S, numbers: &[S]) -> bool {
    // 0 · x is 0 for a finite x alone; four sums, since one would wait for itself
    let mut sums = [S::of(0.0); 4];
    for (i, x) in numbers.iter().enumerate() {
        sums[i % 4] = (*x * factor).mul_add(S::of(0.0), sums[i % 4]);
    }
    let sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    !S::any(S::less(S::of(0.0), S::select(S::less(sum, S::of(1.0)), S::of(0.0), S::of(1.0))))
}

/// Normalises x, y, z, w; whether their norm was 1 already, up to what is accepted.
#[inline(always)]
fn normalise<S: Real>(xyzw: &mut [S]) -> bool {
    // as `check_quaternions` does it, to the bit
    let squared = xyzw[0] * xyzw[0] + xyzw[1] * xyzw[1] + xyzw[2] * xyzw[2] + xyzw[3] * xyzw[3];
    let off = (squared.sqrt() - S::of(1.0)).abs();
    Quat::from_xyzw(xyzw).normalized().write_xyzw(xyzw);
    !S::any(S::less(S::of(UNIT_NORM), off))
}
