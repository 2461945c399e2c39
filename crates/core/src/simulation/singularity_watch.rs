//! Detection of singular configurations of closed loops during a run.

/// Ratio of the pivot of a row to its largest pivot in the run below which the configuration counts as
/// singular. A pivot is proportional to the square of the distance from the singular configuration, so this
/// ratio corresponds to 1 % of a typical distance.
const SINGULAR: f64 = 1e-4;
/// Ratio of the pivot of a row to its largest pivot in the run above which the configuration is regular
/// again.
const REGULAR: f64 = 1e-3;
/// Smallest pivot that is distinguished from zero; the pivot of a redundant row is always smaller.
const ZERO: f64 = 1e-10;

/// Closed loop or mimic joint whose constraints became linearly dependent in a singular configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct SingularLoop {
    /// Name of the system.
    pub system: String,
    /// Name of the loop, of the capture that closes it, or of the mimic joint.
    pub name: String,
    /// Time at which the run came near the singular configuration for the first time, s.
    pub time: f64,
}

/// Detector of singular configurations, which follows the pivots of the constraint rows of closed loops
/// during a run. A pivot vanishes where a row is linearly dependent on other rows.
#[derive(Clone, Debug, Default)]
pub(super) struct SingularityWatch {
    rows: Vec<WatchedRow>,
    /// True for each joint, `(n,)`, that was kept at rest in the last update; empty if there were none.
    kept: Vec<bool>,
}

#[derive(Clone, Debug)]
struct WatchedRow {
    largest: f64,
    /// Smallest pivot since the last reported singular configuration, and the time of this pivot, s.
    least: (f64, f64),
    is_reported: bool,
    /// True while the pivot grows after a reported singular configuration.
    is_leaving: bool,
}

impl SingularityWatch {
    /// Returns the indices of the rows that have become singular, each with the time of its smallest pivot,
    /// s. `pivots` has the pivots of all rows at `t`, s. The pivots depend on which joints are `kept` at
    /// rest, so a change of these joints restarts the detection. A start in a singular configuration is
    /// recognized only after the run has left it.
    pub(super) fn update(
        &mut self,
        t: f64,
        pivots: impl Iterator<Item = f64>,
        kept: &[bool],
    ) -> Vec<(usize, f64)> {
        if self.kept != kept {
            self.kept.clear();
            self.kept.extend_from_slice(kept);
            self.rows.clear();
        }
        let mut found = Vec::new();
        for (i, pivot) in pivots.enumerate() {
            let pivot = pivot.max(ZERO);
            if i == self.rows.len() {
                let (is_reported, is_leaving) = (false, false);
                self.rows.push(WatchedRow { largest: pivot, least: (pivot, t), is_reported, is_leaving });
            }
            let row = &mut self.rows[i];
            row.largest = row.largest.max(pivot);
            row.is_leaving &= pivot >= row.least.0;
            if pivot < row.least.0 || row.is_leaving {
                row.least = (pivot, t);
            }
            if !row.is_reported && row.least.0 < SINGULAR * row.largest {
                found.push((i, row.least.1));
                row.is_reported = true;
            }
            if row.is_reported && pivot > REGULAR * row.largest {
                row.least = (pivot, t);
                (row.is_reported, row.is_leaving) = (false, true);
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the times at which a row with these pivots, one per second, becomes singular.
    fn times(pivots: &[f64]) -> Vec<f64> {
        let mut watch = SingularityWatch::default();
        let each = pivots.iter().enumerate();
        each.flat_map(|(t, pivot)| watch.update(t as f64, [*pivot].into_iter(), &[]))
            .map(|(_, time)| time)
            .collect()
    }

    #[test]
    fn a_row_is_reported_once_each_time_that_its_pivot_vanishes() {
        assert_eq!(times(&[0.2, 0.1, 1e-6, 1e-9, 1e-6, 0.1, 0.2, 1e-5, 0.1]), [2.0, 7.0]);
        assert_eq!(times(&[0.0, 1e-7, 1e-6, 1e-5, 0.1, 0.3]), [0.0]);
    }

    #[test]
    fn rows_that_are_always_redundant_and_regular_rows_are_not_reported() {
        assert!(times(&[1e-16, 0.0, 1e-13, 1e-16]).is_empty());
        assert!(times(&[0.2, 0.01, 1e-3, 0.3]).is_empty());
    }

    #[test]
    fn locked_joints_start_anew() {
        let mut watch = SingularityWatch::default();
        assert!(watch.update(0.0, [0.3].into_iter(), &[]).is_empty());
        assert!(watch.update(1.0, [1e-9].into_iter(), &[true]).is_empty());
        assert!(watch.update(2.0, [0.3].into_iter(), &[]).is_empty());
        assert_eq!(watch.update(3.0, [1e-9].into_iter(), &[]), [(0, 3.0)]); // control
    }
}
