//! The application layer of Quell: a study in, an answer out.
//!
//! A [`BeltStudy`] is a belt with its friction law and its dither, parsed from the text of a study file; an existing value is
//! always valid. Each question is one function in [`run`]. Its outcome contains the numbers, a sentence (`sentence`), the object
//! that the command line prints with `--json` (`json`), warnings, and datasets if it has arrays. [`picture`] draws outcomes.
//!
//! # Does this dither quench the vibration, and at what cost?
//!
//! ```
//! use quell::Study;
//! use quell::verbs::verbs;
//! use quell::run::response::ResponseRequest;
//!
//! # fn main() -> Result<(), quell::Failure> {
//! let text = r#"
//!     [belt]
//!     damping_ratio = 0.005
//!     normal_load = 1.0
//!     belt_velocity = 0.05
//!     [friction]
//!     law = "stribeck"
//!     static_coefficient = 0.4
//!     minimum_coefficient = 0.2857
//!     reference_velocity = 0.2
//!     [dither]
//!     direction = "tangential"
//!     waveform = "sine"
//!     amplitude = 0.52
//!     frequency_ratio = 10.0
//! "#;
//! let study = Study::parse(text, &[])?;
//! let steady = verbs(&study).response(&ResponseRequest::default())?;
//! assert_eq!(steady.json()["effect"], "quenches");
//! println!("{}", steady.text());
//! # Ok(())
//! # }
//! ```
//!
//! # Above which amplitude does it quench?
//!
//! ```
//! # use quell::Study;
//! use quell::RealInterval;
//! use quell::verbs::verbs;
//! use quell::run::protocol::Protocol;
//! use quell::run::thresholds::ThresholdsRequest;
//!
//! # fn main() -> Result<(), quell::Failure> {
//! # let text = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.05\n[friction]\nlaw = \"stribeck\"\n\
//! #     static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\n\
//! #     direction = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.52\nfrequency_ratio = 10.0\n";
//! # let study = Study::parse(text, &[])?;
//! let request = ThresholdsRequest {
//!     parameter: "dither.amplitude".to_owned(),
//!     window: RealInterval::new(0.4, 0.6),
//!     protocols: vec![Protocol::Rest],
//!     ..ThresholdsRequest::default()
//! };
//! let found = verbs(&study).thresholds(&request)?.json();
//! assert!((found["local"][0]["value"].as_f64().unwrap_or(0.0) - 0.4965619).abs() < 1e-7);
//! # Ok(())
//! # }
//! ```
//!
//! # How does the stability criterion vary with the amplitude?
//!
//! ```
//! # use quell::BeltStudy;
//! use std::sync::atomic::AtomicBool;
//!
//! use quell::map;
//! use quell::running::Running;
//! use quell::sweep::{MapQuantity, Plan};
//!
//! # fn main() -> Result<(), quell::Failure> {
//! # let text = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.05\n[friction]\nlaw = \"stribeck\"\n\
//! #     static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\n\
//! #     direction = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.52\nfrequency_ratio = 10.0\n";
//! let axis = "[[sweep]]\nparameter = \"dither.amplitude\"\nfrom = 0.1\nto = 0.6\npoints = 6\n";
//! let study = BeltStudy::parse(&format!("{text}{axis}"), &[])?;
//! let plan = Plan::new(&study, &[MapQuantity::named("criterion", "quantity")?])?;
//! let running = Running { threads: None, stop: &AtomicBool::new(false), progress: &() };
//! let map = map::run(plan, None, running)?;
//! let least = map.summaries()[0].least.clone().expect("known everywhere");
//! assert_eq!(least.place.len(), 1);
//! # Ok(())
//! # }
//! ```
//!
//! # Does this disc squeal?
//!
//! ```
//! use quell::DiscStudy;
//! use quell::run::disc::stability;
//!
//! # fn main() -> Result<(), quell::Failure> {
//! let text = r#"
//!     [disc]
//!     inner_radius_ratio = 0.5
//!     poisson_ratio = 0.3
//!     radial_modes = 1
//!     nodal_diameters = 2
//!     [disc.load]
//!     radius_ratio = 0.75
//!     stiffness = 0.1
//!     friction = 0.05
//!     speed = 0.4
//! "#;
//! let study = DiscStudy::parse(text, &[])?;
//! let found = stability::run(&study)?;
//! println!("{}", found.sentence(&study));
//! assert!(found.growth.rate > 0.0);
//! # Ok(())
//! # }
//! ```
//!
//! # How do I use my own friction law?
//!
//! Give a formula of the slip velocity `v`. It is proven finite and non-negative up to the velocities that occur:
//!
//! ```
//! use quell::Study;
//! use quell::verbs::verbs;
//!
//! # fn main() -> Result<(), quell::Failure> {
//! let text = r#"
//!     [belt]
//!     damping_ratio = 0.005
//!     normal_load = 1.0
//!     belt_velocity = 0.2
//!     [friction]
//!     law = "expression"
//!     coefficient = "0.3 + 0.1*exp(-abs(v)/c)"
//!     constants = { c = 0.1 }
//! "#;
//! let found = verbs(&Study::parse(text, &[])?).stability()?;
//! println!("{}", found.text());
//! # Ok(())
//! # }
//! ```
//!
//! # Modules
//!
//! | module | content |
//! |---|---|
//! | [`verbs`] | the verbs of a study, as answers that are presented |
//! | [`run`], [`needs`], [`running`] | one function per question, what it needs of a study, and how it is run (`quell-verbs`) |
//! | [`study`], [`complaint`], [`schema`] | studies and complaints about invalid ones (`quell-study`) |
//! | [`keys`] | the keys of a study file in words |
//! | [`measurement`], [`record`] | measured friction, time series and spectra in files (`quell-study`) |
//! | [`map`], [`sweep`], [`store`], [`status`] | maps: points, quantities, why a value is unknown; stores that survive interruptions (`quell-maps`) |
//! | [`picture`], [`plot`] | pictures of outcomes; figures as data (`quell-plot`) |
//! | [`dataset`], [`fields`], [`output`] | labelled arrays, JSON objects, files that are complete or absent |
//! | [`table_file`] | datasets as CSV, MATLAB and NetCDF files |
//! | [`report`], [`html`] | one page about a study; pages in HTML |
//! | [`sound`] | the velocity of a motion as a sound file |
//! | [`cite`], [`template`] | sources of a study's computations; commented studies to start from |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod html;
pub mod keys;
pub mod outcome;
pub mod picture;
pub mod report;
pub mod table_file;
pub mod template;
pub mod verbs;

pub use quell_input::{complaint, document, input, measurement, nearest, record, said};
pub use quell_maps::{map, store, sweep};
pub use quell_numerics::interval::RealInterval;
pub use quell_plot as plot;
pub use quell_study::{quantity, schema, study};
pub use quell_verbs::{
    cite, dataset, fields, needs, output, parallel, run, running, sound, status, words,
};
use quell_verbs::{disc_units, noise};

pub use complaint::{Complaint, Complaints, Failure, Fault, Origin};
pub use study::{BeltStudy, Change, DiscStudy, Study};
