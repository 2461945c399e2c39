//! Schedule of a run, which determines its cuts: the instants at which steps begin and end. Cuts are on a
//! regular grid, at control ticks, and at events, where loads or torques may be discontinuous.

use serde::{Deserialize, Serialize};

/// Difference, as a fraction of a regular step, below which two instants are treated as equal.
pub(super) const SAME_INSTANT: f64 = 1e-9;
/// Longest interval of an adaptive run without a planned end, as a multiple of the regular step.
pub(super) const LONGEST_INTERVAL: f64 = 1e6;

/// Interval between two cuts. A fixed-step integrator covers it in one step unless an event, a contact or a
/// change of mode ends the step early; an adaptive integrator may need several steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    /// Start of the interval, s.
    pub(super) start: f64,
    /// End of the interval, s.
    pub(super) end: f64,
    /// Index of the grid step that begins at the start of the interval; `None` if the start is not a grid
    /// point.
    pub(super) grid_step: Option<usize>,
    /// True if an event occurs at the start of the interval, where wrenches or torques may then be
    /// discontinuous.
    pub(super) is_event: bool,
}

/// Schedule of a run. Its cuts are the multiples of the time step and of the control period, the events, and
/// the end of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Schedule {
    time_step: f64,
    /// Planned end of the run, s; `None` for an open-ended run.
    duration: Option<f64>,
    /// Clocks of the controllers, one per system.
    clocks: Vec<Clock>,
    events: Vec<f64>,
    /// Times of events that became known during the run, s.
    due: Vec<f64>,
    /// True if steps end at the grid points.
    cuts_at_grid: bool,
    at: Cursor,
}

/// Instants at which the controllers of one system are updated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Clock {
    /// Time between two regular ticks, s.
    pub(super) period: f64,
    /// Additional instants, s, at which controls start or stop.
    pub(super) switches: Vec<f64>,
}

/// Current position in a schedule: the current cut, s, and the indices of the next grid point and of the next
/// event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Cursor {
    now: f64,
    next_grid: usize,
    next_event: usize,
}

impl Schedule {
    /// Creates a schedule with grid points at the multiples of `time_step`, s, and events at the times
    /// `events`, s, of which those that are not finite are ignored. Each clock ticks at least at time zero;
    /// the switches of clocks are also cuts.
    pub(super) fn new(
        time_step: f64,
        duration: Option<f64>,
        clocks: Vec<Clock>,
        mut events: Vec<f64>,
    ) -> Self {
        events.extend(clocks.iter().flat_map(|clock| &clock.switches));
        events.retain(|t| t.is_finite());
        events.sort_by(f64::total_cmp);
        Self {
            time_step,
            duration,
            clocks,
            events,
            due: Vec::new(),
            cuts_at_grid: true,
            at: Cursor::default(),
        }
    }

    /// Returns the schedule without cuts at grid points; the grid points then determine only the times of
    /// rows.
    pub(super) fn without_grid_steps(self) -> Self {
        Self { cuts_at_grid: false, ..self }
    }

    /// Sets the times of events that became known during the run, s.
    pub(super) fn set_due(&mut self, due: Vec<f64>) {
        self.due = due;
    }

    /// Returns the time, s, of the first event between `t` and `end` that became known during the run, or
    /// `end` if there is none.
    pub(super) fn first_due(&self, t: f64, end: f64) -> f64 {
        if self.due.is_empty() {
            return end;
        }
        let is_between = |due: &f64| *due > t + self.tolerance() && *due < end - self.tolerance();
        self.due.iter().copied().filter(is_between).fold(end, f64::min)
    }

    /// Returns the current cut, at which the current step begins, s.
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

    /// Returns true if another schedule has the same cuts, apart from events that became known during the
    /// run; the current positions may differ.
    pub(super) fn has_cuts_of(&self, other: &Self) -> bool {
        *self == Self { at: self.at, due: self.due.clone(), ..other.clone() }
    }

