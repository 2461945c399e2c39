//! Program with which `make bench` times the kernels for one state, without Python.
//!
//! Usage: `contestant URDF STATES COUNT [SET]`. `URDF` is the robot. The file `STATES` holds `COUNT` rows of
//! `q, v, x` as raw `f64`, where `x` are generalized forces or accelerations. `SET` is the highest
//! instruction set to use. The program then answers requests, one per line, from standard input:
//!
//! - `time KERNEL SECONDS` → `{"ns": …}`, nanoseconds per state: the median over passes through all states;
//! - `result KERNEL FILE` → `{}`, after the results of all states were written to `FILE` as raw `f64`;
//! - `flops KERNEL` → number of operations per state, by kind;
//! - `peak SET SECONDS` → `{"gflops": …}`, peak throughput of one core with that instruction set.
//!
//! The C++ programs in `benches/peers` answer `time` and `result` in the same way.
#![allow(clippy::print_stdout)] // answers are printed

mod kernels;
mod operation_count;
mod peak_flops;

use kernels::{KERNELS, Kernels};
use nalgebra::Isometry3;
use onorbit_core::model::{Loop, LoopKind, Model, urdf::from_file};
use onorbit_core::spatial::{Fused, InstructionSet, Real};
use operation_count::CountedF64;
use std::error::Error;
use std::hint::black_box;
use std::io::{BufRead, stdin};
use std::path::Path;
use std::time::{Duration, Instant};

/// Frame whose Jacobian, drift and reduced model are computed.
const TOOL: &str = "tool";
/// Frames that a loop connects rigidly if the robot has both.
const GRIPS: [&str; 2] = ["grip_a", "grip_b"];

type Answer = Result<String, Box<dyn Error>>;

fn main() -> Result<(), Box<dyn Error>> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let [urdf, states, count, set @ ..] = &given[..] else {
        return Err("usage: contestant URDF STATES COUNT [SET]".into());
    };
    let model = from_file(Path::new(urdf), &Default::default())?;
    let has_grips = GRIPS.iter().all(|grip| model.frame(grip).is_ok());
    let model = if has_grips { model.closed(&[weld()])? } else { model };
    let rows = read(states)?;
    if rows.len() != count.parse::<usize>()? * (model.nq() + 2 * model.nv()) {
        let width = model.nq() + 2 * model.nv();
        return Err(format!(
            "{states} holds {} numbers; expected {count} states of {width} numbers",
            rows.len()
        )
        .into());
    }
    if let Some(set) = set.first() {
        InstructionSet::limit(
            InstructionSet::named(set).ok_or_else(|| format!("there is no instruction set named '{set}'"))?,
        );
    }
    // kernels of one state have at most four lanes
    match InstructionSet::current() {
        InstructionSet::Baseline => serve::<f64>(&model, &rows),
        InstructionSet::Fused | InstructionSet::Wide => serve::<Fused>(&model, &rows),
    }
}

fn weld() -> Loop {
    Loop {
        name: "weld".to_owned(),
        kind: LoopKind::Weld,
        frames: GRIPS.map(str::to_owned),
        poses: [Isometry3::identity(); 2],
        length: None,
        project: false,
    }
}

fn read(file: &str) -> Result<Vec<f64>, Box<dyn Error>> {
    let bytes = std::fs::read(file)?;
    Ok(bytes.as_chunks::<8>().0.iter().map(|word| f64::from_le_bytes(*word)).collect())
}

/// Answers the requests on standard input until it ends.
fn serve<S: Real>(model: &Model, rows: &[f64]) -> Result<(), Box<dyn Error>> {
    let mut kernels = Kernels::<S>::new(model, model.frame(TOOL)?, rows);
    println!("{{\"ready\": \"{}\"}}", InstructionSet::current().name());
    for line in stdin().lock().lines() {
        let line = line?;
        let words: Vec<&str> = line.split_whitespace().collect();
        let answer = match words[..] {
            ["time", name, seconds] => time(&mut kernels, name, seconds),
            ["result", name, file] => result(&mut kernels, name, file),
            ["flops", name] => flops(model, rows, name),
            ["peak", set, seconds] => peak_flops::answer(set, seconds.parse()?),
            _ => Err(format!("the request is '{line}'; expected time, result, flops or peak").into()),
        };
        println!("{}", answer?);
    }
    Ok(())
}

fn index(name: &str) -> Result<usize, Box<dyn Error>> {
    let unknown = || format!("there is no kernel named '{name}'; expected one of {}", KERNELS.join(", "));
    KERNELS.iter().position(|kernel| *kernel == name).ok_or_else(|| unknown().into())
}

fn time<S: Real>(kernels: &mut Kernels<'_, S>, name: &str, seconds: &str) -> Answer {
    let (kernel, end) = (index(name)?, Instant::now() + Duration::try_from_secs_f64(seconds.parse()?)?);
    let mut passes = Vec::new();
    while passes.is_empty() || Instant::now() < end {
        let started = Instant::now();
        for k in 0..kernels.count() {
            black_box(kernels.run(kernel, black_box(k)));
        }
        passes.push(started.elapsed().as_secs_f64() * 1e9 / kernels.count() as f64);
    }
    passes.sort_by(f64::total_cmp);
    Ok(format!("{{\"ns\": {}}}", passes[passes.len() / 2]))
}

fn result<S: Real>(kernels: &mut Kernels<'_, S>, name: &str, file: &str) -> Answer {
    let (kernel, mut bytes) = (index(name)?, Vec::new());
    for k in 0..kernels.count() {
        kernels.run(kernel, k);
        kernels.output(kernel).for_each(|x| bytes.extend(x.lane(0).to_le_bytes()));
    }
    std::fs::write(file, bytes)?;
    Ok("{}".into())
}

fn flops(model: &Model, rows: &[f64], name: &str) -> Answer {
    let (kernel, mut kernels) = (index(name)?, Kernels::<CountedF64>::new(model, model.frame(TOOL)?, rows));
    Ok(operation_count::during(|| _ = kernels.run(kernel, 0)))
}
