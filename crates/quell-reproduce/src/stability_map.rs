//! Figures 2.6, 2.7, 3.5, 3.6, 4.7, 4.8: the region of the (α, v₀) plane in which averaged steady sliding is unstable.
//!
//! At each α the unstable band extends from v₀ = αG_max to the upper edge of (3.43)–(3.59), in closed form. The map for normal
//! dither is the same with (α_T, v₀) → (α_T/μ(v₀), v₀), the substitution of (4.33)–(4.42). Also drawn are the boundary by
//! finite-R averaging, with the oscillator's own response at the study's R instead of αG (for a sine α = DR/(R² − 1)), and the
//! upper edge as printed for the triangle, (3.47), (4.35), where it is wrong.

use quell_linear::averaging::{
    Averaging, EverywhereStable, FastWave, NoBand, closed_band, everywhere_stable_amplitude,
    unstable_bands,
};
use quell_model::{Belt, Direction, Dither, Friction, LawKind, Waveform};

use super::axis::values;
use super::caption::{law_name, letter, parameters, waveform_name};
use super::failure::failed;
use super::printed_formulas::{self, LawNumbers};
use super::product::{DataTable, Product};
use super::source::EntrySource;
use quell::cite::Task;
use quell::complaint::Failure;
use quell::plot::{
    Figure, Legend, LineStyle, Note, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline,
    ReferenceLine, Region, SharedLegend, Sharing, Size,
};
use quell::study::BeltStudy;

/// Points on an edge.
const POINTS: u32 = 240;
/// Points on an edge that requires quadrature.
const FEWER_POINTS: u32 = 48;

/// A curve of (α, v₀).
type EdgeCurve = Vec<PlotPoint>;

/// The plane of one panel.
struct StabilityPlane<'a> {
    source: &'a EntrySource,
    belt: &'a Belt,
    waveform: Waveform,
    direction: Direction,
    /// Largest α and v₀ shown.
    reach: PlotPoint,
}

/// An unstable region: its edges from α = 0, and its tip.
struct Unstable {
    damping_ratio: f64,
    lower: EdgeCurve,
    upper: EdgeCurve,
    /// (α^L, α^L G_max), if it exists.
    tip: Option<PlotPoint>,
}

/// Figures 2.6 and 2.7: one waveform, one damping ratio.
pub(super) fn single(source: &EntrySource) -> Result<Product, Failure> {
    let study = source.study()?;
    let mut table = empty_table();
    let panel = panel(source, &study, study.belt().dithers()[0].waveform.clone(), &mut table)?;
    let ratios = damping_ratios(source, &study)?;
    let damping: Vec<String> = ratios.iter().map(f64::to_string).collect();
    let opening = opening(&study, lightest(&ratios));
    let shows = format!("{opening} $ζ$ = {}, {}.", damping.join(", "), parameters(&study));
    let caption = source.caption(&shows, &closing(&study, false));
    Ok(Product::new(Figure::single(panel), caption, &study).by(&[Task::Stability]).table(table))
}

/// Figures 3.5, 3.6, 4.7, 4.8: three waveforms, three damping ratios.
pub(super) fn three(source: &EntrySource) -> Result<Product, Failure> {
    let study = source.study()?;
    let mut table = empty_table();
    let mut panels = Vec::new();
    let studies = source.with_waveforms()?;
    for (index, (waveform, study)) in studies.iter().enumerate() {
        let title = format!("({}) {}", letter(index), waveform_name(waveform.clone()));
        panels.push(
            panel(source, study, waveform.clone(), &mut table)?.title(title).legend(Legend::None),
        );
    }
    let ratios = damping_ratios(source, &study)?;
    let damping: Vec<String> = ratios.iter().map(f64::to_string).collect();
    let opening = opening(&study, lightest(&ratios));
    let shows = format!("{opening} $ζ$ = {}; {}.", damping.join(", "), parameters(&study));
    let caption = source.caption(&shows, &closing(&study, true));
    let figure = Figure::grid(panels.len().clamp(1, 3), panels)
        .sharing_x(Sharing::All)
        .sharing_y(Sharing::All)
        .legend(SharedLegend::Below)
        .size(Size::Frame(270.0, 250.0));
    let product =
        Product::new(figure, caption, &study).also(studies.iter().map(|(_, study)| study));
    Ok(product.by(&[Task::Stability]).table(table))
}

