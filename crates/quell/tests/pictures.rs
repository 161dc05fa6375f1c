//! Pictures as their users see them: kinds, files, dashes, gaps, size, sameness.

use std::fs;

use quell::plot::{
    Axis, Figure, Fill, Legend, Line, LineStyle, Marker, Note, Panel, PlotError, Points, Region,
    Role, Rule, SharedLegend, Sharing, Size,
};

fn axes() -> Panel {
    Panel::new(Axis::new("time").symbol("τ"), Axis::new("displacement").symbol("x"))
}

fn wave(count: u32) -> Vec<(f64, f64)> {
    (0..count)
        .map(|step| {
            let time = 100.0 * f64::from(step) / f64::from(count);
            (time, time.sin() + 0.1 * (37.0 * time).sin())
        })
        .collect()
}

fn rich() -> Figure {
    let panel = |title: &str| {
        axes()
            .title(title)
            .with(
                Region::across_x(Role::Unstable, 20.0, 40.0).fill(Fill::Hatched).label("unstable"),
            )
            .with(Line::new(Role::Undithered, wave(5000)).label("undithered"))
            .with(Points::new(Role::Printed, wave(20)).marker(Marker::Circle).label("printed"))
            .with(Rule::vertical(50.0).label("$R$ = 10"))
            .with(Note::new(60.0, 0.5, "$\\bar{μ}$"))
    };
    Figure::grid(2, [panel("(a)"), panel("(b)"), panel("(c)")])
        .title("Title")
        .caption("Caption")
        .legend(SharedLegend::Below)
        .sharing_x(Sharing::All)
        .sharing_y(Sharing::Aligned)
}

/// The path data of strokes with this colour, in the order they are drawn.
fn strokes<'a>(svg: &'a str, colour: &str) -> Vec<&'a str> {
    svg.split("<path ")
        .skip(1)
        .filter(|path| {
            path.split("/>")
                .next()
                .is_some_and(|path| path.contains(&format!("stroke=\"{colour}\"")))
        })
        .filter_map(|path| path.strip_prefix("d=\"")?.split('"').next())
        .collect()
}

const BLUE: &str = "#0072b2";
const GREY: &str = "#808080";

#[test]
fn an_unknown_extension_is_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for name in ["picture.pdf", "picture", "picture.svg.txt"] {
        let path = folder.path().join(name);
        let refused = Figure::single(axes()).write(&path);
        assert!(matches!(refused, Err(PlotError::UnknownExtension { .. })), "{name}");
        assert!(Figure::check_path(&path).is_err());
    }
    assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 0);
    assert!(Figure::check_path("A.SVG").is_ok() && Figure::check_path("a.Png").is_ok());
}

#[test]
fn a_path_that_cannot_be_written_is_an_error_and_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let missing = folder.path().join("no/such/folder/a.svg");
    let refused = Figure::single(axes()).write(&missing);
    assert!(matches!(&refused, Err(PlotError::Write { path, .. }) if *path == missing));
    // A folder of the file's name stands in the way of the rename.
    let taken = folder.path().join("taken.svg");
    fs::create_dir(&taken).expect("a folder");
    fs::write(taken.join("content"), "kept").expect("a file");
    assert!(matches!(Figure::single(axes()).write(&taken), Err(PlotError::Write { .. })));
    let left: Vec<_> = fs::read_dir(folder.path()).expect("the folder").collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

#[test]
fn files_hold_what_the_memory_holds() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let figure = rich();
    let (svg, png) = (folder.path().join("a.svg"), folder.path().join("a.png"));
    fs::write(&svg, "older").expect("a file");
    figure.write(&svg).expect("an SVG");
    figure.write(&png).expect("a PNG");
    assert_eq!(fs::read_to_string(&svg).expect("the SVG"), figure.to_svg());
    let bytes = fs::read(&png).expect("the PNG");
    assert!(bytes.starts_with(b"\x89PNG\r\n"));
    assert_eq!(bytes, figure.to_png().expect("a PNG"));
    assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 2);
}

