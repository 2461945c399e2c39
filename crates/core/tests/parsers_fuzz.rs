//! Checks that each file in the corpus of `make fuzz`, and some mutations of it, is either read or rejected
//! with a message.

#[path = "../../../tests/fuzz/engine/mutate.rs"]
mod mutate;
#[path = "../../../tests/fuzz/engine/parsers.rs"]
mod parsers;

use mutate::{Random, mutated};
use parsers::{PARSERS, seeds};
use std::fs;
use std::path::Path;

const MUTATIONS: usize = 100;
const SEED: u64 = 14;

/// The files of a parser, in order, and files that the engine writes.
fn corpus(name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fuzz/corpus").join(name);
    let mut files: Vec<_> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    files.sort();
    files.iter().filter_map(|file| fs::read(file).ok()).chain(seeds(name)).collect()
}

#[test]
fn every_parser_reads_the_first_of_its_corpus() {
    for parser in PARSERS {
        let corpus = corpus(parser.name);
        let read = corpus.iter().filter(|input| (parser.read)(input).is_ok()).count();
        assert!(
            read > 0,
            "{}: none of {} inputs is accepted, so mutations reach nothing",
            parser.name,
            corpus.len()
        );
    }
}

#[test]
fn mutations_are_read_or_refused_with_a_message() {
    let mut random = Random(SEED);
    for parser in PARSERS {
        let corpus = corpus(parser.name);
        for k in 0..MUTATIONS {
            let (parent, other) = (&corpus[k % corpus.len()], &corpus[random.below(corpus.len())]);
            let input = mutated(&mut random, parent, other, parser.words);
            if let Err(message) = (parser.read)(&input) {
                assert!(!message.trim().is_empty(), "{}: refused without a word", parser.name);
            }
        }
    }
}

#[test]
fn a_count_that_overflows_a_segment_of_a_kernel_is_refused() {
    let parser = PARSERS.iter().find(|parser| parser.name == "kernel_segments");
    let refused = parser.map(|parser| (parser.read)(b"-86400 86400 18446744073709551615 1 1 1"));
    assert!(refused.is_some_and(|outcome| outcome.is_err()));
}
