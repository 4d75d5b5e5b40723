//! Clearances, in milliseconds of all threads.
//!
//! `cargo bench --bench clearance` prints of each pair how long the first clearance takes, in which
//! the surfaces are found that are kept with the solids, then the next one, and what was found: the
//! distance, or depth and volume, and how exactly. Words after `--` choose those whose names have
//! one of them.

use std::f64::consts::{PI, TAU};
use std::hint::black_box;

use cpu_time::ProcessTime;
use glam::DVec3;
use rvachev::{CellSize, Helix, Mesh, MeshSettings, MeshSolid, Prism, Profile, RFunction, Run, Solid, deg, rad};

/// What makes the two solids of a row.
type Pair = Box<dyn Fn() -> [Solid; 2]>;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    println!("{:>38} {:>8} {:>8}   distance ± tolerance, or depth and volume", "milliseconds", "first", "next");
    for (name, pair) in meshes().into_iter().chain(solids()) {
        if !words.is_empty() && !words.iter().any(|word| name.contains(word.as_str())) {
            continue;
        }
        let [one, other] = pair();
        let clearance = || {
            let start = ProcessTime::now();
            let found = black_box(one.clearance(&other, &Run::default()).expect("they can be asked"));
            (1e3 * start.elapsed().as_secs_f64(), found.expect("neither is empty"))
        };
        let (first, found) = clearance();
        let mut next: Vec<f64> = (0..3).map(|_| clearance().0).collect();
        next.sort_by(f64::total_cmp);
        let told = if found.overlaps {
            let [depth, volume] = [[found.depth, found.depth_error], [found.volume, found.volume_error]]
                .map(|[x, off]| format!("{x:.4} ± {off:.1e}"));
            format!("{depth}, {volume}")
        } else {
            format!("{:.5} ± {:.1e}", found.distance, found.tolerance)
        };
        println!("{name:>38} {first:>8.1} {:>8.1}   {told}", next[1]);
    }
}

fn solid(mesh: &Mesh) -> Solid {
    Solid::from_mesh(mesh, MeshSolid::default())
}

/// A solid's mesh of as many cells along its longest side.
fn meshed(of: &Solid, cells: u32) -> Solid {
    let settings = MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() };
    solid(&of.mesh(&settings).expect("it can be meshed"))
}

/// The same with default settings.
fn mesh(of: &Solid) -> Solid {
    solid(&of.mesh(&MeshSettings::default()).expect("it can be meshed"))
}

fn twice(solid: Solid) -> [Solid; 2] {
    [solid.clone(), solid]
}

fn row(name: &'static str, pair: impl Fn() -> [Solid; 2] + 'static) -> (&'static str, Pair) {
    (name, Box::new(pair))
}

/// Meshes of solids, whose triangles are their surface.
fn meshes() -> Vec<(&'static str, Pair)> {
    let block = || Solid::cuboid([4.0, 4.0, 2.0]);
    let own = move || mesh(&block());
    let tilt = |solid: Solid| mesh(&solid.rotate_x(deg(20.0)).rotate_z(deg(35.0)));
    let ball = || mesh(&Solid::sphere(2.0));
    let moved = |solid: Solid, by: [f64; 3]| [solid.clone(), solid.translate(by)];
    let large = || meshed(&bumpy(), 110);
    let foil = |by: f64| {
        let sheet = Profile::polygon([[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]]);
        sheet.extrude(0.02).rotate_x(deg(by))
    };
    vec![
        row("blocks, a gap between", move || moved(own(), [0.0, 0.0, 3.0])),
        row("blocks face to face", move || moved(own(), [1.0, 0.3, 2.0])),
        row("tilted blocks face to face", move || [tilt(block()), tilt(block().translate([0.5, 0.2, 2.0]))]),
        row("a speck on a tilted block", move || {
            [tilt(block()), tilt(Solid::cuboid([0.004; 3]).translate([0.5, 0.2, 1.002]))]
        }),
        row("faces that are nearly parallel, close", move || {
            [own(), own().rotate_x(deg(0.2)).rotate_z(deg(35.0)).translate([0.3, 0.1, 2.05])]
        }),
        row("rounds that are nearly parallel, close", move || {
            let cup = Solid::sphere(3.0) - Solid::sphere(2.02);
            [ball().translate([0.005, 0.0, 0.0]), mesh(&(cup & Solid::half_space([0.0, 0.0, 1.0], 0.0)))]
        }),
        row("blocks in each other", move || moved(own(), [1.0, 0.3, 0.5])),
        row("a block in itself", move || twice(own())),
        row("balls, a gap between", move || moved(ball(), [4.1, 0.0, 0.0])),
        row("a ball within a ball", move || [mesh(&Solid::sphere(1.0)), ball().translate([0.3, 0.2, 0.1])]),
        row("a ball in a hollow one", move || [ball(), mesh(&Solid::sphere(3.0).shell(0.8))]),
        row("a ball in itself", move || twice(ball())),
        row("a ball in itself, turned", move || [ball(), ball().rotate_x(deg(50.0))]),
        row("balls that are half in each other", move || moved(ball(), [1.0, 0.7, 0.3])),
        row("balls that are just in each other", move || {
            [ball(), ball().rotate_x(deg(50.0)).translate([3.9, 0.0, 0.0])]
        }),
        row("large meshes, a gap between", move || moved(large(), [4.6, 0.3, 0.1])),
        row("large meshes in each other", move || moved(large(), [1.0, 0.7, 0.3])),
        row("a large mesh in itself", move || twice(large())),
        row("large meshes all but the same", move || moved(large(), [0.02, 0.01, 0.0])),
        row("foils that are crossed", move || [foil(0.0), foil(90.0)]),
        row("foils one above the other", move || moved(foil(10.0), [0.2, 0.1, 0.03])),
        row("foils in each other", move || moved(foil(10.0), [0.2, 0.1, 0.01])),
    ]
}

