//! Surfaces as patches: how many there are, and how far off.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use super::facets::{Facets, sharp};
use super::mend::mend;
use super::plots::Plots;
use super::quilt::{Care, Quilt, Spot};
use super::surface::FromMeshes;
use super::{compiled, surface_of};
use crate::eval::{Wanted, surface};
use crate::mesh::Slopes;
use crate::{Blend, Bounds, Run, Solid, deg};
use rvachev_field::{Patch, Patches};

/// Two cubes side by side.
fn block() -> Solid {
    let cube = Solid::cuboid([10.0; 3]);
    cube.translate([-5.0, 0.0, 0.0]) | cube.translate([5.0, 0.0, 0.0])
}

/// A plate with counterbored holes, and a wedge on it.
fn holed() -> Solid {
    let plate = Solid::cuboid([60.0, 40.0, 6.0]) | Solid::wedge([30.0, 5.0, 30.0]).translate([0.0, 0.0, 18.0]);
    let hole = Solid::cylinder(3.0, 30.0) | Solid::cylinder(6.0, 10.0).translate([0.0, 0.0, 5.0]);
    plate - hole.translate([16.0, -12.0, 1.0]) - hole.rotate_y(deg(20.0)).translate([-16.0, 12.0, 1.0])
}

/// The patches that a length of 1 is measured from.
fn few_patches(solid: &Solid) -> Arc<Patches> {
    patches_of(solid, false)
}

/// The same, or those that are looked at one by one.
fn patches_of(solid: &Solid, by_patches: bool) -> Arc<Patches> {
    let wanted = Wanted { by_patches, ..Wanted::of(1.0, None, &Bounds::ALL) };
    surface(solid, &compiled(solid).unwrap(), &wanted, &FromMeshes, &Run::default()).unwrap().patches.clone()
}

#[test]
fn a_joint_face_to_face_hides_nothing() {
    let patches = few_patches(&block());
    assert_eq!(patches.len(), 12, "patches of flat faces");
}

/// Of a plate with holes few triangles are left, which cover its faces and nothing else.
#[test]
fn flat_faces_are_few_patches() {
    let plate = Solid::cuboid([60.0, 40.0, 6.0]);
    let hole = Solid::cylinder(3.0, 30.0);
    let solid = &plate - hole.translate([16.0, -12.0, 0.0]) - hole.translate([-16.0, 12.0, 0.0]);
    let solid = solid.rotate_x(deg(20.0)).rotate_z(deg(40.0));
    let patches = few_patches(&solid);
    // Those that are looked at one by one are small.
    let all = patches_of(&solid, true).len();
    assert!(patches.len() < 3000 && 3 * patches.len() < 2 * all, "{} of {all}", patches.len());
    let area = |n: usize| {
        let [a, b, c] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|at| patches.point(n, at));
        0.5 * (b - a).cross(c - a).length()
    };
    let holes = std::f64::consts::PI * 2.0 * (2.0 * 3.0 * 6.0 - 2.0 * 9.0);
    let (found, right) = ((0..patches.len()).map(area).sum::<f64>(), 2.0 * (2400.0 + 360.0 + 240.0) + holes);
    assert!((found / right - 1.0).abs() < 2e-3, "{found} of {right}");
    let largest = (0..patches.len()).map(area).fold(0.0, f64::max);
    assert!(largest > 100.0, "the largest has {largest}");
}

/// The inner face of a wall is told by flat faces and cylinders: no patch has to follow a hole.
#[test]
fn what_operands_know_is_not_measured() {
    let (plate, hole) = (block(), Solid::cylinder(2.0, 20.0));
    let solid = &plate - hole.translate([4.0, 0.0, 0.0]);
    // The ball of this rounding has a radius of 1.
    let rounded = solid.rounded(1.0 / 0.9985);
    for made in [solid.shell(1.0), solid.offset(-1.0), rounded, solid.named("part").offset(-1.0)] {
        let accuracy = compiled(&made).unwrap().accuracy;
        assert!(accuracy.error < 2e-3, "{made}: {accuracy:?}");
    }
    let known = compiled(&solid.offset(-1.0)).unwrap().accuracy;
    let all = compiled(&solid.offset(1.0)).unwrap().accuracy;
    assert!(known.error < 1e-5 && all.error > 1e-5, "{known:?}, {all:?}");
    // A hole is larger by what the plate is smaller, and by what that is again.
    let deep = solid.offset(-1.0);
    for (made, by) in [(deep.offset(-0.5), 1.5), (!(!&deep).offset(0.5), 1.5), (deep.clone(), 1.0)] {
        for (p, far) in [(DVec3::new(7.0, 0.0, 0.0), 1.0), (DVec3::new(4.0, 2.3, 1.0), 0.3), (DVec3::X * -8.0, 2.0)] {
            let value = made.value(p).unwrap();
            assert!((value - (far - by)).abs() < 1e-5, "{value} at {p}, moved by {by}");
        }
    }
    // Outside of a union the same holds.
    let ball = Solid::superellipsoid([4.0, 3.0, 5.0], 0.5, 0.7);
    let union = (&ball | Solid::cuboid([20.0, 1.0, 1.0])).offset(0.5);
    let alone = ball.offset(0.5);
    assert_eq!(compiled(&union).unwrap().accuracy, compiled(&alone).unwrap().accuracy);
    let p = DVec3::new(0.5, 3.2, 0.1);
    assert!((union.value(p).unwrap() - alone.value(p).unwrap()).abs() < 1e-9);
    assert!((union.value([10.2, 0.0, 0.0]).unwrap() - 0.3).abs() < 1e-9);
}

