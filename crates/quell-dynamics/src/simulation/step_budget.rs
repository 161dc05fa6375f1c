//! The limit on the steps of a run: steps are counted, and a run that would never end is stopped with the reason.
//!
//! Two things make a run endless although every step advances time. Its equation is stiff (an enormous ζ, or forces that
//! are enormous compared with F), so that a step is a vanishing part of a period; or the requested time is enormous compared
//! with a period. Both are detected from outside: the clock is checked every [`CHECK_INTERVAL`] steps.
//!
//! * [`MOST_CHECKS`] checks within one period of the fastest oscillation end a run: an ordinary run takes three steps per
//!   period, and a few more for each event.
//! * After [`STEPS_TO_PROJECT`] steps, a run that would take more than [`MOST_STEPS`] at its rate so far is stopped. A step of a large
//!   system counts as many steps of one mass as it takes their time.
//! * All runs of one request ([`within`]) together take at most the number of steps that the request allows.
//!
//! The counts depend on the run alone, except for the last one: it decides only how soon a request is abandoned.

use std::cell::Cell;
use std::f64::consts::TAU;

/// Steps between two checks of the clock.
pub(super) const CHECK_INTERVAL: u64 = 1 << 16;

/// Checks within one period of the fastest oscillation that end a run.
const MOST_CHECKS: u32 = 2;

/// Steps after which the total number of steps of a run is projected.
const STEPS_TO_PROJECT: u64 = 1 << 20;

/// Most steps of a run: some minutes of computation.
pub const MOST_STEPS: u64 = 2_000_000_000;

/// Steps charged for starting a run: a request may take many runs of one step each.
const STEPS_PER_START: u64 = 64;

/// Why a run whose steps are too short was stopped.
const TOO_STIFF: &str = "a hundred thousand steps did not cover one period of its fastest oscillation: the \
                         damping, the friction or the dither is too large compared with the other forces";

/// Why a run that is too long was stopped.
const TOO_LONG: &str = "it would take more than 2 000 000 000 steps of one mass, or as much work: the requested time, or a period of \
                        the dither, is too long compared with the fastest oscillation; a large model takes fewer and shorter steps \
                        when it is reduced to its lowest modes";

/// Why a request was abandoned.
const TOO_MUCH: &str = "the steps allowed for one request are used up: its runs neither settle nor end, or a \
                        period of the dither is too long compared with the fastest oscillation";

thread_local! {
    /// Steps that the request of this thread may still take.
    static LEFT: Cell<u64> = const { Cell::new(u64::MAX) };
}

/// Calls `work` with a limit on the steps that all its runs on this thread take together (a check may be `CHECK_INTERVAL`
/// steps late). Runs beyond the limit end immediately, with the reason.
pub fn within<T>(steps: u64, work: impl FnOnce() -> T) -> T {
    /// Restores the remaining steps of the outer request, also if the work panics.
    struct Outer(u64, u64);
    impl Drop for Outer {
        fn drop(&mut self) {
            let Self(outer, given) = *self;
            let taken = LEFT.with(|left| given - left.get().min(given));
            LEFT.with(|left| left.set(if outer == u64::MAX { outer } else { outer - taken }));
        }
    }
    let outer = LEFT.with(Cell::get);
    let given = outer.min(steps);
    let _outer = Outer(outer, given);
    LEFT.with(|left| left.set(given));
    work()
}

/// Calls `work` with a limit of its own and returns also the steps that it took: a part of a request that runs on any thread, also on one
/// that waits for a part of another request. Neither limits the other.
pub fn apart<T>(steps: u64, work: impl FnOnce() -> T) -> (T, u64) {
    /// Restores the remaining steps of the thread, also if the work panics.
    struct Meanwhile(u64);
    impl Drop for Meanwhile {
        fn drop(&mut self) {
            LEFT.with(|left| left.set(self.0));
        }
    }
    let _meanwhile = Meanwhile(LEFT.with(Cell::get));
    LEFT.with(|left| left.set(steps));
    let done = work();
    // Without a limit nothing is counted.
    let left = LEFT.with(Cell::get);
    (done, steps - left.min(steps))
}

/// Steps that the request of this thread may still take; the largest number without a limit.
pub fn left() -> u64 {
    LEFT.with(Cell::get)
}

/// Counts steps that parts of the request of this thread took on other threads.
pub fn count_taken(steps: u64) {
    // Where they are used up, the next run ends.
    let _ = charge(steps);
}

/// Whether the request of this thread has used up its steps: what it found is not the end of what it searched for.
pub fn is_used_up() -> bool {
    LEFT.with(Cell::get) == 0
}

/// The step budget of one run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepBudget {
    /// Start and end of the run.
    from: f64,
    until: f64,
    /// Period of the fastest oscillation.
    period: f64,
    /// Time of a step over that of one mass.
    work: f64,
    /// Steps at the last check.
    steps: u64,
    /// Start of the current window of one period, and the number of checks in it.
    window: f64,
    checks: u32,
}

