//! Random solids as code, compiled by `rustc` against the library that the tests are linked with.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

use glam::DVec3;
use rvachev::Solid;
use rvachev::catalogue::Part;

use super::{assert_same, file, formatted, parts};
use crate::battery::make;

/// What is asked of a solid: its own code, and the bits of values.
fn answers(solid: &Solid) -> String {
    let values = [DVec3::ZERO, DVec3::new(0.3, -0.7, 0.2), DVec3::new(1.5, 1.0 / 3.0, -0.25)];
    let bits = values.map(|p| solid.value(p).map_or(0, f64::to_bits));
    format!("{}{bits:x?}\n", solid.to_rust("solid"))
}

const ANSWERS: &str = r#"
fn main() {
    for (_, make) in SOLIDS {
        let solid = make();
        let values = [[0.0, 0.0, 0.0], [0.3, -0.7, 0.2], [1.5, 1.0 / 3.0, -0.25]];
        let bits = values.map(|p| solid.value(p).map_or(0, f64::to_bits));
        print!("{}{bits:x?}\n", solid.to_rust("solid"));
    }
}
"#;

/// The library that was built last, beside the test.
fn library(deps: &Path) -> Option<PathBuf> {
    let files = std::fs::read_dir(deps).ok()?.filter_map(Result::ok).map(|entry| entry.path());
    let is_library = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("librvachev-") && name.ends_with(".rlib")
    };
    let age = |path: &PathBuf| path.metadata().and_then(|data| data.modified()).unwrap_or(SystemTime::UNIX_EPOCH);
    files.filter(is_library).max_by_key(age)
}

#[test]
#[ignore = "compiles 300 random solids: 2 min"]
fn random_solids_are_compiled_and_are_the_same() {
    let mut solids: Vec<Solid> = (0..600).filter_map(make::solid).take(300).collect();
    solids.extend(parts().into_iter().filter_map(|(_, part)| part.into_solid()));
    let has_code = |solid: &Solid| !solid.to_rust("solid").contains("Result<");
    solids.retain(has_code);
    let named: Vec<(String, Part)> =
        solids.iter().enumerate().map(|(i, solid)| (format!("solid_{i}"), Part::Solid(solid.clone()))).collect();
    let text = file(&named);
    if let Some(wanted) = formatted(&text) {
        // Rustfmt has rules for long chains that nobody can guess.
        let kept: HashSet<&str> = wanted.split("\npub fn ").collect();
        let others: Vec<&str> = text.split("\npub fn ").filter(|function| !kept.contains(function)).collect();
        println!("{} of {} functions are broken otherwise by rustfmt", others.len(), solids.len());
        assert!(100 * others.len() <= 2 * solids.len(), "{}", others.join("\npub fn "));
    }
    let deps = std::env::current_exe().expect("a test").parent().expect("a folder").to_path_buf();
    let Some(library) = library(&deps) else { panic!("no library in {}", deps.display()) };
    let scratch = std::env::temp_dir().join(format!("rvachev-code-{}", std::process::id()));
    std::fs::create_dir_all(&scratch).expect("a folder");
    let source = scratch.join("scratch.rs");
    std::fs::write(&source, text + ANSWERS).expect("a file");
    let mut rustc = Command::new("rustc");
    rustc.args(["--edition", "2024", "-A", "warnings", "-C", "debuginfo=0"]).arg("-L");
    let mut path = std::ffi::OsString::from("dependency=");
    path.push(&deps);
    rustc.arg(path).arg("--extern");
    let mut path = std::ffi::OsString::from("rvachev=");
    path.push(&library);
    rustc.arg(path).arg("-o").arg(scratch.join("scratch")).arg(&source);
    let output = rustc.output().expect("rustc");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let output = Command::new(scratch.join("scratch")).output().expect("the scratch program");
    let found = String::from_utf8(output.stdout).expect("text");
    let wanted = solids.iter().fold(String::new(), |mut all, solid| {
        let _ = write!(all, "{}", answers(solid));
        all
    });
    assert_same(&found, &wanted, "compiled");
    let _ = std::fs::remove_dir_all(&scratch);
    println!("{} solids", solids.len());
}
