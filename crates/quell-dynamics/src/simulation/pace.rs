//! Whether a run gets on: its steps are counted, and a run that would never end is stopped with the reason.
//!
//! Two things make a run endless although every step advances time. Its equation is stiff (an enormous ζ, or forces that
//! are enormous beside F), so that a step is a vanishing part of a period; or the time asked for is enormous beside a
//! period. Both are seen from outside: every [`EVERY`] steps the clock is looked at.
//!
//! * [`STRIKES`] looks within one period of the fastest oscillation end a run: an ordinary one takes three steps in it,
//!   and a few more for each event.
//! * After [`FAIR`] steps, a run that at its pace so far would take more than [`MOST_STEPS`] ends.
//! * All runs of one question ([`within`]) take at most the steps that it allows them together.
//!
//! What is counted depends on the run alone, except for the last: it decides only how soon a question is given up.

use std::cell::Cell;
use std::f64::consts::TAU;

/// Steps between two looks at the clock.
pub(super) const EVERY: u64 = 1 << 16;

/// Looks within one period of the fastest oscillation that end a run.
const STRIKES: u32 = 2;

/// Steps after which the pace of a run is known.
const FAIR: u64 = 1 << 20;

/// Most steps of a run: some minutes of work.
pub const MOST_STEPS: u64 = 2_000_000_000;

/// Steps that the beginning of a run counts for: a question may take many runs of a step each.
const OF_A_RUN: u64 = 64;

/// Why a run whose steps are too short was stopped.
const TOO_STIFF: &str = "a hundred thousand steps did not cover one period of its fastest oscillation: the \
                         damping, the friction or the dither is too large beside the other forces";

/// Why a run that is too long was stopped.
const TOO_LONG: &str = "it would take more than 2 000 000 000 steps: the time asked for, or a \
                        period of the dither, is too long beside the fastest oscillation";

/// Why a question was given up.
const TOO_MUCH: &str = "the steps that a question may take are used up: its runs neither settle nor \
                        end, or a period of the dither is too long beside the fastest oscillation";

thread_local! {
    /// Steps that the question of this thread may still take.
    static LEFT: Cell<u64> = const { Cell::new(u64::MAX) };
}

/// Does `work`, in which all runs on this thread take at most so many steps together (a look may come `EVERY` steps
/// late); those after that end at once, with the reason.
pub fn within<T>(steps: u64, work: impl FnOnce() -> T) -> T {
    /// Gives the outer question what is left of its own, also where the work panics.
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

/// The pace of one run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// When the run began and is to end.
    from: f64,
    until: f64,
    /// Period of the fastest oscillation.
    period: f64,
    /// Steps at the last look.
    steps: u64,
    /// When the window of looks began, and looks in it.
    window: f64,
    strikes: u32,
}

impl Pace {
    /// Of a run whose fastest oscillation has this frequency ratio.
    pub(super) fn new(from: f64, until: f64, fastest: f64) -> Self {
        Self { from, until, period: TAU / fastest.max(1.0), steps: 0, window: from, strikes: 0 }
    }

    /// Whether a look is due after so many steps of the run.
    #[inline(always)]
    pub(super) fn is_due(&self, steps: u64) -> bool {
        steps - self.steps >= EVERY
    }

    /// Looks at the clock after so many steps of the run.
    ///
    /// # Errors
    /// Why it will not end.
    #[cold]
    pub(super) fn look(&mut self, steps: u64, time: f64) -> Result<(), &'static str> {
        self.spend(steps)?;
        if time - self.window >= self.period {
            (self.window, self.strikes) = (time, 0);
        } else {
            self.strikes += 1;
            if self.strikes >= STRIKES {
                return Err(TOO_STIFF);
            }
        }
        if steps >= FAIR {
            let whole = steps as f64 * ((self.until - self.from) / (time - self.from));
            // It is infinite where no time has passed.
            if whole.is_nan() || whole > MOST_STEPS as f64 {
                return Err(TOO_LONG);
            }
        }
        Ok(())
    }

    /// Counts the beginning of a run.
    ///
    /// # Errors
    /// Where the steps of the question are used up.
    pub(super) fn begin() -> Result<(), &'static str> {
        take(OF_A_RUN)
    }

    /// Takes the steps since the last look from those of the question.
    ///
    /// # Errors
    /// Where they are used up.
    pub(super) fn spend(&mut self, steps: u64) -> Result<(), &'static str> {
        let taken = steps - self.steps;
        self.steps = steps;
        take(taken)
    }
}

/// Takes steps from those of the question of this thread.
fn take(steps: u64) -> Result<(), &'static str> {
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
    fn a_run_that_gets_on_is_left_alone_and_one_that_does_not_is_stopped() {
        let mut ordinary = Pace::new(0.0, 1e8, 10.0);
        let mut stiff = Pace::new(0.0, 1e3, 10.0);
        let mut long = Pace::new(0.0, 1e12, 10.0);
        let (mut stiffness, mut length) = (Ok(()), Ok(()));
        for look in 1..=100_u64 {
            let steps = look * EVERY;
            assert!(ordinary.is_due(steps));
            assert_eq!(ordinary.look(steps, steps as f64 * 0.2), Ok(()));
            stiffness = stiffness.and_then(|()| stiff.look(steps, steps as f64 * 1e-8));
            length = length.and_then(|()| long.look(steps, steps as f64 * 0.2));
        }
        assert_eq!((stiffness, length), (Err(TOO_STIFF), Err(TOO_LONG)));
    }

    #[test]
    fn runs_of_a_question_share_its_steps() {
        let run = |steps| Pace::new(0.0, 1.0, 1.0).spend(steps);
        let told = within(100, || {
            assert_eq!(
                within(1000, || [run(60), run(60), run(1)]),
                [Ok(()), Ok(()), Err(TOO_MUCH)]
            );
            run(1)
        });
        assert_eq!((told, run(u64::MAX / 2)), (Err(TOO_MUCH), Ok(())));
        assert_eq!(within(100, || [within(10, || run(20)), run(80)]), [Ok(()); 2]);
        // Runs without steps come to an end too.
        let begun = within(OF_A_RUN * 3, || (0..9).take_while(|_| Pace::begin().is_ok()).count());
        assert_eq!(begun, 3);
    }
}
