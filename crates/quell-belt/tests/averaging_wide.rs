//! Averaging over a wide grid: stored 40-digit values, closed form against quadrature, limits and symmetries.

use quell_belt::averaging::{
    AveragingError, AveragingOptions, FastMotion, FastWave, PeriodicMotion, Response, Side, SlipTerm, effective,
    effective_by_quadrature,
};
use quell_model::{Belt, Direction, Dither, Friction, LawKind, Waveform};

const VM: f64 = 0.2;

fn laws() -> [Friction; 2] {
    [LawKind::Stribeck, LawKind::Decreasing].map(|k| k.build(&[0.4, 0.2857, VM]).expect("valid"))
}

fn plain(waveform: Waveform, alpha: f64) -> FastMotion {
    FastMotion::single(FastWave::Integral(waveform), alpha)
}

fn relative(value: f64, exact: f64) -> f64 {
    if value == exact { 0.0 } else { ((value - exact) / exact).abs() }
}

/// 40-digit values: μ̄ to 1e-11, slope to 1e-9, for α/v_m and v/v_m over nine decades.
#[test]
fn stored_wide_grid() {
    let table = include_str!("../../../reference/averaging_wide.csv");
    let (mut rows, mut worst, mut worst_slope) = (0, (0.0, ""), (0.0, ""));
    for line in table.lines().filter(|line| !line.starts_with('#')) {
        let field: Vec<&str> = line.split(',').collect();
        let law = LawKind::from_name(field[0]).expect("a law");
        let law = law.build(&[0.4, 0.2857, VM]).expect("valid");
        let waveform = Waveform::from_name(field[1]).expect("a waveform");
        let number = |i: usize| -> f64 { field[i].parse().expect("a number") };
        let found = effective(&law, &plain(waveform, number(2)), number(3)).expect("a value");
        let e = relative(found.coefficient, number(4));
        let s = relative(found.slope, number(5));
        assert!(e < 1e-11, "{found:?}: {e:e} in {line}");
        assert!(s < 1e-9, "{found:?}: {s:e} in {line}");
        if e > worst.0 {
            worst = (e, line);
        }
        if s > worst_slope.0 {
            worst_slope = (s, line);
        }
        rows += 1;
    }
    assert!(rows > 1, "{rows}");
    println!("{rows} rows, worst μ̄ {worst:?}, slope {worst_slope:?}");
}
