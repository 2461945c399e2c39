//! Running a kernel over rows.

use super::input::{InputError, check_finite, check_quaternions};
use super::kernel::{Kernel, Work};
use super::threads::for_each;
use crate::dynamics::FrameWrench;
use crate::model::Model;
use crate::spatial::{Fused, InstructionSet, Lanes4, Lanes8, Quat, Real};
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

/// States that one task takes, so that a batch is cut alike for every number of threads.
const CHUNK: usize = 64;

/// Space of one model's kernels for single states, kept between calls.
#[derive(Clone, Debug)]
pub struct Evaluator {
    plain: Space<f64>,
    fused: Space<Fused>,
}

/// Workspace and rows of one state.
#[derive(Clone, Debug)]
struct Space<S> {
    work: Work<S>,
    inputs: Vec<Vec<S>>,
    outputs: Vec<Vec<S>>,
}

impl Evaluator {
    /// Space for `model`.
    pub fn new(model: &Model) -> Self {
        Self { plain: Space::new(model), fused: Space::new(model) }
    }

    /// Checks the inputs and computes one state on the calling thread.
    ///
    /// # Errors
    /// [`InputError`]; the outputs are untouched then, but for [`InputError::Singular`].
    pub fn single(
        &mut self,
        kernel: Kernel,
        model: &Model,
        inputs: &[Rows<'_>],
        external: &[FrameWrench<f64>],
        outputs: &mut [RowsMut<'_>],
    ) -> Result<(), InputError> {
        check(kernel, model, inputs)?;
        match InstructionSet::current() {
            InstructionSet::Baseline => self.plain.states(kernel, model, inputs, 0..1, external, outputs),
            InstructionSet::Fused | InstructionSet::Wide => {
                self.fused.states(kernel, model, inputs, 0..1, external, outputs);
            }
        }
        check_regular(kernel, model, outputs)
    }

    /// Checks the inputs and computes many states, on `threads` threads (all cores if `None`).
    /// The bits do not depend on the number of threads.
    ///
    /// # Errors
    /// [`InputError`]; the outputs are untouched then, but for [`InputError::Singular`].
    pub fn many(
        kernel: Kernel,
        model: &Model,
        inputs: &[Rows<'_>],
        external: &[FrameWrench<f64>],
        outputs: &mut [RowsMut<'_>],
        threads: Option<usize>,
    ) -> Result<(), InputError> {
        check(kernel, model, inputs)?;
        match InstructionSet::current() {
            InstructionSet::Baseline => all::<f64>(kernel, model, inputs, external, outputs, threads),
            InstructionSet::Fused => all::<Lanes4>(kernel, model, inputs, external, outputs, threads),
            InstructionSet::Wide => all::<Lanes8>(kernel, model, inputs, external, outputs, threads),
        }?;
        check_regular(kernel, model, outputs)
    }
}

fn check(kernel: Kernel, model: &Model, inputs: &[Rows<'_>]) -> Result<(), InputError> {
    let count = inputs[0].data.len() / inputs[0].width.max(1);
    for (name, rows) in kernel.inputs().iter().zip(inputs) {
        let expected = Kernel::width(name, model);
        if rows.width != expected {
            return Err(InputError::WrongLength { name, expected, got: rows.width });
        }
        let got = rows.data.len().checked_div(expected).unwrap_or(count); // a robot may have no joints
        if got != count {
            return Err(InputError::WrongBatch { name, expected: count, got });
        }
        check_finite(name, rows.data, expected)?;
        if name.starts_with('q') {
            check_quaternions(rows.data, expected)?;
        }
    }
    Ok(())
}

/// Refuses what forward dynamics makes of a mass matrix that is singular in this configuration.
fn check_regular(kernel: Kernel, model: &Model, outputs: &[RowsMut<'_>]) -> Result<(), InputError> {
    if !matches!(kernel, Kernel::ForwardDynamics | Kernel::ForwardDynamicsDerivatives) {
        return Ok(()); // no other kernel divides by what a joint feels
    }
    match outputs[0].iter().position(|x| !x.is_finite()) {
        Some(index) => Err(InputError::Singular { state: index / kernel.outputs(model)[0] }),
        None => Ok(()),
    }
}

impl<S: Real> Space<S> {
    fn new(model: &Model) -> Self {
        Self { work: Work::new(model), inputs: vec![Vec::new(); 3], outputs: vec![Vec::new(); 5] }
    }

    /// Computes the states `range` (at most one per lane) into the first rows of the outputs.
    ///
    /// Lanes beyond the range repeat its last state and are thrown away.
    fn states(
        &mut self,
        kernel: Kernel,
        model: &Model,
        inputs: &[Rows<'_>],
        range: Range<usize>,
        external: &[FrameWrench<f64>],
        outputs: &mut [RowsMut<'_>],
    ) {
        self.work.set_external(external);
        let last = range.end - 1;
        for ((to, from), name) in self.inputs.iter_mut().zip(inputs).zip(kernel.inputs()) {
            to.clear();
            let at = |lane: usize, i: usize| from.data[(range.start + lane).min(last) * from.width + i];
            to.extend((0..from.width).map(|i| S::from_lanes(|lane| at(lane, i))));
            if name.starts_with('q') {
                S::enter(
                    #[inline(always)]
                    || Quat::from_xyzw(&to[3..7]).normalized().write_xyzw(&mut to[3..7]),
                );
            }
        }
        for (space, out) in self.outputs.iter_mut().zip(outputs.iter()) {
            space.resize(out.len() / range.len(), S::of(0.0));
        }
        kernel.run(model, &mut self.work, &self.inputs, &mut self.outputs);
        for (out, space) in outputs.iter_mut().zip(&self.outputs) {
            for (lane, row) in out.chunks_mut(space.len().max(1)).enumerate() {
                row.iter_mut().zip(space).for_each(|(to, from)| *to = from.lane(lane));
            }
        }
    }
}

fn all<S: Real>(
    kernel: Kernel,
    model: &Model,
    inputs: &[Rows<'_>],
    external: &[FrameWrench<f64>],
    outputs: &mut [RowsMut<'_>],
    threads: Option<usize>,
) -> Result<(), InputError> {
    let count = inputs[0].data.len() / inputs[0].width;
    let widths = kernel.outputs(model);
    // hand every task its own rows of every output
    let mut tasks: Vec<Task<'_>> =
        (0..count.div_ceil(CHUNK)).map(|index| Task { first: index * CHUNK, outputs: Vec::new() }).collect();
    for (out, width) in outputs.iter_mut().zip(&widths) {
        let mut chunks = out.chunks_mut((CHUNK * width).max(1)); // none where a row holds nothing
        tasks.iter_mut().for_each(|task| task.outputs.push(chunks.next().unwrap_or_default()));
    }
    let run = |space: &mut Space<S>, mut task: Task<'_>| {
        let states = task.first..count.min(task.first + CHUNK);
        for start in states.clone().step_by(S::LANES) {
            let end = states.end.min(start + S::LANES);
            let mut rows: Vec<&mut [f64]> = Vec::with_capacity(task.outputs.len());
            for (rest, width) in task.outputs.iter_mut().zip(&widths) {
                let (now, later) = std::mem::take(rest).split_at_mut((end - start) * width);
                rows.push(now);
                *rest = later;
            }
            space.states(kernel, model, inputs, start..end, external, &mut rows);
        }
    };
    for_each(threads, tasks, || Space::new(model), run)
}

/// Some states of a batch and their rows of every output.
struct Task<'a> {
    first: usize,
    outputs: Vec<&'a mut [f64]>,
}
