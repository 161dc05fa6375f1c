//! Averaging against the stored reference, every row (tolerances in `reference/README.md`).

use quell_linear::averaging::{
    AveragedVerdict, Averaging, Becomes, CrossingKind, FastMotion, FastWave, SlopeSide, criterion,
    critical_amplitudes, effective,
};
use quell_model::{Belt, Friction, LawKind, Waveform};
use quell_zoo::belt::{DAMPING_RATIO, belt};
use quell_zoo::dither::{normal, tangential};
use quell_zoo::law::{REFERENCE_VELOCITY, dissertation};
use serde_json::Value;

const VM: f64 = REFERENCE_VELOCITY;

fn reference() -> Value {
    serde_json::from_str(include_str!("../../../reference/averaging.json")).expect("valid JSON")
}

fn law(row: &Value) -> Friction {
    dissertation(LawKind::from_name(text(row, "law")).expect("a law"))
}

fn waveform(row: &Value) -> Waveform {
    Waveform::from_name(text(row, "wave")).expect("a waveform")
}

fn text<'a>(row: &'a Value, key: &str) -> &'a str {
    row[key].as_str().unwrap_or_else(|| panic!("{key} in {row}"))
}

/// A number, written as a number or as a string.
fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap_or_else(|| text(row, key).parse().expect("a number"))
}

fn rows<'a>(reference: &'a Value, key: &str) -> &'a Vec<Value> {
    reference[key].as_array().expect("rows")
}

/// Relative error; absolute where the exact value is zero up to the rounding of the reference.
fn error(value: f64, exact: f64) -> f64 {
    if exact.abs() < 1e-25 { (value - exact).abs() * 1e3 } else { ((value - exact) / exact).abs() }
}

#[test]
fn tangential_rows() {
    let reference = reference();
    let (mut worst, mut worst_slope, mut corners) = (0.0_f64, 0.0_f64, 0);
    for row in rows(&reference, "tangential") {
        let alpha = number(row, "alpha_over_vm") * VM;
        let mut v = number(row, "vr_over_vm") * VM;
        let at_corner = row["at_corner"].as_bool().unwrap_or(false);
        if at_corner {
            corners += 1;
            // The product of two rounded numbers need not hit the corner.
            v = alpha * waveform(row).peak_integral();
        }
        let motion = FastMotion::single(FastWave::Integral(waveform(row)), alpha);
        let found = effective(&law(row), &motion, v).expect("a value");
        let e = error(found.coefficient, number(row, "mubar"));
        let s = error(found.slope, number(row, "dmubar"));
        assert!(e < 1e-11, "coefficient {}: {e:e} in {row}", found.coefficient);
        assert!(s < 1e-9, "slope {}: {s:e} in {row}", found.slope);
        assert_eq!(found.side, if at_corner { SlopeSide::Outer } else { SlopeSide::Both }, "{row}");
        worst = worst.max(e);
        worst_slope = worst_slope.max(s);
    }
    assert_eq!(rows(&reference, "tangential").len(), 226);
    assert!(corners >= 2);
    println!("tangential: worst μ̄ {worst:e}, slope {worst_slope:e}, {corners} corners");
}

#[test]
fn normal_rows() {
    let reference = reference();
    let mut worst = [0.0_f64; 2];
    for row in rows(&reference, "normal") {
        let v = number(row, "vr_over_vm") * VM;
        let dither = normal(waveform(row), number(row, "DN"), number(row, "RN"));
        let belt = belt(DAMPING_RATIO, v, law(row), vec![dither]);
        for (i, (order, key)) in [
            (Averaging::Limit, "mubar_first_order"),
            (Averaging::LimitToSecondOrder, "mubar_with_cos2"),
        ]
        .into_iter()
        .enumerate()
        {
            let options = order;
            let motion = FastMotion::of(&belt, v, options).expect("one dither");
            let found = effective(belt.friction(), &motion, v).expect("a value");
            let e = error(found.coefficient, number(row, key));
            assert!(e < 1e-11, "{order:?} {}: {e:e} in {row}", found.coefficient);
            worst[i] = worst[i].max(e);
        }
    }
    assert_eq!(rows(&reference, "normal").len(), 86);
    println!("normal: worst first order {:e}, second {:e}", worst[0], worst[1]);
}

#[test]
fn stability_rows() {
    let reference = reference();
    let (mut worst, mut critical) = (0.0_f64, 0);
    for row in rows(&reference, "stability") {
        let r = 10.0;
        let dither = tangential(waveform(row), 1.0, r);
        let (zeta, load, v) = (number(row, "zeta"), number(row, "F"), number(row, "v0"));
        let belt = Belt::new(zeta, load, v, law(row), vec![dither]).expect("valid");
        let options = Averaging::Limit;
        let undithered = criterion(&belt.undithered(), options).expect("slides").verdict;
        let stable = row["undithered_stable"].as_bool().expect("a flag");
        assert_eq!(
            undithered,
            if stable { AveragedVerdict::Stable } else { AveragedVerdict::Unstable },
            "{row}"
        );
        let found = critical_amplitudes(&belt, options).expect("found");
        let expected = row["critical_alpha"].as_array().expect("rows");
        assert_eq!(found.len(), expected.len(), "{found:?} in {row}");
        for (found, expected) in found.iter().zip(expected) {
            let e = error(found.amplitude_ratio, number(expected, "alpha"));
            // Both are given to 12 digits and more: 1e-12, well inside the reference's 1e-9.
            assert!(e < 1e-12, "{found:?}: {e:e} in {row}");
            assert!((found.amplitude / (r * found.amplitude_ratio) - 1.0).abs() < 1e-15);
            let jump = text(expected, "type").starts_with("jump");
            assert_eq!(
                found.crossing,
                if jump { CrossingKind::Jump } else { CrossingKind::Root },
                "{row}"
            );
            let stable = text(expected, "change").ends_with("->stable");
            assert_eq!(found.becomes, if stable { Becomes::Stable } else { Becomes::Unstable });
            worst = worst.max(e);
            critical += 1;
        }
    }
    assert_eq!(rows(&reference, "stability").len(), 115);
    println!("stability: {critical} critical amplitudes, worst {worst:e}");
}
