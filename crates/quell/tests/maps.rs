//! Pictures of maps as users see them: isolines, gaps, outcomes, curves, size.

use quell::picture::{MapAxis, MapKind, MappedQuantity, map};
use quell::plot::{PlotAxis, PlotError, PlotPoint, PlotRole, Polyline, Size, Spread};

fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| from + (to - from) * k as f64 / (count - 1) as f64).collect()
}

fn axis(name: &str, symbol: &str, values: Vec<f64>) -> MapAxis {
    MapAxis { axis: PlotAxis::new(name).symbol(symbol), values }
}

fn stable_or_not() -> MapKind {
    MapKind::Outcome(vec![
        (PlotRole::Stable, "stable".into()),
        (PlotRole::Unstable, "unstable".into()),
    ])
}

/// A map over ratio (to the right) and amplitude with these values.
fn plane(
    count: usize,
    kind: MapKind,
    value: impl Fn(f64, f64) -> Result<f64, usize>,
) -> MappedQuantity {
    let (ratio, amplitude) = (even(1.0, 20.0, count), even(0.0, 1.0, count));
    let values =
        ratio.iter().flat_map(|r| amplitude.iter().map(|d| value(*r, *d)).collect::<Vec<_>>());
    MappedQuantity {
        values: values.collect(),
        axes: vec![axis("frequency ratio", "R", ratio), axis("dither amplitude", "D", amplitude)],
        quantity: PlotAxis::new("residual_vibration").symbol("E"),
        kind,
        reasons: vec!["$E$ undefined".into(), "not settled".into()],
        zero: None,
        over: Vec::new(),
    }
}

/// Falls from 1 to 0 across D = R/20.
fn quench(ratio: f64, amplitude: f64) -> f64 {
    1.0 / (1.0 + (12.0 * (amplitude - 0.05 * ratio)).exp())
}

fn svg(given: &MappedQuantity) -> String {
    map(given).expect("a map").to_svg()
}

/// Paths of the strokes with this colour and width.
fn strokes(svg: &str, colour: &str, width: &str) -> Vec<String> {
    svg.split("<path ")
        .skip(1)
        .map(|path| path.split("/>").next().unwrap_or(""))
        .filter(|path| path.contains(&format!("stroke=\"{colour}\"")))
        .filter(|path| path.contains(&format!("stroke-width=\"{width}")))
        .map(String::from)
        .collect()
}

#[test]
fn isolines_of_an_residual_vibration_carry_their_per_cent() {
    let svg = svg(&plane(60, MapKind::ResidualVibration, |r, d| Ok(quench(r, d))));
    for level in ["5", "20", "50", "80", "95"] {
        assert!(svg.contains(&format!(">{level}\u{202f}%<")), "{level} per cent has no number");
    }
    assert!(svg.contains("(%)"), "the colour bar is in per cent");
    assert_eq!(svg.matches("<image ").count(), 2, "one image for the map, one for its bar");
}

#[test]
fn reasons_that_occur_are_in_the_legend() {
    let undefined = |r: f64, d: f64| if r < 3.0 { Err(0) } else { Ok(quench(r, d)) };
    let one = svg(&plane(40, MapKind::ResidualVibration, undefined));
    assert!(one.contains(" undefined") && !one.contains("not settled"));
    assert!(one.contains("<pattern "));
    let none = svg(&plane(40, MapKind::ResidualVibration, |r, d| Ok(quench(r, d))));
    assert!(!none.contains(" undefined") && !none.contains("<pattern "));
    let unnamed = svg(&plane(40, stable_or_not(), |r, _| if r < 3.0 { Err(7) } else { Ok(1.0) }));
    assert!(unnamed.contains("no value"));
}

#[test]
fn outcomes_that_occur_are_in_the_legend_without_a_bar() {
    let both = svg(&plane(40, stable_or_not(), |r, d| Ok(f64::from(u8::from(20.0 * d < r)))));
    assert!(both.contains(">stable<") && both.contains(">unstable<"));
    assert_eq!(both.matches("<image ").count(), 1);
    let one = svg(&plane(40, stable_or_not(), |_, _| Ok(0.0)));
    assert!(one.contains(">stable<") && !one.contains(">unstable<"));
}

