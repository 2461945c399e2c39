//! Where steps end: the regular grid, control ticks, and instants at which something jumps.

use serde::{Deserialize, Serialize};

/// Two instants closer than this share of a step are the same instant.
pub(super) const SAME_INSTANT: f64 = 1e-9;

/// A stretch that the integrator crosses in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch {
    /// Its start, s.
    pub(super) start: f64,
    /// Its end, s.
    pub(super) end: f64,
    /// Whether the controller is asked at its start.
    pub(super) is_control_tick: bool,
    /// Number of the grid step that begins at its start, if one does.
    pub(super) grid_step: Option<usize>,
    /// Whether an event is at its start: wrenches or torques may jump there.
    pub(super) is_event: bool,
}

/// Cuts `0..duration` at every multiple of the step and of the control period, and at every event.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Schedule {
    time_step: f64,
    duration: f64,
    control_period: f64,
    events: Vec<f64>,
    /// Whether steps end at the grid.
    cuts_at_grid: bool,
    /// Instants at which the controller is asked beside its own.
    switches: Vec<f64>,
    now: f64,
    next_grid: usize,
    next_tick: usize,
    next_event: usize,
}

impl Schedule {
    pub(super) fn new(
        time_step: f64,
        duration: f64,
        control_period: Option<f64>,
        mut events: Vec<f64>,
    ) -> Self {
        events.retain(|t| t.is_finite());
        events.sort_by(f64::total_cmp);
        let control_period = control_period.unwrap_or(time_step);
        Self {
            time_step,
            duration,
            control_period,
            events,
            cuts_at_grid: true,
            switches: Vec::new(),
            now: 0.0,
            next_grid: 0,
            next_tick: 0,
            next_event: 0,
        }
    }

    /// Steps that pass over the grid: it is for rows alone.
    pub(super) fn over_the_grid(self) -> Self {
        Self { cuts_at_grid: false, ..self }
    }

    /// Ends the present stretch early.
    pub(super) fn cut(&mut self, t: f64) {
        self.now = t;
    }

    /// Number and instant of the next grid step that begins before `t`, once each.
    pub(super) fn passed(&mut self, t: f64) -> Option<(usize, f64)> {
        let step = self.next_grid;
        let instant = step as f64 * self.time_step;
        let is_passed = instant < t - self.tolerance();
        self.next_grid += usize::from(is_passed);
        is_passed.then_some((step, instant))
    }

    /// Instant reached, s.
    pub(super) fn now(&self) -> f64 {
        self.now
    }

    /// Duration and regular step, s.
    pub(super) fn duration_and_step(&self) -> (f64, f64) {
        (self.duration, self.time_step)
    }

    /// Whether another schedule has the same cuts, wherever the two stand.
    pub(super) fn cuts_like(&self, other: &Self) -> bool {
        let Self { now, next_grid, next_tick, next_event, .. } = *self;
        *self == Self { now, next_grid, next_tick, next_event, ..other.clone() }
    }

    /// With instants at which controls are switched: steps end there, and the controller is asked.
    pub(super) fn switching(mut self, switches: Vec<f64>) -> Self {
        self.events.extend(&switches);
        self.events.sort_by(f64::total_cmp);
        self.switches = switches;
        self
    }

    /// Number of grid steps; the last may be shorter.
    pub(super) fn grid_steps(&self) -> usize {
        (self.duration / self.time_step - SAME_INSTANT).ceil().max(1.0) as usize
    }

    /// A share of the step, and late in a run the rounding of the instants themselves.
    fn tolerance(&self) -> f64 {
        (SAME_INSTANT * self.time_step).max(4.0 * f64::EPSILON * self.now)
    }

    /// Upper bound of the number of stretches.
    pub(super) fn stretches(&self) -> usize {
        let ticks =
            if self.control_period == self.time_step { 0.0 } else { self.duration / self.control_period };
        self.grid_steps().saturating_add(ticks.ceil() as usize).saturating_add(self.events.len())
    }

    /// Whether the controller is due now.
    pub(super) fn is_control_tick(&self) -> bool {
        self.is_regular_tick() || self.switches.iter().any(|&t| self.is_now(t))
    }

