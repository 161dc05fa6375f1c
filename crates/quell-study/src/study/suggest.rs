//! Suggests the nearest valid key for an unknown one, by its symbol (`zeta`, `v0`, `D_T`) or its letters.

use quell_input::nearest::{NEAR, likeness};

use super::vocabulary::{self, DocumentKind, Key, Section};

/// The nearest key to an unknown one of a table.
pub fn key(kind: DocumentKind, table: Section, name: &str) -> Option<&'static Key> {
    let score = |key: &Key| {
        let letters = if same_symbol(name, key) { 1.0 } else { likeness(name, key.name) };
        // A key of the same table is preferred, unless a key of another table matches much better; a name without a table may
        // belong to any.
        let elsewhere = if table == Section::Root { 0.1 } else { 0.35 };
        letters - if key.section == table { 0.0 } else { elsewhere }
    };
    vocabulary::keys()
        .iter()
        .filter(|key| key.scope.includes(kind))
        .filter(|key| key.section == table || key.role.inner().is_none())
        .filter(|key| key.section != Section::Sweep || table == Section::Sweep)
        .map(|key| (score(key), key))
        .filter(|(score, _)| *score >= NEAR)
        // Among equal scores the outermost is taken, and the first of them: keys are in the order of the file, dimensionless before SI.
        .rev()
        .max_by(|a, b| a.0.total_cmp(&b.0).then_with(|| depth(b.1).cmp(&depth(a.1))))
        .map(|(_, key)| key)
}

/// How many tables a key is within.
fn depth(key: &Key) -> usize {
    key.section.path().split('.').count()
}

/// Whether a key was named by its symbol, as `zeta` for ζ or `mu_s` for μ_s.
fn same_symbol(name: &str, key: &Key) -> bool {
    let vocabulary::Role::Number(parameter) = key.role else { return false };
    let name = spelled(name);
    // An amplitude is also asked for by the symbol of its force.
    let of_twins = parameter.si.iter().filter_map(|twin| Some(twin.own?.0));
    [parameter.symbol].into_iter().chain(of_twins).any(|symbol| {
        let symbol = spelled(symbol);
        name == symbol || (symbol == "d" && (name == "dt" || name == "dn"))
    })
}

/// A symbol in plain letters: Greek letters by name, no underscores, subscripts as digits.
fn spelled(symbol: &str) -> String {
    let mut plain = String::new();
    for letter in symbol.chars() {
        match letter {
            'ζ' => plain.push_str("zeta"),
            'μ' => plain.push_str("mu"),
            'φ' => plain.push_str("phi"),
            'ε' => plain.push_str("epsilon"),
            'τ' => plain.push_str("tau"),
            'ξ' => plain.push_str("xi"),
            'ν' => plain.push_str("nu"),
            'ρ' => plain.push_str("rho"),
            'β' => plain.push_str("beta"),
            'θ' => plain.push_str("theta"),
            'ω' | 'Ω' => plain.push_str("omega"),
            '₀' => plain.push('0'),
            '_' | '*' => {}
            other => plain.extend(other.to_lowercase()),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typing_errors_are_understood() {
        for (table, wrong, right) in [
            ("belt", "dampng_ratio", "belt.damping_ratio"),
            ("belt", "dampingratio", "belt.damping_ratio"),
            ("belt", "zeta", "belt.damping_ratio"),
            ("belt", "v0", "belt.belt_velocity"),
            ("belt", "velocity", "belt.belt_velocity"),
            ("belt", "mas", "belt.mass"),
            ("friction", "mu_s", "friction.static_coefficient"),
            ("friction", "damping_ratio", "belt.damping_ratio"),
            ("dither", "freqency_ratio", "dither.frequency_ratio"),
            ("dither", "amplitud", "dither.amplitude"),
            ("dither", "D_T", "dither.amplitude"),
            ("", "titel", "title"),
            ("", "amplitude", "dither.amplitude"),
            ("", "a", "dither.amplitude"),
            ("solver", "tolerence", "solver.tolerance"),
        ] {
            let table = Section::ALL.iter().find(|section| section.path() == table).copied();
            let found = key(DocumentKind::Belt, table.expect("a table"), wrong).map(Key::path);
            assert_eq!(found.as_deref(), Some(right), "{wrong}");
        }
        assert_eq!(key(DocumentKind::Belt, Section::Belt, "xyzzy"), None);
    }
}
