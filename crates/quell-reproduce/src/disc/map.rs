//! Figures 5.3 to 5.5 and 5.7 to 5.15: growth rate of the disc over speed and friction.
//!
//! The dissertation distinguishes only stable and unstable points. Here the growth rate is shown, with its zero contour, and
//! hatching where its sign is undetermined within its error. The speeds are those of the study's axis and additional ones near
//! every meeting of waves.

use quell_disc::resonance::{Order, Resonance, Waves};
use quell_linear::growth::Verdict;
use quell_model::Disc;
use quell_model::disc::DiscDither;
use quell_numerics::interval::RealInterval;

use super::super::caption::letter;
use super::super::failure::failed;
use super::super::product::{DataTable, Product};
use super::super::source::EntrySource;
use super::growth::{Growths, growths};
use super::zero_lines::{speeds_of_tongues, zero_lines};
use super::{FRICTION_PER_PRINTED, OPEN, STRENGTH_PER_PRINTED, study};
use quell::cite::Task;
use quell::complaint::Failure;
use quell::picture::{self, MapAxis, MapKind};
use quell::plot::{
    Figure, Legend, LineStyle, Panel, PlotAxis, PlotPoint, ReferenceLine, SharedLegend, Sharing,
    Size, Spread,
};
use quell::study::DiscStudy;
use quell::sweep::Grid;

/// Growth rates below this are drawn on a linear scale.
const LINEAR: f64 = 1e-5;
/// Frictions below the first of a linear axis, as fractions of it.
const LOW_FRICTIONS: [f64; 4] = [0.002, 0.03, 0.15, 0.5];
/// Number of frictions at which the edges of predicted tongues are evaluated.
const EDGES: usize = 80;

/// A meeting of two waves to be marked.
struct MeetingMark {
    label: String,
    speed: f64,
    /// Whether the pair has a tongue at the order of the theory.
    has_tongue: bool,
}

/// Every meeting of tables 5.1 and 5.2: of undithered waves, and those that dither induces.
fn marks(disc: &Disc, speeds: &[f64]) -> Vec<MeetingMark> {
    let (Some(&first), Some(&last)) = (speeds.first(), speeds.last()) else { return Vec::new() };
    let Ok(waves) = Waves::new(disc) else { return Vec::new() };
    // Counted from the slowest, as in tables 5.1 and 5.2; a disc at rest is no resonance.
    let numbered = |found: Vec<Resonance>, star: &str| -> Vec<MeetingMark> {
        let found = found.into_iter().filter(|resonance| resonance.speed > 0.0);
        let mark = |(index, resonance): (usize, Resonance)| MeetingMark {
            label: format!("$Ω_{{{}}}{star}$", index + 1),
            speed: resonance.speed,
            has_tongue: resonance.pair_can_be_unstable(),
        };
        found.enumerate().map(mark).collect()
    };
    let order = match disc.dither() {
        DiscDither::Tangential { .. } => Order::Second,
        DiscDither::None | DiscDither::Normal { .. } => Order::First,
    };
    let mut marks = numbered(waves.clone().with_order(order).undithered(0.0..=last), "");
    marks.extend(numbered(waves.dithered(0.0..=last), "^*"));
    marks.retain(|mark| mark.speed >= first);
    marks
}

/// The axes of a study: speeds, including those near meetings of waves, and frictions.
fn axes(source: &EntrySource, study: &DiscStudy) -> Result<[Vec<f64>; 2], Failure> {
    let grid = Grid::of(study)?;
    let values = |path: &str| {
        let axis = grid.axes().iter().find(|axis| axis.path == path);
        axis.map(|axis| axis.values.clone())
            .ok_or_else(|| failed(source.name, &"an axis is missing"))
    };
    Ok([values("disc.load.speed")?, values("disc.load.friction")?])
}