    fn is_regular_tick(&self) -> bool {
        self.is_now(self.next_tick as f64 * self.control_period)
    }

    fn is_now(&self, t: f64) -> bool {
        (t - self.now).abs() <= self.tolerance()
    }
}

impl Iterator for Schedule {
    type Item = Stretch;

    fn next(&mut self) -> Option<Stretch> {
        if self.now >= self.duration - self.tolerance() {
            return None;
        }
        let grid = self.next_grid as f64 * self.time_step; // a product, so that errors do not add up
        let grid_step = self.is_now(grid).then_some(self.next_grid);
        self.next_grid += usize::from(grid_step.is_some());
        let is_control_tick = self.is_control_tick();
        self.next_tick += usize::from(self.is_regular_tick());
        let events_before = self.next_event;
        while self.events.get(self.next_event).is_some_and(|&t| t <= self.now + self.tolerance()) {
            self.next_event += 1;
        }
        let grid = if self.cuts_at_grid { self.next_grid as f64 * self.time_step } else { self.duration };
        let mut end = grid.min(self.duration);
        let cuts =
            [Some(self.next_tick as f64 * self.control_period), self.events.get(self.next_event).copied()];
        for cut in cuts.into_iter().flatten() {
            if cut < end - self.tolerance() {
                end = cut;
            }
        }
        if (self.duration - end).abs() <= self.tolerance() {
            end = self.duration;
        }
        let is_event = self.next_event > events_before;
        let stretch = Stretch { start: self.now, end, is_control_tick, grid_step, is_event };
        self.now = end;
        Some(stretch)
    }
}

#[cfg(test)]
mod tests {
    use super::Schedule;

    fn ends(schedule: Schedule) -> Vec<f64> {
        schedule.map(|s| s.end).collect()
    }

    #[test]
    fn events_are_hit_exactly_and_the_grid_does_not_drift() {
        let schedule = Schedule::new(0.1, 1.0, None, vec![0.25, 0.3, 7.0, -1.0]);
        assert_eq!(schedule.grid_steps(), 10);
        let ends = ends(schedule);
        assert_eq!(ends.len(), 11);
        assert!(ends.contains(&0.25) && ends.contains(&(3.0 * 0.1)) && ends.last() == Some(&1.0));
    }

    #[test]
    fn control_has_its_own_rate() {
        let slow = Schedule::new(0.1, 1.0, Some(0.25), vec![]);
        let ticks: Vec<f64> = slow.filter(|s| s.is_control_tick).map(|s| s.start).collect();
        assert_eq!(ticks, [0.0, 0.25, 0.5, 0.75]);
        let fast = Schedule::new(0.1, 0.2, Some(0.05), vec![]);
        assert_eq!(fast.filter(|s| s.is_control_tick).count(), 4);
    }

    #[test]
    fn a_switch_is_a_cut_and_a_tick() {
        let schedule = Schedule::new(0.1, 1.0, Some(0.5), vec![]).switching(vec![0.73, 0.1]);
        let ticks: Vec<f64> = schedule.filter(|s| s.is_control_tick).map(|s| s.start).collect();
        assert_eq!(ticks, [0.0, 0.1, 0.5, 0.73]);
    }

    #[test]
    fn rounding_late_in_a_run_makes_no_slivers() {
        // 10 000 s at 1 ms: k · 0.003 and 3k · 0.001 differ by more than a billionth of a step
        let schedule = Schedule::new(1e-3, 1e4, Some(3e-3), vec![9000.0003]);
        let shortest = schedule.clone().map(|s| s.end - s.start).fold(f64::INFINITY, f64::min);
        assert!(shortest > 0.2e-3, "{shortest}");
        assert_eq!(schedule.count(), 10_000_001);
    }

    #[test]
    fn a_duration_that_is_no_multiple_ends_with_a_shorter_step() {
        let schedule = Schedule::new(0.3, 1.0, None, vec![]);
        assert_eq!(schedule.grid_steps(), 4);
        assert_eq!(ends(schedule).last(), Some(&1.0));
    }
}
