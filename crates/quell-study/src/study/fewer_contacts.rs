//! A study with some of its contacts alone, each of which stands for others.

use quell_input::complaint::{Complaint, Complaints, Fault, Origin};
use quell_input::document::{Node, Value};
use quell_model::parameter::system::{
    CONTACT_NORMAL_DAMPING, CONTACT_NORMAL_LOAD, CONTACT_NORMAL_STIFFNESS,
    CONTACT_TANGENTIAL_STIFFNESS,
};
use quell_model::system::Contact;
use serde_json::Value as Json;

use super::path::set;
use super::{Kind, Study};

impl Study {
    /// The study of a system with these contacts alone, counted from 0 and ascending, whose loads, stiffnesses and damping are multiplied
    /// by the factors.
    ///
    /// # Errors
    /// A study of another kind; all complaints about the changed study, such as that of a path to a contact that is left out.
    pub fn with_contacts(&self, kept: &[(usize, f64)]) -> Result<Self, Complaints> {
        let Kind::System(setup) = self.kind() else {
            let allowed = "a study of a system";
            return Err(Complaint::new(
                Fault::Conflict,
                "contact",
                Origin::Whole,
                Json::Null,
                allowed,
            )
            .into());
        };
        let contacts = &setup.system().contacts;
        let mut document = self.source.document.clone();
        for (place, factor) in kept.iter().filter(|(_, factor)| *factor != 1.0) {
            for (name, value) in sizes(&contacts[*place]) {
                let path = format!("contact.{}.{name}", contacts[*place].name);
                let value = Value::Number(factor * value);
                set(&mut document, &path, &Node { value, origin: Origin::Whole })?;
            }
        }
        if let Some(Value::List(tables)) = document.get_mut("contact").map(|node| &mut node.value) {
            let mut place = 0..;
            tables.retain(|_| place.next().is_some_and(|at| kept.iter().any(|(k, _)| *k == at)));
        }
        Self::parse_with(&document.to_toml(), &[], &self.source.files)
    }
}

/// What is a share of the whole surface in a contact: its load and what is given of stiffness and damping.
fn sizes(contact: &Contact) -> Vec<(&'static str, f64)> {
    let given = [
        (CONTACT_NORMAL_STIFFNESS, contact.normal_stiffness),
        (CONTACT_NORMAL_DAMPING, contact.normal_damping),
        (CONTACT_TANGENTIAL_STIFFNESS, contact.tangential_stiffness.unwrap_or(0.0)),
    ];
    let given = given.into_iter().filter(|(_, value)| *value != 0.0);
    let load = (CONTACT_NORMAL_LOAD, contact.normal_load);
    std::iter::once(load).chain(given).map(|(of, value)| (of.key(), value)).collect()
}
