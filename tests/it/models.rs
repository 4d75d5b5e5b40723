//! The models M1 to M6 that tests and benches share.
//!
//! M1 is a superellipsoid; M2 unites three and subtracts two; M4 unites 200. M3 and M5 are M2
//! and M4 joined by R_p with p = 2 in place of min and max. M6 is M1 tapered, twisted and bent.
//!
//! Benches include this file by its path and need not use all of it.
#![allow(dead_code)]

use glam::{DAffine3, DMat3, DVec3};
use rvachev::{Bounds, RFunction, Solid, deg, rad};

/// Numbers of the superellipsoids; the file says what they are.
const NUMBERS: &str = include_str!("../models/superellipsoids.txt");

/// A named model and the cube that it is sampled in.
#[derive(Clone, Debug)]
pub struct Model {
    pub name: &'static str,
    /// Half the side of the cube, which is centred at the origin.
    pub half: f64,
    pub solid: Solid,
}

impl Model {
    /// The cube.
    pub fn cube(&self) -> Bounds {
        Bounds::from_center(DVec3::ZERO, DVec3::splat(self.half))
    }
}

/// Superellipsoids that are joined the same way by any rule.
pub struct Set {
    pub half: f64,
    /// How many are united; the others are subtracted.
    pub united: usize,
    pub solids: Vec<Placed>,
}

/// A superellipsoid in its place.
pub struct Placed {
    pub semi_axes: DVec3,
    pub exponents: [f64; 2],
    pub pose: DAffine3,
}

impl Placed {
    /// The superellipsoid of a line of the file.
    fn parse(line: &str) -> Placed {
        let n: Vec<f64> = line.split(' ').map(|word| word.parse().expect("a number")).collect();
        let vector = |at: usize| DVec3::new(n[at], n[at + 1], n[at + 2]);
        let rows = DMat3::from_cols(vector(8), vector(11), vector(14));
        let pose = DAffine3::from_mat3_translation(rows.transpose(), vector(5));
        Placed { semi_axes: vector(0), exponents: [n[3], n[4]], pose }
    }

    /// From the world to its own frame.
    pub fn inverse(&self) -> DAffine3 {
        self.pose.inverse()
    }

    fn solid(&self) -> Solid {
        Solid::superellipsoid(self.semi_axes, self.exponents[0], self.exponents[1]).affine(self.pose)
    }
}

impl Set {
    fn read(name: &str) -> Set {
        let mut lines = NUMBERS.lines().filter(|line| !line.starts_with('#'));
        let header = lines.find(|line| line.starts_with(&format!("set {name} "))).expect("the set is in the file");
        let fields: Vec<&str> = header.split(' ').collect();
        let solids = lines.take_while(|line| !line.starts_with("set")).map(Placed::parse).collect();
        Set { half: fields[2].parse().expect("a number"), united: fields[3].parse().expect("a number"), solids }
    }

    fn join(&self, rule: RFunction) -> Solid {
        let solids: Vec<Solid> = self.solids.iter().map(Placed::solid).collect();
        let (united, subtracted) = solids.split_at(self.united);
        let union = match united {
            [only] => only.clone(),
            _ => Solid::union_all(united.iter().cloned(), rule),
        };
        if subtracted.is_empty() { union } else { union.difference_all(subtracted.iter().cloned(), rule) }
    }
}

/// The superellipsoids of a model, where it is made of them and nothing else.
pub fn set(model: &str) -> Option<Set> {
    match model {
        "M1" | "M2" | "M4" => Some(Set::read(model)),
        "M3" => Some(Set::read("M2")),
        "M5" => Some(Set::read("M4")),
        _ => None,
    }
}

fn model(name: &'static str, set: &str, rule: RFunction) -> Model {
    let set = Set::read(set);
    Model { name, half: set.half, solid: set.join(rule) }
}

pub fn m1() -> Model {
    model("M1", "M1", RFunction::MIN_MAX)
}

pub fn m2() -> Model {
    model("M2", "M2", RFunction::MIN_MAX)
}

pub fn m3() -> Model {
    model("M3", "M2", RFunction::P(2.0))
}

pub fn m4() -> Model {
    model("M4", "M4", RFunction::MIN_MAX)
}

pub fn m5() -> Model {
    model("M5", "M4", RFunction::P(2.0))
}

pub fn m6() -> Model {
    let solid = Solid::superellipsoid(DVec3::new(1.0, 0.8, 0.6), 0.3, 0.7);
    Model { name: "M6", half: 1.5, solid: solid.taper(0.25, 0.25, 1.2).twist(rad(0.8)).bend(0.5, deg(0.0)) }
}

/// All six, in order.
pub fn all() -> [Model; 6] {
    [m1(), m2(), m3(), m4(), m5(), m6()]
}
