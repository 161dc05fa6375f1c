//! Pictures as users see them: kinds, files, dashes, gaps, size, reproducibility.

use std::fs;

use quell::Complaint;
use quell::input::Inputs;
use quell::output::Output;
use quell::picture::{EXTENSIONS, write};
use quell::plot::{
    Colouring, Contours, Field, Figure, Fill, Heatmap, Legend, LineStyle, Marker, Note, Palette,
    Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline, ReferenceLine, Region, Shading,
    SharedLegend, Sharing, Size, Spread, Tint,
};

fn axes() -> Panel {
    Panel::new(PlotAxis::new("time").symbol("τ"), PlotAxis::new("displacement").symbol("x"))
}

fn wave(count: u32) -> Vec<PlotPoint> {
    (0..count)
        .map(|step| {
            let time = 100.0 * f64::from(step) / f64::from(count);
            PlotPoint::new(time, time.sin() + 0.1 * (37.0 * time).sin())
        })
        .collect()
}

fn rich() -> Figure {
    let panel = |title: &str| {
        axes()
            .title(title)
            .with(
                Region::across_x(PlotRole::Unstable, 20.0, 40.0)
                    .fill(Fill::Hatched)
                    .label("unstable"),
            )
            .with(Polyline::new(PlotRole::Undithered, wave(5000)).label("undithered"))
            .with(Points::new(PlotRole::Printed, wave(20)).marker(Marker::Circle).label("printed"))
            .with(ReferenceLine::vertical(50.0).label("$R$ = 10"))
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

fn output(path: &std::path::Path) -> Result<Output, Box<Complaint>> {
    Output::prepare(path, "--plot", EXTENSIONS, &Inputs::NONE)
}

#[test]
fn an_unknown_extension_is_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for name in ["picture.jpg", "picture", "picture.svg.txt"] {
        let refused = output(&folder.path().join(name)).expect_err(name);
        assert!(refused.to_string().contains(".svg or .pdf or .png"), "{refused}");
    }
    for name in ["A.SVG", "a.Png", "b.PDF"] {
        assert!(output(&folder.path().join(name)).is_ok(), "{name}");
    }
    assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 0);
}

#[test]
fn a_path_that_cannot_be_written_is_an_error_and_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let missing = folder.path().join("no/such/folder/a.svg");
    assert!(output(&missing).is_err());
    let taken = folder.path().join("taken.svg");
    let prepared = output(&taken).expect("free");
    // Meanwhile a folder with the name of the file blocks the rename.
    fs::create_dir(&taken).expect("a folder");
    fs::write(taken.join("content"), "kept").expect("a file");
    let refused = write(&Figure::single(axes()), prepared).expect_err("a folder is there");
    assert!(refused.to_string().contains("taken.svg"), "{refused}");
    let left: Vec<_> = fs::read_dir(folder.path()).expect("the folder").collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

#[test]
fn files_hold_what_the_memory_holds() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let figure = rich();
    let path = |name: &str| folder.path().join(name);
    let (svg, png, pdf) = (path("a.svg"), path("a.png"), path("a.pdf"));
    fs::write(&svg, "older").expect("a file");
    for path in [&svg, &png, &pdf] {
        write(&figure, output(path).expect("writable")).expect("written");
    }
    assert_eq!(fs::read_to_string(&svg).expect("the SVG"), figure.to_svg());
    let bytes = fs::read(&png).expect("the PNG");
    assert!(bytes.starts_with(b"\x89PNG\r\n"));
    assert_eq!(bytes, figure.to_png().expect("a PNG"));
    assert!(fs::read(&pdf).expect("the PDF").starts_with(b"%PDF-"));
    assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 3);
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
        |line: Polyline| Figure::single(axes().with(line)).to_svg().contains("stroke-dasharray=\"");
    assert!(dashes(Polyline::new(PlotRole::Undithered, wave(100))));
    assert!(!dashes(Polyline::new(PlotRole::Dithered, wave(100))));
    assert!(dashes(Polyline::new(PlotRole::Dithered, wave(100)).style(LineStyle::Dashed)));
    assert!(dashes(Polyline::new(PlotRole::Exact, wave(100)).style(LineStyle::Dotted)));
    assert!(!dashes(Polyline::new(PlotRole::Undithered, wave(100)).style(LineStyle::Solid)));
}