/// Boxes that cut a slab off at all angles: of their own faces nothing is left, and of the slab's
/// nothing is missing.
#[test]
fn faces_that_cut_a_surface_off_are_left_out() {
    const CELL: f64 = 0.25;
    let box_ = Bounds::new(DVec3::splat(-1.0), DVec3::splat(1.0));
    let run = Run::default();
    let mut left = 0;
    for turn in [0.3, 1.0, 3.0, 17.0, 44.9] {
        let slab = Solid::slab(DVec3::Z, 0.6).rotate_x(deg(turn)).rotate_y(deg(0.7 * turn)).translate([0.0, 0.1, 0.72]);
        let part = compiled(&(&slab & Solid::cuboid([2.0; 3]))).unwrap();
        let mesh = sharp(&part.surface, box_, CELL, &run).unwrap();
        let of_slab = compiled(&slab).unwrap();
        let slopes = Slopes { program: &of_slab.surface, precision: 1e-4, reach: 0.1 };
        let is_on = |p: &DVec3| p.abs().max_element() > 1.0 - 1e-3 * CELL;
        let mut facets = Facets::new(&mesh, |corners| !corners.iter().all(is_on));
        left += facets.triangles.len();
        facets.leave_faces(&box_, &slopes, &run).unwrap();
        left -= facets.triangles.len();
        for triangle in &facets.triangles {
            let middle = triangle.map(|v| facets.positions[v as usize]).iter().sum::<DVec3>() / 3.0;
            let off = slab.value(middle).unwrap().abs();
            // Where two faces of the box meet the slab, a corner may be cut off.
            assert!(off < 0.2 * CELL, "{turn}: {off} off the slab at {middle}");
        }
        // The area of the slab's faces in the box, by their intersection with a grid of lines.
        let count = 400;
        let at = |i: i32| (f64::from(i) + 0.5) * 2.0 / f64::from(count) - 1.0;
        let lines = (0..count * count).map(|n| (at(n / count), at(n % count)));
        let normal = glam::DMat3::from_rotation_y((0.7 * turn).to_radians())
            * glam::DMat3::from_rotation_x(turn.to_radians())
            * DVec3::Z;
        let crossed = |(x, y): (f64, f64)| {
            [-0.3, 0.3]
                .map(|side| (side + normal.dot(DVec3::new(-x, 0.1 - y, 0.72))) / normal.z)
                .into_iter()
                .filter(|z| z.abs() < 1.0)
                .count()
        };
        let want = lines.map(crossed).sum::<usize>() as f64 * (2.0 / f64::from(count)).powi(2) / normal.z;
        assert!((facets.area() - want).abs() < 0.03 * want, "{turn}: area {} for {want}", facets.area());
    }
    assert!(left > 0, "no box had faces that corners do not tell");
}

