//! x
use quell_belt::simulation::{InstructionSet, Run, Start, simulate_many_with};
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let free = args[1] == "free";
    let set = match args[2].as_str() {
        "512" => InstructionSet::Avx512,
        "2" => InstructionSet::Avx2,
        _ => InstructionSet::Baseline,
    };
    let law = if free { LawKind::Decreasing } else { LawKind::Stribeck };
    let f = law.build(&[0.4, 0.2857, 0.2]).unwrap();
    let mut belts = vec![];
    let mut periods = 0.0;
    let until = if free { 2000.0 } else { 200.0 };
    let n = if free { 64 } else { 32 };
    for c in 0..n {
        for d in if free { vec![2.0] } else { vec![0.1, 0.3, 0.5, 0.8] } {
            for r in if free { vec![10.0] } else { vec![5.0, 10.0] } {
                let dither = Dither {
                    direction: Direction::Tangential,
                    waveform: Waveform::Sine,
                    amplitude: d * (1.0 + 1e-3 * c as f64),
                    frequency_ratio: r,
                    phase: 0.0,
                };
                belts.push(
                    Belt::new(0.005, 1.0, if free { 1.0 } else { 0.05 }, f, vec![dither]).unwrap(),
                );
                periods += until * r / std::f64::consts::TAU;
            }
        }
    }
    let mut best = f64::INFINITY;
    for _ in 0..args[3].parse::<usize>().unwrap() {
        let mut obs = vec![(); belts.len()];
        let start = if free { Start { displacement: 0.2, ..Start::REST } } else { Start::REST };
        let runs = belts
            .iter()
            .zip(&mut obs)
            .map(|(belt, observer)| Run { belt, start, until, observer })
            .collect();
        let t = std::time::Instant::now();
        let o = simulate_many_with(set, runs, 1e-10);
        best = best.min(t.elapsed().as_secs_f64());
        assert!(o.iter().all(Result::is_ok));
    }
    println!("{} {}: {:.4} us/period", args[1], args[2], best * 1e6 / periods);
}
