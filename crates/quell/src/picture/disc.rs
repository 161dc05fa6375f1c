//! Pictures of a disc: mode shapes, Campbell diagram, and instability tongues over speed and friction.

use quell_disc::plate::PlateMode;
use quell_disc::resonance::{Order, Waves};
use quell_model::Disc;
use quell_model::disc::DiscDither;
use quell_numerics::interval::RealInterval;

use super::caption::disc_caption;
use super::undrawable;
use crate::complaint::Failure;
use crate::plot::{
    Colouring, Contours, Field, Figure, Heatmap, Layer, Legend, LineStyle, Marker, Note, Palette,
    Panel, PlotAxis, PlotError, PlotPoint, PlotRole, Points, Polyline, ReferenceLine, Shading,
    SharedLegend, Sharing, Size,
};
use crate::run::disc::campbell::Campbell;
use crate::run::disc::modes::Modes;
use crate::run::disc::resonances::Resonances;
use crate::run::disc::stability::DiscStability;
use crate::study::DiscStudy;
use crate::study::disc::ModeSource;

/// Number of points across the plate.
const ACROSS: usize = 161;
/// Maximum number of mode shapes in a picture.
const MOST_SHAPES: usize = 12;
/// Number of friction coefficients at which the edges of tongues are computed.
const EDGES: usize = 120;
/// A predicted edge counts only if its distance from the speed of the resonance is below this fraction of that speed.
const FAR: f64 = 0.15;

/// Shapes of the first modes; frequencies over nodal diameters if the modes are given and not computed.
///
/// # Errors
/// [`Failure::Failed`] if it cannot be drawn.
pub fn modes(study: &DiscStudy, done: &Modes) -> Result<Figure, Failure> {
    let figure = match study.source() {
        ModeSource::Plate(plate) => {
            let shown = plate.set.modes().iter().zip(&done.rows).take(MOST_SHAPES);
            let panels: Result<Vec<Panel>, PlotError> = shown
                .map(|(mode, row)| {
                    let title =
                        format!("({}, {}): $β$ = {:.4}", row.radial, row.diameters, row.ratio);
                    Ok(shape(mode, plate.plate.inner_radius_ratio())?.title(title))
                })
                .collect();
            let panels = panels.map_err(undrawable)?;
            let columns = panels.len().min(4);
            Figure::grid(columns, panels)
                .sharing_x(Sharing::All)
                .sharing_y(Sharing::All)
                .size(Size::Frame(190.0, 190.0))
        }
        ModeSource::List(_) | ModeSource::File { .. } => {
            let points =
                done.rows.iter().map(|row| PlotPoint::new(row.diameters as f64, row.ratio));
            let panel = Panel::new(
                PlotAxis::new("nodal diameters").symbol("q"),
                PlotAxis::new("frequency").symbol("β").from(0.0),
            );
            Figure::single(panel.with(Points::new(PlotRole::Exact, points).marker(Marker::Disc)))
        }
    };
    let left = done.rows.len().saturating_sub(MOST_SHAPES);
    let more = match study.source() {
        ModeSource::Plate(_) if left > 0 => {
            format!(" The first {MOST_SHAPES} of {} modes.", done.rows.len())
        }
        _ => String::new(),
    };
    let caption = format!("{}{more}", disc_caption(study));
    Ok(figure.title(study.title().unwrap_or_default()).caption(caption))
}

/// The deflection φ(r) cos jθ of a mode over the plate: red up, blue down, with nodal lines.
///
/// # Errors
/// [`PlotError`] if the field is invalid.
pub fn shape(mode: &PlateMode, inner: f64) -> Result<Panel, PlotError> {
    let places: Vec<f64> =
        (0..ACROSS).map(|k| 1.02 * (2.0 * (k as f64) / (ACROSS - 1) as f64 - 1.0)).collect();
    let field = Field::from_fn(places.clone(), places.clone(), |column, row| {
        let (x, y) = (places[column], places[row]);
        mode.shape.deflection(libm::hypot(x, y), libm::atan2(y, x))
    })?;
    let most = field.extremes().map_or(1.0, |range| range.upper.max(-range.lower));
    let shading = Shading::new(Palette::Diverging).range(-most, most);
    let circle = |radius: f64| {
        (0..=180).map(move |k| {
            let angle = std::f64::consts::TAU * f64::from(k) / 180.0;
            PlotPoint::new(radius * libm::cos(angle), radius * libm::sin(angle))
        })
    };
    let axis = |symbol: &str| {
        let axis = PlotAxis::new("").symbol(format!("{symbol}/a")).between(-1.02, 1.02);
        axis.ticks([-1.0, -0.5, 0.0, 0.5, 1.0])
    };
    // Outside the plate the deflection is drawn as zero, instead of hatched as unknown.
    let values = field.values().iter().map(|value| Some(value.unwrap_or(0.0))).collect();
    let shown = Field::new(places.clone(), places.clone(), values)?;
    let grid = Heatmap::new(shown, Colouring::Shaded(shading));
    Ok(Panel::new(axis("x"), axis("y"))
        .with(grid)
        .with(Contours::new(field, [0.0]).plain())
        .with(Polyline::pieces(PlotRole::Boundary, [circle(inner), circle(1.0)]))
        .with_all(signs(mode, inner))
        .equal_scales()
        .legend(Legend::None))
}

