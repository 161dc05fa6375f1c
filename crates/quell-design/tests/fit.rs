//! Laws fitted to points: stored fits, planted laws, bounds, weights and what is reported as unknown.

use quell_design::NoStandardError;
use quell_design::fit::{
    Estimate, FitFinding, FitModel, FitPoint, LawFit, Unfitted, akaike_weights, diagnose, fit,
};
use quell_model::friction::LawKind;
use serde_json::Value;

fn model(kind: LawKind) -> FitModel {
    FitModel::new(kind).expect("a law of numbers")
}

fn point(slip_velocity: f64, coefficient: f64) -> FitPoint {
    FitPoint { slip_velocity, coefficient, standard_deviation: 1.0 }
}

fn value(fit: &LawFit, key: &str) -> f64 {
    let path = format!("friction.{key}");
    fit.parameter(&path).unwrap_or_else(|| panic!("{key}")).value
}

fn points_of(csv: &str) -> Vec<FitPoint> {
    csv.lines()
        .skip(1)
        .map(|line| {
            let (v, c) = line.split_once(',').expect("two columns");
            point(v.parse().expect("a number"), c.parse().expect("a number"))
        })
        .collect()
}

/// Numbers in (−1, 1) by a linear congruential generator.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 11) as f64) / (1_u64 << 52) as f64 - 1.0
    }
}

#[test]
fn stored_fits_are_reproduced() {
    let text = include_str!("../../../reference/fits.json");
    let cases: Vec<Value> = serde_json::from_str(text).expect("valid JSON");
    assert_eq!(cases.len(), 5);
    // Two independent programs agree to 8e-16; the conditions of the problems are below 1e3, and steps end at 1e-12.
    let close = |own: f64, stored: &Value| {
        let stored = stored.as_f64().expect("a number");
        assert!((own / stored - 1.0).abs() < 1e-10, "{own} against {stored}");
    };
    for case in &cases {
        let kind = LawKind::from_name(case["law"].as_str().expect("a name")).expect("a law");
        let points = points_of(case["csv"].as_str().expect("text"));
        let found = fit(&model(kind), &points).expect("solvable");
        close(found.residual(), &case["residual"]);
        close(found.rss, &case["rss"]);
        close(found.aic().expect("finite"), &case["aic"]);
        let order = case["covariance"]["order"].as_array().expect("a list");
        let own = &found.covariance;
        assert_eq!(own.order.len(), order.len());
        let place = |key: &Value| {
            own.order.iter().position(|one| Some(one.key()) == key.as_str()).expect("the same")
        };
        for (i, key) in order.iter().enumerate() {
            let name = key.as_str().expect("a key");
            let stored = &case["parameters"][name];
            close(value(&found, name), &stored["value"]);
            let fitted = found.parameter(&format!("friction.{name}")).expect("it is there");
            close(fitted.standard_error.expect("known"), &stored["standard_error"]);
            for (j, other) in order.iter().enumerate() {
                close(own.matrix[place(key)][place(other)], &case["covariance"]["matrix"][i][j]);
            }
        }
    }
}

/// Laws with numbers, and the range of speeds in which they are sampled.
fn planted() -> Vec<(FitModel, Vec<f64>, f64)> {
    let all = |kind: LawKind| {
        let parameters = kind.parameters().iter();
        parameters.fold(model(kind), |model, parameter| {
            let key = parameter.key();
            model.clone().freeing(key).unwrap_or(model)
        })
    };
    vec![
        (all(LawKind::Stribeck), vec![0.4, 0.25, 0.2], 0.34),
        (all(LawKind::Decreasing), vec![0.4, 0.25, 0.3], 2.0),
        (all(LawKind::Coulomb), vec![0.3, 0.3, 0.05], 2.0),
        (all(LawKind::StribeckExponential), vec![0.25, 0.4, 0.2, 1.3, 0.06], 2.0),
        (all(LawKind::Lugre), vec![0.25, 0.4, 0.2, 1.0, 0.0, 0.06], 2.0),
    ]
}