/// Path of the family of damping ratios.
pub(super) const DAMPING: &str = "belt.damping_ratio";

/// The damping ratios of the curves: one's own, those of the study's axis, or that of the belt.
fn damping_ratios(source: &EntrySource, study: &BeltStudy) -> Result<Vec<f64>, Failure> {
    let own = source
        .family(DAMPING, &[])
        .iter()
        .map(|value| Ok(source.changed(&[&format!("{DAMPING}={value}")])?.belt().damping_ratio()))
        .collect::<Result<Vec<f64>, Failure>>()?;
    if !own.is_empty() {
        return Ok(own);
    }
    let of_the_axis = values(study, DAMPING);
    Ok(if of_the_axis.is_empty() { vec![study.belt().damping_ratio()] } else { of_the_axis })
}

/// The damping ratio of the last curve, for which finite-R averaging is drawn too.
fn lightest(damping: &[f64]) -> f64 {
    damping.last().copied().unwrap_or_default()
}

fn opening(study: &BeltStudy, damping_ratio: f64) -> String {
    let dither = study.belt().dithers()[0].clone();
    format!(
        "Stability map with the {} law and {} dither: in the shaded region averaged steady sliding is unstable, \
         2$ζ$ + $F$ d$\\bar{{μ}}$/d$v$ < 0. Dash-dotted: the boundary at $R$ = {} and $ζ$ = {} with the exact fast motion of the \
         oscillator instead of $αG$ (for a sine, $α$ = $DR$/($R^2$ − 1)).",
        law_name(study.belt().friction().kind()),
        dither.direction.name(),
        dither.frequency_ratio,
        damping_ratio,
    )
}

/// Additions to the figure of the dissertation, and departures from it.
fn closing(study: &BeltStudy, three: bool) -> String {
    let belt = study.belt();
    let dither = belt.dithers()[0].clone();
    let normal = dither.direction == Direction::Normal;
    let stribeck = belt.friction().kind() == LawKind::Stribeck;
    let ratio = dither.frequency_ratio;
    let mut sentences: Vec<String> = Vec::new();
    if three && stribeck {
        let equation = if normal { "(4.35)" } else { "(3.47)" };
        sentences.push(format!(
            "Dotted in (b): the upper edge as printed {equation}, with π²/48 instead of π²/30."
        ));
    }
    if normal {
        sentences.push(format!(
            "$α_N$ = $D_N$/$R_N$ cannot exceed $F$/$R_N$ (4.29), marked for $R_N$ = {ratio}; $α$ of chapter 3 is \
             replaced by $μ$($v_0$)$α_N$."
        ));
    }
    if normal && stribeck {
        sentences.push(
            "For the square, $α^L$ is half of (4.38), which repeats (4.36) of the triangle."
                .to_owned(),
        );
    }
    if !stribeck && !normal && !three {
        let wave = FastWave::Integral(dither.waveform);
        let (law, load) = (belt.friction(), belt.normal_load());
        let tip =
            everywhere_stable_amplitude(law, belt.damping_ratio(), load, wave, dither.direction);
        if let Ok(EverywhereStable::From { amplitude_ratio, .. }) = tip {
            sentences.push(format!("The band closes only at $α^L$ = {amplitude_ratio:.0}."));
        }
    }
    if !stribeck && !normal {
        sentences.push(
            "Stability is local: a stick-slip cycle can coexist with stable sliding.".to_owned(),
        );
    }
    sentences.join(" ")
}

