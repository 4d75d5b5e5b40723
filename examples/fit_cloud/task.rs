//! What is asked for, and what is printed.

use std::error::Error;
use std::path::PathBuf;

use rvachev::PointCloud;
use rvachev::fit::{Fit, FitError, FitSettings, deformed, superellipsoid, supershape};

/// What points are taken for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Superellipsoid,
    Supershape,
    Deformed,
    /// What explains them best, each parameter at its price.
    Auto,
}

/// The command line.
#[derive(Debug, PartialEq)]
pub struct Arguments {
    pub file: Option<PathBuf>,
    pub kind: Kind,
    pub seed: u64,
}

impl Arguments {
    /// Of the words behind the program's name.
    pub fn read(words: impl IntoIterator<Item = String>) -> Result<Arguments, Box<dyn Error>> {
        let mut arguments = Arguments { file: None, kind: Kind::Auto, seed: 0 };
        let mut words = words.into_iter();
        while let Some(word) = words.next() {
            match &*word {
                "--kind" => arguments.kind = kind(&words.next().unwrap_or_default())?,
                "--seed" => {
                    let seed = words.next().unwrap_or_default();
                    let wrong = |_| format!("the seed is {seed:?}; allowed: whole numbers, 0 to {}", u64::MAX);
                    arguments.seed = seed.parse().map_err(wrong)?;
                }
                _ if word.starts_with("--") => {
                    return Err(format!("{word} is none of --kind KIND, --seed N").into());
                }
                _ if arguments.file.is_some() => return Err(format!("{word} is a second file; give one").into()),
                _ => arguments.file = Some(word.into()),
            }
        }
        Ok(arguments)
    }
}

fn kind(word: &str) -> Result<Kind, String> {
    match word {
        "superellipsoid" => Ok(Kind::Superellipsoid),
        "supershape" => Ok(Kind::Supershape),
        "deformed" => Ok(Kind::Deformed),
        "auto" => Ok(Kind::Auto),
        _ => Err(format!("the kind is {word:?}; allowed: superellipsoid, supershape, deformed, auto")),
    }
}

/// The solid that a cloud is of.
pub fn fitted(cloud: &PointCloud, kind: Kind, seed: u64) -> Result<Fit, FitError> {
    let settings = FitSettings { seed, ..FitSettings::default() };
    match kind {
        Kind::Superellipsoid => superellipsoid(cloud, &settings),
        Kind::Supershape => supershape(cloud, &settings),
        Kind::Deformed => deformed(cloud, &settings),
        Kind::Auto => {
            let simple = superellipsoid(cloud, &settings)?;
            // The others know of no tables.
            if simple.search().table {
                return Ok(simple);
            }
            // An error of theirs leaves the simple one.
            let others = [supershape(cloud, &settings), deformed(cloud, &settings)];
            let better = |best: Fit, other: Fit| if other.criterion() > best.criterion() { other } else { best };
            Ok(others.into_iter().flatten().fold(simple, better))
        }
    }
}

/// The fit as one JSON object, with the time that it took.
pub fn line(fit: &Fit, milliseconds: f64) -> String {
    let json = fit.to_json();
    format!("{}, \"ms\": {milliseconds:.3}}}", json.trim_end_matches('}'))
}
