//! What each source is used for: the one list behind `quell cite`.

use quell_model::{Contact, Direction, LawKind};

use super::citation::{Citation, Task};
use super::cited_study::CitedStudy;
use super::correction::DiscKind;
use super::references::{
    ARMSTRONG_HELOUVRY_1994, CANUDAS_DE_WIT_1995, CHAN_1994, CUNEFARE_GRAF_2002,
    DAS_SAIKI_SANDER_YORKE_2017, FILIPPOV_1988, GELB_VANDER_VELDE_1968, HAIRER_NORSETT_WANNER_1993,
    HARRIS_1978, HOFFMANN_2002, IWAN_STAHL_1973, JORBA_ZOU_2005, MENCK_2013, MICHAUX_2005,
    NAYFEH_MOOK_1979, STEELE_2014, Source, TAKAHASHI_IMADA_1984, THOMSEN_1999, THOMSEN_FIDLIN_2003,
    VOGEL_SKINNER_1965, WILSON_1927,
};

use Task::{
    Basins, Bifurcation, Friction, Modes, Resonances, Response, Simulate, Stability, Thresholds,
};

/// A use of a source.
struct SourceUse {
    source: Source,
    /// The equations used, or the purpose.
    used: &'static str,
    /// The computations that use it.
    tasks: &'static [Task],
    /// The studies of which they do.
    by: fn(&CitedStudy) -> bool,
}

const fn used(
    source: Source,
    used: &'static str,
    tasks: &'static [Task],
    by: fn(&CitedStudy) -> bool,
) -> SourceUse {
    SourceUse { source, used, tasks, by }
}

/// Computations of runs.
const RUNS: &[Task] = &[Simulate, Response, Bifurcation, Basins];
/// Computations of a mass that begin with its equation of motion.
const MOTIONS: &[Task] =
    &[Friction, Stability, Thresholds, Simulate, Response, Bifurcation, Basins];
/// Computations into which friction enters.
const LAWS: &[Task] =
    &[Friction, Stability, Thresholds, Simulate, Response, Bifurcation, Basins, Resonances];

/// Every use.
#[rustfmt::skip]
const USES: &[SourceUse] = &[
    used(MICHAUX_2005, "equation of motion (2.1), (3.1)", MOTIONS, |study| study.is_one_mass() && !normal(study)),
    used(MICHAUX_2005, "equation of motion (2.1), (3.1), (4.1)", MOTIONS, normal),
    used(MICHAUX_2005, "Stribeck law (2.7)", LAWS, |study| study.has_law(LawKind::Stribeck)),
    used(MICHAUX_2005, "decreasing law (2.8)", LAWS, |study| study.has_law(LawKind::Decreasing)),
    used(ARMSTRONG_HELOUVRY_1994, "exponential Stribeck friction with a viscous part", LAWS, |study| study.has_law(LawKind::StribeckExponential)),
    used(CANUDAS_DE_WIT_1995, "LuGre friction, whose bristles are a state", LAWS, |study| study.has_law(LawKind::Lugre)),
    used(CHAN_1994, "friction as a follower force", LAWS, |study| study.has_contact(|contact| contact.slope.is_some())),
    used(HOFFMANN_2002, "mode coupling: two frequencies merge under friction", &[Stability, Thresholds], |study| study.has_contact(has_normal_row)),
    used(GELB_VANDER_VELDE_1968, "describing function of averaged friction (--describing), with the structure in harmonic balance", &[Friction], is_system),
    used(THOMSEN_1999, "averaging over the fast motion; effective friction", &[Friction, Stability], CitedStudy::has_waves),
    used(MICHAUX_2005, "effective friction under tangential dither (2.21), (3.19)–(3.27)", &[Friction, Stability], tangential),
    used(MICHAUX_2005, "closed forms (3.29)–(3.31)", &[Friction, Stability], |study| tangential(study) && study.has_law(LawKind::Stribeck)),
    used(MICHAUX_2005, "closed forms (3.36)–(3.39), (B.10), (C.7)", &[Friction, Stability], |study| tangential(study) && study.has_law(LawKind::Decreasing)),
    used(MICHAUX_2005, "fast motion under normal dither (4.13)–(4.23), effective friction (4.27), (4.28)", &[Friction, Stability], normal),
    used(MICHAUX_2005, "effective friction (2.21), here of each contact", &[Friction, Stability], |study| study.is_larger() && study.has_waves()),
    used(GELB_VANDER_VELDE_1968, "statistical linearisation: mean and gain of friction under a Gaussian velocity", &[Friction, Stability], CitedStudy::has_noise),
    used(MICHAUX_2005, "criterion of stability (2.26), thresholds (3.41)–(3.62), (4.33)–(4.42)", &[Stability], CitedStudy::is_one_mass),
    used(HAIRER_NORSETT_WANNER_1993, "periodic motion in pure slip and its multipliers by extrapolation (--exact)", &[Stability], CitedStudy::has_waves),
    used(JORBA_ZOU_2005, "Taylor steps and the choice of their length", RUNS, is_system),
    used(FILIPPOV_1988, "definition of a solution for a set-valued friction law", RUNS, is_system),
    used(MICHAUX_2005, "residual vibration E under dither (2.27)", &[Response], CitedStudy::has_waves),
    used(HARRIS_1978, "Hann window of the spectrum", &[Response], is_system),
    used(THOMSEN_FIDLIN_2003, "the stick-slip of the belt without dither", &[Response], CitedStudy::is_one_mass),
    used(CUNEFARE_GRAF_2002, "dither against squeal", &[Response], CitedStudy::has_waves),
    used(STEELE_2014, "the random numbers of noise (SplitMix64)", &[Simulate, Response], CitedStudy::has_noise),
    used(WILSON_1927, "confidence interval of the share of quiet runs", &[Response], CitedStudy::has_noise),
    used(DAS_SAIKI_SANDER_YORKE_2017, "averages of a section and rotation numbers", &[Bifurcation, Basins], CitedStudy::is_one_mass),
    used(MENCK_2013, "the share of starts that reach a response", &[Basins], is_system),
    used(WILSON_1927, "confidence interval of a sampled share", &[Basins], is_system),
    used(MICHAUX_2005, "plate clamped inside and free outside (5.1)–(5.7), reference frequency (5.17)", &[Modes], |study| DiscKind::ComputedModes.is(study)),
    used(VOGEL_SKINNER_1965, "frequencies and shapes of the annular plate", &[Modes], |study| DiscKind::ComputedModes.is(study)),
    used(MICHAUX_2005, "equations of motion (5.15), (5.18)", &[Stability], |study| is_disc(study) && !DiscKind::Dithered.is(study)),
    used(MICHAUX_2005, "equations of motion under normal dither (5.22)–(5.25)", &[Stability], |study| DiscKind::Dithered.is(study) && !DiscKind::Tangential.is(study)),
    used(MICHAUX_2005, "equations of motion under tangential dither (5.31), (5.32)", &[Stability], |study| DiscKind::Tangential.is(study)),
    used(IWAN_STAHL_1973, "a disc under a rotating load", &[Stability], is_disc),
    used(CHAN_1994, "friction as a follower force", &[Stability], is_disc),
    used(TAKAHASHI_IMADA_1984, "Floquet exponents by a fourth-order splitting", &[Stability], |study| DiscKind::Dithered.is(study)),
    used(NAYFEH_MOOK_1979, "multiple scales", &[Resonances], is_disc),
    used(MICHAUX_2005, "complex form (5.41), resonant speeds (5.55), (5.56), slow equations (5.43)–(5.54), (5.57)–(5.66)", &[Resonances], is_disc),
];