#[test]
fn a_planted_law_is_found_from_exact_points() {
    for (model, values, fastest) in planted() {
        let law = model.kind().build(&values).expect("valid");
        let points: Vec<FitPoint> = (1..=40)
            .map(|k| {
                let v = fastest * f64::from(k) / 40.0;
                let sign = if k % 3 == 0 { -1.0 } else { 1.0 };
                point(sign * v, law.coefficient(v))
            })
            .collect();
        let found = fit(&model, &points).expect("solvable");
        for (parameter, truth) in model.kind().parameters().iter().zip(&values) {
            let Some(fitted) = found.parameter(parameter.path) else { continue };
            // The points are rounded to 1e-16, and the least determined parameter multiplies that by less than 1e4.
            let close = (fitted.value - truth).abs() < 1e-11;
            assert!(close, "{} {}: {}", found.name(), parameter.key(), fitted.value);
        }
        assert!(found.residual() < 1e-14);
        assert_eq!(diagnose(&found, &points), [FitFinding::Exact]);
    }
}

#[test]
fn steady_points_contain_nothing_about_bristles() {
    let model = model(LawKind::Lugre);
    let unused = model.estimates().iter().filter(|own| **own == Estimate::Unused).count();
    assert_eq!(unused, 2);
    let refused = model.clone().freeing("bristle_stiffness").expect_err("not in steady sliding");
    assert!(refused.to_string().contains("contain no information"), "{refused}");
    assert!(model.clone().freeing("exponent").is_err());
    // The curve does not depend on a bristle stiffness that is given.
    let text = include_str!("../../../reference/fits.json");
    let cases: Vec<Value> = serde_json::from_str(text).expect("valid JSON");
    let points = points_of(cases[3]["csv"].as_str().expect("text"));
    let without = fit(&model, &points).expect("solvable");
    let given = model.fixing("bristle_stiffness", 1e4).expect("in range");
    let with = fit(&given, &points).expect("solvable");
    assert_eq!(with.rss, without.rss);
    let exponential = fit(&self::model(LawKind::StribeckExponential), &points).expect("solvable");
    assert_eq!(exponential.rss, without.rss);
    assert_eq!(exponential.covariance.matrix, without.covariance.matrix);
}

#[test]
fn points_without_a_fall_tie_the_levels() {
    let points: Vec<FitPoint> =
        (1..=30).map(|k| point(0.05 * f64::from(k), 0.3 + 0.001 * f64::from(k))).collect();
    let decreasing = fit(&model(LawKind::Decreasing), &points).expect("solvable");
    let constant = fit(&model(LawKind::Coulomb), &points).expect("solvable");
    assert!((decreasing.rss / constant.rss - 1.0).abs() < 1e-12);
    assert_eq!(value(&decreasing, "static_coefficient"), value(&decreasing, "minimum_coefficient"));
    // The combined level has the standard error of a constant, apart from the two further parameters.
    let own = decreasing.covariance.matrix[0][0] * 27.0;
    let other = constant.covariance.matrix[0][0] * 29.0;
    assert!((own / other - 1.0).abs() < 1e-12);
    let without: Vec<&str> = diagnose(&decreasing, &points)
        .iter()
        .filter_map(|finding| match finding {
            FitFinding::WithoutError { key, .. } => Some(*key),
            _ => None,
        })
        .collect();
    assert_eq!(without, ["minimum_coefficient", "reference_velocity"]);
    assert!(
        diagnose(&constant, &points).iter().any(|one| matches!(one, FitFinding::Pattern { .. }))
    );
}

#[test]
fn bounds_are_respected() {
    // A straight fall to 0: the best exponential would have a negative limit.
    let points: Vec<FitPoint> =
        (1..=20).map(|k| point(0.05 * f64::from(k), 0.42 - 0.02 * f64::from(k))).collect();
    let found = fit(&model(LawKind::Decreasing), &points).expect("solvable");
    let minimum = found.parameter("friction.minimum_coefficient").expect("it is there");
    assert_eq!(minimum.value, 0.0);
    assert!(matches!(
        minimum.standard_error,
        Err(NoStandardError::OnZero | NoStandardError::OnBoundBy(_))
    ));
    // With the limit fixed there, the fit is the same, with one parameter less.
    let fixed = model(LawKind::Decreasing).fixing("minimum_coefficient", 0.0).expect("in range");
    let fixed = fit(&fixed, &points).expect("solvable");
    assert!((fixed.rss / found.rss - 1.0).abs() < 1e-10);
    assert_eq!((fixed.free, found.free), (2, 3));
    // A fixed static coefficient below the data bounds the other level.
    let low = model(LawKind::Decreasing).fixing("static_coefficient", 0.1).expect("in range");
    let low = fit(&low, &points).expect("solvable");
    assert!(value(&low, "minimum_coefficient") <= 0.1);
    assert!(model(LawKind::Decreasing).fixing("reference_velocity", 0.0).is_err());
    let both = model(LawKind::Decreasing).fixing("static_coefficient", 0.1).expect("in range");
    assert!(both.fixing("minimum_coefficient", 0.2).is_err());
}

