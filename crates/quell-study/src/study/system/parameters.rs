//! `[parameters]`: named numbers, or formulas of other parameters.

use quell_input::complaint::{Complaint, Fault};
use quell_input::document::{Node, Table, Value};
use quell_model::friction::expression::{NumberFormula, is_name, is_taken};
use quell_model::parameter::Bounds;

use crate::study::reader::{NumbersByName, Reader};

/// A parameter while it is evaluated.
enum ParameterStep<'t> {
    Known(f64),
    Formula(&'t Node, NumberFormula),
    /// Reported already.
    Wrong,
}

/// Reads the parameters. A parameter that is wrong is reported and has the value NaN.
pub(super) fn read(reader: &mut Reader, document: &Table) -> NumbersByName {
    let none = NumbersByName::default();
    let Some(table) = document.get("parameters").and_then(|node| reader.table("parameters", node))
    else {
        return none;
    };
    let names: Vec<String> = table.iter().map(|(name, _)| name.to_owned()).collect();
    let known: Vec<&str> = names.iter().map(String::as_str).collect();
    let steps: Vec<ParameterStep<'_>> =
        table.iter().map(|(name, node)| step(reader, name, node, &known)).collect();
    let mut values: Vec<Option<f64>> = vec![None; steps.len()];
    for index in 0..steps.len() {
        evaluate(reader, &names, &steps, &mut values, index);
    }
    let values = values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect();
    NumbersByName { names, values }
}

fn step<'t>(reader: &mut Reader, name: &str, node: &'t Node, known: &[&str]) -> ParameterStep<'t> {
    let key = format!("parameters.{name}");
    if !is_name(name) || is_taken(name) {
        let allowed = if name == "v" {
            "must have another name: in formulas v is the slip velocity"
        } else {
            "must have a name of letters, digits and _ that is no function, constant or variable of formulas"
        };
        let complaint = Complaint::new(Fault::Conflict, key, node.origin, node.given(), allowed);
        reader.complain(complaint);
        return ParameterStep::Wrong;
    }
    match &node.value {
        Value::Number(number) if number.is_finite() => ParameterStep::Known(*number),
        Value::Text(text) => match NumberFormula::parse(text, known) {
            Ok(formula) => ParameterStep::Formula(node, formula),
            Err(error) => {
                reader.wrong(&key, node, format!("a number or a formula of parameters; {error}"));
                ParameterStep::Wrong
            }
        },
        Value::Number(_) => {
            reader.wrong(&key, node, Bounds::FINITE.to_string());
            ParameterStep::Wrong
        }
        _ => {
            let allowed = format!("a number or a formula of parameters; got {}", node.kind());
            reader.wrong(&key, node, allowed);
            ParameterStep::Wrong
        }
    }
}

/// Evaluates a parameter after those that it uses. The depth is bounded by an explicit stack.
fn evaluate(
    reader: &mut Reader,
    names: &[String],
    steps: &[ParameterStep<'_>],
    values: &mut [Option<f64>],
    first: usize,
) {
    let mut path = vec![first];
    while let Some(&index) = path.last() {
        let (node, formula) = match &steps[index] {
            ParameterStep::Known(value) => {
                values[index] = Some(*value);
                path.pop();
                continue;
            }
            ParameterStep::Formula(node, formula) if values[index].is_none() => (node, formula),
            ParameterStep::Formula(..) | ParameterStep::Wrong => {
                values[index].get_or_insert(f64::NAN);
                path.pop();
                continue;
            }
        };
        let open = formula.uses().into_iter().find(|&used| values[used].is_none());
        let Some(used) = open else {
            let all: Vec<f64> = values.iter().map(|value| value.unwrap_or(f64::NAN)).collect();
            let value = formula.value(&all);
            let uses_wrong = formula.uses().iter().any(|&used| all[used].is_nan());
            if !value.is_finite() && !uses_wrong {
                let key = format!("parameters.{}", names[index]);
                reader.wrong(&key, node, format!("a finite number; its value is {value}"));
            }
            values[index] = Some(if value.is_finite() { value } else { f64::NAN });
            path.pop();
            continue;
        };
        if let Some(start) = path.iter().position(|&open| open == used) {
            let ring: Vec<&str> =
                path[start..].iter().chain([&used]).map(|&index| names[index].as_str()).collect();
            let key = format!("parameters.{}", names[used]);
            let at = match &steps[used] {
                ParameterStep::Formula(node, _) => node,
                ParameterStep::Known(_) | ParameterStep::Wrong => node,
            };
            let allowed = format!("a formula that does not need itself: {}", ring.join(" → "));
            reader.wrong(&key, at, allowed);
            for &index in &path[start..] {
                values[index] = Some(f64::NAN);
            }
            path.truncate(start);
        } else {
            path.push(used);
        }
    }
}