#[test]
fn a_dashed_line_is_dashed_in_pixels_too() {
    let flat = |style| {
        let line =
            Polyline::new(PlotRole::Dithered, [PlotPoint::new(0.0, 0.5), PlotPoint::new(1.0, 0.5)])
                .style(style);
        Figure::single(axes().with(line)).to_png().expect("a PNG")
    };
    assert_ne!(flat(LineStyle::Dashed), flat(LineStyle::Solid));
}

#[test]
fn a_break_is_not_bridged() {
    let jump =
        || (0..100).map(|step| PlotPoint::new(f64::from(step), if step < 50 { 0.0 } else { 1.0 }));
    let count = |line: Polyline| {
        let svg = Figure::single(axes().with(line)).to_svg();
        strokes(&svg, BLUE)[0].matches('M').count()
    };
    assert_eq!(count(Polyline::new(PlotRole::Dithered, jump())), 1);
    assert_eq!(count(Polyline::pieces(PlotRole::Dithered, [wave(50), wave(50), wave(50)])), 3);
    let hole = jump()
        .map(|PlotPoint { x, y }| PlotPoint::new(x, if x == 70.0 { f64::INFINITY } else { y }));
    assert_eq!(count(Polyline::new(PlotRole::Dithered, hole)), 2);
}

#[test]
fn pieces_share_one_entry_of_the_legend() {
    let line = Polyline::pieces(PlotRole::Dithered, [wave(50), wave(50)]).label("only once");
    let svg = Figure::single(axes().with(line)).to_svg();
    assert_eq!(svg.matches("only once").count(), 1);
}

#[test]
fn a_shared_legend_names_each_curve_once() {
    let svg = rich().to_svg();
    for name in ["undithered", "unstable", "printed"] {
        assert_eq!(svg.matches(&format!(">{name}<")).count(), 1, "{name}");
    }
    // Shared x: only the last panel of each column has the label.
    assert_eq!(svg.matches(">time ").count(), 2);
}

#[test]
fn a_long_series_stays_small_and_keeps_its_spike() {
    let mut series = wave(100_000);
    series[43_210].y = 5.0;
    let svg = Figure::single(axes().with(Polyline::new(PlotRole::Dithered, series))).to_svg();
    assert!(svg.len() < 200_000, "{}", svg.len());
    // The spike is by far the highest point: its end of the axis is drawn close to the frame's top.
    let path = strokes(&svg, BLUE)[0];
    let steps: Vec<PlotPoint> = path
        .trim_start_matches('M')
        .split('l')
        .filter_map(|step| {
            let split = step.rfind(['-', ' ']).filter(|at| *at > 0)?;
            Some(PlotPoint::new(step[..split].parse().ok()?, step[split..].trim().parse().ok()?))
        })
        .collect();
    let mut height = 0.0;
    let heights: Vec<f64> = steps
        .iter()
        .map(|PlotPoint { y: down, .. }| {
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
        PlotPoint::new(
            (1.0 + 0.1 * (0.01 * time).sin()) * time.cos(),
            (1.0 + 0.1 * (0.01 * time).cos()) * time.sin(),
        )
    });
    let svg = Figure::single(axes().with(Polyline::new(PlotRole::Dithered, orbit))).to_svg();
    assert!(svg.len() < 1_000_000, "{}", svg.len());
}

#[test]
fn hostile_labels_stay_text() {
    let panel = axes().title("<script>&\"'$x_{<b>}$ \u{1} 5$ \u{E000}");
    let figure =
        Figure::single(panel.with(Polyline::new(PlotRole::Dithered, wave(9)).label("</text><g>")));
    let svg = figure.to_svg();
    assert!(!svg.contains("<script>") && !svg.contains("<b>") && !svg.contains("</text><g>"));
    assert!(figure.to_png().is_ok());
}