#[test]
fn a_point_of_twice_the_weight_counts_twice() {
    let mut next = noise(3);
    let points: Vec<FitPoint> = (1..=20)
        .map(|k| {
            let v = 0.1 * f64::from(k);
            point(v, 0.25 + 0.15 * (-v / 0.3).exp() + 0.005 * next())
        })
        .collect();
    let twice: Vec<FitPoint> = points.iter().chain(&points[4..5]).copied().collect();
    let mut weighted = points.clone();
    weighted[4].standard_deviation = 0.5_f64.sqrt();
    let model = model(LawKind::Decreasing);
    let (twice, weighted) =
        (fit(&model, &twice).expect("a fit"), fit(&model, &weighted).expect("a fit"));
    for key in ["static_coefficient", "minimum_coefficient", "reference_velocity"] {
        assert!((value(&twice, key) / value(&weighted, key) - 1.0).abs() < 1e-10);
    }
    assert!((twice.rss / weighted.rss - 1.0).abs() < 1e-10);
    // A common factor of all σ changes neither estimates nor errors, nor AIC.
    let scaled: Vec<FitPoint> =
        points.iter().map(|own| FitPoint { standard_deviation: 0.01, ..*own }).collect();
    let (plain, scaled) =
        (fit(&model, &points).expect("a fit"), fit(&model, &scaled).expect("a fit"));
    for (a, b) in plain.parameters.iter().zip(&scaled.parameters) {
        assert!(
            (a.standard_error.expect("known") / b.standard_error.expect("known") - 1.0).abs()
                < 1e-9
        );
    }
    let difference = plain.aic().expect("finite") - scaled.aic().expect("finite");
    assert!(difference.abs() < 1e-9, "{difference}");
}

/// Standard errors against the scatter of many fits.
#[test]
fn standard_errors_are_the_scatter_of_repeated_measurements() {
    const FITS: u64 = 200;
    let model = model(LawKind::Decreasing);
    let truth = [0.4, 0.2857, 0.2];
    let law = LawKind::Decreasing.build(&truth).expect("valid");
    let mut squares = [0.0; 3];
    let mut covered = 0;
    let speeds: Vec<f64> = (1..=40).map(|k| 0.03 * f64::from(k)).collect();
    for seed in 1..=FITS {
        let mut next = noise(seed);
        // The sum of three uniform errors is nearly normal.
        let points: Vec<FitPoint> = speeds
            .iter()
            .map(|&v| point(v, law.coefficient(v) + 0.003 * (next() + next() + next())))
            .collect();
        let found = fit(&model, &points).expect("a fit");
        for (square, (fitted, truth)) in squares.iter_mut().zip(found.parameters.iter().zip(truth))
        {
            let error = fitted.standard_error.expect("known");
            *square += ((fitted.value - truth) / error).powi(2);
        }
        let band = 2.026 * found.standard_deviation(0.3);
        covered += i32::from((found.coefficient(0.3) - law.coefficient(0.3)).abs() < band);
    }
    for square in squares {
        // Of 200 squares of a normal deviate the mean scatters by √(2/200) = 0.1; four times that, and 5 % for curvature.
        assert!((square / FITS as f64 - 1.0).abs() < 0.45, "{square}");
    }
    // 190 of 200 expected, ±3.1; four times that.
    assert!((177..=200).contains(&covered), "{covered}");
}

