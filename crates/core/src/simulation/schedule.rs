//! Where steps end: the regular grid, control ticks, and instants at which something jumps.

use serde::{Deserialize, Serialize};

/// Two instants closer than this fraction of a step are the same instant.
pub(super) const SAME_INSTANT: f64 = 1e-9;
/// Longest interval of an adaptive run without a planned end, in regular steps.
pub(super) const LONGEST_INTERVAL: f64 = 1e6;

/// An interval that the integrator crosses in one step, or in several if it adapts them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    /// Its start, s.
    pub(super) start: f64,
    /// Its end, s.
    pub(super) end: f64,
    /// Whether the controllers are updated at its start.
    pub(super) is_control_tick: bool,
    /// Number of the grid step that begins at its start, if one does.
    pub(super) grid_step: Option<usize>,
    /// Whether an event is at its start: wrenches or torques may jump there.
    pub(super) is_event: bool,
}

/// Cuts of a run: every multiple of the step and of the control period, every event, and the end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Schedule {
    time_step: f64,
    /// Planned end of the run, s.
    duration: Option<f64>,
    control_period: f64,
    events: Vec<f64>,
    /// Whether steps end at the grid.
    cuts_at_grid: bool,
    /// Instants at which the controllers are updated besides the regular ticks.
    switches: Vec<f64>,
    at: Cursor,
}

/// Present place in a schedule.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Cursor {
    now: f64,
    next_grid: usize,
    next_tick: usize,
    next_event: usize,
}

impl Schedule {
    pub(super) fn new(
        time_step: f64,
        duration: Option<f64>,
        control_period: Option<f64>,
        mut events: Vec<f64>,
    ) -> Self {
        events.retain(|t| t.is_finite());
        events.sort_by(f64::total_cmp);
        Self {
            time_step,
            duration,
            control_period: control_period.unwrap_or(time_step),
            events,
            cuts_at_grid: true,
            switches: Vec::new(),
            at: Cursor::default(),
        }
    }

    /// Lets steps pass over the grid, which then only places the rows.
    pub(super) fn without_grid_steps(self) -> Self {
        Self { cuts_at_grid: false, ..self }
    }

    /// Adds instants at which controls start or stop: steps end there, and the controllers are updated.
    pub(super) fn with_switches(mut self, switches: Vec<f64>) -> Self {
        self.events.extend(&switches);
        self.events.sort_by(f64::total_cmp);
        self.switches = switches;
        self
    }

    /// Instant reached, s: the present cut.
    pub(super) fn now(&self) -> f64 {
        self.at.now
    }

    pub(super) fn cursor(&self) -> Cursor {
        self.at
    }

    pub(super) fn set_cursor(&mut self, at: Cursor) {
        self.at = at;
    }

    pub(super) fn duration(&self) -> Option<f64> {
        self.duration
    }

    pub(super) fn time_step(&self) -> f64 {
        self.time_step
    }

    /// Returns true if another schedule has the same cuts; the present places may differ.
    pub(super) fn has_cuts_of(&self, other: &Self) -> bool {
        *self == Self { at: self.at, ..other.clone() }
    }

    /// Number of grid steps of a run with a planned end; the last may be shorter.
    pub(super) fn grid_steps(&self) -> Option<usize> {
        self.duration.map(|duration| (duration / self.time_step - SAME_INSTANT).ceil().max(1.0) as usize)
    }

    /// Upper bound of the number of intervals of a run with a planned end.
    pub(super) fn intervals(&self) -> Option<usize> {
        let ticks = |duration: f64| {
            if self.control_period == self.time_step { 0.0 } else { duration / self.control_period }
        };
        let ticks = ticks(self.duration?).ceil() as usize;
        Some(self.grid_steps()?.saturating_add(ticks).saturating_add(self.events.len()))
    }

    /// A fraction of the step, and late in a run the rounding of the instants themselves.
    fn tolerance(&self) -> f64 {
        (SAME_INSTANT * self.time_step).max(4.0 * f64::EPSILON * self.at.now)
    }

    /// Returns true if `t` is the present cut.
    pub(super) fn is_now(&self, t: f64) -> bool {
        (t - self.at.now).abs() <= self.tolerance()
    }

    /// Returns true if `t` is later than `other` by more than the resolution of instants.
    pub(super) fn is_later(&self, t: f64, other: f64) -> bool {
        t > other + self.tolerance()
    }

    /// Returns true if a control tick is due at the present cut.
    pub(super) fn is_control_tick(&self) -> bool {
        self.is_regular_tick() || self.switches.iter().any(|&t| self.is_now(t))
    }

    fn is_regular_tick(&self) -> bool {
        self.is_now(self.at.next_tick as f64 * self.control_period)
    }

    /// Returns true if the counters belong to the present cut, and `t` to the interval that begins there.
    pub(super) fn is_consistent(&self, t: f64) -> bool {
        let Cursor { now, next_grid, next_tick, next_event } = self.at;
        let is_next = |count: usize, period: f64| {
            let before = count.checked_sub(1).map(|before| before as f64 * period);
            count as f64 * period >= now - self.tolerance()
                && before.is_none_or(|before| before <= now + self.tolerance())
        };
        let last = self.following().map_or(now, |(interval, _)| interval.end);
        now.is_finite()
            && now >= 0.0
            && self.duration.is_none_or(|duration| now <= duration + self.tolerance())
            && is_next(next_grid, self.time_step)
            && (self.control_period == f64::MAX || is_next(next_tick, self.control_period))
            && next_event <= self.events.len()
            && t >= now - self.tolerance()
            && t <= last + self.tolerance()
    }

