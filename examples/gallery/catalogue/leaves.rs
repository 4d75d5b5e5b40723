//! Leaves: solids given by one formula.

use std::f64::consts::PI;

use fidget::context::Tree;
use glam::DVec3;
use rvachev::{
    Bounds, Formula, GeneralisedSuperquadric, Gielis, Grading, Interval, MinimalSurface, NetworkLattice, SheetLattice,
    Solid, Superhyperboloid, Supershape, Turns, field::Real,
};

use super::Entry;

pub const SUPERQUADRICS: &[Entry] = &[
    ("superellipsoid_cube", || Solid::superellipsoid([1.0, 1.0, 1.0], 0.2, 0.2)),
    ("superellipsoid_cylinder", || Solid::superellipsoid([1.0, 1.0, 1.0], 0.2, 1.0)),
    ("superellipsoid_cushion", || Solid::superellipsoid([1.2, 1.2, 0.7], 1.0, 0.3)),
    ("superellipsoid_ellipsoid", || Solid::superellipsoid([1.3, 1.0, 0.7], 1.0, 1.0)),
    ("superellipsoid_double_cone", || Solid::superellipsoid([1.0, 1.0, 1.0], 2.0, 1.0)),
    ("superellipsoid_octahedron", || Solid::superellipsoid([1.0, 1.0, 1.0], 2.0, 2.0)),
    ("superellipsoid_pinched", || Solid::superellipsoid([1.0, 1.0, 1.0], 2.6, 2.6)),
    ("generalised_superquadric", || GeneralisedSuperquadric::new([1.2, 1.0, 0.8], [8.0, 2.0, 1.3]).into()),
    ("supertoroid", || Solid::supertoroid([0.35, 0.35, 0.35], 2.0, 1.0, 1.0)),
    ("supertoroid_frame", || Solid::supertoroid([0.3, 0.3, 0.45], 2.2, 0.2, 0.3)),
    ("supertoroid_bevelled", || Solid::supertoroid([0.4, 0.4, 0.4], 1.8, 2.0, 0.6)),
    ("superhyperboloid_one_sheet", || Superhyperboloid::one_sheet([0.5, 0.5, 0.6], 1.0, 1.0, 2.0).into()),
    ("superhyperboloid_one_sheet_x", || Superhyperboloid::one_sheet_x([0.6, 0.5, 0.5], 1.0, 0.4, 2.0).into()),
    ("superhyperboloid_two_sheets", || Superhyperboloid::two_sheets([0.35, 0.35, 0.3], 1.0, 1.0, 2.0).into()),
    ("superhyperboloid_two_sheets_x", || Superhyperboloid::two_sheets_x([0.3, 0.35, 0.35], 1.0, 0.6, 2.0).into()),
];

/// A star with five arms that cross: its curve closes after two turns.
fn crossing_star(turns: Turns) -> Supershape {
    let star = Gielis::rational(5, 2, 3.0, 7.0, 7.0).with_turns(turns);
    Supershape::new(star, Gielis::polygon(4, 20.0)).scaled([1.0, 1.0, 0.4])
}

/// Six blunt arms.
fn starfish() -> Supershape {
    Supershape::new(Gielis::new(6.0, 2.0, 7.0, 7.0), Gielis::circle()).scaled([1.0, 1.0, 0.6])
}

pub const SUPERSHAPES: &[Entry] = &[
    ("supershape", || starfish().into()),
    ("supershape_hexagon", || Supershape::new(Gielis::polygon(6, 60.0), Gielis::polygon(4, 30.0)).into()),
    ("supershape_flower", || Supershape::new(Gielis::new(8.0, 4.0, 4.0, 9.0), Gielis::new(4.0, 2.0, 3.0, 3.0)).into()),
    ("supershape_shell", || Supershape::new(Gielis::new(3.0, 5.0, 18.0, 18.0), Gielis::new(2.0, 3.0, 6.0, 6.0)).into()),
    ("supershape_outer", || crossing_star(Turns::Outer).into()),
    ("supershape_inner", || crossing_star(Turns::Inner).into()),
    ("supershape_irrational", || Supershape::new(Gielis::new(PI, 2.0, 5.0, 5.0), Gielis::circle()).into()),
    ("supershape_rational_radius", || starfish().rational().into()),
];

/// A cuboid below a plane that is tilted.
fn below_a_plane() -> Solid {
    let normal = DVec3::new(0.3, -0.4, 1.0).normalize();
    Solid::cuboid([2.0, 2.0, 1.6]) & Solid::half_space(normal, 0.15)
}

