//! Running a kernel over rows.

use super::input::{InputError, check_finite, check_quaternions};
use super::kernel::{Kernel, Work};
use crate::dynamics::FrameWrench;
use crate::model::Model;
use crate::spatial::{Fused, InstructionSet, Scalar};
use rayon::prelude::*;

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
    /// [`InputError`]; the outputs are untouched then.
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
            InstructionSet::Baseline => self.plain.state(kernel, model, inputs, 0, external, outputs),
            InstructionSet::Fused => self.fused.state(kernel, model, inputs, 0, external, outputs),
        }
        Ok(())
    }

    /// Checks the inputs and computes many states, on `threads` threads (all cores if `None`).
    /// The bits do not depend on the number of threads.
    ///
    /// # Errors
    /// [`InputError`]; the outputs are untouched then.
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
            InstructionSet::Fused => all::<Fused>(kernel, model, inputs, external, outputs, threads),
        }
        Ok(())
    }
}

fn check(kernel: Kernel, model: &Model, inputs: &[Rows<'_>]) -> Result<(), InputError> {
    let count = inputs[0].data.len() / inputs[0].width.max(1);
    for (name, rows) in kernel.inputs().iter().zip(inputs) {
        let expected = if name.starts_with('q') { model.nq() } else { model.nv() };
        if rows.width != expected {
            return Err(InputError::WrongLength { name, expected, got: rows.width });
        }
        let got = rows.data.len() / expected;
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

impl<S: Scalar> Space<S> {
    fn new(model: &Model) -> Self {
        Self { work: Work::new(model), inputs: vec![Vec::new(); 3], outputs: vec![Vec::new(); 5] }
    }

    /// Computes row `k` of the inputs into the first rows of the outputs.
    fn state(
        &mut self,
        kernel: Kernel,
        model: &Model,
        inputs: &[Rows<'_>],
        k: usize,
        external: &[FrameWrench<f64>],
        outputs: &mut [RowsMut<'_>],
    ) {
        self.work.set_external(external);
        for ((to, from), name) in self.inputs.iter_mut().zip(inputs).zip(kernel.inputs()) {
            let row = &from.data[k * from.width..(k + 1) * from.width];
            to.clear();
            to.extend(row.iter().map(|x| S::of(*x)));
            if name.starts_with('q') {
                let attitude = crate::spatial::Quat::from_xyzw(&to[3..7]).normalized();
                attitude.write_xyzw(&mut to[3..7]);
            }
        }
        for (space, out) in self.outputs.iter_mut().zip(outputs.iter()) {
            space.resize(out.len(), S::of(0.0));
        }
        kernel.run(model, &mut self.work, &self.inputs, &mut self.outputs);
        for (out, space) in outputs.iter_mut().zip(&self.outputs) {
            out.iter_mut().zip(space).for_each(|(to, from)| *to = from.value());
        }
    }
}

fn all<S: Scalar>(
    kernel: Kernel,
    model: &Model,
    inputs: &[Rows<'_>],
    external: &[FrameWrench<f64>],
    outputs: &mut [RowsMut<'_>],
    threads: Option<usize>,
) {
    let count = inputs[0].data.len() / inputs[0].width;
    let widths = kernel.outputs(model);
    // hand every task its own rows of every output
    let mut tasks: Vec<Vec<&mut [f64]>> = (0..count.div_ceil(CHUNK)).map(|_| Vec::new()).collect();
    for (out, width) in outputs.iter_mut().zip(&widths) {
        tasks.iter_mut().zip(out.chunks_mut(CHUNK * width)).for_each(|(task, rows)| task.push(rows));
    }
    let run = |space: &mut Space<S>, (index, task): (usize, Vec<&mut [f64]>)| {
        let states = CHUNK.min(count - index * CHUNK);
        let mut rows: Vec<_> =
            task.into_iter().zip(&widths).map(|(rows, width)| rows.chunks_mut(*width)).collect();
        for k in 0..states {
            let mut row: Vec<&mut [f64]> = rows.iter_mut().filter_map(Iterator::next).collect();
            space.state(kernel, model, inputs, index * CHUNK + k, external, &mut row);
        }
    };
    let parallel = || tasks.into_par_iter().enumerate().for_each_init(|| Space::new(model), run);
    match threads {
        Some(threads) => match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
            Ok(pool) => pool.install(parallel),
            Err(_) => parallel(), // no threads to be had: the global pool still computes the same
        },
        None => parallel(),
    }
}
