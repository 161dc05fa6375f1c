//! A document as TOML: what is read from it is the same document.

use std::fmt::Write as _;

use serde_json::Value as Json;

use crate::document::{Node, Table, Value, given_number};

impl Table {
    /// The text, tables after plain keys, and matrices row by row. Numbers have the digits that read back as the same number.
    ///
    /// ```
    /// use quell_input::document::Table;
    ///
    /// let text = "title = \"Two masses\"\n\n[system]\nmass = [\n  [1, 0.5],\n  [0.5, 2],\n]\n\n[[contact]]\nname = \"pad\"\n";
    /// assert_eq!(Table::parse(text)?.to_toml(), text);
    /// # Ok::<(), quell_input::complaint::Complaints>(())
    /// ```
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        write_table(&mut text, "", self);
        text
    }
}

/// The tables of a list of tables.
fn tables(node: &Node) -> Option<Vec<&Table>> {
    let Value::List(list) = &node.value else { return None };
    let tables: Option<Vec<&Table>> = list.iter().map(Node::table).collect();
    tables.filter(|tables| !tables.is_empty())
}

fn write_table(text: &mut String, path: &str, table: &Table) {
    let of = |name: &str| {
        let name = key(name);
        if path.is_empty() { name } else { format!("{path}.{name}") }
    };
    for (name, node) in
        table.iter().filter(|(_, node)| node.table().is_none() && tables(node).is_none())
    {
        let _ = write!(text, "{} = ", key(name));
        write_value(text, &node.value, true);
        text.push('\n');
    }
    for (name, node) in table.iter() {
        let path = of(name);
        let alone = node.table().map(|inner| (format!("[{path}]"), inner));
        let several = tables(node).into_iter().flatten();
        for (header, inner) in
            alone.into_iter().chain(several.map(|inner| (format!("[[{path}]]"), inner)))
        {
            if !text.is_empty() {
                text.push('\n');
            }
            let _ = writeln!(text, "{header}");
            write_table(text, &path, inner);
        }
    }
}

/// A key, quoted where it is not bare.
fn key(name: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(is_bare) { name.to_owned() } else { quoted(name) }
}

/// A string between quotes; JSON escapes what TOML does.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string().replace('\u{7f}', "\\u007f")
}

fn write_value(text: &mut String, value: &Value, alone: bool) {
    match value {
        Value::Number(number) => {
            // Whole numbers as people write them.
            let _ = match given_number(*number) {
                Json::Number(whole) if whole.is_i64() => write!(text, "{whole}"),
                _ => write!(text, "{number:?}"),
            };
        }
        Value::Text(word) => text.push_str(&quoted(word)),
        Value::Flag(flag) => {
            let _ = write!(text, "{flag}");
        }
        Value::Date(date) => text.push_str(date),
        Value::List(rows)
            if alone && rows.iter().any(|row| matches!(row.value, Value::List(_))) =>
        {
            text.push_str("[\n");
            for row in rows {
                text.push_str("  ");
                write_value(text, &row.value, false);
                text.push_str(",\n");
            }
            text.push(']');
        }
        Value::List(list) => write_all(text, "[", list.iter().map(|node| (None, node)), "]"),
        Value::Table(table) => {
            let entries = table.iter().map(|(name, node)| (Some(key(name)), node));
            write_all(text, "{ ", entries, " }");
        }
    }
}

/// Entries between brackets.
fn write_all<'n>(
    text: &mut String,
    open: &str,
    entries: impl Iterator<Item = (Option<String>, &'n Node)>,
    close: &str,
) {
    text.push_str(open);
    for (place, (name, node)) in entries.enumerate() {
        if place > 0 {
            text.push_str(", ");
        }
        if let Some(name) = name {
            let _ = write!(text, "{name} = ");
        }
        write_value(text, &node.value, false);
    }
    text.push_str(close);
}
