//! Figures for the column of a journal: their width, the size of the text, and nothing outside the page.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use flate2::read::GzDecoder;
use quell_plot::{
    CaptionPlacement, Colouring, Contours, Field, Figure, Heatmap, Legend, Palette, Panel,
    PlotAxis, PlotPoint, PlotRole, Points, Polyline, ReferenceLine, Shading, SharedLegend, Sharing,
    Size,
};
use resvg::usvg::{self, Node, Options, Tree};

/// 85 mm in units of 1/96 inch.
const COLUMN: f64 = 85.0 / 25.4 * 96.0;
/// 7 pt in the same units.
const SEVEN_POINTS: f64 = 7.0 / 72.0 * 96.0;

fn curves(title: &str) -> Panel {
    let wave = |phase: f64| {
        (0..200).map(|k| 0.4 * f64::from(k)).map(move |t| PlotPoint::new(t, (t + phase).sin()))
    };
    Panel::new(
        PlotAxis::new("time after the start of the run").symbol("τ"),
        PlotAxis::new("displacement of the mass").symbol("x").unit("mm"),
    )
    .title(title)
    .with(Polyline::new(PlotRole::Undithered, wave(0.0)).label("without dither"))
    .with(Polyline::new(PlotRole::Dithered, wave(1.0)).label("with dither, long label"))
    .with(Points::new(PlotRole::Exact, wave(2.0).step_by(20)).label("events"))
    .with(ReferenceLine::horizontal(0.5).label("$v_0$"))
}

fn map() -> Panel {
    let axis: Vec<f64> = (0..30).map(f64::from).collect();
    let field = Field::from_fn(axis.clone(), axis, |column, row| Some(1.7 * (column + row) as f64))
        .expect("a grid");
    let shading = Shading::new(Palette::Pale).range(0.0, 100.0);
    let colours = Heatmap::new(field.clone(), Colouring::Shaded(shading));
    Panel::new(PlotAxis::new("frequency ratio").symbol("R"), PlotAxis::new("amplitude").symbol("D"))
        .with(colours.bar(PlotAxis::new("residual_vibration").unit("%")))
        .with(Contours::new(field, [5.0, 50.0, 95.0]).unit("%"))
        .legend(Legend::Above)
}

fn figures() -> Vec<Figure> {
    let several = |count: usize| {
        (0..count).map(|k| curves(&format!("({k}) $D$ = 0.3, $E$ = 0.50"))).collect::<Vec<_>>()
    };
    let with_texts = |figure: Figure| {
        figure
            .title("A title that is wider than one column of a journal by far, and more")
            .caption("Caption with $v_m$. ".repeat(12))
    };
    vec![
        with_texts(Figure::single(curves("(a)"))),
        with_texts(Figure::single(map())),
        with_texts(Figure::grid(2, [map(), map(), map(), map()])),
        with_texts(Figure::grid(3, several(9)).sharing_y(Sharing::Aligned))
            .legend(SharedLegend::Above),
        with_texts(Figure::grid(6, several(18)).sharing_x(Sharing::All))
            .legend(SharedLegend::Below),
    ]
}

/// The picture as another program sees it, with the bundled fonts.
fn tree(svg: &str) -> Tree {
    let mut options = Options { font_family: "DejaVu Sans".to_owned(), ..Options::default() };
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    for name in ["DejaVuSans.ttf.gz", "DejaVuSans-Bold.ttf.gz", "DejaVuSans-Oblique.ttf.gz"] {
        let mut font = Vec::new();
        let file = File::open(assets.join(name)).expect("a bundled font");
        GzDecoder::new(file).read_to_end(&mut font).expect("a font");
        options.fontdb_mut().load_font_data(font);
    }
    Tree::from_str(svg, &options).expect("an SVG")
}

fn each_text(group: &usvg::Group, visit: &mut impl FnMut(&usvg::Text)) {
    for node in group.children() {
        match node {
            Node::Group(group) => each_text(group, visit),
            Node::Text(text) => visit(text),
            _ => {}
        }
    }
}

#[test]
fn a_figure_has_the_width_that_is_asked_for() {
    for (number, figure) in figures().into_iter().enumerate() {
        for width in [COLUMN, 2.0 * COLUMN, 900.0] {
            let size = tree(&figure.clone().size(Size::Wide(width)).to_svg()).size();
            assert!((f64::from(size.width()) - width).abs() < 0.01, "figure {number}: {size:?}");
        }
    }
}

#[test]
fn no_text_is_smaller_than_seven_points() {
    for figure in figures() {
        let svg = figure.size(Size::Wide(COLUMN)).to_svg();
        let sizes = svg.split("<text ").skip(1).map(|rest| {
            let size = rest.split("font-size=\"").nth(1).and_then(|rest| rest.split('"').next());
            size.expect("a size").parse::<f64>().expect("a number")
        });
        let least = sizes.fold(f64::INFINITY, f64::min);
        assert!(least.is_finite() && least >= SEVEN_POINTS, "{least}");
    }
}

#[test]
fn texts_are_inside_the_page() {
    for (number, figure) in figures().into_iter().enumerate() {
        for placement in [CaptionPlacement::Below, CaptionPlacement::Apart] {
            let figure = figure.clone().caption_placement(placement);
            let tree = tree(&figure.size(Size::Wide(COLUMN)).to_svg());
            let size = tree.size();
            let mut count = 0;
            each_text(tree.root(), &mut |text| {
                let area = text.abs_bounding_box();
                let words: String = text.chunks().iter().map(usvg::TextChunk::text).collect();
                let inside = area.left() >= -0.5
                    && area.right() <= size.width() + 0.5
                    && area.top() >= -0.5
                    && area.bottom() <= size.height() + 0.5;
                assert!(inside, "figure {number}: {words:?} {area:?} on {size:?}");
                count += 1;
            });
            assert!(count > 10, "figure {number} has {count} texts");
        }
    }
}

#[test]
fn a_caption_apart_is_the_description_of_the_picture() {
    let figure = Figure::single(curves("(a)")).caption("$v_m$ = 0.2 & more");
    let below = figure.to_svg();
    let apart = figure.clone().caption_placement(CaptionPlacement::Apart).to_svg();
    assert!(!below.contains("<desc>") && below.contains("&amp; more"));
    assert!(apart.contains("<desc>v_m = 0.2 &amp; more</desc>"));
    assert_eq!(apart.matches("&amp; more").count(), 1);
    assert_eq!(figure.plain_caption(), "v_m = 0.2 & more");
}

#[test]
fn a_pdf_is_one_page_of_the_figures_size_with_embedded_fonts() {
    for figure in figures() {
        let figure = figure.size(Size::Wide(COLUMN));
        let pdf = figure.to_pdf().expect("a PDF");
        assert!(pdf.starts_with(b"%PDF-"));
        let text = String::from_utf8_lossy(&pdf).replace(' ', "");
        assert_eq!(text.matches("/Count1").count(), 1);
        let media = text.split("/MediaBox[").nth(1).and_then(|rest| rest.split(']').next());
        let media = media.expect("a size");
        let width = 85.0 / 25.4 * 72.0;
        assert!(media.starts_with(&format!("00{}", &width.to_string()[..5])), "{media}");
        assert!(text.contains("/FontFile2") || text.contains("/FontFile3"), "fonts are embedded");
    }
}