/// The sign of the deflection at every antinode, for prints without colours.
fn signs(mode: &PlateMode, inner: f64) -> Vec<Note> {
    const RADII: usize = 100;
    // A sign at the outer edge would cover it.
    const OUTERMOST: f64 = 0.92;
    let radii: Vec<f64> =
        (0..=RADII).map(|k| inner + (OUTERMOST - inner) * (k as f64 / RADII as f64)).collect();
    let sizes: Vec<f64> =
        radii.iter().map(|r| mode.shape.deflection(*r, 0.0).unwrap_or(0.0)).collect();
    let is_antinode = |k: usize| {
        let size = |k: usize| sizes[k].abs();
        size(k) > size(k - 1) && (k == RADII || size(k) >= size(k + 1))
    };
    let diameters = mode.diameters;
    let angles: Vec<(f64, f64)> = match diameters {
        // A shape without nodal diameters has one sign around; four marks show it.
        0 => (0..4).map(|k| (std::f64::consts::FRAC_PI_4 * f64::from(2 * k + 1), 1.0)).collect(),
        _ => (0..2 * diameters)
            .map(|k| {
                let angle = std::f64::consts::PI * f64::from(k) / f64::from(diameters);
                (angle, if k % 2 == 0 { 1.0 } else { -1.0 })
            })
            .collect(),
    };
    (1..=RADII)
        .filter(|k| is_antinode(*k))
        .flat_map(|k| angles.iter().map(move |angle| (k, *angle)))
        .map(|(k, (angle, side))| {
            let sign = if sizes[k] * side > 0.0 { "+" } else { "\u{2212}" };
            Note::new(radii[k] * libm::cos(angle), radii[k] * libm::sin(angle), sign)
        })
        .collect()
}

/// The picture of a disc that was computed as a system, with the caption of the disc.
pub fn of_motion(figure: Figure, study: &DiscStudy) -> Figure {
    figure.caption(disc_caption(study))
}

/// Frequency and growth rate of every motion over speed, with the speed of the study marked.
pub fn stability(study: &DiscStudy, done: &DiscStability, campbell: &Campbell) -> Figure {
    let last = campbell.speeds.last().copied().unwrap_or(1.0);
    let across = || PlotAxis::new("speed").symbol("Ω").between(0.0, last);
    let every = |pick: fn(&(f64, f64)) -> f64| {
        let columns = campbell.speeds.iter().zip(&campbell.motions);
        columns
            .flat_map(|(speed, motions)| {
                motions.iter().map(|motion| PlotPoint::new(*speed, pick(motion)))
            })
            .collect::<Vec<_>>()
    };
    let dots = |points: Vec<PlotPoint>, label: &str| {
        Points::new(PlotRole::Undithered, points).marker(Marker::Disc).size(1.6).label(label)
    };
    let speed = study.disc().speed();
    let own = |value: f64, marker: Marker| {
        Points::new(PlotRole::Exact, [PlotPoint::new(speed, value)]).marker(marker).size(7.0)
    };
    let frequency = Panel::new(across(), PlotAxis::new("frequency").symbol("|Im ρ|").from(0.0))
        .with(dots(every(|motion| motion.0), "motions without dither"))
        .with(own(done.undithered.frequency, Marker::Circle).label("least stable without dither"))
        .title("(a) frequency in the frame of the load")
        .legend(Legend::None);
    let mut growth = Panel::new(across(), PlotAxis::new("growth rate").symbol("Re ρ"))
        .with(ReferenceLine::horizontal(0.0))
        .with(dots(every(|motion| motion.1), "motions without dither"));
    if let Some(dithered) = &campbell.dithered {
        let points = PlotPoint::zip(campbell.speeds.iter().copied(), dithered.iter().copied());
        growth =
            growth.with(Polyline::new(PlotRole::Dithered, points).label("largest, with dither"));
    }
    let growth = growth
        .with(own(done.growth.rate, Marker::Disc).label("this study"))
        .title("(b) growth")
        .legend(Legend::None);
    Figure::grid(2, [frequency, growth])
        .legend(SharedLegend::Below)
        .size(Size::Frame(390.0, 300.0))
        .title(study.title().unwrap_or_default())
        .caption(disc_caption(study))
}

