//! Smooth joins of many in a chain, beside the hard union of the same.

use std::hint::black_box;

use glam::DVec3;
use rvachev::program::{Program, Region};
use rvachev::{Bounds, Camera, CellSize, MeshSettings, RFunction, Run, Solid, camera::Window};

use crate::measure::in_turn;

/// How often boxes are halved along each axis.
const LEVELS: u32 = 5;

/// Balls of (fill / ∛n) · (.6 to 1.4) with centres in a cube of 2.
fn balls(count: usize, fill: f64) -> impl Iterator<Item = Solid> {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut next = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    let size = fill / (count as f64).cbrt();
    (0..count).map(move |_| {
        let radius = size * (0.6 + 0.8 * next());
        Solid::sphere(radius).translate(DVec3::new(next(), next(), next()) * 2.0 - 1.0)
    })
}

/// Narrows a program to the eighths of a box, and to those of what the surface may cross in them, so
/// many times; gives how many of the smallest it may cross.
fn narrowed(program: &Program, bounds: &Bounds, levels: u32) -> usize {
    let half = bounds.half_extents();
    (0..8u32)
        .map(|eighth| {
            let up = DVec3::new(f64::from(eighth & 1), f64::from(eighth >> 1 & 1), f64::from(eighth >> 2));
            let part = Bounds::from_center(bounds.min + (0.5 + up) * half, 0.5 * half);
            match program.narrow(&part) {
                Region::Surface(_) if levels == 1 => 1,
                Region::Surface(program) => narrowed(&program, &part, levels - 1),
                Region::Inside | Region::Outside => 0,
            }
        })
        .sum()
}

/// Prints the rows: how many times the time of the hard union.
pub fn rows(threads: usize) {
    let bounds = Bounds::from_center(DVec3::ZERO, DVec3::splat(1.5));
    let settings = MeshSettings { cell: CellSize::LongestSide(128), bounds: Some(bounds), ..MeshSettings::default() };
    for (count, fill, radius) in [(186, 0.8, 0.05), (1001, 0.8, 0.026), (2000, 0.55, 0.03), (2000, 0.55, 0.003)] {
        let hard = || Solid::union_all(balls(count, fill), RFunction::MIN_MAX);
        let smooth = || balls(count, fill).reduce(|all, next| all.smooth_union(next, radius)).expect("there are some");
        let mesh = |solid: Solid| {
            let (settings, run) = (settings.clone(), Run { threads, ..Run::default() });
            move || drop(black_box(solid.mesh_with(&settings, &run).expect("a mesh")))
        };
        let picture = |solid: Solid| {
            let run = Run { threads, ..Run::default() };
            move || {
                let rays = Camera::framing(&bounds).parallel().rays(256, 256);
                let scene = solid.scene_with(&run).expect("the solid is valid");
                drop(black_box(scene.surfaces_with(&rays, Window::whole(256, 256), &run).expect("nobody cancels")));
            }
        };
        let narrow = |solid: Solid| {
            let program = solid.surface_program().expect("the solid is valid");
            move || narrowed(&program, &bounds, LEVELS)
        };
        let narrowed = in_turn(threads, [narrow(hard()), narrow(smooth())]);
        let meshes = in_turn(threads, [mesh(hard()), mesh(smooth())]);
        let pictures = in_turn(threads, [picture(hard()), picture(smooth())]);
        println!(
            "{count} balls in a chain, smooth over {radius}: narrowed to level {LEVELS} {:.4} s, {:.2} times the union; mesh 128³ {:.3} s, {:.2} times the union; picture 256² {:.3} s, {:.2} times",
            narrowed.seconds[1], narrowed.ratio, meshes.seconds[1], meshes.ratio, pictures.seconds[1], pictures.ratio,
        );
    }
}
