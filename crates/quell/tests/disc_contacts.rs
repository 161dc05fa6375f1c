//! Disc studies whose loads have an area, pads and calipers, and discs that rotate: keys, complaints, answers.

use std::path::Path;

use quell::Complaints;
use quell::run::disc::{check, modes, stability};
use quell::study::DiscStudy;
use serde_json::Value as Json;

const PLATE: &str = "schema = 1\n[disc]\ninner_radius_ratio = 0.5\n";
const LOAD: &str = "[disc.load]\nradius_ratio = 0.75\nmass = 0.1\ndamping = 0.1\nstiffness = 0.1\n\
    friction = 0.5\nspeed = 0.3\n";
const LISTED: &str = "schema = 1\n[disc]\n[[disc.mode]]\ndiameters = 2\nratio = 2.0\n\
    shape_at_load = 0.9\n";

fn parse(text: &str) -> Result<DiscStudy, Complaints> {
    DiscStudy::parse_in(text, &[], Path::new(""))
}

fn good(text: &str) -> DiscStudy {
    parse(text).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

fn answer(text: &str) -> Json {
    let study = good(text);
    stability::run(&study).expect("finite").json(&study)
}

#[test]
fn complaints_name_the_key() {
    let load = format!("{PLATE}{LOAD}");
    for (text, key, allowed) in [
        (format!("{load}extent_deg = -1\n"), "disc.load.extent_deg", "[0, 360]"),
        (format!("{load}points = 4\n"), "disc.load.points", "extent_deg"),
        (format!("{load}radial_extent = 0.6\n"), "disc.load.radial_extent", "clamp at 0.5"),
        (format!("{LISTED}{LOAD}radial_extent = 0.1\n"), "disc.load.radial_extent", "one radius"),
        (format!("{load}pad_mass = 0.1\n"), "disc.load.pad_stiffness", "> 0"),
        (format!("{load}pad_mass = 0\npad_stiffness = 1\n"), "disc.load.pad_mass", "> 0"),
        (
            format!("{load}caliper_mass = 0.1\ncaliper_stiffness = 1\n"),
            "disc.load.pad_mass",
            "a caliper carries",
        ),
        (format!("{load}slip_ratio = 2\n"), "disc.load.slip_ratio", "tangential"),
        (format!("{PLATE}centrifugal = 0.5\n{LOAD}"), "disc.centrifugal", "rotating = \"disc\""),
        (format!("{PLATE}rotating = \"pad\"\n{LOAD}"), "disc.rotating", "loads"),
        (
            format!("{LISTED}centrifugal = 0.5\n{LOAD}"),
            "disc.mode[0].centrifugal",
            "rotating = \"disc\"",
        ),
    ] {
        let complaints = parse(&text).expect_err(&text);
        let complaint = complaints.iter().next().expect("a complaint");
        assert_eq!(complaint.key, key, "{text}");
        assert!(complaint.allowed.contains(allowed), "{key}: {}", complaint.allowed);
    }
}

#[test]
fn areas_and_bodies_are_read() {
    let text = format!(
        "{PLATE}{LOAD}extent_deg = 30\nradial_extent = 0.2\npad_mass = 0.05\npad_stiffness = 2\n\
         caliper_mass = 0.4\ncaliper_stiffness = 1\ncaliper_damping = 0.02\n"
    );
    let study = good(&text);
    let load = &check::json(&study)["disc"]["loads"][0];
    assert!((load["extent_deg"].as_f64().expect("a number") - 30.0).abs() < 1e-12);
    assert_eq!(load["pad_mass"], 0.05);
    assert_eq!(load["pad_damping"], 0.0);
    assert_eq!(load["caliper_damping"], 0.02);
    assert_eq!(load["radial_points"], 9);
    assert_eq!(study.disc().coordinates(), 5 + 2);
    let found = answer(&text);
    assert!(found["growth_rate"].as_f64().expect("a number").is_finite());
    // A narrow patch is nearly the point.
    let growth = |more: &str| {
        answer(&format!("{PLATE}{LOAD}{more}"))["growth_rate"].as_f64().expect("a number")
    };
    let narrow = growth("extent_deg = 0.1\nradial_extent = 0.001\n");
    assert!((narrow - growth("")).abs() < 1e-6);
    // The default numbers of points are enough.
    let wide = "extent_deg = 60\nradial_extent = 0.4\n";
    let more = growth(&format!("{wide}points = 24\nradial_points = 12\n"));
    assert!((growth(wide) - more).abs() < 1e-11, "{}", growth(wide) - more);
}

#[test]
fn kinds_of_instability_are_named() {
    let found = answer(&format!("{PLATE}{LOAD}"));
    let listed = found["unstable_modes"].as_array().expect("modes");
    assert!(!listed.is_empty());
    for mode in listed {
        assert_eq!(mode["kind"], "friction");
        assert!(mode["shares"]["friction"].as_f64().expect("a share") > 0.0);
        assert!(mode["shares"]["damper"].as_f64().expect("a share") < 0.0);
    }
    let dither = "[dither]\ndirection = \"normal\"\namplitude = 0.1\nfrequency_ratio = 2.7\n";
    let dithered = answer(&format!("{PLATE}{LOAD}{dither}"));
    assert_eq!(dithered["unstable_modes"][0]["kind"], Json::Null);
    assert!(dithered["why"]["unstable_modes[].kind"].is_string());
}

#[test]
fn tangential_dither_has_a_force() {
    let dither = "slip_ratio = 2\n[dither]\ndirection = \"tangential\"\nwaveform = \"square\"\n\
        frequency_ratio = 20.0\n";
    let found = answer(&format!("{PLATE}{LOAD}{dither}"));
    let shaken = &found["tangential_dither"][0];
    assert!((shaken["mean"].as_f64().expect("a number") - 1.0 / 3.0).abs() < 1e-14);
    // Inertia 0.1·2·0.3·20 = 1.2; at the reversal √¾ of it and 4/3 of the friction.
    let force = shaken["force"].as_f64().expect("a number");
    assert!((force - (1.2 * 0.75f64.sqrt() + 0.5 * 4.0 / 3.0)).abs() < 1e-12, "{force}");
    assert_eq!(
        check::json(&good(&format!("{PLATE}{LOAD}{dither}")))["dither"]["waveform"],
        "square"
    );
    let plain = answer(&format!("{PLATE}{LOAD}{}", dither.replace("slip_ratio = 2\n", "")));
    assert!(plain["why"]["tangential_dither"].is_string());
}

#[test]
fn a_disc_that_rotates_is_stiffened() {
    let rotating = format!("{PLATE}rotating = \"disc\"\ncentrifugal = 0.5\n{LOAD}");
    let study = good(&rotating);
    let rows = modes::run(&study).rows;
    assert_eq!(rows[1].critical_speed(), Some(rows[1].ratio / 0.5f64.sqrt()));
    assert_eq!(rows[2].critical_speed(), Some(rows[2].ratio / 3.5f64.sqrt()));
    let still = good(&format!("{PLATE}rotating = \"disc\"\n{LOAD}"));
    assert_eq!(still.disc(), good(&format!("{PLATE}{LOAD}")).disc());
    let listed = format!(
        "{}centrifugal = 0.5\n{LOAD}",
        LISTED.replace("[disc]\n", "[disc]\nrotating = \"disc\"\n")
    );
    assert_eq!(good(&listed).disc().centrifugal(0), 0.5);
}

const PRESSED: &str = "[disc.load]\nradius_ratio = 0.75\nmass = 0.1\ndamping = 0.1\nstiffness = 0.1\n\
    normal_load = 0.8\nspeed = 0.3\n";

#[test]
fn a_friction_law_stands_for_the_friction_force() {
    let law = "[friction]\nlaw = \"coulomb\"\ncoefficient = 0.25\n";
    let found = answer(&format!("{PLATE}{PRESSED}{law}"));
    let plain = answer(&format!("{PLATE}{}", LOAD.replace("0.5\n", "0.2\n")));
    assert_eq!(found["growth_rate"], plain["growth_rate"]);
    let steel = "youngs_modulus_pa = 210e9\ndensity_kg_per_m3 = 7850\nthickness_m = 0.01\n\
        outer_radius_m = 0.14\n";
    let study = good(&format!("{PLATE}{steel}{PRESSED}{law}"));
    let half = 0.5 * 0.01 / (0.75 * 0.14);
    assert!((study.disc().loads()[0].half_thickness - half).abs() < 1e-15);
    assert_eq!(check::json(&study)["friction"]["coefficient"], 0.25);
    // Slip velocities in SI are those at the first load.
    let stribeck =
        "[friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.3\n";
    let unit = std::f64::consts::TAU * study.reference_hz().expect("SI") * 0.75 * 0.14;
    let both = [
        "reference_velocity = 0.5\n".to_owned(),
        format!("reference_velocity_m_per_s = {:?}\n", 0.5 * unit),
    ];
    let rates = both.map(|velocity| {
        answer(&format!("{PLATE}{steel}{PRESSED}{stribeck}{velocity}"))["growth_rate"].as_f64()
    });
    let [plain, si] = rates.map(|rate| rate.expect("a number"));
    assert!((plain - si).abs() < 1e-12, "{plain} {si}");
    for (text, key) in [
        (format!("{PLATE}{PRESSED}"), "disc.load.normal_load"),
        (format!("{PLATE}{LOAD}{law}"), "disc.load.friction"),
        (format!("{PLATE}{LOAD}normal_load = 1.0\n{law}"), "disc.load.friction"),
        (format!("{PLATE}{}{law}", PRESSED.replace("speed = 0.3\n", "")), "disc.load.speed"),
        (
            format!("{PLATE}{PRESSED}[friction]\nlaw = \"expression\"\ncoefficient = \"0.3\"\n"),
            "friction.law",
        ),
    ] {
        let complaints = parse(&text).expect_err(&text);
        assert_eq!(complaints.iter().next().expect("a complaint").key, key, "{text}");
    }
}

#[test]
fn a_static_load_is_warned_of_near_a_critical_speed() {
    let found = answer(&format!("{PLATE}{}static_load = 0.02\n", LOAD.replace("0.3\n", "0.98\n")));
    let critical = found["critical_speeds"].as_array().expect("speeds");
    assert_eq!(critical.len(), 2);
    assert_eq!((&critical[0]["diameters"], &critical[0]["near"]), (&Json::from(2), &true.into()));
    assert!(found["warnings"][0].as_str().expect("a warning").contains("critical speed"));
    let deflection = |key: &str| found[key][0].as_f64().expect("a number");
    assert!(deflection("deflection").abs() > deflection("deflection_at_rest").abs());
    let slow = answer(&format!("{PLATE}{LOAD}static_load = 0.02\n"));
    assert!(slow["warnings"].as_array().expect("a list").is_empty());
    assert!(answer(&format!("{PLATE}{LOAD}"))["deflection"].is_null());
}
