//! A manoeuvre: drive, load, dither, response and spectrogram over one time axis.

use std::f64::consts::TAU;

use quell_dynamics::motion::MotionSampler;
use quell_model::profile::{Knots, Wave};
use quell_model::system::{InputTarget, Mechanical};
use quell_model::units::Quantity;
use quell_model::{Input, Profile, System};
use quell_numerics::interval::RealInterval;

use super::ruler::Ruler;
use crate::plot::{
    Colouring, Field, Heatmap, Palette, Panel, PlotAxis, PlotPoint, PlotRole, Polyline, Shading,
    Spread,
};
use crate::run::manoeuvre::{SampledMotion, Spectrogram};
use crate::run::system::periods::natural_period;
use crate::study::SystemStudy;

/// Points of a curve of a profile.
const POINTS: usize = 600;

/// Curves in a panel of drives, loads or envelopes.
const MOST_CURVES: usize = 6;

/// Decades of the spectrogram below its largest amplitude.
const DECADES: f64 = 1e-4;

/// A spectrogram over an axis of time.
fn heatmap(
    found: &Spectrogram,
    axis: PlotAxis,
    (time, frequency, amplitude): (&Ruler, &Ruler, &Ruler),
) -> Option<Panel> {
    let largest = found.largest();
    let (columns, least) = (found.times.len(), DECADES * largest);
    let field = Field::from_fn(
        found.times.iter().map(|at| time.place(*at)).collect(),
        found.frequencies.iter().map(|at| frequency.place(*at)).collect(),
        |column, row| Some(amplitude.place(found.amplitudes[row * columns + column].max(least))),
    );
    let shading = Shading::new(Palette::Pale)
        .spread(Spread::Log)
        .range(amplitude.place(least), amplitude.place(largest));
    let bar = amplitude.axis("spectral amplitude", "").log();
    let grid = Heatmap::new(field.ok()?, Colouring::Shaded(shading)).bar(bar);
    Some(Panel::new(axis, frequency.axis("frequency", "")).with(grid))
}

/// The load of a contact, if it varies: its own, or the constant one with what guides add to it over time.
fn load_over_time(system: &System, place: usize) -> Option<Profile> {
    let contact = system.contacts.get(place)?;
    let added = system.inputs.iter().find(|input| {
        let on = matches!(input.target, InputTarget::NormalLoad { contact, reaction: false } if contact == place);
        on && !input.profile.is_steady()
    });
    let whole =
        |input: &Input| input.profile.clone().about(input.profile.mean() + contact.normal_load);
    contact.varying_load.clone().or_else(|| added.map(whole))
}

/// Panels above the response of a system whose drives, loads or dithers vary in time, and the spectrogram below it.
pub(super) fn around_response(
    study: &SystemStudy,
    samples: &MotionSampler,
    displacement: &[f64],
    (axis, time): (&PlotAxis, &Ruler),
) -> (Vec<Panel>, Option<Panel>) {
    let system = study.system();
    let (from, to) = match (samples.times.first(), samples.times.last()) {
        (Some(from), Some(to)) if from < to => (*from, *to),
        _ => return (Vec::new(), None),
    };
    let curve = |profile: &Profile, ruler: &Ruler| -> Vec<PlotPoint> {
        let moment = |place: usize| from + (to - from) * place as f64 / (POINTS - 1) as f64;
        (0..POINTS)
            .map(moment)
            .map(|at| PlotPoint::new(time.place(at), ruler.place(profile.value(at))))
            .collect()
    };
    let panel = |name: &str, quantity: Quantity, profiles: &[(String, Profile)]| {
        let largest = profiles
            .iter()
            .flat_map(|(_, profile)| [profile.bounds().lower, profile.bounds().upper]);
        let ruler = Ruler::new(study, quantity, largest);
        let lines = profiles.iter().enumerate().map(|(place, (label, profile))| {
            Polyline::new(PlotRole::Series(place), curve(profile, &ruler)).label(label.clone())
        });
        let panel = Panel::new(axis.clone(), ruler.axis(name, ""));
        (!profiles.is_empty()).then(|| panel.with_all(lines.collect::<Vec<_>>()))
    };
    let contacts = || system.contacts.iter().take(MOST_CURVES);
    let speed = system.structure.mechanical().and_then(Mechanical::by_speed);
    let speeds: Vec<(String, Profile)> =
        speed.map(|by_speed| ("$Ω$".to_owned(), by_speed.speed.clone())).into_iter().collect();
    // The surface of every load has the speed of the disc.
    let moved = contacts().take(if speed.is_some() { 0 } else { MOST_CURVES });
    let drives: Vec<(String, Profile)> = moved
        .filter(|contact| {
            contact.surface_velocity != Profile::constant(contact.surface_velocity.mean())
        })
        .map(|contact| (contact.name.clone(), contact.surface_velocity.clone()))
        .collect();
    let loads: Vec<(String, Profile)> = contacts()
        .enumerate()
        .filter_map(|(place, contact)| Some((contact.name.clone(), load_over_time(system, place)?)))
        .collect();
    let dithers: Vec<(String, Profile)> = system
        .inputs
        .iter()
        .take(MOST_CURVES)
        .enumerate()
        .filter_map(|(place, input)| {
            let envelope = input.profile.waves().first()?.envelope.clone();
            let envelope = envelope.filter(|envelope| !Knots::is_constant(envelope))?;
            Some((format!("dither {}", place + 1), Profile::over(envelope)))
        })
        .collect();
    let above = [
        panel("speed of the disc", Quantity::FrequencyRatio, &speeds),
        panel("belt velocity", Quantity::Velocity, &drives),
        panel("normal load", Quantity::Force, &loads),
        panel("share of the amplitude", Quantity::Ratio, &dithers),
    ];
    let step = (to - from) / (samples.times.len() - 1) as f64;
    let motion = SampledMotion { start: from, step, displacement };
    let period = natural_period(study, RealInterval::new(from, to));
    let own = TAU / period;
    let fastest = system.waves().map(Wave::repetition).fold(0.0, f64::max);
    let highest = if fastest <= 40.0 * own { (1.25 * fastest).max(6.0 * own) } else { 8.0 * own };
    let spectrogram = Spectrogram::of(motion, period, highest).and_then(|found| {
        let frequency =
            Ruler::new(study, Quantity::FrequencyRatio, found.frequencies.iter().copied());
        let amplitude = Ruler::new(study, Quantity::Displacement, [found.largest()]);
        heatmap(&found, axis.clone(), (time, &frequency, &amplitude))
    });
    (above.into_iter().flatten().collect(), spectrogram)
}