/// Solids that are measured, and extruded polygons.
fn solids() -> Vec<(&'static str, Pair)> {
    let egg = || Solid::superellipsoid([3.0, 1.5, 6.0], 0.3, 0.5).twist(deg(10.0));
    let bolted = |gap: f64| [screw(0.0), Solid::from(Prism::across_flats(6, 13.0, 2.0)) - screw(gap)];
    let meshing = |turn: f64| {
        let [pinion, wheel] = [17, 30].map(|teeth| gear(teeth, 0.2).extrude(4.0));
        [pinion.rotate_z(rad(turn)), wheel.rotate_z(rad(PI / 30.0)).translate([47.0, 0.0, 0.0])]
    };
    let peg = |aside: f64| {
        let plate = Solid::cuboid([30.0, 30.0, 5.0]) - Solid::cylinder(5.1, 10.0);
        [Solid::cylinder(5.0, 20.0).translate([aside, 0.0, 0.0]), plate]
    };
    vec![
        row("solid balls, a gap between", || [Solid::sphere(2.0), Solid::sphere(1.0).translate([2.0, 3.0, 6.0])]),
        row("solid balls that touch", || [Solid::sphere(2.0), Solid::sphere(2.0).translate([4.0, 0.0, 0.0])]),
        row("solid balls in each other", || [Solid::sphere(2.0), Solid::sphere(2.0).translate([3.5, 0.0, 0.0])]),
        row("a solid ball within a ball", || [Solid::sphere(1.0), Solid::sphere(10.0)]),
        row("a solid ball in itself", || twice(Solid::sphere(2.0))),
        row("a solid block in itself", || twice(Solid::cuboid([4.0, 4.0, 2.0]))),
        row("eggs, a gap between", move || [egg(), egg().rotate_y(deg(70.0)).translate([0.5, 5.5, 1.0])]),
        row("eggs in each other", move || [egg(), egg().rotate_y(deg(70.0)).translate([0.5, 1.5, 1.0])]),
        row("a solid foil through a block", || {
            [Solid::cuboid([3.0, 3.0, 0.01]).rotate_x(deg(20.0)).rotate_z(deg(35.0)), Solid::cuboid([2.0; 3])]
        }),
        row("a peg in its hole", move || peg(0.0)),
        row("a peg that jams", move || peg(0.2)),
        row("gears in mesh", move || meshing(0.0)),
        row("gears that jam", move || meshing(0.15 / 17.0)),
        row("a bolt in its nut", move || bolted(0.1)),
        row("a bolt in its nut, touching", move || bolted(0.0)),
        row("a bolt in its nut, too thick", move || bolted(-0.1)),
    ]
}

/// A ball with bumps.
fn bumpy() -> Solid {
    let bump = |way: [f64; 3]| Solid::sphere(0.8).translate(1.6 * DVec3::from(way).normalize());
    let bumps = [[1.0, 0.2, 0.1], [-0.4, 1.0, 0.3], [0.1, -0.8, 1.0], [-0.9, -0.5, -0.4], [0.3, 0.4, -1.0]];
    bumps.into_iter().fold(Solid::sphere(2.0), |all, way| all | bump(way))
}

/// A screw: a ridge on a core, all grown by a length.
fn screw(by: f64) -> Solid {
    let section =
        Profile::polygon([[-0.3, -0.42 - by], [0.6 + by, -0.12 - by], [0.6 + by, 0.12 + by], [-0.3, 0.42 + by]]);
    let ridge = section.sweep_helix(&Helix::new(4.0, 1.25, 3.0));
    ridge.union(Solid::cylinder(4.0 + by, 6.0), RFunction::MIN_MAX)
}

/// A spur gear with involute teeth, the first in the middle of +x.
fn gear(teeth: u32, backlash: f64) -> Profile {
    let (module, pressure) = (2.0, 20f64.to_radians());
    let pitch = 0.5 * module * f64::from(teeth);
    let (base, tip, root) = (pitch * pressure.cos(), pitch + module, pitch - 1.25 * module);
    let involute = |angle: f64| angle.tan() - angle;
    let half = (0.25 * PI * module - 0.25 * backlash) / pitch + involute(pressure);
    let flank = (0..=8).map(|k| {
        let radius = base + (tip - base) * f64::from(k) / 8.0;
        [radius, half - involute((base / radius).acos())]
    });
    let flank: Vec<[f64; 2]> = [[root, half]].into_iter().chain(flank).collect();
    let mut outline = Vec::new();
    for tooth in 0..teeth {
        let middle = TAU * f64::from(tooth) / f64::from(teeth);
        let at = |[radius, angle]: [f64; 2]| [radius * (middle + angle).cos(), radius * (middle + angle).sin()];
        outline.extend(flank.iter().map(|[radius, angle]| at([*radius, -angle])));
        outline.extend(flank.iter().rev().map(|p| at(*p)));
    }
    Profile::polygon(outline)
}