    /// Returns the names of the settings in which two schedules differ, joined by "and".
    pub(super) fn differences(&self, other: &Self) -> String {
        let names = [
            ("duration", self.duration != other.duration),
            ("time_step", self.time_step != other.time_step),
            ("control_period", self.periods().ne(other.periods())),
            ("the events", self.events != other.events && self.switches().eq(other.switches())),
            ("the times of the controls", self.switches().ne(other.switches())),
            ("the integrators", self.cuts_at_grid != other.cuts_at_grid),
        ];
        let names: Vec<_> = names.into_iter().filter(|(_, differ)| *differ).map(|(name, _)| name).collect();
        names.join(" and ")
    }

    fn periods(&self) -> impl Iterator<Item = f64> {
        self.clocks.iter().map(|clock| clock.period)
    }

    fn switches(&self) -> impl Iterator<Item = f64> {
        self.clocks.iter().flat_map(|clock| clock.switches.iter().copied())
    }

    /// Returns the number of grid steps of the run, of which the last may be shorter; `None` without a
    /// planned end.
    pub(super) fn grid_steps(&self) -> Option<usize> {
        self.duration.map(|duration| (duration / self.time_step - SAME_INSTANT).ceil().max(1.0) as usize)
    }

    /// Returns an upper bound of the number of intervals of the run, apart from intervals that result from
    /// events which become known during the run; `None` without a planned end.
    pub(super) fn intervals(&self) -> Option<usize> {
        let duration = self.duration?;
        let ticks = |period: f64| if period == self.time_step { 0.0 } else { (duration / period).ceil() };
        let ticks = self.periods().map(ticks).sum::<f64>() as usize;
        Some(self.grid_steps()?.saturating_add(ticks).saturating_add(self.events.len()))
    }

    /// Returns the tolerance for comparing instants, s. It is a fraction of the step or, late in a run, the
    /// rounding error of instants.
    fn tolerance(&self) -> f64 {
        (SAME_INSTANT * self.time_step).max(4.0 * f64::EPSILON * self.at.now)
    }

    /// Returns true if `t`, s, equals the current cut within the tolerance for comparing instants.
    pub(super) fn is_now(&self, t: f64) -> bool {
        (t - self.at.now).abs() <= self.tolerance()
    }

    /// Returns true if `t`, s, is later than `other`, s, by more than the tolerance for comparing instants.
    pub(super) fn is_later(&self, t: f64, other: f64) -> bool {
        t > other + self.tolerance()
    }

    /// Returns true if the grid point `grid`, s, is later than the end `last`, s, by more than the tolerance
    /// for comparing instants, or the rounding error of `last` if that is larger.
    fn is_beyond(&self, grid: f64, last: f64) -> bool {
        grid > last + self.tolerance().max(4.0 * f64::EPSILON * last)
    }

    /// Returns true if an update of the controllers of the system with index `system` is due at `t`, s.
    pub(super) fn is_tick(&self, system: usize, t: f64) -> bool {
        let Clock { period, switches } = &self.clocks[system];
        let is_now = |instant: f64| (instant - t).abs() <= self.tolerance();
        is_now(nearest_tick(t, *period) * period) || switches.iter().any(|&switch| is_now(switch))
    }

    /// Returns the first regular tick after the current cut, s, of a clock with this `period`, s.
    fn next_tick(&self, period: f64) -> f64 {
        let count = nearest_tick(self.at.now, period); // a product, so that rounding errors do not accumulate
        let nearest = count * period;
        if nearest > self.at.now + self.tolerance() { nearest } else { (count + 1.0) * period }
    }

    /// Returns true if the indices of the next grid point and event agree with the current cut, and `t`, s,
    /// is in the interval that begins at that cut.
    pub(super) fn is_consistent(&self, t: f64) -> bool {
        let Cursor { now, next_grid, next_event } = self.at;
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
            && next_event <= self.events.len()
            && t >= now - self.tolerance()
            && t <= last + self.tolerance()
    }