#[test]
fn plots_are_told_of_what_is_beyond_their_sides() {
    let solid = holed();
    let programs = compiled(&solid).unwrap();
    let mesh = sharp(&programs.surface, programs.bounds(), 3.0, &Run::default()).unwrap();
    let facets = || Facets::new(&mesh, |_| true);
    let side = |p: [DVec3; 2]| {
        let mut ends = p.map(|p| p.to_array().map(f64::to_bits));
        ends.sort_unstable();
        ends
    };
    let (mut triangles, mut rims) = (0, HashMap::new());
    for plot in Plots::new(facets(), 64) {
        assert!(plot.facets.triangles.len() <= 64);
        triangles += plot.facets.triangles.len();
        let place = |v: u32| plot.facets.positions[v as usize];
        let mut own: HashMap<[[u64; 3]; 2], (u32, DVec3)> = HashMap::new();
        for [a, b, c] in &plot.facets.triangles {
            for [a, b, c] in [[a, b, c], [b, c, a], [c, a, b]] {
                own.entry(side([*a, *b].map(place))).or_insert((0, place(*c))).0 += 1;
            }
        }
        let of_rims = plot.rims.iter().map(|rim| (side(rim.ends.map(place)), rim.toward));
        let told: HashMap<[[u64; 3]; 2], DVec3> = of_rims.collect();
        for (side, (count, corner)) in own {
            assert_eq!(count == 1, told.contains_key(&side), "a side of {count} triangles");
            if let Some(toward) = told.get(&side) {
                rims.entry(side).or_insert_with(Vec::new).push([corner, *toward]);
            }
        }
    }
    assert_eq!(triangles, mesh.triangles().len());
    assert!(rims.len() > 100, "{} sides between plots", rims.len());
    for both in rims.values() {
        let &[[a, b], [c, d]] = &both[..] else { panic!("{} plots", both.len()) };
        assert_eq!([a, b], [d, c], "what one has is what the other is told");
    }
}

#[test]
fn rims_of_holes_are_on_the_surface() {
    // Outside of a difference holes are measured, too.
    let accuracy = compiled(&holed().offset(1.0)).unwrap().accuracy;
    assert!(accuracy.error <= 8.0 * accuracy.tolerance, "{accuracy:?}");
}

#[test]
fn no_patch_passes_over_a_concave_crease() {
    const RADIUS: f64 = 0.05;
    let pin = Solid::cylinder(0.1, 1.0);
    let both = Solid::cuboid([4.2, 3.5, 0.4]).union_with(pin, Blend::Fillet { radius: RADIUS });
    // On the fillet, as the ball leaves it that rolls round the pin.
    for i in 0..500 {
        let side = DVec3::X.rotate_z(f64::from(i));
        let ball = (0.1 + RADIUS) * side + (0.2 + RADIUS) * DVec3::Z;
        let towards = (-side - DVec3::Z).normalize();
        let value = both.value(ball + RADIUS * towards).unwrap();
        assert!(value.abs() < 3e-3 * RADIUS, "{value} at {side}");
    }
}

/// A pin of .15 through a plate, and triangles of the plate's top and of the pin beside its edge.
fn beside_a_pin(positions: &[[f64; 3]], triangles: &[([u32; 3], bool)]) -> Quilt {
    let plate = Solid::cuboid([2.0, 2.0, 1.0]).translate([0.0, 0.0, -0.5]);
    let programs = compiled(&(plate | Solid::cylinder(0.15, 1.0))).unwrap();
    let positions: Vec<DVec3> = positions.iter().copied().map(DVec3::from).collect();
    let normals = |(corners, is_top): &([u32; 3], bool)| {
        corners
            .map(|v| if *is_top { DVec3::Z } else { (positions[v as usize] * DVec3::new(1.0, 1.0, 0.0)).normalize() })
    };
    let normals = triangles.iter().map(normals).collect();
    let facets = Facets { triangles: triangles.iter().map(|(corners, _)| *corners).collect(), normals, positions };
    let slopes = Slopes { program: &programs.surface, precision: 3e-5, reach: 0.1 };
    Quilt::new(facets, &slopes, Care::new(3e-5), &Run::default()).unwrap().unwrap()
}

/// An edge that passes over a side between two vertices of one face, and comes back.
#[test]
fn no_patch_is_beyond_an_edge_that_its_side_is_crossed_by() {
    let top = [[0.2241, 0.019, 0.0], [0.1489, 0.019, 0.0], [0.1489, -0.0562, 0.0]];
    let edge = [[0.14776, -0.02583, 0.0], [0.13799, 0.05882, 0.0]];
    let of_pin = [[0.1487, 0.0197, 0.0014]];
    let positions = [&top[..], &edge, &of_pin].concat();
    let triangles = [([0, 1, 2], true), ([3, 2, 1], true), ([3, 1, 4], true), ([4, 5, 3], false)];
    let quilt = beside_a_pin(&positions, &triangles);
    let patches = Patches::new(&quilt.patches, &Run::default()).unwrap();
    let foot = patches.nearest(DVec3::new(0.15, 0.0, 0.0) - 0.05 * (DVec3::X + DVec3::Z).normalize()).unwrap();
    assert!((foot.distance - 0.05).abs() < 5e-5, "{foot:?}");
}

