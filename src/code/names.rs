//! Names of variables and functions.

use std::collections::{BTreeMap, BTreeSet};

/// Names end here.
const LONGEST: usize = 24;

/// What no variable may be called: Rust's words, and the functions that are called.
const TAKEN: &[&str] = &[
    "_", "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "deg", "do",
    "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro",
    "match", "mod", "move", "mut", "override", "priv", "pub", "rad", "ref", "return", "rvachev", "self", "static",
    "struct", "super", "trait", "true", "try", "type", "typeof", "unsafe", "unsized", "use", "virtual", "where",
    "while", "yield",
];

/// A name in the style of variables: words in lower case between underscores. `other` where
/// nothing of the text is left.
pub(super) fn identifier(text: &str, other: &str) -> String {
    let mut name = String::new();
    for c in text.chars() {
        let is_gap = name.is_empty() || name.ends_with('_');
        match c {
            'a'..='z' | '0'..='9' => name.push(c),
            'A'..='Z' => name.push(c.to_ascii_lowercase()),
            // Digits of a number stay apart.
            _ if !is_gap => name.push('_'),
            _ => {}
        }
    }
    name.truncate(LONGEST);
    let name = name.trim_matches('_');
    match name.chars().next() {
        None => other.to_string(),
        Some('0'..='9') => format!("{other}_{name}"),
        Some(_) if TAKEN.contains(&name) => format!("{name}_{other}"),
        Some(_) => name.to_string(),
    }
}

/// The names that are in use.
#[derive(Default)]
pub(super) struct Names {
    taken: BTreeSet<String>,
    /// The number behind a name that was given last.
    last: BTreeMap<String, u64>,
}

impl Names {
    /// Those that are in use already.
    pub(super) fn among(taken: &BTreeSet<String>) -> Names {
        Names { taken: taken.clone(), ..Names::default() }
    }

    pub(super) fn is_free(&self, name: &str) -> bool {
        !self.taken.contains(name) && !TAKEN.contains(&name)
    }

    /// This name, or with a number behind it.
    pub(super) fn take(&mut self, name: &str) -> String {
        let mut free = name.to_string();
        while !self.is_free(&free) {
            let last = self.last.entry(name.to_string()).or_insert(1);
            *last += 1;
            free = format!("{name}_{last}");
        }
        self.taken.insert(free.clone());
        free
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_words_of_rust() {
        let of = |text| identifier(text, "part");
        assert_eq!(of("Hole 6.35 (through)"), "hole_6_35_through");
        assert_eq!(of("2nd hole"), "part_2nd_hole");
        assert_eq!((of("øø"), of(""), of("__")), ("part".into(), "part".into(), "part".into()));
        assert_eq!((of("type"), of("Self"), of("deg")), ("type_part".into(), "self_part".into(), "deg_part".into()));
        let mut names = Names::default();
        assert_eq!([(); 3].map(|()| names.take("pin")), ["pin", "pin_2", "pin_3"]);
    }
}
