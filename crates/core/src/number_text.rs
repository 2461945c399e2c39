//! Formatting of numbers in messages: short texts without rounding noise.

/// Largest number of significant digits that [`short`] prints, except that the integer part of a number below
/// [`LARGE`] is printed in full.
const DIGITS: usize = 6;
/// Magnitude from which numbers are printed with an exponent, because the integer part would be too long to
/// read.
const LARGE: f64 = 1e9;
/// Magnitude below which numbers are printed with an exponent, because there would be too many leading zeros.
const SMALL: f64 = 1e-4;

/// Formats a number with up to six significant digits: `1.4`, `700000`, `1e-300`.
///
/// Below 1e9 the integer part is printed in full, even if it has more digits: distances from the centre of
/// the Earth in metres have seven.
#[must_use]
pub fn short(value: f64) -> String {
    rounded(value, DIGITS)
}

/// Formats a number with enough digits to distinguish it from other numbers in the same message.
///
/// An example is `1.000002` beside 1: with six digits, both would be printed as 1.
#[must_use]
pub fn unlike(value: f64, others: &[f64]) -> String {
    let told_apart = |digits: &usize| {
        let text = rounded(value, *digits);
        others.iter().all(|&other| other == value || text != short(other))
    };
    rounded(value, (DIGITS..17).find(told_apart).unwrap_or(17))
}

/// Formats a number with all digits that distinguish it from other numbers: `1.0000000000000002`, `1e60`.
///
/// An input that is compared exactly with a limit is printed in this form, so that it does not look like the
/// limit.
#[must_use]
pub fn exact(value: f64) -> String {
    let is_plain = value == 0.0 || !value.is_finite() || (SMALL..LARGE).contains(&value.abs());
    if is_plain { value.to_string() } else { format!("{value:e}") }
}

/// Formats several numbers as a list: `[1, 2.5, 3]`.
#[must_use]
pub fn list(values: &[f64]) -> String {
    format!("[{}]", values.iter().map(|&value| short(value)).collect::<Vec<_>>().join(", "))
}

/// Formats a count with its noun: `1 number`, `2 numbers`.
#[must_use]
pub fn count(number: usize, one: &str) -> String {
    if number == 1 { format!("1 {one}") } else { format!("{number} {}", plural(one)) }
}

/// Formats the names of the known objects of a kind, as a clause: `the contacts are: a, b`, `the only contact
/// is 'a'` or `there are no contacts`. `one` is the kind in the singular.
#[must_use]
pub fn names<T: AsRef<str>>(known: &[T], one: &str) -> String {
    match known {
        [] => format!("there are no {}", plural(one)),
        [only] => format!("the only {one} is '{}'", only.as_ref()),
        _ => {
            let known: Vec<&str> = known.iter().map(AsRef::as_ref).collect();
            format!("the {} are: {}", plural(one), known.join(", "))
        }
    }
}

/// Formats several numbers with all digits as a list: `[1, 2.5, 0.30000000000000004]`.
#[must_use]
pub fn exact_list(values: &[f64]) -> String {
    format!("[{}]", values.iter().map(|&value| exact(value)).collect::<Vec<_>>().join(", "))
}

/// Formats the accepted indices of `count` objects: `joints 0 to 5`, `only joint 0` or `no joints`.
#[must_use]
pub fn indices(count: usize, one: &str) -> String {
    match count {
        0 => format!("no {}", plural(one)),
        1 => format!("only {one} 0"),
        _ => format!("{} 0 to {}", plural(one), count - 1),
    }
}

/// Formats the accepted indices of `count` objects with the advice to give one of them: `joints 0 to 5; give
/// one of these indices`.
#[must_use]
pub fn choice(count: usize, one: &str) -> String {
    let known = indices(count, one);
    match count {
        0 => format!("{known}, so no index is valid"),
        1 => format!("{known}; give the index 0"),
        _ => format!("{known}; give one of these indices"),
    }
}

fn plural(one: &str) -> String {
    match one.strip_suffix('y') {
        Some(stem) if !stem.ends_with(['a', 'e', 'o', 'u']) => format!("{stem}ies"),
        _ => format!("{one}s"),
    }
}

/// Formats a number with up to `digits` significant digits, without trailing zeros. From [`SMALL`] to
/// [`LARGE`] in magnitude, there is no exponent, and the integer part is printed in full.
fn rounded(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let scientific = format!("{value:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    if !(SMALL..LARGE).contains(&value.abs()) {
        return format!("{}e{exponent}", without_zeros(mantissa));
    }
    let before_point = 1 + exponent.parse::<i32>().unwrap_or(0);
    let decimals = i32::try_from(digits).unwrap_or(0) - before_point;
    without_zeros(&format!("{value:.*}", usize::try_from(decimals).unwrap_or(0))).to_owned()
}

fn without_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::{choice, count, exact, exact_list, indices, list, names, short, unlike};

    #[test]
    fn noise_of_rounding_is_not_printed() {
        for (value, text) in [
            (1.400_000_000_000_000_1, "1.4"),
            (699_999.999_999_999_9, "700000"),
            (1.0, "1"),
            (0.0, "0"),
            (-0.1 - 0.2, "-0.3"),
            (6_378_136.9, "6378137"),
            (1.0 / 3.0, "0.333333"),
            (999_999.96, "1000000"),
            (0.000_12, "0.00012"),
            (1e-300, "1e-300"),
            (-1.25e60, "-1.25e60"),
            (9.999_999_9e-5, "1e-4"),
            (2.5e9, "2.5e9"),
            (f64::INFINITY, "inf"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(short(value), text);
        }
        assert_eq!((count(1, "number"), count(0, "row")), ("1 number".to_owned(), "0 rows".to_owned()));
        assert_eq!(list(&[1.0, 0.1 + 0.2]), "[1, 0.3]");
        assert_eq!(exact_list(&[1.0, 0.1 + 0.2]), "[1, 0.30000000000000004]");
        assert_eq!(names::<&str>(&[], "contact"), "there are no contacts");
        assert_eq!(names(&["a"], "contact"), "the only contact is 'a'");
        assert_eq!(names(&["a", "b"], "contact"), "the contacts are: a, b");
        assert_eq!([0, 1, 3].map(|n| indices(n, "joint")), ["no joints", "only joint 0", "joints 0 to 2"]);
        assert_eq!(indices(2, "body"), "bodies 0 to 1");
        assert_eq!(["array", "key", "entry"].map(|one| count(2, one)), ["2 arrays", "2 keys", "2 entries"]);
        assert_eq!(choice(0, "joint"), "no joints, so no index is valid");
        assert_eq!(choice(1, "frame"), "only frame 0; give the index 0");
        assert_eq!(choice(3, "frame"), "frames 0 to 2; give one of these indices");
    }

    #[test]
    fn a_number_is_told_apart_from_its_limit() {
        assert_eq!(unlike(6_378_136.9, &[6_378_137.0]), "6378136.9");
        assert_eq!(unlike(1.000_002, &[1.0]), "1.000002");
        assert_eq!(unlike(1.0 + f64::EPSILON, &[1.0]), "1.0000000000000002");
        assert_eq!(unlike(0.5, &[1.0, 0.5]), "0.5");
        assert_eq!(
            [2.0, 2.000_000_1, -1e-7, 1.5e60, f64::NAN].map(exact),
            ["2", "2.0000001", "-1e-7", "1.5e60", "NaN"]
        );
    }
}