    /// Returns the interval that begins at the current cut, and the position at its end; `None` at the
    /// planned end of the run.
    ///
    /// If the last grid point equals the planned end within the tolerance for comparing instants, the run
    /// ends at the grid point, so that its cuts are those of a run without a planned end. In floating point,
    /// `140 · 0.005` differs from `0.7`.
    #[inline]
    pub(super) fn following(&self) -> Option<(Interval, Cursor)> {
        let Cursor { now, mut next_grid, mut next_event } = self.at;
        if self.duration.is_some_and(|duration| now >= duration - self.tolerance()) {
            return None;
        }
        let grid = next_grid as f64 * self.time_step; // a product, so that rounding errors do not accumulate
        let grid_step = self.is_now(grid).then_some(next_grid);
        next_grid += usize::from(grid_step.is_some());
        let events_before = next_event;
        while self.events.get(next_event).is_some_and(|&t| t <= now + self.tolerance()) {
            next_event += 1;
        }
        let last = self.duration.unwrap_or(now + LONGEST_INTERVAL * self.time_step);
        let grid = if self.cuts_at_grid { next_grid as f64 * self.time_step } else { last };
        let end = if self.is_beyond(grid, last) { last } else { grid };
        let has_own_ticks = self.periods().any(|period| !self.is_on_grid(period));
        let has_only_grid = next_event == self.events.len() && self.due.is_empty() && !has_own_ticks;
        let end = if has_only_grid { end } else { self.first_cut(next_event, end) };
        let is_event = next_event > events_before || self.due.iter().any(|&t| self.is_now(t));
        let interval = Interval { start: now, end, grid_step, is_event };
        Some((interval, Cursor { now: end, next_grid, next_event }))
    }

    /// Returns true if the ticks of a clock with this `period`, s, are cuts of the grid.
    fn is_on_grid(&self, period: f64) -> bool {
        self.cuts_at_grid && period == self.time_step
    }

    /// Returns the first cut after the current one, s, if the next cut of the grid, or the end of the run, is
    /// at `end`, s, and the next event has the index `next_event`.
    #[inline(never)]
    fn first_cut(&self, next_event: usize, mut end: f64) -> f64 {
        let due = self.due.iter().copied().filter(|t| *t > self.at.now + self.tolerance());
        let own = self.periods().filter(|&period| !self.is_on_grid(period));
        let ticks = own.map(|period| self.next_tick(period));
        for cut in ticks.chain(self.events.get(next_event).copied()).chain(due) {
            if cut < end - self.tolerance() {
                end = cut;
            }
        }
        end
    }

    /// Ends the current interval at `t`, s, which becomes the current cut.
    pub(super) fn cut_at(&mut self, t: f64) {
        self.at.now = t;
    }

    /// Returns the index and the start time, s, of the next grid step that begins before the current cut, and
    /// advances past this step; `None` if there is no such step.
    pub(super) fn next_grid_step_passed(&mut self) -> Option<(usize, f64)> {
        let step = self.at.next_grid;
        let instant = step as f64 * self.time_step;
        let is_passed = instant < self.at.now - self.tolerance();
        self.at.next_grid += usize::from(is_passed);
        is_passed.then_some((step, instant))
    }
}

/// Returns the index of the regular tick nearest to `t`, s, for ticks at the multiples of `period`, s.
fn nearest_tick(t: f64, period: f64) -> f64 {
    // uses an integer conversion, because rounding is a library call on processors without SSE 4.1
    (t / period + 0.5) as u64 as f64
}

#[cfg(test)]
mod tests {
    use super::{Clock, Interval, Schedule};

    fn schedule(time_step: f64, duration: Option<f64>, period: f64, events: Vec<f64>) -> Schedule {
        Schedule::new(time_step, duration, vec![Clock { period, switches: vec![] }], events)
    }

