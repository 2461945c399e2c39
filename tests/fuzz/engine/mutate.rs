//! Mutations of bytes: seeded, the same for one seed on every machine.

/// SplitMix64. Source: Steele, Lea and Flood, OOPSLA 2014.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number below `n`, which is not zero.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

/// Longest input made, bytes.
const LONGEST: usize = 16_384;

/// Numbers at which parsers have failed.
const NUMBERS: &[&str] = &[
    "0",
    "-0",
    "1",
    "-1",
    "nan",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "1e-308",
    "5e-324",
    "1e999",
    "1e16",
    "0x10",
    "9223372036854775807",
    "18446744073709551616",
    "4294967296",
    "0.1",
    "1e-9",
    "1,5",
    "1_0",
    "１",
    "+",
    "e",
];

/// A child of `parent`, perhaps crossed with `other`, by one to eight changes.
pub(crate) fn mutated(random: &mut Random, parent: &[u8], other: &[u8], words: &[&str]) -> Vec<u8> {
    let mut input = parent.to_vec();
    for _ in 0..1 << random.below(4) {
        change(random, &mut input, other, words);
    }
    input.truncate(LONGEST);
    input
}

fn change(random: &mut Random, input: &mut Vec<u8>, other: &[u8], words: &[&str]) {
    let at = random.below(input.len() + 1);
    let longest = if random.below(4) == 0 { input.len() + 1 } else { 9 };
    let length = random.below(longest);
    let end = (at + length).min(input.len());
    match random.below(10) {
        0 if at < input.len() => input[at] ^= 1 << random.below(8),
        1 if at < input.len() => input[at] = random.next() as u8,
        2 => drop(input.drain(at..end)),
        3 => {
            let part = input[at..end].to_vec();
            let to = random.below(input.len() + 1);
            drop(input.splice(to..to, part));
        }
        4 => drop(input.splice(at..at, pick(random, words).bytes())),
        5 => drop(input.splice(at..end, pick(random, words).bytes())),
        6 => number(random, input, at),
        7 => line(random, input, at),
        8 if !other.is_empty() => {
            let from = random.below(other.len());
            let to = (from + 1 + random.below(other.len() - from)).min(other.len());
            drop(input.splice(at..end, other[from..to].iter().copied()));
        }
        _ => input.insert(at, *b" \n\t\"'<>{}[]:,=-.0e\0\xFF".get(random.below(21)).unwrap_or(&0)),
    }
}

fn pick<'a>(random: &mut Random, words: &[&'a str]) -> &'a str {
    words.get(random.below(words.len())).copied().unwrap_or("")
}

/// Replaces the number at or after `at` by a special one, or changes one of its digits.
fn number(random: &mut Random, input: &mut Vec<u8>, at: usize) {
    let Some(start) = (at..input.len()).find(|&i| input[i].is_ascii_digit()) else { return };
    let is_part = |byte: &u8| byte.is_ascii_digit() || b".eE+-".contains(byte);
    let end = (start..input.len()).find(|&i| !is_part(&input[i])).unwrap_or(input.len());
    if random.below(3) == 0 {
        input[start] = b'0' + random.below(10) as u8;
    } else {
        drop(input.splice(start..end, pick(random, NUMBERS).bytes()));
    }
}

/// Repeats, moves or removes the line at `at`.
fn line(random: &mut Random, input: &mut Vec<u8>, at: usize) {
    let start = input[..at].iter().rposition(|&byte| byte == b'\n').map_or(0, |i| i + 1);
    let end = input[at..].iter().position(|&byte| byte == b'\n').map_or(input.len(), |i| at + i + 1);
    let whole = input[start..end].to_vec();
    match random.below(3) {
        0 => drop(input.drain(start..end)),
        1 => drop(input.splice(start..start, whole)),
        _ => {
            drop(input.drain(start..end));
            let to = random.below(input.len() + 1);
            drop(input.splice(to..to, whole));
        }
    }
}
