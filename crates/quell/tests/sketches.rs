//! Sketches: of every study and template, without texts that cover anything, and with every part of the study.

use std::fs;
use std::path::{Path, PathBuf};

use quell::Study;
use quell::picture::sketch::sketch;
use quell::plot::Sketch;
use quell::study::{Change, Kind};
use quell::template::TEMPLATES;
use quell_model::system::InputTarget;

fn studies() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies")
}

/// Every study and template by its name. A template that names a file in its folder is one of the studies too.
fn all() -> Vec<(String, Study)> {
    let mut all: Vec<(String, Study)> = fs::read_dir(studies())
        .expect("studies")
        .map(|file| file.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| {
            let study =
                Study::read(&path, &[]).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
            (path.file_stem().expect("a name").to_string_lossy().into_owned(), study)
        })
        .collect();
    for template in TEMPLATES {
        let study = Study::parse_in(template.text, &[], &studies());
        let study = study.unwrap_or_else(|why| panic!("{}: {why:?}", template.name));
        all.push((template.name.to_owned(), study));
    }
    assert!(all.len() > 70);
    all
}

fn drawn(study: &Study, width: f64) -> Sketch {
    sketch(study, Some(width)).expect("a sketch")
}

fn parse(text: &str) -> Study {
    Study::parse(text, &[]).unwrap_or_else(|why| panic!("{why:?}"))
}

/// Names of the parts of a class.
fn names<'a>(sketch: &'a Sketch, class: &str) -> Vec<&'a str> {
    let parts = sketch.parts.iter().filter(|part| part.class == class);
    parts.map(|part| part.name.as_str()).filter(|name| !name.is_empty()).collect()
}

#[test]
fn no_text_of_any_sketch_covers_anything_or_leaves_the_sheet() {
    for (name, study) in all() {
        for width in [80.0, 85.0, 120.0, 180.0] {
            let sketch = drawn(&study, width);
            assert_eq!(sketch.collisions(), Vec::<String>::new(), "{name} at {width} mm");
            assert!(sketch.text_size() >= 7.0, "{name} at {width} mm");
        }
    }
}

#[test]
fn every_part_of_a_study_is_in_its_sketch() {
    for (name, study) in all() {
        let sketch = drawn(&study, 85.0);
        match study.kind() {
            Kind::Belt(setup) => {
                let dithers = setup.belt().dithers().len();
                assert_eq!(names(&sketch, "dither").len(), dithers, "{name}");
                for class in ["mass", "spring", "damper", "surface", "load", "velocity"] {
                    assert_eq!(names(&sketch, class).len(), 1, "{name}: {class}");
                }
            }
            Kind::Disc(setup) => {
                let loads = setup.disc().loads().len();
                assert_eq!(names(&sketch, "contact").len(), loads, "{name}");
                assert_eq!(
                    sketch.key.iter().filter(|row| row.head.starts_with("Load")).count(),
                    loads
                );
            }
            Kind::System(setup) => {
                let system = setup.system();
                let svg = sketch.to_svg();
                for contact in &system.contacts {
                    assert!(
                        svg.contains(&format!("contact {}", contact.name)),
                        "{name}: {}",
                        contact.name
                    );
                }
                let names_of_bodies = system.structure.names();
                if names_of_bodies.len() <= 12 && !names_of_bodies[0].contains('.') {
                    for body in names_of_bodies {
                        assert!(svg.contains(body.as_str()), "{name}: {body}");
                    }
                }
                let arrows: usize = system
                    .inputs
                    .iter()
                    .map(|input| match &input.target {
                        InputTarget::Force(row)
                            if row.len() <= 12 && !names_of_bodies[0].contains('.') =>
                        {
                            row.iter().filter(|entry| **entry != 0.0).count()
                        }
                        _ => 1,
                    })
                    .sum();
                assert_eq!(names(&sketch, "dither").len(), arrows, "{name}");
            }
        }
    }
}

const CHAIN: &str = r#"
[system]
coordinates = ["a", "b", "c"]
mass = [2.0, 3.0, 4.0]
stiffness = [[12.0, -7.0, -5.0], [-7.0, 7.0, 0.0], [-5.0, 0.0, 5.5]]
damping = [[0.3, -0.3, 0.0], [-0.3, 0.3, 0.0], [0.0, 0.0, 0.0]]
[[contact]]
name = "plate"
tangent = { b = 1.0 }
normal = { c = 1.0 }
normal_load = 11.0
normal_stiffness = 13.0
belt_velocity = 0.25
[contact.friction]
law = "coulomb"
coefficient = 0.5
[[dither]]
at = { a = 1.0, c = -1.0 }
waveform = "square"
amplitude = 17.0
frequency = 19.0
[[dither]]
contact = "plate"
direction = "normal"
waveform = "triangle"
amplitude = 1.5
frequency = 23.0
"#;