fn empty_table() -> DataTable {
    DataTable::new(
        "",
        &[
            ("waveform", "1"),
            ("damping_ratio", "1"),
            ("curve", "1"),
            ("amplitude_ratio", "length (velocity/ω0)"),
            ("belt_velocity", "length (velocity/ω0)"),
        ],
    )
}

fn panel(
    source: &EntrySource,
    study: &BeltStudy,
    waveform: Waveform,
    table: &mut DataTable,
) -> Result<Panel, Failure> {
    let belt = study.belt();
    let dither = belt.dithers()[0].clone();
    let last = |path: &str| values(study, path).last().copied();
    let velocity = last("belt.belt_velocity").unwrap_or(1.0);
    let normal = dither.direction == Direction::Normal;
    let alpha = match (normal, belt.friction().kind()) {
        (false, _) => last("dither.amplitude").unwrap_or(1.0) / dither.frequency_ratio,
        // The printed axis extends beyond the limit of a closed contact.
        (true, LawKind::Stribeck) => 0.8,
        (true, _) => 6.0,
    };
    let plane = StabilityPlane {
        source,
        belt,
        waveform,
        direction: dither.direction,
        reach: PlotPoint::new(alpha, velocity),
    };
    let damping = damping_ratios(source, study)?;
    let symbol = if normal { "α_N" } else { "α_T" };
    let mut panel = Panel::new(
        PlotAxis::new("dither amplitude").symbol(symbol).between(0.0, alpha),
        PlotAxis::new("belt velocity").symbol("v_0").between(0.0, velocity),
    );
    let regions: Result<Vec<Unstable>, Failure> =
        damping.iter().map(|&zeta| plane.unstable(zeta)).collect();
    let regions = regions?;
    let lone = regions.len() == 1;
    for region in &regions {
        panel = panel.with(Region::between(
            PlotRole::Unstable,
            region.lower.clone(),
            region.upper.clone(),
        ));
    }
    for (index, region) in regions.iter().enumerate() {
        let role = if lone { PlotRole::Boundary } else { PlotRole::Series([1, 2, 0][index % 3]) };
        let label =
            if lone { "averaging".to_owned() } else { format!("$ζ$ = {}", region.damping_ratio) };
        panel = panel.with(
            Polyline::pieces(role, [region.lower.clone(), region.upper.clone()]).label(label),
        );
        plane.record(table, region.damping_ratio, "lower", &region.lower);
        plane.record(table, region.damping_ratio, "upper", &region.upper);
    }
    panel = plane.finite_r(panel, lightest(&damping), table)?;
    panel = plane.printed(panel, &damping, table);
    panel = plane.tips(panel, &regions, lone);
    Ok(plane.words(panel, &regions))
}

