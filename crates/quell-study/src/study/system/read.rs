//! Reads the tables of a system.

use std::sync::Arc;

use quell_design::actuator::Actuator;
use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_input::frequency_response::FrequencyResponse;
use quell_model::system::{Input, Structure};
use quell_model::{Contact, System, Waveform};
use serde_json::Value as Json;

use super::contact::{self, ContactContext, ReadContact};
use super::dither::{self, DitherContext, ReadDithers};
use super::frequency_response;
use super::modes;
use super::rows::RowBasis;
use super::setup::{RecordSettings, SystemSetup};
use super::structure::{self, ReadStructure};
use super::{initial, parameters, sized, unused};
use crate::study::actuator;
use crate::study::design::{self, DesignContext};
use crate::study::dither_size::GivenSize;
use crate::study::path::amplitude_of;
use crate::study::reader::{NumbersByName, Reader};
use crate::study::vocabulary::{Choice, Section};
use crate::study::{passivity, plausible};
use quell_model::units::UnitSystem;

/// Adds what is valid but unlikely, or without effect, to the study of a system that was read from a document.
pub(super) fn with_warnings(setup: SystemSetup, document: &Table) -> SystemSetup {
    let Some(table) = document.get("system").and_then(Node::table) else { return setup };
    let known = KnownSystem { system: &setup.system, measured: setup.response.is_some() };
    let mut warnings = warnings(document, table, (setup.units, &setup.named), known);
    warnings.extend(setup.warnings);
    warnings.extend(passivity::warnings(&setup.system.contacts, setup.units));
    SystemSetup { warnings, ..setup }
}

/// Reads the study of a system without its warnings; `None` if something is wrong, which has then been reported.
pub(super) fn study(reader: &mut Reader, document: &Table) -> Option<SystemSetup> {
    let equations = SystemEquations::read(reader, document)?;
    let context = equations.dither_context();
    let places = dither::places(reader, document, context);
    let inputs = equations.dithers.as_ref().map(|(inputs, _)| inputs.as_slice());
    let context = DesignContext {
        waveform: inputs.and_then(|inputs| designed_wave(document, inputs)),
        document,
        places: places.as_deref().unwrap_or(&[]),
    };
    let design = design::read(reader, document, context);
    let SystemEquations { table, ref basis, first_order, .. } = equations;
    let observe = initial::observe(reader, table, basis);
    let initial = initial::read(reader, table, basis, first_order);
    let (units, named, response) =
        (equations.units, equations.named.clone(), equations.response.clone());
    let basis = equations.basis.clone();
    let (warnings, actuator) = (equations.warnings.clone(), equations.actuator.clone());
    let (system, sizes) = equations.assembled(reader)?;
    let System { structure, contacts, .. } = &system;
    let observe = observe.ok()?.unwrap_or_else(|| initial::default_row(contacts, structure));
    Some(SystemSetup {
        system: Arc::new(system),
        basis,
        observe,
        initial: initial?,
        units,
        named,
        warnings,
        response,
        design: design.filter(|_| places.is_some())?,
        actuator: actuator?,
        sizes: sizes.into(),
        tolerance: None,
        record: RecordSettings::default(),
        time: None,
    })
}

/// Reads the equations of a system and nothing else; `None` if something is wrong, which has then been reported.
pub(in crate::study) fn assemble(reader: &mut Reader, document: &Table) -> Option<System> {
    SystemEquations::read(reader, document)?.assembled(reader).map(|(system, _)| system)
}

/// The equations of the tables of a system, as far as they are right.
struct SystemEquations<'t> {
    document: &'t Table,
    /// The table `[system]`.
    table: &'t Table,
    units: UnitSystem,
    named: NumbersByName,
    basis: Arc<RowBasis>,
    first_order: bool,
    structure: Option<Structure>,
    response: Option<Arc<FrequencyResponse>>,
    /// Names of all contacts, right or wrong.
    names: Vec<String>,
    contacts: Option<Vec<Contact>>,
    warnings: Vec<String>,
    has_actuator: bool,
    #[expect(clippy::option_option, reason = "invalid, absent, given")]
    actuator: Option<Option<Actuator>>,
    dithers: Option<ReadDithers>,
}

impl<'t> SystemEquations<'t> {
    /// Reads them; `None` where not even the coordinates are known.
    fn read(reader: &mut Reader, document: &'t Table) -> Option<Self> {
        let units = units(reader, document);
        reader.set_file_units(units);
        let named = parameters::read(reader, document);
        reader.set_named(named.clone());
        let node = document.get("system");
        let header = node.map_or(Origin::Whole, |node| node.origin);
        let Some(node) = node else {
            let allowed = "a table [system] with coordinates, mass and stiffness";
            reader.missing("system", header, allowed);
            return None;
        };
        let table = reader.table("system", node)?;
        reader.unknown_keys(table, Section::System, "system");
        let body = reader.part(table, (), |reader| Some(body(reader, table, header)));
        let (ReadStructure { basis, structure }, response) = body?;
        reader.set_natural_frequency(structure.as_ref().and_then(Structure::natural_frequency));
        // Without names no row can be read.
        let basis = basis?;
        let first_order = table.has("states");
        let context = ContactContext {
            basis: &basis,
            first_order,
            measured: response.is_some(),
            shared: document.get("friction"),
            modulated: &dither::modulated(document),
        };
        let contacts = contact::read(reader, document, context);
        let warnings = contacts.iter().flatten().filter_map(ReadContact::warning).collect();
        let contacts: Option<Vec<Contact>> =
            contacts.map(|read| read.into_iter().map(|read| read.contact).collect());
        let mut equations = Self {
            document,
            table,
            units,
            named,
            basis,
            first_order,
            structure,
            response,
            names: contact::names(document),
            contacts,
            warnings,
            has_actuator: document.has("actuator"),
            actuator: None,
            dithers: None,
        };
        equations.dithers = dither::read(reader, document, equations.dither_context());
        equations.actuator = actuator::read(reader, document);
        Some(equations)
    }