    /// Returns the interval that begins at the present cut, and the place after it; `None` at the planned end.
    pub(super) fn following(&self) -> Option<(Interval, Cursor)> {
        let Cursor { now, mut next_grid, mut next_tick, mut next_event } = self.at;
        if self.duration.is_some_and(|duration| now >= duration - self.tolerance()) {
            return None;
        }
        let grid = next_grid as f64 * self.time_step; // a product, so that errors do not add up
        let grid_step = self.is_now(grid).then_some(next_grid);
        next_grid += usize::from(grid_step.is_some());
        let is_control_tick = self.is_control_tick();
        next_tick += usize::from(self.is_regular_tick());
        let events_before = next_event;
        while self.events.get(next_event).is_some_and(|&t| t <= now + self.tolerance()) {
            next_event += 1;
        }
        let last = self.duration.unwrap_or(now + LONGEST_INTERVAL * self.time_step);
        let grid = if self.cuts_at_grid { next_grid as f64 * self.time_step } else { last };
        let mut end = grid.min(last);
        let cuts = [Some(next_tick as f64 * self.control_period), self.events.get(next_event).copied()];
        for cut in cuts.into_iter().flatten() {
            if cut < end - self.tolerance() {
                end = cut;
            }
        }
        if self.duration.is_some_and(|duration| (duration - end).abs() <= self.tolerance()) {
            end = last;
        }
        let is_event = next_event > events_before;
        let interval = Interval { start: now, end, is_control_tick, grid_step, is_event };
        Some((interval, Cursor { now: end, next_grid, next_tick, next_event }))
    }

    /// Makes `t`, in the interval entered last, the present cut.
    pub(super) fn cut_at(&mut self, t: f64) {
        self.at.now = t;
    }

    /// Returns number and instant of the next grid step that begins before the present cut, once each.
    pub(super) fn next_grid_step_passed(&mut self) -> Option<(usize, f64)> {
        let step = self.at.next_grid;
        let instant = step as f64 * self.time_step;
        let is_passed = instant < self.at.now - self.tolerance();
        self.at.next_grid += usize::from(is_passed);
        is_passed.then_some((step, instant))
    }
}

#[cfg(test)]
mod tests {
    use super::{Interval, Schedule};

    fn intervals(mut schedule: Schedule) -> impl Iterator<Item = Interval> {
        std::iter::from_fn(move || {
            let (interval, after) = schedule.following()?;
            schedule.set_cursor(after);
            Some(interval)
        })
    }

    fn ticks(schedule: Schedule) -> Vec<f64> {
        intervals(schedule)
            .filter(|interval| interval.is_control_tick)
            .map(|interval| interval.start)
            .collect()
    }

    #[test]
    fn events_are_hit_exactly_and_the_grid_does_not_drift() {
        let schedule = Schedule::new(0.1, Some(1.0), None, vec![0.25, 0.3, 7.0, -1.0]);
        assert_eq!(schedule.grid_steps(), Some(10));
        let ends: Vec<f64> = intervals(schedule).map(|interval| interval.end).collect();
        assert_eq!(ends.len(), 11);
        assert!(ends.contains(&0.25) && ends.contains(&(3.0 * 0.1)) && ends.last() == Some(&1.0));
    }

    #[test]
    fn control_has_its_own_rate() {
        assert_eq!(ticks(Schedule::new(0.1, Some(1.0), Some(0.25), vec![])), [0.0, 0.25, 0.5, 0.75]);
        assert_eq!(ticks(Schedule::new(0.1, Some(0.2), Some(0.05), vec![])).len(), 4);
    }

    #[test]
    fn a_switch_is_a_cut_and_a_tick() {
        let schedule = Schedule::new(0.1, Some(1.0), Some(0.5), vec![]).with_switches(vec![0.73, 0.1]);
        assert_eq!(ticks(schedule), [0.0, 0.1, 0.5, 0.73]);
    }

    #[test]
    fn rounding_late_in_a_run_makes_no_slivers() {
        // 10 000 s at 1 ms: k · 0.003 and 3k · 0.001 differ by more than a billionth of a step
        let schedule = Schedule::new(1e-3, Some(1e4), Some(3e-3), vec![9000.0003]);
        let lengths = || intervals(schedule.clone()).map(|interval| interval.end - interval.start);
        let shortest = lengths().fold(f64::INFINITY, f64::min);
        assert!(shortest > 0.2e-3, "{shortest}");
        assert_eq!(lengths().count(), 10_000_001);
    }

    #[test]
    fn a_duration_that_is_no_multiple_ends_with_a_shorter_step() {
        let schedule = Schedule::new(0.3, Some(1.0), None, vec![]);
        assert_eq!(schedule.grid_steps(), Some(4));
        assert_eq!(intervals(schedule).last().map(|interval| interval.end), Some(1.0));
    }

    #[test]
    fn without_a_planned_end_the_cuts_before_it_are_the_same() {
        let schedule = |duration| Schedule::new(0.1, duration, Some(0.25), vec![0.33]);
        let open: Vec<_> = intervals(schedule(None)).take(14).collect();
        let planned: Vec<_> = intervals(schedule(Some(1.0))).collect();
        assert_eq!(open[..planned.len()], planned);
        let adaptive = intervals(schedule(None).without_grid_steps()).nth(3).expect("an interval");
        assert_eq!((adaptive.start, adaptive.end), (0.5, 0.75));
    }
}