#[test]
fn equal_figures_give_equal_pictures() {
    assert_eq!(rich().to_svg(), rich().to_svg());
    assert_eq!(rich().to_png().expect("a PNG"), rich().to_png().expect("a PNG"));
}

#[test]
fn identifiers_of_different_pictures_differ() {
    let id = |figure: &Figure| {
        let svg = figure.to_svg();
        svg.split("clipPath id=\"").nth(1).and_then(|rest| rest.split('"').next()).map(String::from)
    };
    assert!(id(&rich()).is_some());
    assert_ne!(id(&rich()), id(&Figure::single(axes())));
}

#[test]
fn roles_and_styles_decide_the_dashes() {
    let dashes =
        |line: Line| Figure::single(axes().with(line)).to_svg().contains("stroke-dasharray=\"");
    assert!(dashes(Line::new(Role::Undithered, wave(100))));
    assert!(!dashes(Line::new(Role::Dithered, wave(100))));
    assert!(dashes(Line::new(Role::Dithered, wave(100)).style(LineStyle::Dashed)));
    assert!(dashes(Line::new(Role::Exact, wave(100)).style(LineStyle::Dotted)));
    assert!(!dashes(Line::new(Role::Undithered, wave(100)).style(LineStyle::Solid)));
}

#[test]
fn a_dashed_line_is_dashed_in_pixels_too() {
    let flat = |style| {
        let line = Line::new(Role::Dithered, [(0.0, 0.5), (1.0, 0.5)]).style(style);
        Figure::single(axes().with(line)).to_png().expect("a PNG")
    };
    assert_ne!(flat(LineStyle::Dashed), flat(LineStyle::Solid));
}

#[test]
fn a_break_is_not_bridged() {
    let jump = || (0..100).map(|step| (f64::from(step), if step < 50 { 0.0 } else { 1.0 }));
    let count = |line: Line| {
        let svg = Figure::single(axes().with(line)).to_svg();
        strokes(&svg, BLUE)[0].matches('M').count()
    };
    assert_eq!(count(Line::new(Role::Dithered, jump())), 1);
    assert_eq!(count(Line::new(Role::Dithered, jump()).broken_at_jumps(0.5)), 2);
    assert_eq!(count(Line::pieces(Role::Dithered, [wave(50), wave(50), wave(50)])), 3);
    let hole = jump().map(|(x, y)| (x, if x == 70.0 { f64::INFINITY } else { y }));
    assert_eq!(count(Line::new(Role::Dithered, hole)), 2);
}

#[test]
fn pieces_share_one_entry_of_the_legend() {
    let line = Line::pieces(Role::Dithered, [wave(50), wave(50)]).label("only once");
    let svg = Figure::single(axes().with(line)).to_svg();
    assert_eq!(svg.matches("only once").count(), 1);
}

#[test]
fn a_shared_legend_names_each_curve_once() {
    let svg = rich().to_svg();
    for name in ["undithered", "unstable", "printed"] {
        assert_eq!(svg.matches(&format!(">{name}<")).count(), 1, "{name}");
    }
    // Shared x: the label stands below the last panel of each column only.
    assert_eq!(svg.matches(">time ").count(), 2);
}

#[test]
fn a_long_series_stays_small_and_keeps_its_spike() {
    let mut series = wave(100_000);
    series[43_210].1 = 5.0;
    let svg = Figure::single(axes().with(Line::new(Role::Dithered, series))).to_svg();
    assert!(svg.len() < 200_000, "{}", svg.len());
    // The spike is by far the highest point: its end of the axis is drawn close to the frame's top.
    let path = strokes(&svg, BLUE)[0];
    let steps: Vec<(f64, f64)> = path
        .trim_start_matches('M')
        .split('l')
        .filter_map(|step| {
            let split = step.rfind(['-', ' ']).filter(|at| *at > 0)?;
            Some((step[..split].parse().ok()?, step[split..].trim().parse().ok()?))
        })
        .collect();
    let mut height = 0.0;
    let heights: Vec<f64> = steps
        .iter()
        .map(|(_, down)| {
            height += down;
            height
        })
        .collect();
    let top = heights.iter().copied().fold(f64::INFINITY, f64::min);
    let second = heights.iter().copied().filter(|y| *y > top + 1.0).fold(f64::INFINITY, f64::min);
    assert!(second - top > 100.0, "{top} {second}");
}