#[test]
fn zero_growth_is_drawn_where_the_sign_changes() {
    for spread in [Spread::Linear, Spread::SignedLog(1e-3)] {
        let growth = |sign: f64| {
            let mut given = plane(41, MapKind::Growth(spread), |r, _| Ok(sign + r - 10.5));
            given.quantity = PlotAxis::new("growth rate");
            svg(&given)
        };
        assert!(growth(0.0).contains("zero growth rate"));
        assert_eq!(strokes(&growth(0.0), "#000000", "1.5").len(), 2, "the line and its sample");
        let beside = strokes(&growth(100.0), "#000000", "1.5");
        assert!(beside.len() <= 1, "no line without a change of sign");
    }
}

#[test]
fn the_first_of_two_axes_is_horizontal() {
    // One point at the upper end of the ratio is unknown: the hatching touches only the right edge.
    let given = plane(3, MapKind::Number(Spread::Linear), |r, d| {
        if r > 19.0 && d < 0.1 { Err(0) } else { Ok(r + d) }
    });
    let turned = MappedQuantity {
        axes: given.axes.iter().rev().cloned().collect(),
        values: (0..9).map(|k| given.values[3 * (k % 3) + k / 3]).collect(),
        ..given.clone()
    };
    // Left end of the hatched corner.
    let corner = |given: &MappedQuantity| -> f64 {
        let svg = svg(given);
        // The sample in the legend comes last.
        let path = svg.split("<path ").find(|path| path.contains("fill=\"url(#"));
        let start = path.and_then(|path| path.strip_prefix("d=\"M")?.split([' ', 'l']).next());
        start.and_then(|start| start.parse().ok()).expect("a hatched path")
    };
    // The frame is 400 pixels wide, each cell at least a quarter of it.
    assert!(corner(&given) - corner(&turned) > 250.0, "{} {}", corner(&given), corner(&turned));
    // Descending values give the same map.
    let mut falling = given.clone();
    falling.axes[0].values.reverse();
    falling.values = (0..9).map(|k| given.values[3 * (2 - k / 3) + k % 3]).collect();
    assert_eq!(svg(&given), svg(&falling));
}

#[test]
fn curves_of_a_theory_are_drawn_over_the_map_and_do_not_widen_it() {
    let mut given = plane(40, stable_or_not(), |_, _| Ok(0.0));
    let bare = svg(&given);
    let boundary =
        Polyline::new(PlotRole::Averaged, [PlotPoint::new(0.0, 0.0), PlotPoint::new(100.0, 5.0)]);
    given.over = vec![boundary.label("averaged: $D$ = $α^*R$").into()];
    let with = svg(&given);
    assert!(with.contains("averaged: ") && !bare.contains("averaged: "));
    for shown in [&bare, &with] {
        assert!(shown.contains(">20<") && !shown.contains(">100<"));
    }
}

#[test]
fn a_sweep_is_open_and_hatched_where_nothing_is_known() {
    let values: Vec<Result<f64, usize>> = (0..90)
        .map(|k| if (30..40).contains(&k) { Err(1) } else { Ok(0.01 * f64::from(k)) })
        .collect();
    let given = MappedQuantity {
        axes: vec![axis("dither amplitude", "D", even(0.0, 1.0, 90))],
        values,
        ..plane(2, MapKind::ResidualVibration, |_, _| Ok(0.0))
    };
    let svg = svg(&given);
    let curve = strokes(&svg, "#000000", "1.4");
    assert_eq!(curve.len(), 1);
    assert_eq!(curve[0].matches('M').count(), 2, "one piece on each side of the gap");
    assert!(svg.contains("not settled") && svg.contains("<pattern "));
}