#[test]
fn what_the_points_cannot_determine_is_found() {
    // Nothing below the reference velocity, nothing above it.
    let law = LawKind::Decreasing.build(&[0.4, 0.25, 0.2]).expect("valid");
    let range = |from: f64, to: f64| -> Vec<FitPoint> {
        let mut next = noise(7);
        (0..30)
            .map(|k| {
                let v = from + (to - from) * f64::from(k) / 29.0;
                point(v, law.coefficient(v) + 0.001 * next())
            })
            .collect()
    };
    let slow = range(0.005, 0.1);
    let found = diagnose(&fit(&model(LawKind::Decreasing), &slow).expect("a fit"), &slow);
    assert!(found.iter().any(|one| matches!(one, FitFinding::NothingFast { .. })), "{found:?}");
    let fast = range(0.35, 1.0);
    let found = diagnose(&fit(&model(LawKind::Decreasing), &fast).expect("a fit"), &fast);
    assert!(found.iter().any(|one| matches!(one, FitFinding::NothingSlow { .. })), "{found:?}");
    // One wild point, by its place.
    let mut wild = range(0.01, 1.0);
    wild[11].coefficient += 0.05;
    let found = diagnose(&fit(&model(LawKind::Decreasing), &wild).expect("a fit"), &wild);
    let outliers = found.iter().find_map(|one| match one {
        FitFinding::Outliers { places, .. } => Some(places.clone()),
        _ => None,
    });
    assert_eq!(outliers, Some(vec![11]));
    // More friction forward than backward.
    let mut uneven = range(0.01, 1.0);
    for own in uneven.iter_mut().step_by(2) {
        own.slip_velocity = -own.slip_velocity;
        own.coefficient -= 0.01;
    }
    let found = diagnose(&fit(&model(LawKind::Decreasing), &uneven).expect("a fit"), &uneven);
    assert!(found.iter().any(
        |one| matches!(one, FitFinding::Directions { difference } if (difference - 0.01).abs() < 1e-3)
    ));
    // The cubic is not intended beyond √3 of its reference velocity.
    let cubic = fit(&model(LawKind::Stribeck), &wild).expect("a fit");
    assert!(cubic.upper_limit().is_some());
}

/// Points on a line, which the law with a viscous part meets with both levels equal: nothing depends on the velocity between them.
#[test]
fn a_velocity_between_equal_levels_has_no_error() {
    let line: Vec<FitPoint> = [2.0, 3.0, 4.0, 5.0, 6.0].map(|v| point(v, 0.298 + 0.001 * v)).into();
    let found = fit(&model(LawKind::StribeckExponential), &line).expect("a fit");
    assert!(found.is_exact(), "{found:?}");
    let reference = found.parameters.iter().find(|one| one.parameter.key() == "reference_velocity");
    let error = reference.expect("a reference velocity").standard_error;
    assert!(
        matches!(error, Err(NoStandardError::AtLimit | NoStandardError::NoChange)),
        "{error:?}"
    );
    let findings = diagnose(&found, &line);
    assert!(findings.contains(&FitFinding::Exact), "{findings:?}");
}

#[test]
fn too_little_is_refused() {
    let few = [point(0.1, 0.4), point(0.2, 0.35), point(0.3, 0.3)];
    let found = fit(&model(LawKind::Decreasing), &few);
    assert_eq!(found, Err(Unfitted::TooFewPoints { points: 3, parameters: 3 }));
    let one = [point(0.1, 0.4), point(-0.1, 0.41), point(0.1, 0.39), point(0.1, 0.4)];
    let found = fit(&model(LawKind::Decreasing), &one);
    assert_eq!(found, Err(Unfitted::OneSpeed { speed: 0.1 }));
    // A constant needs one speed only.
    let mean = fit(&model(LawKind::Coulomb), &one).expect("a mean");
    assert!((value(&mean, "coefficient") - 0.4).abs() < 1e-15);
    let fixed = model(LawKind::Coulomb).fixing("coefficient", 0.4).expect("in range");
    assert_eq!(fit(&fixed, &one), Err(Unfitted::NothingFree));
    assert!(FitModel::new(LawKind::Expression).is_none());
}

#[test]
fn akaike_weights_are_relative_likelihoods() {
    let weights = akaike_weights(&[-100.0, -98.0, -90.0]);
    assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
    assert!((weights[0] / weights[1] - 1.0_f64.exp()).abs() < 1e-12);
    assert!((weights[1] / weights[2] - 4.0_f64.exp()).abs() < 1e-10);
    // The least AIC of the planted laws is that of the law itself: a wrong law has larger residuals.
    let text = include_str!("../../../reference/fits.json");
    let cases: Vec<Value> = serde_json::from_str(text).expect("valid JSON");
    for case in &cases {
        let points = points_of(case["csv"].as_str().expect("text"));
        let aic = |kind: LawKind| {
            fit(&model(kind), &points).and_then(|fit| fit.aic().map_err(|_| Unfitted::Unsolvable))
        };
        let laws = [
            LawKind::Stribeck,
            LawKind::Decreasing,
            LawKind::Coulomb,
            LawKind::StribeckExponential,
        ];
        let best = laws
            .iter()
            .min_by(|a, b| aic(**a).expect("a fit").total_cmp(&aic(**b).expect("a fit")));
        assert_eq!(best.map(|kind| kind.name()), case["law"].as_str());
    }
}