#[test]
fn spots_that_small_cells_do_not_show_are_kept_and_told() {
    const OFF: f64 = 0.5;
    let sheet = Solid::cuboid([10.0, 10.0, 0.01]);
    let programs = compiled(&sheet).unwrap();
    let patch = Patch::flat([DVec3::ZERO, 4.0 * DVec3::X, 4.0 * DVec3::Y].map(|p| p + 0.005 * DVec3::Z));
    let mut quilt = Quilt::of(vec![Spot { patch, off: OFF }], 1e-3);
    let slopes = Slopes { program: &programs.surface, precision: 1e-3, reach: 0.1 };
    mend(&mut quilt, &slopes, 1.0, 1e-3, &Run::default()).unwrap();
    assert!(!quilt.patches.is_empty() && quilt.error >= OFF, "{} patches, {}", quilt.patches.len(), quilt.error);
}

/// Of more spots than are mended the farthest are.
#[test]
fn the_farthest_of_many_spots_are_mended() {
    const ROW: usize = 24;
    let top = Solid::cuboid([100.0, 100.0, 2.0]).translate([50.0, 50.0, -1.0]);
    let programs = compiled(&top).unwrap();
    // One beside the other, and farther off one by one.
    let spot = |n: usize| {
        let off = 0.01 + 1e-4 * n as f64;
        let at = 4.0 * DVec3::new((n % ROW) as f64, (n / ROW) as f64, 0.0) + DVec3::new(2.0, 2.0, off);
        Spot { patch: Patch::flat([DVec3::ZERO, 0.5 * DVec3::X, 0.5 * DVec3::Y].map(|p| at + p)), off }
    };
    let slopes = Slopes { program: &programs.surface, precision: 1e-3, reach: 0.1 };
    let mut quilt = Quilt::of((0..ROW * ROW).map(spot).collect(), 1e-3);
    mend(&mut quilt, &slopes, 1.0, 1e-3, &Run::default()).unwrap();
    let left: Vec<f64> = quilt.patches.iter().map(|patch| patch.corners[0].z).filter(|off| *off > 5e-3).collect();
    assert!(!left.is_empty() && left.len() < 80, "{} of {} are left", left.len(), ROW * ROW);
    assert!(left.iter().all(|off| *off < 0.018), "{left:?}");
}

/// Where there are too many patches to see whether splitting helps, it does not.
#[test]
fn patches_are_no_more_than_they_may_be() {
    let solid = Solid::superellipsoid([1.0, 0.7, 0.5], 0.4, 1.7).twist(deg(60.0));
    let programs = compiled(&solid).unwrap();
    let (slopes, run) = (Slopes { program: &programs.surface, precision: 1e-6, reach: 0.1 }, Run::default());
    let mesh = sharp(&programs.surface, programs.bounds(), 0.2, &run).unwrap();
    let count = mesh.triangles().len();
    let quilt = |most: usize, patience: f64| {
        let care = Care { most, patience, ..Care::new(1e-6) };
        Quilt::new(Facets::new(&mesh, |_| true), &slopes, care, &run).unwrap()
    };
    for most in [count, 5 * count, 40 * count] {
        let found = quilt(most, f64::INFINITY).unwrap();
        assert!(found.len() <= most, "{} for {most} of {count}", found.len());
        assert!(!found.spots.is_empty(), "nothing is off with {most}");
        assert!(quilt(most, 5e-3).is_none(), "{most} of {count} do");
    }
}

#[test]
fn nothing_is_doubtful_of_patches_that_were_left_out() {
    let at = |x: f64| Patch::flat([DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| p + x * DVec3::X));
    let mut quilt = Quilt::of(Vec::new(), 1e-3);
    quilt.add_all([(at(0.0), 2e-3), (at(10.0), 5e-3)].into_iter());
    assert_eq!((quilt.doubts(1e-3).len(), quilt.reached(1e-4)), (2, 5e-3));
    quilt.keep_near(&[&Spot { patch: at(0.5), off: 0.1 }]);
    assert_eq!((quilt.patches.len(), quilt.doubts(1e-3).len(), quilt.reached(1e-4)), (1, 1, 2e-3));
}

