//! The atlas: neutral damping over the belt's speed and the amplitude, up to the grazing.
//!
//! A belt is quiet where its damping is larger than that of the contour lines, and beyond the grazing.

use quell_design::atlas::{Atlas, AtlasLaw, AtlasPoint, NeutralDampings, RANGE, WAVEFORMS};
use quell_model::Waveform;

use super::caption::caption;
use super::undrawable;
use crate::complaint::Failure;
use crate::plot::{
    Colouring, Contours, Field, Figure, Heatmap, LineStyle, Marker, Palette, Panel, PlotAxis,
    PlotError, PlotRole, Points, Polyline, ReferenceLine, Shading, SharedLegend, Size,
};
use crate::run::atlas::AtlasFound;
use crate::study::BeltStudy;

/// Cells along each axis of a panel.
const CELLS: usize = 120;

/// Levels of κ_n that are drawn.
const LEVELS: [f64; 8] = [0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9];

/// Highest amplitude of a panel over the grazing at the largest speed.
const ABOVE: f64 = 1.05;

/// R and ζ_f/R of the picture without a study.
const OF_TABLES: (f64, f64) = (10.0, 0.01);

/// κ for which the picture without a study has the grazing.
const OF_GRAZING: f64 = 0.05;

/// Frame of a panel of the picture without a study (pixels).
const SMALL: Size = Size::Frame(230.0, 190.0);

/// Frame of the picture of a study (pixels).
const LARGE: Size = Size::Frame(400.0, 310.0);

/// Values of κ between which the grazing of one speed is interpolated: it is nearly √(1 + (2κζ_f/R)²) times that at κ = 0.
const DAMPINGS: [f64; 3] = [0.0, 0.5, 1.0];

/// Iterations for the share of the grazing amplitude, which depends on κ_n by a factor below 0.1.
const ITERATIONS: usize = 6;

/// One speed of a panel.
struct AtlasColumn {
    /// α/v_m at the grazing at [`DAMPINGS`].
    grazing: [f64; 3],
    neutral: NeutralDampings,
}

impl AtlasColumn {
    fn of(point: &AtlasPoint) -> Option<Self> {
        let at = |relative_damping| {
            let point = AtlasPoint { relative_damping, ..point.clone() };
            Some(Atlas::shipped().grazing_amplitude(&point)? / point.frequency_ratio)
        };
        let [first, middle, last] = DAMPINGS;
        Some(Self {
            grazing: [at(first)?, at(middle)?, at(last)?],
            neutral: Atlas::shipped().neutral_dampings(point)?,
        })
    }

    /// α/v_m at the grazing: the parabola through the three values.
    fn grazing(&self, kappa: f64) -> f64 {
        let [first, middle, last] = self.grazing;
        let kappa = 2.0 * kappa.clamp(0.0, 1.0);
        let bend = 0.5 * (last - 2.0 * middle + first);
        first + kappa * (middle - first) + kappa * (kappa - 1.0) * bend
    }

    /// κ_n at an amplitude α/v_m; `None` beyond the grazing.
    fn at(&self, amplitude: f64) -> Option<f64> {
        let mut kappa = 0.0;
        for _ in 0..ITERATIONS {
            kappa = self.neutral.at((amplitude / self.grazing(kappa)).min(1.0));
        }
        (amplitude <= self.grazing(kappa)).then_some(kappa)
    }
}

/// What a panel shows.
struct AtlasPanel<'a> {
    /// The groups; its speed is that of a study.
    point: &'a AtlasPoint,
    title: String,
    bar: bool,
}