fn is_system(study: &CitedStudy) -> bool {
    study.system().is_some()
}

fn is_disc(study: &CitedStudy) -> bool {
    study.disc().is_some()
}

fn tangential(study: &CitedStudy) -> bool {
    study.has_dither(Direction::Tangential, None)
}

fn normal(study: &CitedStudy) -> bool {
    study.has_dither(Direction::Normal, None)
}

fn has_normal_row(contact: &Contact) -> bool {
    contact.normal.is_some()
}

/// The citations of a study, task by task.
pub(super) fn citations(study: &CitedStudy) -> Vec<Citation> {
    let reaches = is_disc(study) || study.has_waves();
    let tasks = Task::ALL.iter().copied().filter(|task| *task != Resonances || reaches);
    let of_task = |task: Task| {
        let uses = USES.iter().filter(move |one| one.tasks.contains(&task) && (one.by)(study));
        uses.map(move |one| Citation { source: one.source, task, used: one.used })
    };
    tasks.flat_map(of_task).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Study;

    /// Keys of the sources that a verb cites.
    fn keys(contact: &str, dither: &str, task: Task) -> Vec<&'static str> {
        let text = format!(
            "schema = 1\n[system]\ncoordinates = [\"x\", \"y\"]\nmass = [1, 1]\nstiffness = [[2, 1], [1, 2]]\n\
             [[contact]]\ntangent = {{ x = 1 }}\nnormal_load = 1\nbelt_velocity = 1\n{contact}\n\
             [contact.friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n{dither}"
        );
        let study = CitedStudy::of(&Study::parse(&text, &[]).expect("valid"));
        let found = citations(&study).into_iter().filter(|citation| citation.task == task);
        found.map(|citation| citation.source.key).collect()
    }

    #[test]
    fn a_source_is_cited_where_its_method_enters() {
        let spring = "normal = { y = 1 }\nnormal_stiffness = 1";
        let tilted = "normal = { y = 1 }\nnormal_stiffness = 1\nslope = { y = 0.1 }";
        let dither =
            "[[dither]]\nat = { x = 1 }\nwaveform = \"sine\"\namplitude = 1\nfrequency = 20";
        assert!(keys("", "", Stability).is_empty());
        assert_eq!(keys(spring, "", Stability), ["hoffmann2002"]);
        assert_eq!(keys(spring, "", Thresholds), ["hoffmann2002"]);
        assert_eq!(keys(tilted, "", Stability), ["chan1994", "hoffmann2002"]);
        let averaged = ["thomsen1999", "michaux2005", "hairer1993"];
        assert_eq!(keys("", dither, Stability), averaged);
        assert_eq!(keys(tilted, dither, Resonances), ["chan1994"]);
        assert!(keys(spring, dither, Modes).is_empty());
        assert_eq!(keys("", dither, Friction), ["gelb1968", "thomsen1999", "michaux2005"]);
    }
}
