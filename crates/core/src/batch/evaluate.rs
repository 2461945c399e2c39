//! Running a kernel over rows.

use super::input::{InputError, Wrenches, check_finite, check_quaternions, check_shapes};
use super::kernel::{Kernel, OUTPUTS};
use super::space::{Call, Rows, RowsMut, Space};
use super::threads::{Threads, for_each};
use crate::model::Model;
use crate::spatial::{Fused, InstructionSet, Lanes4, Lanes8, Real};
use std::sync::atomic::{AtomicBool, Ordering};

/// States that one task takes, so that a batch is cut alike for every number of threads.
const CHUNK: usize = 128;

/// Space of one model's kernels for single states, kept between calls.
#[derive(Clone, Debug)]
pub struct Evaluator {
    plain: Space<f64>,
    fused: Space<Fused>,
}

impl Evaluator {
    /// Space for `model`.
    pub fn new(model: &Model) -> Self {
        Self { plain: Space::new(model), fused: Space::new(model) }
    }

    /// Checks inputs and outputs and computes one state on the calling thread.
    ///
    /// # Errors
    /// [`InputError`]; the outputs are untouched then, but for [`InputError::Singular`] and
    /// [`InputError::Overflow`].
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
        let is_fine = match InstructionSet::current() {
            InstructionSet::Baseline => self.plain.states(&call, 0..1, outputs),
            InstructionSet::Fused | InstructionSet::Wide => self.fused.states(&call, 0..1, outputs),
        };
        if is_fine { Ok(()) } else { fault(&call, outputs) }
    }

    /// Checks inputs and outputs and computes many states. The bits do not depend on the number of threads.
    ///
    /// # Errors
    /// [`InputError`] for the first fault in the order of the arguments; what the outputs hold then is of no use.
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
        let is_fine = match InstructionSet::current() {
            InstructionSet::Baseline => all::<f64>(&call, outputs, threads),
            InstructionSet::Fused => all::<Lanes4>(&call, outputs, threads),
            InstructionSet::Wide => all::<Lanes8>(&call, outputs, threads),
        }?;
        if is_fine || threads.is_stopped() { Ok(()) } else { fault(&call, outputs) }
    }
}

/// All states; whether they and what came of them are as they should be.
fn all<S: Real>(
    call: &Call<'_>,
    outputs: &mut [RowsMut<'_>],
    threads: Threads<'_>,
) -> Result<bool, InputError> {
    let (count, (widths, used)) = (call.count(), call.kernel.widths(call.model));
    let widths = &widths[..used];
    let mut rest: [RowsMut<'_>; OUTPUTS] = Default::default();
    rest.iter_mut().zip(outputs).for_each(|(rest, out)| *rest = out);
    let tasks = (0..count.div_ceil(CHUNK)).map(|index| {
        let states = index * CHUNK..count.min((index + 1) * CHUNK);
        (states.clone(), take(&mut rest, widths, states.len()))
    });
    let is_fine = AtomicBool::new(true);
    for_each(
        threads,
        tasks,
        || Space::<S>::new(call.model),
        |space, (states, mut rows)| {
            for start in states.clone().step_by(S::LANES) {
                let group = start..states.end.min(start + S::LANES);
                let mut rows = take(&mut rows, widths, group.len());
                if !space.states(call, group, &mut rows[..used]) {
                    is_fine.store(false, Ordering::Relaxed);
                }
            }
        },
    )?;
    Ok(is_fine.into_inner())
}

/// The next `count` rows of every output.
fn take<'a>(rest: &mut [RowsMut<'a>; OUTPUTS], widths: &[usize], count: usize) -> [RowsMut<'a>; OUTPUTS] {
    let mut taken: [RowsMut<'a>; OUTPUTS] = Default::default();
    for ((taken, rest), width) in taken.iter_mut().zip(rest).zip(widths) {
        (*taken, *rest) = std::mem::take(rest).split_at_mut(count * width);
    }
    taken
}

/// What is wrong with a call of which something is.
#[cold]
fn fault(call: &Call<'_>, outputs: &[RowsMut<'_>]) -> Result<(), InputError> {
    for (name, rows) in call.kernel.inputs().iter().zip(call.inputs) {
        check_finite(name, rows.data, rows.width)?;
        if name.starts_with('q') {
            check_quaternions(rows.data, rows.width)?;
        }
    }
    for wrenches in call.external {
        check_finite("external wrench", wrenches.rows, 6)?;
    }
    // the mass matrix is singular, or products overflow
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