    /// What a dither refers to.
    fn dither_context(&self) -> DitherContext<'_> {
        DitherContext {
            basis: &self.basis,
            names: &self.names,
            contacts: self.contacts.as_deref(),
            has_actuator: self.has_actuator,
        }
    }

    /// The system, with the amplitudes that an actuator determines, and every amplitude that is given by another size than a peak force.
    fn assembled(self, reader: &mut Reader) -> Option<(System, Vec<GivenSize>)> {
        let (inputs, sizes) = self.dithers?;
        let mut system = System { structure: self.structure?, contacts: self.contacts?, inputs };
        let known = self.actuator.as_ref().and_then(Option::as_ref);
        let sizes = sized::amplitudes(reader, &mut system, known, sizes)?;
        contact::placed_in(reader, self.document, &mut system)?;
        if let (Some(response), Some(node)) = (&self.response, self.table.get("frequency_response"))
        {
            let System { contacts, inputs, .. } = &system;
            frequency_response::check_pairs(reader, node, response, contacts, inputs);
        }
        Some((system, sizes))
    }
}

/// The waveform of the dither whose amplitude `[design]` chooses.
fn designed_wave<'i>(document: &Table, inputs: &'i [Input]) -> Option<&'i Waveform> {
    let design = document.get("design")?.table()?;
    let Value::List(paths) = &design.get("vary")?.value else { return None };
    let input = paths.iter().find_map(|node| match &node.value {
        Value::Text(path) => amplitude_of(document, path),
        _ => None,
    });
    inputs.get(input?)?.profile.waves().first().map(|wave| &wave.waveform)
}

/// A system, and whether its structure is measured.
#[derive(Clone, Copy)]
struct KnownSystem<'a> {
    system: &'a System,
    measured: bool,
}

/// The warnings about a valid study.
fn warnings(
    document: &Table,
    table: &Table,
    (units, named): (UnitSystem, &NumbersByName),
    known: KnownSystem<'_>,
) -> Vec<String> {
    let KnownSystem { system, measured } = known;
    let modal = table.has("mode") || table.has("modes") || table.has("component");
    let plausible = (!measured).then(|| plausible::warnings(system, units, modal));
    let half = table.has("coordinates").then(|| plausible::half_symmetric(system));
    let idle = (!measured).then(|| contact::without_rows(&system.contacts)).into_iter().flatten();
    let listed = plausible.into_iter().chain(half).flatten().chain(idle);
    listed.chain(unused::warning(document, named)).collect()
}

fn units(reader: &mut Reader, document: &Table) -> UnitSystem {
    let system = document.get("system").and_then(|node| node.table());
    let Some(node) = system.and_then(|table| table.get("units")) else {
        return UnitSystem::None;
    };
    // Where the word is wrong, numbers with units are no further faults.
    let name = reader.choice("system.units", node, Choice::Units);
    name.map_or(UnitSystem::Si, |name| UnitSystem::from_name(name).unwrap_or_default())
}

/// The keys that a form of the structure has, the first of which choose it.
const FORMS: &[(&[&str], &[&str])] = &[
    (&["coordinates"], &["mass", "damping", "stiffness"]),
    (&["states"], &["matrix"]),
    (&["mode", "modes"], &["normalisation"]),
    (&["component"], &[]),
    (&["frequency_response"], &[]),
];

/// Reads the structure in the form that its keys choose, and its measured response in that form.
fn body(
    reader: &mut Reader,
    table: &Table,
    header: Origin,
) -> (ReadStructure, Option<Arc<FrequencyResponse>>) {
    let chosen = FORMS.iter().find(|(first, _)| first.iter().any(|name| table.has(name)));
    let Some(form @ (first, _)) = chosen else {
        let allowed = "the names of the coordinates, with mass and stiffness; or states and matrix, mode or modes, \
                       component, or frequency_response";
        reader.missing("system.coordinates", header, allowed);
        return (ReadStructure::default(), None);
    };
    other_forms(reader, table, form);
    match first[0] {
        "coordinates" => (structure::mechanical(reader, table, header), None),
        "states" => (structure::first_order(reader, table, header), None),
        "frequency_response" => {
            let node = table.get("frequency_response");
            let response = node.and_then(|node| frequency_response::read(reader, node));
            let body = response
                .as_ref()
                .map(|response| structure::of_names(reader, table, response.names.clone()));
            (body.unwrap_or_default(), response)
        }
        _ => (modes::read(reader, table, header), None),
    }
}

/// Reports keys of other forms.
fn other_forms(reader: &mut Reader, table: &Table, form: &(&[&str], &[&str])) {
    let own = |name: &str| form.0.contains(&name) || form.1.contains(&name);
    for (first, further) in FORMS {
        for name in first.iter().chain(*further).filter(|name| !own(name)) {
            if let Some(node) = table.get(name) {
                let key = format!("system.{name}");
                let allowed = format!("does not belong to a structure given by {}", form.0[0]);
                let complaint =
                    Complaint::new(Fault::Conflict, key, node.origin, Json::Null, allowed);
                reader.complain(complaint);
            }
        }
    }
}
