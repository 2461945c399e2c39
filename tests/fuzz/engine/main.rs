//! Coverage-guided fuzzing of the engine's parsers; `make fuzz` builds it with counters and runs it.
//!
//! `fuzz PARSER COUNT SECONDS SEED CORPUS WORK`: at most `COUNT` inputs in `SECONDS`, mutated from the files of
//! `CORPUS/PARSER` and of `WORK/corpus/PARSER`, where inputs that reach new code are kept. Findings go to
//! `WORK/findings`, one for each place that panics. Prints what was done as JSON; exit code 1 with findings, 3
//! where an input exceeds a limit. `fuzz --replay PARSER FILE` tries one file, `fuzz --list` names the parsers.
#![allow(clippy::print_stdout)] // answers go there

mod coverage;
mod guard;
mod mutate;
mod parsers;

use coverage::Reached;
use guard::{Counting, Guard};
use mutate::{Random, mutated};
use parsers::{PARSERS, Parser};
use std::collections::BTreeMap;
use std::error::Error;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Where the last panic was, and what it said.
static PANIC: Mutex<String> = Mutex::new(String::new());

type Done<T> = Result<T, Box<dyn Error>>;

fn main() -> Done<()> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = given.iter().map(String::as_str).collect();
    panic::set_hook(Box::new(|info| {
        if let Ok(mut last) = PANIC.lock() {
            *last = info.to_string().replace('\n', " ");
        }
    }));
    let has_findings = match words[..] {
        ["--list"] => {
            PARSERS.iter().for_each(|parser| println!("{}", parser.name));
            false
        }
        ["--replay", name, file] => replay(named(name)?, Path::new(file))?,
        [name, count, seconds, seed, corpus, work] => {
            let seconds = Duration::try_from_secs_f64(seconds.parse()?)?;
            let folders = [Path::new(corpus), Path::new(work)];
            Campaign::new(named(name)?, seed.parse()?, folders)?.run(count.parse()?, seconds)?
        }
        _ => return Err("usage: fuzz PARSER COUNT SECONDS SEED CORPUS WORK".into()),
    };
    std::process::exit(i32::from(has_findings))
}

fn named(name: &str) -> Done<&'static Parser> {
    PARSERS.iter().find(|parser| parser.name == name).ok_or_else(|| format!("no parser {name}").into())
}

/// Tries one input; the text of the panic, where there was one.
fn tried(parser: &Parser, input: &[u8]) -> Option<String> {
    let done = panic::catch_unwind(AssertUnwindSafe(|| (parser.read)(input)));
    match done {
        Ok(Err(message)) if message.trim().is_empty() => Some("refused without a word".to_owned()),
        Ok(_) => None,
        Err(_) => Some(PANIC.lock().map(|last| last.clone()).unwrap_or_default()),
    }
}

fn replay(parser: &Parser, file: &Path) -> Done<bool> {
    let found = tried(parser, &std::fs::read(file)?);
    println!("{}", found.as_deref().unwrap_or("no finding"));
    Ok(found.is_some())
}

/// One parser's inputs and what came of them.
struct Campaign {
    parser: &'static Parser,
    seed: u64,
    random: Random,
    guard: Guard,
    reached: Reached,
    corpus: Vec<Vec<u8>>,
    /// Inputs by what they gave rise to.
    findings: BTreeMap<String, PathBuf>,
    work: PathBuf,
}

impl Campaign {
    fn new(parser: &'static Parser, seed: u64, [corpus, work]: [&Path; 2]) -> Done<Self> {
        let kept = work.join("corpus").join(parser.name);
        std::fs::create_dir_all(&kept)?;
        std::fs::create_dir_all(work.join("findings"))?;
        let mut files = Vec::new();
        for folder in [corpus.join(parser.name), kept] {
            let entries = std::fs::read_dir(&folder).into_iter().flatten(); // a parser may have no files
            let mut here = entries.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>()?;
            here.sort();
            files.extend(here);
        }
        let mut corpus = files.iter().map(std::fs::read).collect::<Result<Vec<_>, _>>()?;
        corpus.extend(parsers::seeds(parser.name));
        if corpus.is_empty() {
            return Err(format!("there is nothing to mutate for {}", parser.name).into());
        }
        Ok(Self {
            parser,
            seed,
            random: Random(seed ^ hash(parser.name.as_bytes())),
            guard: Guard::new(&work.join("current"))?,
            reached: Reached::default(),
            corpus,
            findings: BTreeMap::new(),
            work: work.to_owned(),
        })
    }

    fn run(mut self, count: usize, seconds: Duration) -> Done<bool> {
        let started = Instant::now();
        for input in self.corpus.clone() {
            self.one(&input)?;
        }
        let (seeds, mut done) = (self.corpus.len(), self.corpus.len());
        while done < count && started.elapsed() < seconds {
            let [parent, other] = [(); 2].map(|()| self.random.below(self.corpus.len()));
            let input =
                mutated(&mut self.random, &self.corpus[parent], &self.corpus[other], self.parser.words);
            if self.one(&input)? {
                let file = format!("corpus/{}/{:016x}", self.parser.name, hash(&input));
                std::fs::write(self.work.join(file), &input)?;
                self.corpus.push(input);
            }
            done += 1;
        }
        let (reached, all) = self.reached.share();
        println!(
            "{{\"parser\": \"{}\", \"inputs\": {done}, \"kept\": {}, \"seconds\": {:.1}, \"reached\": {reached}, \
             \"counters\": {all}, \"findings\": {}}}",
            self.parser.name,
            self.corpus.len() - seeds,
            started.elapsed().as_secs_f64(),
            self.findings.len(),
        );
        Ok(!self.findings.is_empty())
    }

    /// Tries an input; whether it reached new code.
    fn one(&mut self, input: &[u8]) -> Done<bool> {
        self.guard.hold(input)?;
        self.reached.start();
        let found = tried(self.parser, input);
        let is_new = self.reached.is_new();
        self.guard.release();
        if let Some(what) = found {
            // one file for each place, whatever the numbers in the message
            let place: String =
                what.chars().filter(|c| !c.is_ascii_digit() || what.len() < 40).take(160).collect();
            if !self.findings.contains_key(&place) {
                let file = self.work.join(format!("findings/{}-{:016x}", self.parser.name, hash(input)));
                std::fs::write(&file, input)?;
                let note = format!("parser {}\nseed {}\n{what}\n", self.parser.name, self.seed);
                std::fs::write(file.with_extension("txt"), note)?;
                self.findings.insert(place, file);
            }
        }
        Ok(is_new)
    }
}

fn hash(bytes: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    hasher.finish()
}