impl AtlasPanel<'_> {
    /// κ_n, the contours and the grazing; and κ_n as a field.
    fn panel(&self) -> Result<(Panel, Field), PlotError> {
        let largest = self.point.law.largest_velocity();
        let (low, high) = RANGE.velocity_share;
        let part = |k: usize| (k as f64 + 0.5) / CELLS as f64;
        let speeds: Vec<f64> =
            (0..CELLS).map(|k| largest * (high - low).mul_add(part(k), low)).collect();
        let column = |speed: f64| {
            AtlasColumn::of(&AtlasPoint { relative_velocity: speed, ..self.point.clone() })
        };
        let columns: Option<Vec<AtlasColumn>> = speeds.iter().copied().map(column).collect();
        let ends: Option<Vec<AtlasColumn>> =
            [low, high].map(|end| column(end * largest)).into_iter().collect();
        let (Some(columns), Some(ends)) = (columns, ends) else {
            return Err(PlotError::Field { why: "the atlas lacks a table".to_owned() });
        };
        let kappa = self.point.relative_damping;
        let top = ABOVE * ends[1].grazing(kappa);
        let amplitudes = (0..CELLS).map(|k| top * part(k)).collect::<Vec<_>>();
        let field = Field::from_fn(speeds.clone(), amplitudes.clone(), |column, row| {
            columns[column].at(amplitudes[row])
        })?;
        let shading = Shading::new(Palette::Pale).range(0.0, 1.0);
        let mut map = Heatmap::new(field.clone(), Colouring::Shaded(shading));
        if self.bar {
            map = map.bar(PlotAxis::new("neutral damping").symbol("κ_n").between(0.0, 1.0));
        }
        let grazing =
            speeds.iter().zip(&columns).map(|(speed, column)| (*speed, column.grazing(kappa)));
        let line = [(low * largest, ends[0].grazing(kappa))]
            .into_iter()
            .chain(grazing)
            .chain([(high * largest, ends[1].grazing(kappa))]);
        let x =
            PlotAxis::new("belt speed").symbol("v_0/v_m").between(low * largest, high * largest);
        let y = PlotAxis::new("amplitude ratio").symbol("α/v_m").between(0.0, top);
        let panel = Panel::new(x, y)
            .title(self.title.as_str())
            .with(map.gap("beyond the grazing: quiet", |_, _| true))
            .with(Contours::new(field.clone(), LEVELS))
            .with(Polyline::new(PlotRole::Exact, line).width(2.0).label("grazing"));
        Ok((panel, field))
    }
}

/// One panel for each law and waveform.
///
/// # Errors
/// [`Failure::Failed`] for an atlas that lacks a table.
pub fn atlas_tables() -> Result<Figure, Failure> {
    let (frequency_ratio, per_cycle) = OF_TABLES;
    let mut panels = Vec::new();
    for law in AtlasLaw::ALL {
        for waveform in WAVEFORMS {
            let point = AtlasPoint {
                law,
                waveform: waveform.clone(),
                relative_damping: OF_GRAZING,
                relative_velocity: law.largest_velocity(),
                frequency_ratio,
                friction_damping: per_cycle * frequency_ratio,
            };
            let title = format!("{}, {}", law.name(), waveform.name());
            let bar = waveform == Waveform::Square;
            let panel = AtlasPanel { point: &point, title, bar }.panel();
            panels.push(panel.map_err(undrawable)?.0);
        }
    }
    Ok(Figure::grid(WAVEFORMS.len(), panels)
        .size(SMALL)
        .legend(SharedLegend::Below)
        .title("Exact thresholds of a belt under tangential dither")
        .caption(format!(
            "Damping $κ_n$ at which the base response is neutral, for $R$ = {frequency_ratio} and $ζ_f/R$ = {per_cycle}. A belt of the \
             damping $κ = ζ/ζ_f$ is quiet where $κ ≥ κ_n$, and beyond the grazing (drawn for $κ$ = {OF_GRAZING})."
        )))
}

/// The plane of a study, with its speed, its amplitude and its thresholds.
///
/// # Errors
/// [`Failure::Failed`] for an atlas that lacks a table.
pub fn atlas(study: &BeltStudy, found: &AtlasFound) -> Result<Figure, Failure> {
    let point = &found.answer.point;
    let ratio = point.frequency_ratio;
    let title = String::new();
    let (panel, field) = AtlasPanel { point, title, bar: true }.panel().map_err(undrawable)?;
    let speed = point.relative_velocity;
    let thresholds = found.answer.changes.iter().map(|change| (speed, change.amplitude / ratio));
    let own = found.own_amplitude / found.reference_velocity / ratio;
    let neutral = Contours::new(field, [point.relative_damping]).plain();
    let mut panel = panel.with(ReferenceLine::vertical(speed).style(LineStyle::Dotted)).with(
        neutral.role(PlotRole::Dithered).width(2.0).label("neutral at the damping of this study"),
    );
    let thresholds: Vec<(f64, f64)> = thresholds.collect();
    if !thresholds.is_empty() {
        let points = Points::new(PlotRole::Exact, thresholds).marker(Marker::Circle).size(7.0);
        panel = panel.with(points.label("thresholds of this study"));
    }
    let own = Points::new(PlotRole::Dithered, [(speed, own)]).marker(Marker::Disc).size(7.0);
    let panel = panel.with(own.label("this study"));
    let title = study.title().unwrap_or_default();
    Ok(Figure::grid(1, [panel])
        .size(LARGE)
        .legend(SharedLegend::Below)
        .title(title)
        .caption(format!("{}. {}", caption(study), found.sentence(study))))
}