#[test]
fn springs_are_read_from_the_matrices() {
    let sketch = drawn(&parse(CHAIN), 85.0);
    assert_eq!(sketch.collisions(), Vec::<String>::new());
    let mut springs = names(&sketch, "spring");
    springs.sort_unstable();
    assert_eq!(
        springs,
        ["spring between a and b", "spring between a and c", "spring between c and the ground"]
    );
    assert_eq!(names(&sketch, "damper"), ["damper between a and b"]);
    assert_eq!(names(&sketch, "contact-spring"), ["normal stiffness of contact plate"]);
    let dithers = names(&sketch, "dither");
    assert_eq!(
        dithers,
        [
            "square dither at a",
            "square dither at c",
            "triangle dither of the normal load of contact plate"
        ]
    );
    let items: Vec<&String> = sketch.key.iter().flat_map(|row| &row.items).collect();
    for wanted in ["$k_{12}$ = 7", "$k_{13}$ = 5", "$k_3$ = 0.5", "$c_{12}$ = 0.3", "$m_2$ = 3"] {
        assert!(items.iter().any(|item| *item == wanted), "{wanted}: {items:?}");
    }
    assert!(!items.iter().any(|item| item.starts_with("$k_1$") || item.starts_with("$k_2$")));
}

#[test]
fn a_pair_of_entries_that_is_no_spring_is_a_coupling() {
    let text = CHAIN.replace("[-7.0, 7.0, 0.0]", "[7.0, 7.0, 0.0]");
    let sketch = drawn(&parse(&text), 120.0);
    assert_eq!(names(&sketch, "coupling"), ["coupling between a and b"]);
    let row = sketch.key.iter().find(|row| row.head == "a – b").expect("a row");
    assert!(row.items.contains(&"coupling $K_{12}$ = −7".to_owned()), "{row:?}");
    assert!(row.items.contains(&"$K_{21}$ = 7".to_owned()), "{row:?}");
}

#[test]
fn a_changed_value_changes_its_label_and_nothing_else() {
    let change = |path: &str| {
        let change = Change::parse(&format!("{path}=0.123"), "--set").expect("a change");
        Study::parse(CHAIN, &[change]).expect("valid")
    };
    let before = drawn(&parse(CHAIN), 85.0);
    for (path, item) in [
        ("contact.plate.normal_load", "$N$ = 0.123"),
        ("contact.plate.belt_velocity", "$v$ = 0.123"),
        ("contact.plate.normal_stiffness", "$k_n$ = 0.123"),
        ("system.mass[1]", "$m_2$ = 0.123"),
        ("dither[0].amplitude", "square $u_1$ = 0.123"),
    ] {
        let after = drawn(&change(path), 85.0);
        let changed: Vec<(&String, &String)> = before
            .key
            .iter()
            .flat_map(|row| &row.items)
            .zip(after.key.iter().flat_map(|row| &row.items))
            .filter(|(before, after)| before != after)
            .collect();
        assert_eq!(changed.len(), 1, "{path}: {changed:?}");
        assert_eq!(changed[0].1, item);
        assert_eq!(before.parts, after.parts);
    }
}

#[test]
fn long_chains_and_many_coordinates_stay_legible() {
    for count in [1_usize, 2, 5, 12, 13, 60] {
        let list =
            |entry: &dyn Fn(usize) -> String| (0..count).map(entry).collect::<Vec<_>>().join(", ");
        let row = |i: usize| {
            let entry = |j: usize| match i.abs_diff(j) {
                0 => "3.0".to_owned(),
                1 => "-1.0".to_owned(),
                _ => "0.0".to_owned(),
            };
            format!("[{}]", list(&entry))
        };
        let text = format!(
            "[system]\ncoordinates = [{}]\nmass = [{}]\nstiffness = [{}]\n[[contact]]\nname = \"end\"\n\
             tangent = {{ block{} = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"coulomb\"\n\
             coefficient = 0.3\n",
            list(&|i| format!("\"block{i}\"")),
            list(&|_| "1.0".to_owned()),
            list(&row),
            count - 1
        );
        for width in [80.0, 85.0, 180.0] {
            let sketch = drawn(&parse(&text), width);
            assert_eq!(sketch.collisions(), Vec::<String>::new(), "{count} at {width} mm");
            assert!(sketch.height_mm() < 420.0, "{count}: {}", sketch.height_mm());
            let group = names(&sketch, "group");
            assert_eq!(group.len(), usize::from(count > 12), "{count}: {group:?}");
        }
    }
}