/// Figures 5.3 to 5.5: two sizes of mass, damper and spring, no dither.
pub(crate) fn sizes(source: &EntrySource) -> Result<Product, Failure> {
    let small = format!("{}", 0.01 * STRENGTH_PER_PRINTED);
    let first = study(source, &[])?;
    let [_, frictions] = axes(source, &first)?;
    let ends = [frictions[0], frictions[frictions.len() - 1]].map(|friction| 0.1 * friction);
    let changes = [
        format!("disc.load.mass={small}"),
        format!("disc.load.damping={small}"),
        format!("disc.load.stiffness={small}"),
        format!("sweep[1].from={}", ends[0]),
        format!("sweep[1].to={}", ends[1]),
    ];
    let changes = if source.has_own_axis(1) { &changes[..3] } else { &changes[..] };
    let second = study(source, &changes.iter().map(String::as_str).collect::<Vec<_>>())?;
    let studies = [(first.clone(), first.disc().clone()), (second.clone(), second.disc().clone())];
    let modes = first.disc().modes().len();
    let shows = format!(
        "Growth rate of the undithered disc over speed and friction, {modes} modes, {}; dark red: growth, pale blue: decay, with the \
         exact line of zero growth. Speeds are in units of the lowest critical speed of this set of modes.",
        if source.is_own() {
            "(a) the load of the study, (b) a mass, damper and spring of 0.01 as printed"
        } else {
            "(a) $m$ = $c$ = $k$ = 0.1, (b) 0.01 as printed"
        }
    );
    let print =
        format!("The unit of speed changes by a factor of 1.188 from $N_θ$ = 2 to 5. {OPEN}");
    let caption = source.caption(&shows, &print);
    let first = if source.is_own() { "load of the study" } else { "$m$ = $c$ = $k$ = 0.1" };
    draw(source, &studies, [first, "$m$ = $c$ = $k$ = 0.01"], caption)
}

/// Figures 5.7 to 5.15: growth rate without and with dither.
pub(crate) fn figure(source: &EntrySource) -> Result<Product, Failure> {
    let study = study(source, &[])?;
    let disc = study.disc();
    let studies = [(study.clone(), disc.undithered()), (study.clone(), disc.clone())];
    let (kind, ratio) = match disc.dither() {
        DiscDither::Normal { frequency_ratio, .. } => ("normal", frequency_ratio),
        DiscDither::Tangential { frequency_ratio, .. } => ("tangential", frequency_ratio),
        DiscDither::None => ("no", 0.0),
    };
    let revived = match disc.dither() {
        DiscDither::Tangential { .. } => "; in (b) those of table 5.1 as revived at second order",
        DiscDither::Normal { .. } | DiscDither::None => "",
    };
    let printed = disc.loads().first().map_or(0.0, |load| load.mass / STRENGTH_PER_PRINTED);
    let damping = disc.modal_damping().unwrap_or(0.0);
    let amplitude = match disc.dither() {
        DiscDither::None => 1.0,
        dither => dither.mean_and_amplitude().1,
    };
    let load = match disc.loads().first() {
        Some(load) if source.is_own() => format!(
            "$m$ = {}, $c$ = {}, $k$ = {} of the plate's mass",
            load.mass, load.damping, load.stiffness
        ),
        _ => format!("$m$ = $c$ = $k$ = {printed:.1} as printed"),
    };
    let shows = format!(
        "Growth rate of the disc over speed and friction, (a) without dither, (b) with {kind} dither, $α$ = {amplitude}, $R$ \
         = {ratio}; {load}, $ξ$ = {damping}; dark red: growth, pale blue: decay, with the exact line of zero growth. Dashed: tongues \
         by first-order theory{revived}; vertical lines: meetings of waves, dotted where no pair of waves has a tongue at this order."
    );
    let caption = source.caption(&shows, OPEN);
    draw(source, &studies, ["without dither", "with dither"], caption)
}

