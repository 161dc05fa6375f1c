//! A belt or a disc written as a system has the equations of the original.

use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};

use quell::study::{Kind, Study};
use quell_linear::linearised::Linearised;
use quell_linear::spectrum::spectrum;
use quell_model::Contact;

/// The shipped studies of belts and discs.
fn shipped() -> Vec<(PathBuf, Study)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    let files = fs::read_dir(&folder).expect("studies").map(|file| file.expect("a file").path());
    let studies = files.filter(|path| path.extension().is_some_and(|name| name == "toml"));
    let read = studies.map(|path| (path.clone(), Study::read(&path, &[]).expect("a study")));
    read.filter(|(_, study)| !matches!(study.kind(), Kind::System(_))).collect()
}

/// A law holds, or is proven, up to the same slip speed.
fn same_range(one: &Contact, other: &Contact, path: &Path) {
    let upper = |contact: &Contact| contact.friction.range().map(|range| range.upper);
    let (one, other) = (upper(one), upper(other));
    let close = match (one, other) {
        (Some(one), Some(other)) => (one - other).abs() <= 1e-14 * one,
        _ => one == other,
    };
    assert!(close, "{}: {one:?} {other:?}", path.display());
}

#[test]
fn every_shipped_belt_has_the_same_system() {
    let mut count = 0;
    for (path, study) in shipped().iter().filter(|(_, study)| matches!(study.kind(), Kind::Belt(_)))
    {
        let converted =
            study.as_system().unwrap_or_else(|why| panic!("{}: {why:?}", path.display()));
        let (own, other) = (study.system(), converted.study.system());
        assert_eq!(own.units(), other.units(), "{}", path.display());
        let [one, two] = [own.system(), other.system()];
        assert_eq!(one.structure, two.structure, "{}", path.display());
        assert_eq!(one.inputs.len(), two.inputs.len(), "{}", path.display());
        for (a, b) in one.inputs.iter().zip(&two.inputs) {
            assert_eq!(a.target, b.target, "{}", path.display());
            for (a, b) in a.profile.waves().iter().zip(b.profile.waves()) {
                let close = |a: f64, b: f64| (a - b).abs() <= 1e-15 * a.abs();
                assert!(
                    close(a.amplitude, b.amplitude) && close(a.frequency, b.frequency),
                    "{}",
                    path.display()
                );
                assert_eq!((&a.waveform, a.phase), (&b.waveform, b.phase), "{}", path.display());
            }
        }
        let [a, b] = [one, two].map(|system| &system.contacts[0]);
        for time in [0.0, 0.3, 2.0] {
            let values = |contact: &Contact| {
                [contact.load().value(time), contact.surface_velocity.value(time)]
            };
            for (a, b) in values(a).into_iter().zip(values(b)) {
                assert!((a - b).abs() <= 1e-15 * a.abs(), "{}: {a} {b}", path.display());
            }
        }
        for slip in [0.0, 0.01, 0.07, 0.3] {
            let (a, b) = (a.friction.coefficient(slip), b.friction.coefficient(slip));
            assert!((a - b).abs() <= 1e-14 * a.abs(), "{}: {a} {b}", path.display());
        }
        same_range(a, b, path);
        count += 1;
    }
    assert!(count > 30);
}

/// The exponents of a disc are those of its system: in 1/ω_ref where the disc has no scales, in 1/s where it has.
#[test]
fn discs_have_the_exponents_of_their_systems() {
    let mut count = 0;
    for (path, study) in shipped().iter().filter(|(_, study)| matches!(study.kind(), Kind::Disc(_)))
    {
        let (Ok(converted), Ok(disc)) = (study.as_system(), study.disc()) else {
            assert!(study.varies_by().is_some(), "{}", path.display());
            continue;
        };
        let still = |study: &Study| -> f64 {
            let system = study.system().system().undithered();
            let linear = Linearised::new(&system).expect("sliding");
            let motions = spectrum(&linear, &linear.friction()).expect("a spectrum").motions;
            motions.iter().map(|motion| motion.eigenvalue.re).fold(f64::NEG_INFINITY, f64::max)
        };
        let per_second = disc
            .reference_hz()
            .filter(|_| disc.scales(0).is_some_and(|scales| scales.plate_mass_kg.is_some()));
        let rate = per_second.map_or(1.0, |hertz| TAU * hertz);
        if rate != 1.0 {
            let contacts =
                [study, &converted.study].map(|study| study.system().system().contacts.clone());
            let [own, other] = &contacts;
            own.iter().zip(other).for_each(|(own, other)| same_range(own, other, path));
        }
        let (own, other) = (still(study) * rate, still(&converted.study));
        assert!(
            (own - other).abs() <= 1e-11 * rate + 1e-9 * own.abs(),
            "{}: {own} {other}",
            path.display()
        );
        count += 1;
    }
    assert!(count > 10);
}
