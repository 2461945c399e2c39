//! Checks that no processor executes an instruction that it does not support: outside the entry points of the
//! instruction sets, this program has only instructions of the x86-64 baseline. The program disassembles
//! itself with `objdump` of binutils.
#![cfg(target_arch = "x86_64")]
#![allow(clippy::unwrap_used, clippy::print_stderr)] // a failed unwrap is a failed test; a skip says why

mod common;

use common::{Random, random_model, random_state};
use onorbit_core::batch::{Evaluator, Kernel, Rollout, RolloutControl, Rows};
use onorbit_core::model::Model;
use onorbit_core::simulation::{Integrator, Simulation};
use onorbit_core::spatial::InstructionSet;
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::sync::{Arc, atomic::AtomicBool};

/// Entry points of the crate; functions of libraries that are named after their instruction set and detect
/// the processor. Intrinsics are called only from the entry points and are inlined except in test builds.
const ENTRIES: [&str; 4] = ["enter_fused", "enter_wide_registers", "enter_lanes4", "enter_lanes8"];
const LIBRARIES: [&str; 4] = ["_avx2", "_avx512", "_with_fma", "core_arch::x86::"];

/// Runs one state, a batch, a rollout and a simulation, so that their code is part of this program.
fn use_everything(model: Model) -> f64 {
    let (q, v) = random_state(&model, &mut Random::new(3));
    let rows = [&q, &v, &v].map(|data| Rows { data, width: data.len() });
    let mut a = vec![0.0; v.len()];
    let kernel = Kernel::ForwardDynamics;
    Evaluator::many(kernel, &model, &rows, &[], &mut [&mut a], Some(1)).unwrap();
    Evaluator::new(&model).single(kernel, &model, &rows, &[], &mut [&mut a]).unwrap();
    let (mut to_q, mut to_v, stop) = (q.clone(), v.clone(), AtomicBool::new(false));
    let rollout = Rollout {
        steps: 2,
        time_step: 1e-3,
        integrator: Integrator::Rk4,
        control: RolloutControl::Passive,
        record_every: None,
        threads: Some(1),
        stop: &stop,
    };
    rollout.run(&model, &q, &v, &mut to_q, &mut to_v).unwrap();
    let run = Simulation::new(Arc::new(model), q, v).run(0.002).unwrap().only();
    a[0] + to_q[0] + run.time.len() as f64
}

/// Returns the number of instructions beyond the baseline by function: those with names that begin with `v`
/// (AVX and later).
fn newer_instructions() -> Option<BTreeMap<String, usize>> {
    let program = std::env::current_exe().unwrap();
    let arguments = ["-d", "--no-show-raw-insn", "-C"];
    let mut objdump =
        Command::new("objdump").args(arguments).arg(program).stdout(Stdio::piped()).spawn().ok()?;
    let (mut function, mut found) = (String::new(), BTreeMap::new());
    for line in BufReader::new(objdump.stdout.take()?).lines() {
        let line = line.unwrap();
        if let Some((_, name)) = line.strip_suffix(">:").and_then(|head| head.split_once('<')) {
            name.clone_into(&mut function);
        } else if let Some((_, text)) = line.split_once(":\t") {
            let name = text.split_whitespace().next().unwrap_or_default();
            if name.starts_with('v') && !["verr", "verw"].contains(&name) {
                *found.entry(function.clone()).or_insert(0) += 1;
            }
        }
    }
    objdump.wait().unwrap().success().then_some(found)
}

#[test]
fn newer_instructions_occur_only_in_their_entry_points() {
    assert!(use_everything(random_model(5, 6)).is_finite(), "{:?}", InstructionSet::current());
    let Some(found) = newer_instructions() else {
        eprintln!("skipped: no objdump (binutils) on this machine");
        return;
    };
    // a scan that finds nothing would prove nothing
    for entry in ENTRIES {
        let seen: usize = found.iter().filter(|(name, _)| name.contains(entry)).map(|(_, count)| count).sum();
        assert!(seen > 100, "{entry} holds {seen} instructions of its set");
    }
    for (function, count) in found {
        let is_guarded = ENTRIES.iter().chain(&LIBRARIES).any(|entry| function.contains(entry));
        assert!(is_guarded, "{function} holds {count} instructions that an older processor does not know");
    }
}