#[test]
fn outcomes_over_one_axis_are_strips() {
    let given = MappedQuantity {
        axes: vec![axis("dither amplitude", "D", even(0.0, 1.0, 90))],
        values: (0..90)
            .map(|k| if k == 45 { Err(0) } else { Ok(f64::from(u8::from(k < 45))) })
            .collect(),
        reasons: vec!["undecided".into()],
        ..plane(2, stable_or_not(), |_, _| Ok(0.0))
    };
    let svg = svg(&given);
    for word in ["stable", "unstable", "undecided"] {
        assert!(svg.contains(&format!(">{word}<")), "{word}");
    }
}

#[test]
fn a_third_axis_gives_a_panel_for_each_of_its_values() {
    let flat = plane(12, MapKind::ResidualVibration, |r, d| Ok(quench(r, d)));
    let mut given = flat.clone();
    given.axes.insert(0, axis("belt velocity", "v_0", vec![0.05, 0.1, 0.2]));
    given.values = [0.5, 1.0, 1.5]
        .iter()
        .flat_map(|scale| {
            flat.values.iter().map(|value| value.map(|value| scale * value)).collect::<Vec<_>>()
        })
        .collect();
    let svg = svg(&given);
    for heading in [" = 0.05<", " = 0.1<", " = 0.2<"] {
        assert!(svg.contains(heading), "{heading}");
    }
    assert_eq!(svg.matches("<image ").count(), 3 + 2, "three maps, a bar at the end of each row");
}

#[test]
fn invalid_maps_are_refused() {
    let good = || plane(5, MapKind::ResidualVibration, |r, d| Ok(quench(r, d)));
    let mut doubled = good();
    doubled.axes[0].values[1] = doubled.axes[0].values[0];
    let mut short = good();
    short.values.pop();
    let mut endless = good();
    endless.axes[1].values[4] = f64::INFINITY;
    let bare = MappedQuantity { axes: Vec::new(), values: Vec::new(), ..good() };
    let many = MappedQuantity {
        axes: [vec![axis("x", "x", even(0.0, 1.0, 40))], good().axes].concat(),
        values: vec![Ok(0.0); 1000],
        ..good()
    };
    for (number, wrong) in [doubled, short, endless, bare, many].iter().enumerate() {
        assert!(matches!(map(wrong), Err(PlotError::Field { .. })), "{number}");
    }
}

/// The value of a map at a ratio and an amplitude.
type Value = fn(f64, f64) -> Result<f64, usize>;

#[test]
fn odd_maps_are_pictures_too() {
    let kinds = [
        MapKind::ResidualVibration,
        MapKind::Growth(Spread::SignedLog(1e-6)),
        MapKind::Number(Spread::Log),
        MapKind::Number(Spread::Linear),
        stable_or_not(),
    ];
    let values: [Value; 5] = [
        |_, _| Err(0),
        |_, _| Ok(0.0),
        |_, _| Ok(f64::NAN),
        |_, _| Ok(-1e300),
        |r, d| Ok(1e9 * r * d),
    ];
    for kind in kinds {
        for (number, value) in values.into_iter().enumerate() {
            let given = plane(7, kind.clone(), value);
            let figure = map(&given).expect("a map").size(Size::Frame(100.0, 80.0));
            let svg = figure.to_svg();
            assert!(!svg.contains("NaN\"") && !svg.contains("NaN "), "{kind:?} {number}");
            assert!(figure.to_png().is_ok(), "{kind:?} {number}");
        }
    }
}

#[test]
fn a_large_map_is_a_small_file() {
    // Noise in every point is the worst case for the image.
    let noise = |r: f64, d: f64| Ok(((r * 12.9898 + d * 78.233).sin() * 43758.5453).fract().abs());
    let smooth = |r: f64, d: f64| if r < 3.0 { Err(0) } else { Ok(quench(r, d)) };
    let worst = svg(&plane(
        200,
        MapKind::Outcome((0..200).map(|k| (PlotRole::Series(k), String::new())).collect()),
        |r, d| noise(r, d).map(|value: f64| (200.0 * value).floor()),
    ));
    assert!(worst.len() < 400_000, "{} bytes of noise", worst.len());
    let usual = svg(&plane(200, MapKind::ResidualVibration, smooth));
    assert!(usual.len() < 200_000, "{} bytes", usual.len());
}
