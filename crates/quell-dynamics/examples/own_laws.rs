//! The cost of a user-defined friction law: time per simulated dither period relative to that of a built-in law
//! on the same workload, both measured alternately.
//!
//! `cargo run --release --package quell-dynamics --example own_laws` prints one line per law and workload: the ratio
//! for one run alone, and for runs side by side on the widest instruction set.

#[path = "../benches/workloads/mod.rs"]
mod workloads;

use quell_dynamics::simulation::InstructionSet;
use quell_model::{Belt, Expression, Friction, LawKind, Samples};
use workloads::Workload;

fn formula(text: &str) -> Friction {
    Friction::Expression(Expression::new(text, &[], None, 1.0).expect("a valid formula"))
}

fn samples(law: &Friction, last: f64, terms: usize) -> Friction {
    let sample = |k: u32| {
        let u = last * f64::from(k) / 60.0;
        (u, law.coefficient(u))
    };
    let samples: Vec<(f64, f64)> = (0..=60).map(sample).collect();
    Friction::Samples(Samples::new(&samples, None, Some(terms), 1.0).expect("a fit"))
}

/// A workload with another friction law.
fn with_law(workload: &Workload, law: &Friction) -> Workload {
    let changed = |belt: &Belt| {
        let (zeta, load, velocity) =
            (belt.damping_ratio(), belt.normal_load(), belt.belt_velocity());
        Belt::new(zeta, load, velocity, law.clone(), belt.dithers().to_vec()).expect("valid")
    };
    let cases = workload.cases.iter().map(|(belt, start)| (changed(belt), *start)).collect();
    Workload { name: workload.name, cases, until: workload.until }
}

fn main() {
    let built_in = |kind: LawKind| kind.build(&[0.4, 0.2857, 0.2]).expect("valid");
    let (stribeck, decreasing) = (built_in(LawKind::Stribeck), built_in(LawKind::Decreasing));
    let laws = [
        ("formula of the decreasing law", formula("0.2857 + 0.1143*exp(-abs(v)/0.2)")),
        ("formula of the Stribeck law", formula("0.4 - 0.17145*(abs(v)/0.2 - (abs(v)/0.2)^3/3)")),
        ("Gaussian with a viscous part", formula("0.3 + 0.1*exp(-(v/0.2)^2) + 0.02*abs(v)")),
        ("samples, 1 term", samples(&decreasing, 1.0, 1)),
        ("samples, 2 terms", samples(&stribeck, 0.3, 2)),
        ("samples, 4 terms", samples(&stribeck, 0.3, 4)),
    ];
    let set = InstructionSet::widest();
    for workload in [Workload::stick_slip(), Workload::event_free()] {
        let many = workload.multiplied(16);
        let (alone, together) = (workload.time_alone(), many.time_together(set));
        println!(
            "{}: built-in law {alone:.3} µs alone, {together:.3} µs on {}",
            workload.name,
            set.name()
        );
        for (name, law) in &laws {
            let own = with_law(&workload, law).time_alone();
            let own_many = with_law(&many, law).time_together(set);
            println!("  {name}: {:.2} alone, {:.2} side by side", own / alone, own_many / together);
        }
    }
}