    fn intervals(mut schedule: Schedule) -> impl Iterator<Item = Interval> {
        std::iter::from_fn(move || {
            let (interval, after) = schedule.following()?;
            schedule.set_cursor(after);
            Some(interval)
        })
    }

    fn ticks(schedule: Schedule) -> Vec<f64> {
        let starts: Vec<f64> = intervals(schedule.clone()).map(|interval| interval.start).collect();
        starts.into_iter().filter(|&t| schedule.is_tick(0, t)).collect()
    }

    #[test]
    fn events_are_hit_exactly_and_the_grid_does_not_drift() {
        let schedule = schedule(0.1, Some(1.0), 0.1, vec![0.25, 0.3, 7.0, -1.0]);
        assert_eq!(schedule.grid_steps(), Some(10));
        let ends: Vec<f64> = intervals(schedule).map(|interval| interval.end).collect();
        assert_eq!(ends.len(), 11);
        assert!(ends.contains(&0.25) && ends.contains(&(3.0 * 0.1)) && ends.last() == Some(&1.0));
    }

    #[test]
    fn control_has_its_own_rate() {
        assert_eq!(ticks(schedule(0.1, Some(1.0), 0.25, vec![])), [0.0, 0.25, 0.5, 0.75]);
        assert_eq!(ticks(schedule(0.1, Some(0.2), 0.05, vec![])).len(), 4);
    }

    #[test]
    fn a_switch_is_a_cut_and_a_tick() {
        let clock = Clock { period: 0.5, switches: vec![0.73, 0.1] };
        let schedule = Schedule::new(0.1, Some(1.0), vec![clock], vec![]);
        assert_eq!(ticks(schedule), [0.0, 0.1, 0.5, 0.73]);
    }

    #[test]
    fn rounding_late_in_a_run_makes_no_slivers() {
        // for 10 000 s at 1 ms, k · 0.003 and 3k · 0.001 differ by more than a billionth of a step
        let schedule = schedule(1e-3, Some(1e4), 3e-3, vec![9000.0003]);
        let lengths = || intervals(schedule.clone()).map(|interval| interval.end - interval.start);
        let shortest = lengths().fold(f64::INFINITY, f64::min);
        assert!(shortest > 0.2e-3, "{shortest}");
        assert_eq!(lengths().count(), 10_000_001);
    }

    #[test]
    fn a_duration_that_is_no_multiple_ends_with_a_shorter_step() {
        let schedule = schedule(0.3, Some(1.0), 0.3, vec![]);
        assert_eq!(schedule.grid_steps(), Some(4));
        assert_eq!(intervals(schedule).last().map(|interval| interval.end), Some(1.0));
    }

    #[test]
    fn a_planned_end_on_the_grid_ends_at_the_grid_point() {
        // 140 · 0.005 is 0.7000000000000001
        let ends = |duration| {
            intervals(schedule(0.005, duration, 0.01, vec![0.333])).take(141).map(|interval| interval.end)
        };
        let (planned, open) = (ends(Some(0.7)).collect::<Vec<_>>(), ends(None).collect::<Vec<_>>());
        assert_eq!(planned, open);
        assert!(planned.last().is_some_and(|end| *end > 0.7 && *end - 0.7 < 1e-15));
    }

    #[test]
    fn without_a_planned_end_the_cuts_before_it_are_the_same() {
        let planned = |duration| schedule(0.1, duration, 0.25, vec![0.33]);
        let open: Vec<_> = intervals(planned(None)).take(14).collect();
        let closed: Vec<_> = intervals(planned(Some(1.0))).collect();
        assert_eq!(open[..closed.len()], closed);
        let adaptive = intervals(planned(None).without_grid_steps()).nth(3).expect("an interval");
        assert_eq!((adaptive.start, adaptive.end), (0.5, 0.75));
    }
}