#[test]
fn a_disc_with_several_loads_pads_and_areas_is_drawn() {
    let load = |angle: i32| {
        format!(
            "[[disc.load]]\nradius_ratio = 0.75\nangle_deg = {angle}\nmass = 0.1\ndamping = 0.1\nstiffness = 0.1\nfriction = 0.05\n"
        )
    };
    let mut text = String::from(
        "[disc]\ninner_radius_ratio = 0.3\npoisson_ratio = 0.3\nradial_modes = 1\nnodal_diameters = 2\n",
    );
    for angle in [0, 40, 90, 180, 250, 300] {
        text += &load(angle);
    }
    let text = text.replacen("friction = 0.05\n", "friction = 0.05\nextent_deg = 30\n", 1);
    for width in [80.0, 85.0, 180.0] {
        let sketch = drawn(&parse(&text), width);
        assert_eq!(sketch.collisions(), Vec::<String>::new(), "{width}");
        assert_eq!(names(&sketch, "contact").len(), 6);
        assert!(names(&sketch, "contact").contains(&"load 5 at 250°"));
    }
}

#[test]
fn widths_out_of_range_are_refused() {
    let study = parse(CHAIN);
    for width in [79.0, 401.0, 0.0, -85.0, f64::NAN, f64::INFINITY] {
        let refused = sketch(&study, Some(width)).expect_err("refused").to_string();
        assert!(refused.contains("80 to 400 mm"), "{refused}");
    }
    for text in ["85", "", "mm", "NaNmm", "79mm", "85 furlongs"] {
        assert!(quell::picture::sketch::width(text).is_err(), "{text}");
    }
    let read = quell::picture::sketch::width(" 8.5 cm").expect("a width");
    assert!((read - 85.0).abs() < 1e-12);
}

#[test]
fn names_of_a_study_are_escaped() {
    let text = CHAIN
        .replace("\"plate\"", "\"<script>&\"")
        .replace("[system]", "title = \"<b>\"\n[system]");
    let svg = drawn(&parse(&text), 85.0).to_svg();
    assert!(!svg.contains("<script>") && !svg.contains("<b>"), "{svg}");
    assert!(
        svg.contains("contact &lt;script&gt;&amp;") && svg.contains("<title>&lt;b&gt;</title>")
    );
}

/// Keys of a contact with a state, and the class of the part that shows it.
const STATES: [(&str, &str, &str); 2] = [
    (
        "tangential_stiffness = 30.0\n",
        "law = \"coulomb\"\ncoefficient = 0.3\n",
        "tangential-spring",
    ),
    (
        "",
        "law = \"lugre\"\ncoefficient = 0.3\nstatic_coefficient = 0.4\nreference_velocity = 0.1\nbristle_stiffness = 100.0\n",
        "bristles",
    ),
];

#[test]
fn contacts_with_a_state_show_their_spring_or_their_bristles() {
    for (contact, law, class) in STATES {
        let belt = format!(
            "[belt]\ndamping_ratio = 0.01\nnormal_load = 1\nbelt_velocity = 0.1\n{contact}[friction]\n{law}\
             [[dither]]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 1\nfrequency_ratio = 9\n\
             [[dither]]\ndirection = \"normal\"\nwaveform = \"sine\"\namplitude = 0.5\nfrequency_ratio = 9\n"
        );
        let pad = |name: &str, row: &str| {
            format!(
                "[[contact]]\nname = \"{name}\"\ntangent = {{ {row} = 1 }}\nnormal_load = 1\nbelt_velocity = 0.1\n{contact}\
                 [contact.friction]\n{law}"
            )
        };
        let system = format!(
            "[system]\ncoordinates = [\"x\", \"y\"]\nmass = [1, 1]\ndamping = [0.1, 0.1]\nstiffness = [[2, -1], [-1, 2]]\n\
             {}{}[[dither]]\ncontact = \"left\"\ndirection = \"normal\"\nwaveform = \"sine\"\namplitude = 0.5\nfrequency = 9\n\
             [dither.envelope]\ntime = [0, 9]\nshare = [0, 1]\n",
            pad("left", "x"),
            pad("right", "y")
        );
        for (text, count) in [(belt, 1), (system, 2)] {
            for width in [80.0, 85.0, 120.0, 180.0] {
                let sketch = drawn(&parse(&text), width);
                assert_eq!(names(&sketch, class).len(), count, "{text}");
                assert_eq!(
                    sketch.collisions(),
                    Vec::<String>::new(),
                    "{class} at {width} mm: {text}"
                );
            }
            let key = format!("{:?}", drawn(&parse(&text), 85.0).key);
            let symbol = if contact.is_empty() { "σ₀" } else { "k_" };
            assert!(key.contains(symbol) && (count == 1 || key.contains("envelope")), "{key}");
            let rigid = text.replace(contact, "");
            if !contact.is_empty() {
                assert!(names(&drawn(&parse(&rigid), 85.0), class).is_empty());
            }
        }
    }
}
