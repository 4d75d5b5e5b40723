//! How the house is built: modules name what is below them alone.

use std::fs;
use std::path::{Path, PathBuf};

/// The floor of each module. Those that only hand on what is elsewhere, as `error`, have none.
const FLOORS: [(&str, u32); 13] = [
    ("geom", 0),
    ("solid", 1),
    ("io", 1),
    ("eval", 2),
    ("space", 3),
    ("mesh", 4),
    ("raster", 4),
    ("distance", 5),
    ("query", 6),
    ("render", 7),
    ("measure", 7),
    ("code", 8),
    ("fit", 9),
];

fn floor(module: &str) -> Option<u32> {
    FLOORS.iter().find(|(name, _)| *name == module).map(|(_, floor)| *floor)
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("it is there") {
        let path = entry.expect("it can be read").path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// The text of a file without comments and without its tests, which may ask from above.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("it can be read");
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    text.lines().filter(|line| !line.trim_start().starts_with("//")).map(|line| format!("{line}\n")).collect()
}

/// The words that follow `crate::`, alone or in braces, and are modules.
fn named(code: &str) -> Vec<String> {
    let word = |text: &str| text.trim().chars().take_while(|c| c.is_ascii_lowercase() || *c == '_').collect::<String>();
    let after = code.split("crate::").skip(1);
    let words = |rest: &str| match rest.strip_prefix('{') {
        Some(list) => list.split(';').next().unwrap_or_default().split(',').map(word).collect::<Vec<_>>(),
        None => vec![word(rest)],
    };
    after.flat_map(words).filter(|name| floor(name).is_some()).collect()
}

#[test]
fn no_module_names_one_above() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut count = 0;
    for (module, own) in FLOORS {
        let mut found = Vec::new();
        files(&root.join(module), &mut found);
        for path in found.into_iter().filter(|path| !path.ends_with("tests.rs")) {
            for name in named(&code(&path)) {
                count += 1;
                let other = floor(&name).expect("it has one");
                assert!(other < own || name == module, "{} names {name}, which is above", path.display());
            }
        }
    }
    assert!(count > 300, "{count}");
    // What the test is for is seen.
    assert_eq!(named("use crate::{Bounds, distance::compiled};\nlet a = crate::mesh::Slopes"), ["distance", "mesh"]);
}