impl StepBudget {
    /// For a run whose fastest oscillation has this frequency ratio.
    pub(crate) fn new(from: f64, until: f64, fastest: f64) -> Self {
        let period = TAU / fastest.max(1.0);
        Self { from, until, period, work: 1.0, steps: 0, window: from, checks: 0 }
    }

    /// The same for steps that take this many times as long as those of one mass.
    pub(crate) fn of_work(self, work: f64) -> Self {
        Self { work, ..self }
    }

    /// Whether a check is due after this number of steps.
    #[inline(always)]
    pub(crate) fn is_due(&self, steps: u64) -> bool {
        steps - self.steps >= CHECK_INTERVAL
    }

    /// Checks the clock after this number of steps.
    ///
    /// # Errors
    /// Why the run will not end.
    #[cold]
    pub(crate) fn check(&mut self, steps: u64, time: f64) -> Result<(), &'static str> {
        self.spend(steps)?;
        if time - self.window >= self.period {
            (self.window, self.checks) = (time, 0);
        } else {
            self.checks += 1;
            if self.checks >= MOST_CHECKS {
                return Err(TOO_STIFF);
            }
        }
        let work = steps as f64 * self.work;
        if work >= STEPS_TO_PROJECT as f64 {
            let whole = work * ((self.until - self.from) / (time - self.from));
            // The projection is infinite where no time has passed.
            if whole.is_nan() || whole > MOST_STEPS as f64 {
                return Err(TOO_LONG);
            }
        }
        Ok(())
    }

    /// Charges the start of a run to the request.
    ///
    /// # Errors
    /// If the steps of the request are used up.
    pub(crate) fn begin() -> Result<(), &'static str> {
        charge(STEPS_PER_START)
    }

    /// Charges the steps since the last check to the request.
    ///
    /// # Errors
    /// If the steps of the request are used up.
    pub(crate) fn spend(&mut self, steps: u64) -> Result<(), &'static str> {
        let taken = steps - self.steps;
        self.steps = steps;
        charge(taken)
    }
}

/// Subtracts steps from those that the request of this thread may still take.
fn charge(steps: u64) -> Result<(), &'static str> {
    LEFT.with(|left| {
        let rest = left.get();
        if rest < u64::MAX {
            left.set(rest.saturating_sub(steps));
        }
        if rest == 0 { Err(TOO_MUCH) } else { Ok(()) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_run_that_would_never_end_is_stopped() {
        let mut ordinary = StepBudget::new(0.0, 1e8, 10.0);
        let mut stiff = StepBudget::new(0.0, 1e3, 10.0);
        let mut long = StepBudget::new(0.0, 1e12, 10.0);
        let (mut stiffness, mut length) = (Ok(()), Ok(()));
        for check in 1..=100_u64 {
            let steps = check * CHECK_INTERVAL;
            assert!(ordinary.is_due(steps));
            assert_eq!(ordinary.check(steps, steps as f64 * 0.2), Ok(()));
            stiffness = stiffness.and_then(|()| stiff.check(steps, steps as f64 * 1e-8));
            length = length.and_then(|()| long.check(steps, steps as f64 * 0.2));
        }
        assert_eq!((stiffness, length), (Err(TOO_STIFF), Err(TOO_LONG)));
        // A step of thousands of numbers takes as long as thousands of a few.
        let mut large = StepBudget::new(0.0, 1e6, 10.0).of_work(1e4);
        assert_eq!(large.check(CHECK_INTERVAL, CHECK_INTERVAL as f64 * 0.2), Err(TOO_LONG));
    }

    #[test]
    fn runs_of_a_request_share_its_steps() {
        let run = |steps| StepBudget::new(0.0, 1.0, 1.0).spend(steps);
        let outer = within(100, || {
            assert_eq!(
                within(1000, || [run(60), run(60), run(1)]),
                [Ok(()), Ok(()), Err(TOO_MUCH)]
            );
            run(1)
        });
        assert_eq!((outer, run(u64::MAX / 2)), (Err(TOO_MUCH), Ok(())));
        let used_up = within(100, || [run(60), run(40)].map(|_| is_used_up()));
        assert_eq!((used_up, is_used_up()), ([true, true], false));
        assert_eq!(within(100, || [within(10, || run(20)), run(80)]), [Ok(()); 2]);
        // Parts on other threads, within another request.
        let parts = within(100, || {
            let ((), taken) = within(1, || apart(left().max(100), || run(60).expect("of its own")));
            count_taken(taken);
            (taken, left())
        });
        assert_eq!(parts, (60, 40));
        // Runs without steps are limited too.
        let begun = within(STEPS_PER_START * 3, || {
            (0..9).take_while(|_| StepBudget::begin().is_ok()).count()
        });
        assert_eq!(begun, 3);
    }
}