/// A cylinder between two planes that are tilted.
fn between_planes() -> Solid {
    let normal = DVec3::new(0.3, -0.5, 1.0).normalize();
    Solid::cylinder(1.0, 3.0) & Solid::slab(normal, 0.5)
}

pub const PRIMITIVES: &[Entry] = &[
    ("sphere", || Solid::sphere(1.0)),
    ("ellipsoid", || Solid::ellipsoid([1.3, 0.9, 0.7])),
    ("cuboid", || Solid::cuboid([2.0, 1.6, 1.2])),
    ("rounded_cuboid", || Solid::rounded_cuboid([2.0, 1.6, 1.2], 0.25)),
    ("cylinder", || Solid::cylinder(0.8, 1.8)),
    ("capsule", || Solid::capsule(0.55, 2.2)),
    ("cone", || Solid::cone(1.0, 0.0, 1.8)),
    ("cone_truncated", || Solid::cone(1.0, 0.5, 1.5)),
    ("torus", || Solid::torus(0.8, 0.3)),
    ("prism", || Solid::prism(6, 1.0, 1.4)),
    ("pyramid", || Solid::pyramid(5, 1.0, 1.6)),
    ("wedge", || Solid::wedge([1.8, 1.4, 1.4])),
    ("half_space", below_a_plane),
    ("slab", between_planes),
];

/// In proportion to the height, over a cube of side 2 about the origin.
#[derive(Debug)]
struct Downwards {
    at_top: f64,
    at_bottom: f64,
}

impl Grading for Downwards {
    #[inline(always)]
    fn at<R: Real>(&self, [_, _, z]: [R; 3]) -> R {
        let mean = 0.5 * (self.at_top + self.at_bottom);
        z.scale_add(self.at_top - mean, z.lift(mean)).max(z.lift(self.at_top)).min(z.lift(self.at_bottom))
    }

    fn limits(&self) -> Interval {
        Interval::new(self.at_top, self.at_bottom)
    }
}

fn sheet(surface: MinimalSurface, cell: f64) -> Solid {
    Solid::cuboid([2.0; 3]) & SheetLattice { surface, cell, thickness: 0.12 }
}

fn network(surface: MinimalSurface, cell: f64) -> Solid {
    Solid::cuboid([2.0; 3]) & NetworkLattice { surface, cell, fraction: 0.35 }
}

fn graded_sheet() -> Solid {
    let thickness = Downwards { at_top: 0.04, at_bottom: 0.29 };
    Solid::cuboid([2.0; 3]) & Solid::new(SheetLattice { surface: MinimalSurface::Gyroid, cell: 1.2, thickness })
}

fn graded_network() -> Solid {
    let fraction = Downwards { at_top: 0.15, at_bottom: 0.7 };
    Solid::cuboid([2.0; 3]) & Solid::new(NetworkLattice { surface: MinimalSurface::SchwarzD, cell: 2.0, fraction })
}

pub const LATTICES: &[Entry] = &[
    ("gyroid_sheet", || sheet(MinimalSurface::Gyroid, 1.2)),
    ("gyroid_network", || network(MinimalSurface::Gyroid, 1.2)),
    ("schwarz_p_sheet", || sheet(MinimalSurface::SchwarzP, 1.0)),
    ("schwarz_p_network", || network(MinimalSurface::SchwarzP, 1.0)),
    ("schwarz_d_sheet", || sheet(MinimalSurface::SchwarzD, 2.0)),
    ("schwarz_d_network", || network(MinimalSurface::SchwarzD, 2.0)),
    ("graded_sheet", graded_sheet),
    ("graded_network", graded_network),
];

/// The quartic of twelve tunnels that is called a tanglecube. (Negative inside: fidget's sign.)
fn tanglecube() -> Solid {
    let (x, y, z) = Tree::axes();
    let [x, y, z] = [x, y, z].map(|axis| axis.square());
    let quartic = |square: &Tree| square.square() - square.clone() * 5.0;
    let tree = quartic(&x) + quartic(&y) + quartic(&z) + 11.8;
    Solid::formula(&tree, Bounds::from_center(DVec3::ZERO, DVec3::splat(2.4)))
}

fn heart() -> Solid {
    let bounds = Bounds::new(DVec3::new(-1.2, -0.7, -1.05), DVec3::new(1.2, 0.7, 1.3));
    Formula::from_vm(include_str!("../heart.vm"), bounds).expect("the text is a formula").into()
}

pub const FORMULAS: &[Entry] = &[("formula", tanglecube), ("formula_vm", heart)];