/// Tongues over speed and friction; meetings of pairs without a tongue at this order are thin lines, speeds of exact growth marks at the
/// friction of the study.
pub fn resonances(study: &DiscStudy, done: &Resonances) -> Figure {
    let (from, to) = (*done.question.speeds.start(), *done.question.speeds.end());
    let load = study.disc().loads().first();
    let scale =
        load.map_or(1.0, |load| 2.0 * load.friction.abs().max(2.0 * load.damping)).max(1e-6);
    let mut panel = Panel::new(
        PlotAxis::new("speed").symbol("Ω").between(from, to),
        PlotAxis::new("friction").symbol("f*").between(0.0, scale),
    );
    let all = done.undithered.iter().chain(&done.dithered);
    for resonance in all.filter(|resonance| !resonance.pair_can_be_unstable()) {
        panel = panel.with(
            ReferenceLine::vertical(resonance.speed).role(PlotRole::Guide).style(LineStyle::Dotted),
        );
    }
    let frictions: Vec<f64> = (1..=EDGES).map(|k| scale * (k as f64 / EDGES as f64)).collect();
    panel = panel.with_all(tongues(study.disc(), RealInterval::new(from, to), &frictions, |f| f));
    if let Some(load) = load {
        panel = panel.with(
            ReferenceLine::horizontal(load.friction).role(PlotRole::Guide).label("this study"),
        );
        let growing = done.growing.iter().flatten().map(|growing| growing.speeds);
        let ends = growing
            .map(|speeds| [speeds.from, speeds.to].map(|x| PlotPoint::new(x, load.friction)));
        panel = panel.with(
            Polyline::pieces(PlotRole::Exact, ends).width(3.0).label("exactly, a motion grows"),
        );
    }
    Figure::single(panel.legend(Legend::Above))
        .size(Size::Frame(520.0, 320.0))
        .title(study.title().unwrap_or_default())
        .caption(format!(
            "{} Dotted: meetings of pairs of waves without a tongue at this order. Thick: speeds at which a motion grows exactly.",
            disc_caption(study)
        ))
}

/// Edges of the predicted tongues at these friction coefficients, as lines; `up` converts a friction coefficient to its position
/// on the axis. Under tangential dither, the tongues of the undithered disc are those that reappear at second order.
pub fn tongues(
    disc: &Disc,
    RealInterval { lower: from, upper: to }: RealInterval,
    frictions: &[f64],
    up: impl Fn(f64) -> f64,
) -> Vec<Layer> {
    let Ok(waves) = Waves::new(disc) else { return Vec::new() };
    let order = match disc.dither() {
        DiscDither::Tangential { .. } => Order::Second,
        DiscDither::None | DiscDither::Normal { .. } => Order::First,
    };
    let count = waves.undithered(from..=to).len() + waves.dithered(from..=to).len();
    let mut pieces: Vec<Vec<PlotPoint>> = vec![Vec::new(); 2 * count];
    // The theory applies to non-negative friction.
    for &friction in frictions.iter().filter(|friction| **friction >= 0.0) {
        let at = waves.with_friction(friction);
        let still = at.clone().with_order(order).undithered(from..=to);
        for (index, resonance) in still.iter().chain(&at.dithered(from..=to)).enumerate() {
            let Some(edges) = resonance.tongue.edges() else { continue };
            let near = |edge: &f64| (edge - resonance.speed).abs() < FAR * resonance.speed;
            if edges.iter().all(near) {
                for (side, edge) in edges.into_iter().enumerate() {
                    if let Some(piece) = pieces.get_mut(2 * index + side) {
                        piece.push(PlotPoint::new(edge, up(friction)));
                    }
                }
            }
        }
    }
    pieces.retain(|piece| piece.len() > 1);
    if pieces.is_empty() {
        return Vec::new();
    }
    let line = Polyline::pieces(PlotRole::Boundary, pieces).style(LineStyle::Dashed).width(0.8);
    vec![line.label("tongues, predicted").into()]
}