/// A patch that tells nothing of the surface counts by what would be missed without it.
#[test]
fn patches_that_are_left_out_count_by_what_is_missed() {
    const TOLERANCE: f64 = 1e-3;
    let cube = Solid::cuboid([10.0; 3]);
    let programs = compiled(&cube).unwrap();
    let slopes = Slopes { program: &programs.surface, precision: TOLERANCE, reach: 0.1 };
    let top = [DVec3::new(-5.0, -5.0, 5.0), DVec3::new(5.0, -5.0, 5.0), DVec3::new(5.0, 5.0, 5.0)];
    let sliver = |at: DVec3| Spot {
        patch: Patch::flat([DVec3::ZERO, 0.1 * DVec3::X, 0.1 * DVec3::Y].map(|p| at + p)),
        off: 0.3,
    };
    let left = |at: [f64; 3]| {
        let mut quilt = Quilt::of(vec![sliver(at.into())], TOLERANCE);
        quilt.add_all([(Patch::flat(top), 0.0)].into_iter());
        let spots = std::mem::take(&mut quilt.spots);
        quilt.take_spots(spots);
        quilt.leave(&slopes, &Run::default()).unwrap();
        assert_eq!(quilt.patches.len(), 1);
        (quilt.error, quilt.doubts(TOLERANCE).len(), quilt.reached(1e-4))
    };
    assert_eq!(left([2.0, -2.0, 5.3]), (0.0, 0, TOLERANCE));
    let (error, doubts, reached) = left([2.0, -2.0, -5.3]);
    assert!((error - 0.1 * 2f64.sqrt()).abs() < 1e-9 && doubts == 1 && reached == TOLERANCE, "{error}, {doubts}");
}

#[test]
fn equal_solids_have_one_surface() {
    let surface = |solid: &Solid, length: f64, tolerance: Option<f64>| {
        let wanted = Wanted::of(length, tolerance, &Bounds::ALL);
        surface(solid, &compiled(solid).unwrap(), &wanted, &FromMeshes, &Run::default()).unwrap()
    };
    // Of no other test.
    let (one, other) = (block().scale(1.07), block().scale(1.07));
    let first = surface(&one, 1.0, None);
    assert!(Arc::ptr_eq(&first, &surface(&other, 1.0, None)));
    // Lengths that are alike have one as well, others have not.
    assert!(Arc::ptr_eq(&first, &surface(&one, 1.1, None)));
    assert!(!Arc::ptr_eq(&first, &surface(&one, 0.4, None)));
    assert!(!Arc::ptr_eq(&first, &surface(&one.scale(1.5), 1.0, None)));
    // Two lengths of one solid, in one solid.
    let both = one.shell(1.0) | other.offset(-1.0);
    compiled(&both).unwrap();
    drop((both, one));
    assert!(Arc::ptr_eq(&first, &surface(&other, 1.0, None)));
    drop(other);
    assert_eq!(Arc::strong_count(&first), 1, "it outlives all that have it");
}

/// Of flat faces and of curved ones, with their share of the hierarchy.
#[test]
fn a_patch_takes_at_most_150_bytes() {
    let plate = Solid::cuboid([4.0, 4.0, 0.4]);
    let pin =
        |n: u32| Solid::cylinder(0.1, 1.0).translate([-1.5 + 0.6 * f64::from(n % 6), f64::from(n / 6) - 1.5, 0.0]);
    let pins = Solid::union_all((0..24).map(pin).chain([plate]), crate::RFunction::MIN_MAX);
    for solid in [holed(), pins, Solid::superellipsoid([2.0, 1.0, 1.5], 0.4, 0.6).twist(deg(20.0))] {
        let patches = surface_of(&solid).unwrap().patches.clone();
        let each = patches.bytes() as f64 / patches.len() as f64;
        println!("{} patches, {each:.1} bytes each", patches.len());
        assert!(patches.len() > 1000 && each <= 150.0, "{each} bytes each of {}", patches.len());
    }
}

/// Beyond what is asked for patches are not known: what cells hide there is left.
#[test]
fn what_is_hidden_elsewhere_is_left() {
    let pin = |x: f64| Solid::cylinder(0.2, 1.0).translate([x, 0.0, 0.2]);
    let fillet = |radius: f64| Blend::Fillet { radius };
    let one = Solid::cuboid([7.0, 1.5, 0.4]).union_with(pin(-2.5), fillet(0.1));
    let both = one.union_with(pin(-1.5), fillet(0.1001));
    let accuracy = compiled(&both).unwrap().accuracy;
    assert!(accuracy.tolerance < 3e-4 && accuracy.error < 1e-3, "{accuracy:?}");
}
