//! Evaluation of a kernel for one state or for many.

use super::call::{Call, Rows, RowsMut, Wrenches};
use super::input::{InputError, check_finite, check_quaternions, check_shapes};
use super::kernels::{Kernel, OUTPUTS};
use super::threads::{Threads, for_each};
use super::workspace::Workspace;
use crate::model::Model;
use crate::spatial::{Fused, InstructionSet, Lanes4, Lanes8, Real};
use std::sync::atomic::{AtomicBool, Ordering};

/// Number of states per task. The number is constant, so that results do not depend on the number of threads.
const CHUNK: usize = 128;

/// Evaluator of kernels for one robot. It reuses its workspace in all calls with a single state.
#[derive(Clone, Debug)]
pub struct Evaluator {
    plain: Workspace<f64>,
    fused: Workspace<Fused>,
}

impl Evaluator {
    /// Allocates the workspace for `model`.
    pub fn new(model: &Model) -> Self {
        Self { plain: Workspace::new(model), fused: Workspace::new(model) }
    }

    /// Checks the shapes of inputs and outputs, and computes one state on the calling thread.
    ///
    /// # Errors
    /// [`InputError`] for invalid inputs. The outputs do not change, except after [`InputError::Singular`]
    /// and [`InputError::Overflow`].
    pub fn single(
        &mut self,
        kernel: Kernel,
        model: &Model,
        inputs: &[Rows<'_>],
        external: &[Wrenches<'_>],
        outputs: &mut [RowsMut<'_>],
    ) -> Result<(), InputError> {
        let call = Call { kernel, model, inputs, external };
        check_shapes(&call, outputs)?;
        if call.count() != 1 {
            return Err(InputError::NotSingle { got: call.count() });
        }
        if !self.plain.fits(model) {
            *self = Self::new(model);
        }
        let is_valid = match InstructionSet::current() {
            InstructionSet::Baseline => self.plain.compute(&call, 0..1, outputs),
            InstructionSet::Fused | InstructionSet::Wide => self.fused.compute(&call, 0..1, outputs),
        };
        if is_valid { Ok(()) } else { first_fault(&call, outputs) }
    }

    /// Checks the shapes of inputs and outputs, and computes many states. The results are bit-identical for
    /// any number of threads. If `threads` is stopped, the function returns early, without an error and with
    /// incomplete outputs.
    ///
    /// # Errors
    /// [`InputError`] for the first invalid input in the order of the arguments, or for the first result that
    /// is not finite; the contents of the outputs are then undefined.
    pub fn many<'a>(
        kernel: Kernel,
        model: &Model,
        inputs: &[Rows<'_>],
        external: &[Wrenches<'_>],
        outputs: &mut [RowsMut<'_>],
        threads: impl Into<Threads<'a>>,
    ) -> Result<(), InputError> {
        let threads = threads.into();
        let call = Call { kernel, model, inputs, external };
        check_shapes(&call, outputs)?;
        let is_valid = match InstructionSet::current() {
            InstructionSet::Baseline => evaluate_all::<f64>(&call, outputs, threads),
            InstructionSet::Fused => evaluate_all::<Lanes4>(&call, outputs, threads),
            InstructionSet::Wide => evaluate_all::<Lanes8>(&call, outputs, threads),
        }?;
        if is_valid || threads.is_stopped() { Ok(()) } else { first_fault(&call, outputs) }
    }
}

/// Computes all states. Returns true if the inputs of all computed states are valid and their outputs are
/// finite.
fn evaluate_all<S: Real>(
    call: &Call<'_>,
    outputs: &mut [RowsMut<'_>],
    threads: Threads<'_>,
) -> Result<bool, InputError> {
    let (count, (widths, used)) = (call.count(), call.kernel.widths(call.model));
    let widths = &widths[..used];
    let mut remaining: [RowsMut<'_>; OUTPUTS] = Default::default();
    remaining.iter_mut().zip(outputs).for_each(|(rows, out)| *rows = out);
    let tasks = (0..count.div_ceil(CHUNK)).map(|index| {
        let states = index * CHUNK..count.min((index + 1) * CHUNK);
        (states.clone(), split_rows(&mut remaining, widths, states.len()))
    });
    let is_valid = AtomicBool::new(true);
    for_each(
        threads,
        tasks,
        || Workspace::<S>::new(call.model),
        |workspace, (states, mut rows)| {
            for start in states.clone().step_by(S::LANES) {
                let group = start..states.end.min(start + S::LANES);
                let mut rows = split_rows(&mut rows, widths, group.len());
                if !workspace.compute(call, group, &mut rows[..used]) {
                    is_valid.store(false, Ordering::Relaxed);
                }
            }
        },
    )?;
    Ok(is_valid.into_inner())
}

/// Splits off the next `count` rows of every output.
fn split_rows<'a>(
    remaining: &mut [RowsMut<'a>; OUTPUTS],
    widths: &[usize],
    count: usize,
) -> [RowsMut<'a>; OUTPUTS] {
    let mut next: [RowsMut<'a>; OUTPUTS] = Default::default();
    for ((next, remaining), width) in next.iter_mut().zip(remaining).zip(widths) {
        (*next, *remaining) = std::mem::take(remaining).split_at_mut(count * width);
    }
    next
}

/// Returns the error of the first invalid input or, if there is none, of the first output that is not finite.
#[cold]
fn first_fault(call: &Call<'_>, outputs: &[RowsMut<'_>]) -> Result<(), InputError> {
    for (name, rows) in call.kernel.inputs().iter().zip(call.inputs) {
        check_finite(name, rows.data, rows.width)?;
        if name.starts_with('q') {
            check_quaternions(name, rows.data, rows.width)?;
        }
    }
    for wrenches in call.external {
        check_finite("external wrench", wrenches.rows, 6)?;
    }
    // outputs that are not finite: the mass matrix is singular, or products overflow
    for (out, width) in outputs.iter().zip(call.kernel.widths(call.model).0) {
        if let Some(index) = out.iter().position(|x| !x.is_finite()) {
            let state = index / width;
            let divides = call.kernel.divides();
            return Err(if divides {
                InputError::Singular { state }
            } else {
                InputError::Overflow { state }
            });
        }
    }
    Ok(())
}