fn draw(
    source: &EntrySource,
    studies: &[(DiscStudy, Disc); 2],
    titles: [&str; 2],
    caption: String,
) -> Result<Product, Failure> {
    let columns = [
        ("panel", "1"),
        ("speed", "ω_ref"),
        ("friction", "1"),
        ("friction_as_printed", "1"),
        ("growth_rate", "ω_ref"),
        ("growth_rate_error", "ω_ref"),
        ("verdict", "1"),
    ];
    let mut table = DataTable::new("", &columns);
    let mut panels = Vec::new();
    for (index, (study, disc)) in studies.iter().enumerate() {
        let [speeds, frictions] = axes(source, study)?;
        let frictions = with_low_frictions(frictions);
        let ends = RealInterval::new(frictions[0], frictions[frictions.len() - 1]);
        let speeds = speeds_of_tongues(source.name, disc, speeds, ends)?;
        let done = growths(source.name, disc, speeds, frictions)?;
        let name = letter(index).to_string();
        let mut values = done.values.iter();
        for speed in &done.speeds {
            for (friction, growth) in done.frictions.iter().zip(values.by_ref()) {
                table.row([
                    name.as_str().into(),
                    (*speed).into(),
                    (*friction).into(),
                    (friction / FRICTION_PER_PRINTED).into(),
                    growth.rate.into(),
                    growth.error.into(),
                    growth.verdict().name().into(),
                ]);
            }
        }
        let zero = zero_lines(source.name, &done, disc)?;
        let panel =
            panel(&done, disc, zero, index == 1).map_err(|why| failed(source.name, &why))?;
        panels.push(panel.title(format!("({name}) {}", titles[index])).legend(Legend::None));
    }
    let figure = Figure::grid(2, panels)
        .sharing_x(Sharing::Aligned)
        .legend(SharedLegend::Below)
        .size(Size::Frame(390.0, 280.0));
    let study = &studies[0].0;
    Ok(Product::about(figure, caption, study).by(&[Task::Stability]).table(table))
}

/// Whether frictions are spaced by a ratio.
fn is_logarithmic(frictions: &[f64]) -> bool {
    frictions.len() > 2 && (frictions[1] / frictions[0] - frictions[2] / frictions[1]).abs() < 1e-6
}

/// Equally spaced frictions with smaller ones below the first, so that tongues are seen to begin at zero.
fn with_low_frictions(frictions: Vec<f64>) -> Vec<f64> {
    let Some(&first) = frictions.first().filter(|_| !is_logarithmic(&frictions)) else {
        return frictions;
    };
    LOW_FRICTIONS.iter().map(|share| share * first).chain(frictions).collect()
}

fn panel(
    done: &Growths,
    disc: &Disc,
    zero: Vec<Vec<PlotPoint>>,
    bar: bool,
) -> Result<Panel, quell::plot::PlotError> {
    let logarithmic =
        is_logarithmic(&done.frictions[done.frictions.len().min(LOW_FRICTIONS.len())..]);
    // Printed f in units of 10⁻⁴.
    let unit = 1e4 / FRICTION_PER_PRINTED;
    let across = PlotAxis::new("speed").symbol("Ω").log();
    let up = PlotAxis::new("friction as printed").symbol("f").unit("10⁻⁴");
    let up = if logarithmic { up.log() } else { up };
    let ends = (done.speeds.first(), done.speeds.last());
    let over = match (ends, done.frictions.last()) {
        ((Some(from), Some(to)), Some(high)) => {
            let low = done.frictions.first().copied().unwrap_or(0.0).max(1e-3 * high);
            let step = |k: usize| libm::pow(high / low, k as f64 / (EDGES - 1) as f64);
            let frictions: Vec<f64> = (0..EDGES).map(|k| low * step(k)).collect();
            picture::disc::tongues(disc, RealInterval::new(*from, *to), &frictions, |f| f * unit)
        }
        _ => Vec::new(),
    };
    let mut over = over;
    over.extend(marks(disc, &done.speeds).into_iter().map(|mark| {
        let style = if mark.has_tongue { LineStyle::Dashed } else { LineStyle::Dotted };
        ReferenceLine::vertical(mark.speed).label(mark.label).style(style).into()
    }));
    let zero = zero.into_iter().map(|line| {
        line.into_iter()
            .map(|PlotPoint { x: speed, y: friction }| PlotPoint::new(speed, friction * unit))
            .collect()
    });
    let map = picture::MappedQuantity {
        zero: Some(zero.collect()),
        axes: vec![
            MapAxis { axis: across, values: done.speeds.clone() },
            MapAxis { axis: up, values: done.frictions.iter().map(|f| f * unit).collect() },
        ],
        quantity: PlotAxis::new("growth rate").symbol("Re ρ"),
        kind: MapKind::Growth(Spread::SignedLog(LINEAR)),
        values: done
            .values
            .iter()
            .map(|growth| match growth.verdict() {
                Verdict::Undecided => Err(0),
                _ => Ok(growth.rate),
            })
            .collect(),
        reasons: vec!["undecided: zero within its error".to_owned()],
        over,
    };
    picture::map_panel(&map, bar)
}
