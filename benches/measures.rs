//! What it takes to measure solids: `cargo bench --bench measures` prints the milliseconds of the
//! processor, of all threads, that volume, moments and area take to a thousandth, how far the
//! volume may be off then, as a part of it, and how far it is off where it is known, and how far
//! the area may be off, if that is certain.
//!
//! Words after `--` choose rows: those whose names have one of them.

use std::f64::consts::PI;
use std::hint::black_box;

use cpu_time::ProcessTime;
use rvachev::{Blend, Profile, RFunction, Solid, deg};

/// As a part of the volume.
const TOLERANCE: f64 = 1e-3;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    println!("{:>24} {:>8} {:>10} {:>10} {:>10}", "", "ms", "error", "off", "area");
    for (name, solid, volume) in rows() {
        if !words.is_empty() && !words.iter().any(|word| name.contains(word.as_str())) {
            continue;
        }
        let start = ProcessTime::now();
        let report = black_box(solid.measure(TOLERANCE).expect("it can be measured"));
        let took = 1e3 * start.elapsed().as_secs_f64();
        let off = volume.map_or(f64::NAN, |volume| (report.volume / volume - 1.0).abs());
        let error = report.volume_error / report.volume;
        let of_area = if report.is_area_certain { report.area_error / report.area } else { f64::NAN };
        println!("{name:>24} {took:>8.1} {error:>10.1e} {off:>10.1e} {of_area:>10.1e}");
    }
}

/// Plate, wall, rib and counterbored holes.
fn bracket() -> Solid {
    let plate = Solid::cuboid([60.0, 40.0, 6.0]).translate([0.0, 0.0, 3.0]);
    let wall = Solid::cuboid([6.0, 40.0, 40.0]).translate([-27.0, 0.0, 20.0]);
    let rib = Solid::wedge([30.0, 5.0, 30.0]).translate([-9.0, 0.0, 21.0]);
    let hole = Solid::cylinder(3.0, 30.0) | Solid::cylinder(6.0, 10.0).translate([0.0, 0.0, 5.0]);
    let upright = |y: f64| hole.translate([16.0, y, 4.0]);
    let across = |y: f64| hole.rotate_y(deg(90.0)).translate([-26.0, y, 29.0]);
    let body = plate | wall | rib;
    body.difference_all([upright(-12.0), upright(12.0), across(-12.0), across(12.0)], RFunction::MIN_MAX)
}

/// Solids, and their volumes where these are known.
fn rows() -> Vec<(&'static str, Solid, Option<f64>)> {
    let gap = 0.3;
    let turned = |solid: &Solid| solid.rotate_x(deg(20.0)).rotate_z(deg(35.0));
    let tooth = Solid::cuboid([2.0 - gap, 24.0, 1.5]);
    let teeth = (0..20).map(|n| tooth.translate([2.0 * f64::from(n), 0.0, 0.0]));
    let comb = Solid::union_all(teeth, RFunction::MIN_MAX);
    let copies = tooth.repeat_centered([12, 1, 1], [2.0, 1.0, 1.0]);
    let plate = Solid::cuboid([24.0, 24.0, 1.5]);
    let slots = Solid::cuboid([gap, 20.0, 3.0]).repeat_centered([11, 1, 1], [2.0, 1.0, 1.0]);
    let slotted = &plate - &slots;
    let fins = &slots | plate.translate([0.0, 0.0, -1.5]);
    let half = 0.5 * gap;
    let u =
        [[-8.0, -6.0], [8.0, -6.0], [8.0, 6.0], [half, 6.0], [half, -2.0], [-half, -2.0], [-half, 6.0], [-8.0, 6.0]];
    let notch = Profile::polygon(u).extrude(1.5);
    let ring = (Solid::cylinder(9.0, 3.0) - Solid::cylinder(4.0, 4.0))
        - (Solid::cylinder(6.0 + gap, 4.0) - Solid::cylinder(6.0, 5.0));
    let of_ring = (81.0 - 16.0 - (6.0 + gap) * (6.0 + gap) + 36.0) * 3.0 * PI;
    let drilled = Solid::cuboid([40.0, 30.0, 6.0]) - Solid::cylinder(4.0, 20.0).translate([13.0, 0.0, 0.0]);
    let of_drilled = 7200.0 - 96.0 * PI;
    let solid_prism = Solid::prism(6, 5.0, 8.0) - Solid::prism(6, 3.0, 10.0);
    let of_prism = 8.0 * 3.0 * 0.75f64.sqrt() * (25.0 - 9.0);
    let base = Solid::cuboid([60.0, 40.0, 4.0]);
    let post = Solid::cylinder(6.0, 30.0).translate([0.0, 0.0, 15.0]);
    let of_post = 60.0 * 40.0 * 4.0 + PI * 36.0 * 28.0;
    // What a ball of 3 leaves out between a plane and a pillar of 6: Pappus.
    let of_fillet = 2.0 * PI * (9.0 * (6.0 + 1.5) - PI * 2.25 * (9.0 - 4.0 / PI));
    let egg = Solid::superellipsoid([30.0, 20.0, 40.0], 0.3, 0.4);
    let egg_in_egg = &egg - Solid::superellipsoid([29.0, 19.0, 39.0], 0.3, 0.4);
    let [of_comb, of_copies] = [20.0, 12.0].map(|count| count * (2.0 - gap) * 24.0 * 1.5);
    let of_slots = 11.0 * gap * 20.0;
    vec![
        ("comb", comb.clone(), Some(of_comb)),
        ("comb, turned", turned(&comb), Some(of_comb)),
        ("copies", copies.clone(), Some(of_copies)),
        ("copies, turned", turned(&copies), Some(of_copies)),
        ("slots", slotted.clone(), Some(864.0 - 1.5 * of_slots)),
        ("slots, turned", turned(&slotted), Some(864.0 - 1.5 * of_slots)),
        ("fins", fins.clone(), Some(864.0 + 2.25 * of_slots)),
        ("fins, turned", turned(&fins), Some(864.0 + 2.25 * of_slots)),
        ("notch", notch.clone(), Some((192.0 - 8.0 * gap) * 1.5)),
        ("notch, turned", turned(&notch), Some((192.0 - 8.0 * gap) * 1.5)),
        ("pipe of prisms, turned", turned(&solid_prism), Some(of_prism)),
        ("rings", ring.clone(), Some(of_ring)),
        ("rings, turned", turned(&ring), Some(of_ring)),
        ("drilled plate", drilled.clone(), Some(of_drilled)),
        ("drilled plate, turned", turned(&drilled), Some(of_drilled)),
        ("plate, rounded", drilled.rounded(1.0), None),
        ("post", &base | &post, Some(of_post)),
        ("post, filleted", base.union_with(&post, Blend::Fillet { radius: 3.0 }), Some(of_post + of_fillet)),
        ("bracket", bracket(), None),
        ("bracket, rounded", bracket().rounded(0.8), None),
        ("bracket, shell", bracket().shell(1.0), None),
        ("ball and ball", Solid::sphere(1.0) | Solid::sphere(0.8).translate([1.0, 0.0, 0.0]), None),
        ("torus less ball", Solid::torus(1.0, 0.4) - Solid::sphere(0.5).translate([1.0, 0.0, 0.0]), None),
        ("egg in egg", egg_in_egg, None),
        ("egg, shell", egg.shell(1.0), None),
    ]
}
