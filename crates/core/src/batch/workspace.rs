//! Workspace of a kernel call for one group of SIMD lanes.

use super::call::{Call, RowsMut, Wrenches};
use super::gather_scatter::{Strides, gather, scatter};
use super::input::UNIT_NORM;
use super::kernels::{KernelData, OUTPUTS};
use crate::dynamics::FrameWrench;
use crate::model::{Model, Node, QUATERNION};
use crate::spatial::{Force, Quat, Real, Sym3, Vec3};
use std::ops::Range;

/// Kernel data, inputs and outputs of one state, or of one group of SIMD lanes.
#[derive(Clone, Debug)]
pub(super) struct Workspace<S> {
    kernel_data: KernelData<S>,
    /// Mass, centre of mass and inertia of the robot's base, which `kernel_data` copies only when it is
    /// allocated.
    base: (f64, Vec3<f64>, Sym3<f64>),
    inputs: [Vec<S>; 3],
    outputs: [Vec<S>; OUTPUTS],
    /// True if all inputs are so small that no product of inputs overflows.
    cannot_overflow: bool,
}

impl<S: Real> Workspace<S> {
    pub(super) fn new(model: &Model) -> Self {
        let (inputs, outputs) = (Default::default(), Default::default());
        Self {
            kernel_data: KernelData::new(model),
            base: base_of(model),
            inputs,
            outputs,
            cannot_overflow: true,
        }
    }

    /// Returns true if the workspace can be used for this robot: it must have been allocated for a robot with
    /// the same number of bodies, the same base and the same closures.
    pub(super) fn fits(&self, model: &Model) -> bool {
        self.kernel_data.data.bodies.len() == model.nodes().len()
            && self.base == base_of(model)
            && self.kernel_data.loops.closures() == model.closures()
    }

    /// Computes the states in `range`, at most one per lane. Returns true if inputs and outputs are valid; if
    /// the inputs are invalid, nothing is written.
    ///
    /// Lanes without a state repeat the last state of the range; their results are discarded.
    pub(super) fn compute(
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
        for (lanes, out) in self.outputs.iter_mut().zip(outputs.iter()) {
            lanes.resize(out.len() / range.len(), S::of(0.0));
        }
        kernel.evaluate(model, &mut self.kernel_data, &self.inputs, &mut self.outputs);
        S::enter(
            #[inline(always)]
            || {
                for (out, lanes) in outputs.iter_mut().zip(&self.outputs) {
                    scatter(lanes, Strides { first: 0, stride: lanes.len(), count: range.len() }, out);
                }
                match self.cannot_overflow {
                    true => !kernel.divides() || is_finite(&self.outputs[0]),
                    false => self.outputs.iter().all(|out| is_finite(out)),
                }
            },
        )
    }

    /// Loads the inputs of the states in `range` and normalises their quaternions. Returns true if all
    /// numbers are finite and all quaternions had unit norm within [`UNIT_NORM`].
    #[inline(always)]
    fn read(&mut self, call: &Call<'_>, range: &Range<usize>) -> bool {
        let mut is_valid = true;
        self.cannot_overflow = true;
        for ((to, from), name) in self.inputs.iter_mut().zip(call.inputs).zip(call.kernel.inputs()) {
            to.resize(from.width, S::of(0.0));
            gather(from.data, strides(from.width, range), to);
            is_valid &= all_finite(to, &mut self.cannot_overflow);
            if name.starts_with('q') {
                is_valid &= normalise(&mut to[QUATERNION]);
            }
        }
        self.kernel_data.external.clear();
        for Wrenches { frame, rows } in call.external {
            let mut numbers = [S::of(0.0); 6];
            let range = if rows.len() == 6 { &(0..1) } else { range }; // one wrench applies to all states
            gather(rows, strides(6, range), &mut numbers);
            is_valid &= all_finite(&numbers, &mut self.cannot_overflow);
            let wrench = Force::from_slice(&numbers);
            self.kernel_data.external.push(FrameWrench { frame: *frame, wrench });
        }
        is_valid
    }
}

fn base_of(model: &Model) -> (f64, Vec3<f64>, Sym3<f64>) {
    let Node { mass, com, about_com, .. } = model.nodes()[0];
    (mass, com, about_com)
}

fn strides(width: usize, range: &Range<usize>) -> Strides {
    Strides { first: range.start * width, stride: width, count: range.len() }
}

/// Returns true if all numbers are finite.
#[inline(always)]
fn is_finite<S: Real>(numbers: &[S]) -> bool {
    is_finite_times(S::of(1.0), numbers)
}

/// Returns true if all numbers are finite. Sets `cannot_overflow` to false if a magnitude exceeds 1.8e58; no
/// product of smaller numbers in a kernel overflows.
#[inline(always)]
fn all_finite<S: Real>(numbers: &[S], cannot_overflow: &mut bool) -> bool {
    let is_small = is_finite_times(S::of(1e250), numbers);
    *cannot_overflow &= is_small;
    is_small || is_finite(numbers)
}

/// Returns true if the product of `factor` with each number is finite.
#[inline(always)]
fn is_finite_times<S: Real>(factor: S, numbers: &[S]) -> bool {
    // 0 · x is 0 only for a finite x; four partial sums avoid a chain of dependent additions
    let mut sums = [S::of(0.0); 4];
    for (i, x) in numbers.iter().enumerate() {
        sums[i % 4] = (*x * factor).mul_add(S::of(0.0), sums[i % 4]);
    }
    let sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    !S::any(S::less(S::of(0.0), S::select(S::less(sum, S::of(1.0)), S::of(0.0), S::of(1.0))))
}

/// Normalises the quaternion x, y, z, w. Returns true if its norm was 1 within [`UNIT_NORM`].
#[inline(always)]
fn normalise<S: Real>(xyzw: &mut [S]) -> bool {
    // evaluated as in `check_quaternions`, so that both yield the same bits
    let squared = xyzw[0] * xyzw[0] + xyzw[1] * xyzw[1] + xyzw[2] * xyzw[2] + xyzw[3] * xyzw[3];
    let off = (squared.sqrt() - S::of(1.0)).abs();
    Quat::from_xyzw(xyzw).normalized().write_xyzw(xyzw);
    !S::any(S::less(S::of(UNIT_NORM), off))
}