impl StabilityPlane<'_> {
    fn law(&self) -> &Friction {
        self.belt.friction()
    }

    /// α of the axis for the tangential α at v₀.
    fn along(&self, alpha: f64, v: f64) -> PlotPoint {
        match self.direction {
            Direction::Tangential => PlotPoint::new(alpha, v),
            Direction::Normal => PlotPoint::new(alpha / self.law().coefficient(v), v),
        }
    }

    /// Largest tangential α that the axis shows.
    fn largest(&self) -> f64 {
        match self.direction {
            Direction::Tangential => self.reach.x,
            Direction::Normal => self.reach.x * self.law().static_coefficient(),
        }
    }

    fn unstable(&self, damping_ratio: f64) -> Result<Unstable, Failure> {
        let load = self.belt.normal_load();
        let wave = FastWave::Integral(self.waveform.clone());
        let tip = self.tip(damping_ratio, wave.clone())?;
        let end = tip.unwrap_or(f64::INFINITY).min(self.largest());
        let mut region = Unstable {
            damping_ratio,
            lower: Vec::new(),
            upper: Vec::new(),
            tip: tip.map(|alpha| self.along(alpha, alpha * wave.peak())),
        };
        for k in 0..=POINTS {
            let alpha = end * f64::from(k) / f64::from(POINTS);
            match closed_band(self.law(), damping_ratio, load, &self.waveform, alpha) {
                Ok(band) => {
                    region.lower.push(self.along(alpha, band.lower));
                    // Without an upper edge the band extends beyond the plane.
                    region.upper.push(self.along(alpha, band.upper.unwrap_or(10.0 * self.reach.y)));
                }
                Err(NoBand::Stable) => {}
                Err(why) => return Err(failed("figure", &why)),
            }
        }
        if let Some(tip) = region.tip.filter(|_| end < self.largest()) {
            region.lower.push(tip);
            region.upper.push(tip);
        }
        Ok(region)
    }

    /// The boundary by finite-R averaging: with the oscillator's own response instead of αG.
    fn finite_r(
        &self,
        panel: Panel,
        damping_ratio: f64,
        table: &mut DataTable,
    ) -> Result<Panel, Failure> {
        let ratio = self.belt.dithers()[0].frequency_ratio;
        let edges = if self.waveform == Waveform::Sine {
            // The same curves with α scaled down.
            let region = self.unstable(damping_ratio)?;
            let shorter = (ratio * ratio - 1.0) / (ratio * ratio);
            [region.lower, region.upper].map(|curve| {
                curve
                    .into_iter()
                    .map(|PlotPoint { x: alpha, y: v }| PlotPoint::new(alpha * shorter, v))
                    .collect::<EdgeCurve>()
            })
        } else {
            self.oscillator_edges(damping_ratio, ratio)?
        };
        self.record(table, damping_ratio, "lower_oscillator", &edges[0]);
        self.record(table, damping_ratio, "upper_oscillator", &edges[1]);
        let line = Polyline::pieces(PlotRole::Exact, edges).style(LineStyle::DashDotted).width(0.9);
        Ok(panel.with(line.label(format!("exact fast motion, $R$ = {ratio}"))))
    }

    /// Edges of the bands for the response of the oscillator to a triangle or square, by quadrature.
    fn oscillator_edges(&self, damping_ratio: f64, ratio: f64) -> Result<[EdgeCurve; 2], Failure> {
        let load = self.belt.normal_load();
        let wave = FastWave::Oscillator { waveform: self.waveform.clone(), frequency_ratio: ratio };
        let tip = self.tip(damping_ratio, wave.clone())?;
        let end = tip.unwrap_or(f64::INFINITY).min(self.largest());
        let options = Averaging::FiniteR;
        let mut edges: [EdgeCurve; 2] = Default::default();
        for k in 0..=FEWER_POINTS {
            let alpha = end * f64::from(k) / f64::from(FEWER_POINTS);
            let dither = Dither {
                direction: Direction::Tangential,
                waveform: self.waveform.clone(),
                amplitude: alpha * ratio,
                frequency_ratio: ratio,
                phase: 0.0,
                envelope: None,
            };
            let belt = Belt::new(damping_ratio, load, 1.0, self.law().clone(), vec![dither])
                .map_err(|_| failed(self.source.name, &"a belt of the map is not valid"))?;
            let bands =
                unstable_bands(&belt, options).map_err(|error| failed(self.source.name, &error))?;
            let Some(band) = bands.last() else { break };
            edges[0].push(self.along(alpha, band.lower));
            edges[1].push(self.along(alpha, band.upper.unwrap_or(10.0 * self.reach.y)));
        }
        if let Some(alpha) = tip.filter(|tip| *tip < self.largest()) {
            let tip = self.along(alpha, alpha * wave.peak());
            for edge in &mut edges {
                edge.push(tip);
            }
        }
        Ok(edges)
    }

    /// α^L of tangential dither; `None` where it does not exist.
    fn tip(&self, damping_ratio: f64, wave: FastWave) -> Result<Option<f64>, Failure> {
        let load = self.belt.normal_load();
        let everywhere = everywhere_stable_amplitude(
            self.law(),
            damping_ratio,
            load,
            wave,
            Direction::Tangential,
        );
        Ok(match everywhere.map_err(|error| failed(self.source.name, &error))? {
            EverywhereStable::From { amplitude_ratio, .. } => Some(amplitude_ratio),
            EverywhereStable::Always => Some(0.0),
            EverywhereStable::Never { .. } => None,
        })
    }

    /// The upper edge as printed for the Stribeck law and a triangle, up to the printed α^L.
    fn printed(&self, panel: Panel, damping: &[f64], table: &mut DataTable) -> Panel {
        let is_printed = self.waveform == Waveform::Triangle
            && self.law().kind() == LawKind::Stribeck
            && !self.source.is_own();
        if !is_printed {
            return panel;
        }
        let numbers = LawNumbers::DISSERTATION;
        let mut pieces = Vec::new();
        for &zeta in damping {
            let end = printed_formulas::everywhere_348(numbers, zeta);
            let edge: EdgeCurve = (0..=POINTS)
                .map(|k| end * f64::from(k) / f64::from(POINTS))
                .map(|alpha| {
                    self.along(alpha, printed_formulas::upper_edge_347(numbers, zeta, alpha))
                })
                .collect();
            self.record(table, zeta, "upper_printed", &edge);
            pieces.push(edge);
        }
        let equation = if self.direction == Direction::Normal { "(4.35)" } else { "(3.47)" };
        let line = Polyline::pieces(PlotRole::Printed, pieces).style(LineStyle::Dotted).width(1.1);
        panel.with(line.label(format!("as printed {equation}")))
    }

    /// Marks α^L where it is inside the plane.
    fn tips(&self, mut panel: Panel, regions: &[Unstable], lone: bool) -> Panel {
        let shown = |tip: &PlotPoint| tip.x <= self.reach.x && tip.y <= self.reach.y;
        let tips: EdgeCurve =
            regions.iter().filter_map(|region| region.tip).filter(shown).collect();
        if tips.is_empty() {
            return panel;
        }
        if lone {
            let alpha = tips[0].x;
            panel = panel.with(ReferenceLine::vertical(alpha).label(format!("$α^L$ = {alpha:.4}")));
        }
        panel.with(Points::new(PlotRole::Boundary, tips).label("$α^L$"))
    }

    /// Labels "stable" and "unstable", and the limit (4.29).
    fn words(&self, mut panel: Panel, regions: &[Unstable]) -> Panel {
        let stribeck = self.law().kind() == LawKind::Stribeck;
        // In the wide part of the region of lightest damping.
        if let Some(region) = regions.last().filter(|region| !region.lower.is_empty()) {
            let v = if stribeck { 0.75 } else { 0.85 } * region.upper[0].y;
            let edge = region.lower.iter().take_while(|point| point.y < v).last();
            panel = panel.with(Note::new(0.5 * edge.map_or(0.0, |point| point.x), v, "unstable"));
        }
        let above = if stribeck { 0.55 } else { 0.3 };
        for (alpha, v) in [(0.65, 0.1), (above, 0.93)] {
            panel = panel.with(Note::new(alpha * self.reach.x, v * self.reach.y, "stable"));
        }
        if self.direction == Direction::Normal {
            let limit = self.belt.normal_load() / self.belt.dithers()[0].frequency_ratio;
            panel = panel.with(ReferenceLine::vertical(limit).label("$F$/$R_N$"));
        }
        panel
    }

    fn record(&self, table: &mut DataTable, damping_ratio: f64, curve: &str, points: &EdgeCurve) {
        for &PlotPoint { x: alpha, y: v } in points {
            table.row([
                self.waveform.name().into(),
                damping_ratio.into(),
                curve.into(),
                alpha.into(),
                v.into(),
            ]);
        }
    }
}
