//! Rust code of solids and profiles.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use super::function::Function;
use super::layout::filled;
use super::names::{Names, identifier};
use super::syntax::Code;
use crate::catalogue::Part;
use crate::{Profile, Solid};

/// How solids are written as Rust code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RustSettings {
    /// Comments above named parts, by the [name](Solid::named). Default: none.
    pub comments: BTreeMap<String, String>,
    /// Whether a length that occurs more than once becomes a variable; of a polygon only up to 32
    /// points. 0 never does. Default: true.
    pub lengths: bool,
}

impl Default for RustSettings {
    fn default() -> RustSettings {
        RustSettings { comments: BTreeMap::new(), lengths: true }
    }
}

/// Rust code: a function for each solid or profile, and what they use.
///
/// ```
/// use rvachev::code::{RustFile, RustSettings};
/// use rvachev::{Profile, Solid};
///
/// let hole = Solid::cylinder(3.0, 12.0).named("hole");
/// let plate = Solid::cuboid([40.0, 20.0, 6.0]) - hole;
/// let mut settings = RustSettings::default();
/// settings.comments.insert("hole".into(), "for the bolt, through".into());
/// let mut file = RustFile::new(settings);
/// file.add("plate", &plate);
/// file.add_profile("washer", &(Profile::circle(5.0) - Profile::circle(3.0)));
/// assert_eq!(
///     file.to_string(),
///     r#"use rvachev::{Profile, Solid};
///
/// pub fn plate() -> Solid {
///     // for the bolt, through
///     let hole = Solid::cylinder(3.0, 12.0).named("hole");
///     Solid::cuboid([40.0, 20.0, 6.0]) - hole
/// }
///
/// pub fn washer() -> Profile {
///     Profile::circle(5.0) - Profile::circle(3.0)
/// }
/// "#
/// );
/// ```
///
/// # What is written
///
/// * A call of a method for each node, so that the function makes a solid
///   [equal](Solid#impl-PartialEq-for-Solid) to the one that was written: numbers are read back to
///   the bit.
/// * Variables for parts that have a name, called after it; for parts that occur more than once,
///   equal ones counting as one; for lengths that do ([`RustSettings::lengths`]); and for what
///   would be too long for a line.
/// * Lines are broken as rustfmt does it by its defaults for edition 2024; of long chains it may
///   differ here and there.
/// * A formula is written as its text, which the function reads: then it gives a `Result`.
///
/// # What has no code
///
/// A leaf of a user's own, an imported mesh, and a solid deformed by a law of a user's own become
/// parameters of the function, which then takes them as `&Solid` and names them in its docs.
#[derive(Clone, Debug, Default)]
pub struct RustFile {
    settings: RustSettings,
    names: BTreeSet<String>,
    words: BTreeSet<String>,
    functions: Vec<String>,
}

impl RustFile {
    /// A file without functions.
    #[must_use]
    pub fn new(settings: RustSettings) -> RustFile {
        RustFile { settings, ..RustFile::default() }
    }

    /// Adds a function that makes this solid.
    ///
    /// `name` becomes a name as Rust writes those of functions: words in lower case between
    /// underscores, at most 24 letters; `part` where nothing is left of it. Of a name that is there
    /// already there will be a second one with `_2`.
    pub fn add(&mut self, name: &str, solid: &Solid) {
        self.write(name, &solid.into());
    }

    /// Adds a function that makes this profile.
    pub fn add_profile(&mut self, name: &str, profile: &Profile) {
        self.write(name, &profile.into());
    }

    fn write(&mut self, name: &str, part: &Part) {
        let name = Names::among(&self.names).take(&identifier(name, "part"));
        let function = Function::of(&name, part, &self.settings);
        self.names.insert(name);
        self.words.extend(function.words.iter().filter_map(|word| imported(word)).map(String::from));
        self.functions.push(function.text);
    }
}

impl fmt::Display for RustFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (module, of_module) in MODULES {
            let is_of = |word: &&String| module_of(word) == *of_module;
            let words: Vec<Code> = self.words.iter().filter(is_of).map(Code::word).collect();
            let path = format!("rvachev{module}");
            match &words[..] {
                [] => {}
                [word] => writeln!(f, "use {path}::{};", word.line())?,
                words => {
                    let line = format!("use {path}::{{{}}};", super::syntax::joined(words));
                    if line.len() <= 100 {
                        writeln!(f, "{line}")?;
                    } else {
                        writeln!(f, "use {path}::{{\n{}}};", filled(words, 4))?;
                    }
                }
            }
        }
        for function in &self.functions {
            write!(f, "\n{function}")?;
        }
        Ok(())
    }
}

/// Where what is imported comes from.
const MODULES: &[(&str, Module)] =
    &[("::error", Module::Error), ("::glam", Module::Glam), ("::law", Module::Law), ("", Module::Root)];

#[derive(Clone, Copy, PartialEq, Eq)]
enum Module {
    Error,
    Glam,
    Law,
    Root,
}

fn module_of(word: &str) -> Module {
    match word {
        "FormulaError" => Module::Error,
        "DAffine2" | "DAffine3" => Module::Glam,
        "LinearLaw" | "SmoothStep" | "SineWave" | "LawTable" => Module::Law,
        _ => Module::Root,
    }
}

/// What must be imported for a word or path: its first part, if that is a type or a function.
fn imported(word: &str) -> Option<&str> {
    let first = word.split("::").next().unwrap_or_default();
    let is_type = first.starts_with(|c: char| c.is_ascii_uppercase()) && !["Vec", "Ok"].contains(&first);
    (is_type || ["deg", "rad"].contains(&first)).then_some(first)
}

impl Solid {
    /// The solid as Rust code: the text of a function of this name that makes it again, to the bit,
    /// behind the imports that it needs. With comments, or several solids in a file: [`RustFile`],
    /// which says what is written and how.
    ///
    /// ```
    /// use rvachev::{Solid, deg};
    ///
    /// let pin = Solid::cylinder(1.5, 8.0).named("pin");
    /// let hinge = pin.rotate_x(deg(90.0)) | Solid::cuboid([12.0, 8.0, 1.5]);
    /// assert_eq!(
    ///     hinge.to_rust("hinge"),
    ///     r#"use rvachev::{Solid, deg};
    ///
    /// pub fn hinge() -> Solid {
    ///     let length = 1.5;
    ///     let pin_length = 8.0;
    ///     let pin = Solid::cylinder(length, pin_length).named("pin");
    ///     let cuboid = Solid::cuboid([12.0, pin_length, length]);
    ///     pin.rotate_x(deg(90.0)) | cuboid
    /// }
    /// "#
    /// );
    /// ```
    #[must_use]
    pub fn to_rust(&self, name: &str) -> String {
        let mut file = RustFile::default();
        file.add(name, self);
        file.to_string()
    }
}
