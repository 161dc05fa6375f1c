//! Growth rates against numbers computed by other programs (`reference/README.md`).

use std::path::Path;

use quell_disc::{dithered, undithered};
use quell_linear::growth::Verdict;
use quell_model::disc::{Contribution, Contributions};
use quell_model::disc::{DiscDither, Load, Mode};
use quell_numerics::floquet::Effort;
use quell_zoo::disc::{self as zoo, ZooModes, equal_load};
use serde_json::Value;

fn reference(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reference").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).expect("there")).expect("valid")
}

/// A number, stored as a number or as a string with more digits.
fn number(value: &Value) -> f64 {
    match value {
        Value::String(text) => text.parse().expect("a number"),
        value => value.as_f64().expect("a number"),
    }
}

fn modes(of: &Value, damping: f64) -> Vec<Mode> {
    let list =
        |key: &str| of[key].as_array().expect("a list").iter().map(number).collect::<Vec<_>>();
    let (ratios, diameters, shapes) = (list("beta"), list("q"), list("phi_r0"));
    (0..ratios.len())
        .map(|i| Mode {
            diameters: format!("{}", diameters[i]).parse().expect("whole"),
            ratio: ratios[i],
            shape_at_load: shapes[i],
            damping,
        })
        .collect()
}

/// The models that the tests share have the reference's modes.
#[test]
fn the_zoo_has_the_modes_of_the_reference() {
    let reference = reference("disc_eigenvalues.json");
    for set in ZooModes::ALL {
        assert_eq!(set.modes(1e-3), modes(&reference["models"][set.name()], 1e-3), "{set:?}");
    }
}

#[test]
fn growth_rates_without_dither() {
    let reference = reference("disc_eigenvalues.json");
    let mut marginal = 0;
    let points = reference["points"].as_array().expect("a list");
    assert!(points.len() >= 27, "{}", points.len());
    for point in points {
        let model = &reference["models"][point["model"].as_str().expect("a name")];
        let [m, c, k, f] = ["m", "c", "k", "f"].map(|key| number(&point[key]));
        let modes = modes(model, number(&point["xi"]));
        let loads = vec![Load::new(m, c, k, f)];
        let disc = zoo::disc(modes, loads, DiscDither::None, number(&point["Omega"]));
        let parts = match point["damp"].as_str() {
            Some("diag") => Contributions::ALL.without(Contribution::CirculatoryDamping),
            _ => Contributions::ALL,
        };
        let found = undithered::growth_with(&disc, parts).expect("finite");
        let wanted = number(&point["max_re"]);
        let gap = (found.rate - wanted).abs();
        assert!(gap <= 1e-12 && gap <= found.error, "{point}: {gap:e} {found:?}");
        assert!(found.error < 1e-11, "{point}: {found:?}");
        if wanted == 0.0 {
            assert_eq!(found.verdict(), Verdict::Undecided, "{point}");
            marginal += 1;
        } else {
            assert_eq!(found.verdict() == Verdict::Unstable, wanted > 0.0, "{point}");
            let gap = (found.frequency - number(&point["im_at_max"])).abs();
            assert!(gap < 1e-9, "{point}: frequency off by {gap:e}");
        }
    }
    assert_eq!(marginal, 2);
}

#[test]
fn growth_rates_with_dither() {
    let models = reference("disc_eigenvalues.json");
    let points = reference("disc_floquet.json");
    let points = points["points"].as_array().expect("a list");
    assert!(points.len() >= 21, "{}", points.len());
    for point in points {
        let model = &models["models"][point["model"].as_str().expect("a name")];
        let [strength, friction] = [number(&point["m=c=k"]), number(&point["f"])];
        let (amplitude, frequency_ratio) = (number(&point["alpha"]), number(&point["R"]));
        let dither = match point["dither"].as_str() {
            Some("normal") => DiscDither::Normal { amplitude, frequency_ratio },
            _ => DiscDither::Tangential { amplitude, frequency_ratio },
        };
        let modes = modes(model, number(&point["xi"]));
        let loads = vec![equal_load(strength, friction)];
        let disc = zoo::disc(modes, loads, dither, number(&point["Omega"]));
        let found = dithered::growth(&disc, Effort::default()).expect("finite");
        let wanted = number(&point["max_re_exponent"]);
        let gap = (found.rate - wanted).abs();
        println!("{gap:.1e} within {:.1e} {}", found.error, found.rate);
        assert!(gap <= 1e-9 && gap <= found.error, "{point}: {gap:e} {found:?}");
        assert_eq!(found.verdict() == Verdict::Unstable, wanted > 0.0, "{point}");
        let gap = (found.frequency - number(&point["im_mod_R"])).abs();
        assert!(gap < 1e-5, "{point}: frequency off by {gap:e}");
    }
}