#[test]
fn odd_figures_are_pictures_too() {
    let empty = Figure::grid(3, []);
    let nothing = Figure::single(Panel::default());
    let single = axes().with(Polyline::new(PlotRole::Dithered, [PlotPoint::new(2.0, 3.0)]));
    let negative = Panel::new(PlotAxis::new("x").log(), PlotAxis::new("y").log())
        .with(Polyline::new(
            PlotRole::Dithered,
            [PlotPoint::new(-1.0, -1.0), PlotPoint::new(0.0, 0.0)],
        ))
        .with(Region::across_y(PlotRole::Stable, f64::NEG_INFINITY, f64::INFINITY));
    let huge = axes().with(Polyline::new(
        PlotRole::Dithered,
        [PlotPoint::new(0.0, -1e308), PlotPoint::new(1.0, 1e308)],
    ));
    let far = axes().with(
        Polyline::new(PlotRole::Dithered, [PlotPoint::new(0.0, 1e300), PlotPoint::new(1.0, 1.0)])
            .label("a"),
    );
    let tiny = Figure::single(
        axes().with(Polyline::new(PlotRole::Dithered, wave(10)).label("x".repeat(300))),
    )
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
    let panel =
        Panel::new(PlotAxis::new("x").between(0.0, 1.0), PlotAxis::new("y").between(0.0, 1.0))
            .with(Points::new(
                PlotRole::Undithered,
                [
                    PlotPoint::new(0.5, 0.5),
                    PlotPoint::new(2.0, 0.5),
                    PlotPoint::new(0.5, -3.0),
                    PlotPoint::new(1.0, 1.0),
                ],
            ));
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

fn even(from: f64, to: f64, count: u32) -> Vec<f64> {
    (0..count).map(|k| from + (to - from) * f64::from(k) / f64::from(count - 1)).collect()
}

fn hill(count: u32) -> Field {
    let axis = even(-1.0, 1.0, count);
    let height = |column: usize, row: usize| {
        Some(100.0 * (-2.0 * (axis[column].powi(2) + axis[row].powi(2))).exp())
    };
    Field::from_fn(axis.clone(), axis.clone(), height).expect("a field")
}

fn shaded(palette: Palette) -> Colouring {
    Colouring::Shaded(Shading::new(palette))
}

#[test]
fn a_map_is_one_image_with_one_bar() {
    let grid =
        Heatmap::new(hill(400), shaded(Palette::Viridis)).bar(PlotAxis::new("height").unit("m"));
    let svg = Figure::single(axes().with(grid.clone())).to_svg();
    assert_eq!(svg.matches("<image ").count(), 2);
    assert!(svg.contains(">height (m)<") && svg.len() < 300_000, "{}", svg.len());
    let svg = Figure::single(axes().with(Heatmap { bar: None, ..grid })).to_svg();
    assert_eq!(svg.matches("<image ").count(), 1);
}

#[test]
fn pixels_of_a_map_have_the_colour_of_the_nearest_point() {
    // On the logarithmic axis the border between 1 and 100 is at 10.
    let outcomes = [PlotRole::Stable, PlotRole::Unstable, PlotRole::Undecided, PlotRole::Exact]
        .map(|role| Tint::new(role, ""))
        .to_vec();
    let values = (0..4).map(|value| Some(f64::from(value))).collect();
    let field = Field::new(vec![1.0, 100.0], vec![0.0, 1.0], values).expect("a field");
    let panel = Panel::new(PlotAxis::new("").log(), PlotAxis::new(""))
        .with(Heatmap::new(field, Colouring::Outcomes(outcomes)));
    let picture = Figure::single(panel).size(Size::Frame(200.0, 100.0)).to_png().expect("a PNG");
    let mut reader = png::Decoder::new(picture.as_slice()).read_info().expect("a header");
    let mut pixels = vec![0; reader.output_buffer_size()];
    let width = reader.next_frame(&mut pixels).expect("pixels").width as usize;
    let mut counts = std::collections::BTreeMap::new();
    for pixel in pixels.chunks(4) {
        *counts.entry([pixel[0], pixel[1], pixel[2]]).or_insert(0_usize) += 1;
    }
    // Blue, vermillion, grey and black with four grey levels: a quarter of 400 by 200 pixels each, less frame and ticks.
    for tint in [[208, 229, 241], [223, 131, 58], [188, 188, 188], [120, 120, 120]] {
        let count = counts.get(&tint).copied().unwrap_or(0);
        assert!((18_500..=20_000).contains(&count), "{tint:?} {count} of {width} {counts:?}");
    }
}

#[test]
fn isolines_carry_their_numbers_and_are_open_under_them() {
    let lines = Contours::new(hill(80), [20.0, 40.0, 60.0, 80.0]);
    let labelled = Figure::single(axes().with(lines.clone().unit("%"))).to_svg();
    let plain = Figure::single(axes().with(lines.plain())).to_svg();
    for level in ["20\u{202f}%", "40\u{202f}%", "60\u{202f}%", "80\u{202f}%"] {
        assert!(labelled.contains(&format!(">{level}<")), "{level}");
        assert!(!plain.contains(level));
    }
    // A closed line is one piece, interrupted at each number.
    let pieces = |svg: &str| strokes(svg, "#000000").iter().map(|d| d.matches('M').count()).sum();
    let (open, closed): (usize, usize) = (pieces(&labelled), pieces(&plain));
    // The circle of 20 % leaves no gap in the frame: four closed lines.
    assert_eq!(closed, 4);
    assert!(open >= 8, "{open}");
}

#[test]
fn isolines_follow_the_field_also_on_a_log_axis() {
    // x y = 10 is straight on two logarithmic axes.
    let axis: Vec<f64> = even(0.0, 1.0, 9).into_iter().map(|power| 10_f64.powf(power)).collect();
    let product = |column: usize, row: usize| Some((axis[column] * axis[row]).ln());
    let field = Field::from_fn(axis.clone(), axis.clone(), product).expect("a field");
    let panel = Panel::new(PlotAxis::new("x").log(), PlotAxis::new("y").log())
        .with(Contours::new(field, [10_f64.ln()]).plain());
    let svg = Figure::single(panel).size(Size::Frame(200.0, 100.0)).to_svg();
    let path = strokes(&svg, "#000000")[0];
    let steps: Vec<PlotPoint> = path
        .trim_start_matches('M')
        .split('l')
        .skip(1)
        .filter_map(|step| {
            let split = step.rfind(['-', ' ']).filter(|at| *at > 0)?;
            Some(PlotPoint::new(step[..split].parse().ok()?, step[split..].trim().parse().ok()?))
        })
        .collect();
    assert!(!steps.is_empty());
    for PlotPoint { x: right, y: down } in steps {
        assert!((right.abs() - 2.0 * down.abs()).abs() < 0.05 && right * down > 0.0, "{path}");
    }
}

#[test]
fn gaps_are_hatched_and_named() {
    let axis = even(0.0, 1.0, 10);
    let value = |column: usize, row: usize| (column > 2 && row > 4).then_some(1.0);
    let field = Field::from_fn(axis.clone(), axis, value).expect("a field");
    let grid = Heatmap::new(field, shaded(Palette::Pale))
        .gap("undecided", |column, _| column <= 2)
        .gap("met nowhere", |_, _| false)
        .gap("no vibration", |_, _| true);
    let svg = Figure::single(axes().with(grid)).to_svg();
    assert!(svg.contains(">undecided<") && svg.contains(">no vibration<"));
    assert!(!svg.contains("met nowhere") && !svg.contains("no value"));
    assert_eq!(svg.matches("<pattern ").count(), 2);
}

#[test]
fn odd_maps_are_pictures_too() {
    let field = |x: Vec<f64>, y: Vec<f64>, value: Option<f64>| {
        let values = vec![value; x.len() * y.len()];
        Field::new(x, y, values).expect("a field")
    };
    let spreads = [Spread::Linear, Spread::Log, Spread::SignedLog(0.0)];
    let fields = [
        field(vec![1.0], vec![2.0], Some(3.0)),
        field(vec![0.0, 1.0], vec![-1.0, 0.0, 5.0], Some(0.0)),
        field(vec![1.0, 2.0], vec![1.0, 2.0], None),
        field(vec![-1e308, 1e308], vec![1e-300, 1.0], Some(-1e308)),
    ];
    for field in fields {
        for spread in spreads {
            for palette in [Palette::Viridis, Palette::Diverging] {
                let shading = Colouring::Shaded(Shading::new(palette).spread(spread));
                let grid = Heatmap::new(field.clone(), shading).bar(PlotAxis::new("a"));
                let panel = Panel::new(PlotAxis::new("x").log(), PlotAxis::new("y"))
                    .with(grid)
                    .with(Contours::about(field.clone(), 5));
                let figure = Figure::single(panel);
                let svg = figure.to_svg();
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "{field:?} {spread:?}");
                assert!(figure.to_png().is_ok());
            }
        }
    }
}

#[test]
fn a_map_of_noise_stays_small() {
    let axis = even(0.0, 1.0, 200);
    let mut state = 1_u64;
    let noise = |_: usize, _: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        Some((state >> 40) as f64)
    };
    let field = Field::from_fn(axis.clone(), axis, noise).expect("a field");
    let svg = Figure::single(axes().with(Heatmap::new(field, shaded(Palette::Viridis)))).to_svg();
    assert!(svg.len() < 250_000, "{}", svg.len());
}
