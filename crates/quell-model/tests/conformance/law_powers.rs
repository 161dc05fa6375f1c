//! The recurrence of powers in `stribeck-exponential`, against formulas, which use another recurrence for the same law.

use quell_model::friction::{BranchSeries, LawSeries, LawVisitor};
use quell_model::{Expression, Friction, SlidingLaw, StribeckExponential};

const TERMS: usize = 16;

struct Along([f64; TERMS]);

impl LawVisitor for Along {
    type Output = [f64; TERMS];

    fn visit<L: LawSeries>(self, law: &L) -> [f64; TERMS] {
        let w = self.0.map(|w| w / law.velocity_scale());
        let mut constants = L::constants::<f64>(std::slice::from_ref(law));
        let mut series = L::series::<f64, TERMS>(&mut constants, 1.0, w[0]);
        let slope = series.slope();
        let mut friction = [series.first(); TERMS];
        for k in 1..TERMS {
            friction[k] = slope * w[k] + series.lower(k, &w);
        }
        friction
    }
}

#[test]
fn every_exponent_has_the_series_of_its_formula() {
    for (exponent, formula) in [
        (1.0, "0.25 + 0.15*exp(-abs(v)/0.1) + 0.06*abs(v)"),
        (2.0, "0.25 + 0.15*exp(-(v/0.1)^2) + 0.06*abs(v)"),
        (3.0, "0.25 + 0.15*exp(-(abs(v)/0.1)^3) + 0.06*abs(v)"),
        (4.0, "0.25 + 0.15*exp(-(v/0.1)^4) + 0.06*abs(v)"),
        (1.5, "0.25 + 0.15*exp(-(abs(v)/0.1)*(abs(v)/0.1 + 1e-30)^0.5) + 0.06*abs(v)"),
    ] {
        let law = StribeckExponential::new(0.25, 0.4, 0.1, exponent, 0.06).expect("valid");
        assert_eq!(law.unsimulated().is_some(), exponent == 1.5, "{exponent}");
        let formula = Expression::new(formula, &[], None, 1.0).expect(formula);
        for start in [0.0, 0.004, 0.07, 0.23] {
            if start == 0.0 && exponent == 1.5 {
                continue;
            }
            let mut slip = [start; TERMS];
            for (k, coefficient) in slip.iter_mut().enumerate().skip(1) {
                *coefficient = 0.1 * (1.7 * (k * k) as f64 + 0.3).cos() / k as f64;
            }
            let found = Friction::StribeckExponential(law).visit(Along(slip));
            let other = Friction::Expression(formula.clone()).visit(Along(slip));
            for k in 0..TERMS {
                // A sum of alternating terms is accurate relative to its largest term.
                let size = other[..=k].iter().fold(0.4_f64, |size, term| size.max(term.abs()));
                let error = (found[k] - other[k]).abs();
                assert!(
                    error <= 1e-11 * size,
                    "{exponent} from {start}, {k}: {} {}",
                    found[k],
                    other[k]
                );
            }
        }
    }
}