#[test]
fn a_long_orbit_stays_below_a_megabyte() {
    let orbit = (0..100_000).map(|step| {
        let time = 0.05 * f64::from(step);
        (
            (1.0 + 0.1 * (0.01 * time).sin()) * time.cos(),
            (1.0 + 0.1 * (0.01 * time).cos()) * time.sin(),
        )
    });
    let svg = Figure::single(axes().with(Line::new(Role::Dithered, orbit))).to_svg();
    assert!(svg.len() < 1_000_000, "{}", svg.len());
}

#[test]
fn hostile_labels_stay_text() {
    let panel = axes().title("<script>&\"'$x_{<b>}$ \u{1} 5$ \u{E000}");
    let figure = Figure::single(panel.with(Line::new(Role::Dithered, wave(9)).label("</text><g>")));
    let svg = figure.to_svg();
    assert!(!svg.contains("<script>") && !svg.contains("<b>") && !svg.contains("</text><g>"));
    assert!(figure.to_png().is_ok());
}

#[test]
fn odd_figures_are_pictures_too() {
    let empty = Figure::grid(3, []);
    let nothing = Figure::single(Panel::default());
    let single = axes().with(Line::new(Role::Dithered, [(2.0, 3.0)]));
    let negative = Panel::new(Axis::new("x").log(), Axis::new("y").log())
        .with(Line::new(Role::Dithered, [(-1.0, -1.0), (0.0, 0.0)]))
        .with(Region::across_y(Role::Stable, f64::NEG_INFINITY, f64::INFINITY));
    let huge = axes().with(Line::new(Role::Dithered, [(0.0, -1e308), (1.0, 1e308)]));
    let far = axes().with(Line::new(Role::Dithered, [(0.0, 1e300), (1.0, 1.0)]).label("a"));
    let tiny =
        Figure::single(axes().with(Line::new(Role::Dithered, wave(10)).label("x".repeat(300))))
            .size(Size::Whole(1.0, f64::NAN));
    let figures = [
        empty,
        nothing,
        Figure::single(single),
        Figure::single(negative),
        Figure::single(huge),
        Figure::single(far.legend(Legend::Auto)),
        tiny,
    ];
    for (number, figure) in figures.iter().enumerate() {
        let svg = figure.to_svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "figure {number}");
        assert!(figure.to_png().is_ok(), "figure {number}");
    }
}

#[test]
fn points_out_of_the_frame_are_not_drawn() {
    let panel = Panel::new(Axis::new("x").between(0.0, 1.0), Axis::new("y").between(0.0, 1.0))
        .with(Points::new(Role::Undithered, [(0.5, 0.5), (2.0, 0.5), (0.5, -3.0), (1.0, 1.0)]));
    let svg = Figure::single(panel).to_svg();
    assert_eq!(strokes(&svg, GREY)[0].matches("h0").count(), 2);
}

#[test]
fn the_whole_size_is_kept() {
    let figure = rich().size(Size::Whole(700.0, 600.0));
    let svg = figure.to_svg();
    let number = |name: &str| -> f64 {
        svg.split(&format!(" {name}=\""))
            .nth(1)
            .and_then(|rest| rest.split('"').next()?.parse().ok())
            .expect("a size")
    };
    assert!((number("width") - 700.0).abs() <= 2.0, "{}", number("width"));
    assert!((number("height") - 600.0).abs() <= 2.0, "{}", number("height"));
}
