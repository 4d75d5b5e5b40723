//! Rays through scenes: the first hit is found, whatever the solid.
//!
//! The oracle is an isolation of roots by intervals that shares nothing with the marcher but the
//! ranges: a piece of the ray whose box the program says is all inside or all outside has no
//! crossing, any other is halved, the nearer half first, until it is short.

use glam::DVec3;
use rvachev::{
    Blend, Bounds, Camera, Gielis, Run, Scene, Solid, Supershape,
    camera::Window,
    deg,
    form::Form,
    layers::Surface,
    program::{Program, Region},
};

mod examples;

use crate::models;
use crate::support::{Random, frame_of, near, random_leaf, random_solid};

/// Pieces this short, in proportion to the solid, are not halved.
const SHORT: f64 = 2e-6;

/// Depths must agree to this.
const CLOSE: f64 = 1e-4;

/// What the oracle says of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Answer {
    Miss,
    Hit(f64),
    /// It gave up.
    Unknown,
}

/// The first crossing up to `far`, to [`SHORT`].
fn isolated(program: &Program, size: f64, origin: DVec3, direction: DVec3, far: f64) -> Answer {
    let at = |t: f64| origin + t * direction;
    let inside = program.value(origin) > 0.0;
    let mut pieces = vec![(program.clone(), 0.0, far)];
    let mut patience = 20_000;
    while let Some((program, t0, t1)) = pieces.pop() {
        patience -= 1;
        if patience == 0 {
            return Answer::Unknown;
        }
        match program.narrow(&Bounds::from_corners(at(t0), at(t1)).inflate(1e-12 * size)) {
            Region::Inside if inside => {}
            Region::Outside if !inside => {}
            // The sign has changed at the border to this piece.
            Region::Inside | Region::Outside => return Answer::Hit(t0),
            Region::Surface(program) => {
                if t1 - t0 > SHORT * size {
                    let middle = 0.5 * (t0 + t1);
                    pieces.push((program.clone(), middle, t1));
                    pieces.push((program, t0, middle));
                } else if (program.value(at(t1)) > 0.0) != inside {
                    return Answer::Hit(0.5 * (t0 + t1));
                }
            }
        }
    }
    Answer::Miss
}

/// Whether a hit at this distance, infinite for a miss, is what the oracle says.
fn agree(answer: Answer, found: f64, size: f64) -> bool {
    match answer {
        Answer::Miss => found == f64::INFINITY,
        Answer::Hit(t) => (found - t).abs() <= CLOSE * size,
        Answer::Unknown => true,
    }
}

/// A ray of one kind or another: from anywhere to anywhere, from inside, along the axes, in the
/// axis planes, through corners and edges of the box.
fn ray(random: &mut Random, frame: &Bounds) -> (DVec3, DVec3) {
    let around = frame.inflate(0.6 * frame.longest_side());
    let mut origin = random.point_in(&around);
    let mut target = random.point_in(frame);
    match random.below(8) {
        0 => origin = random.point_in(frame),
        1 => {
            let axis = random.below(3);
            target = origin;
            target[axis] += random.pick(&[-1.0, 1.0]);
            origin[axis] = if target[axis] > origin[axis] { around.min[axis] } else { around.max[axis] };
        }
        2 => {
            let axis = random.below(3);
            (origin[axis], target[axis]) = (0.0, 0.0);
        }
        3 => {
            let axis = random.below(3);
            origin = DVec3::ZERO;
            origin[axis] = random.pick(&[-1.0, 1.0]) * around.longest_side();
            target = DVec3::ZERO;
        }
        4 => target = random.pick(&frame.corners()),
        5 => target = (target * 8.0).round() / 8.0,
        _ => {}
    }
    let direction = (target - origin).normalize_or_zero();
    (origin, if direction == DVec3::ZERO { DVec3::X } else { direction })
}

/// A bounded solid of any kind; some of them thin shells, flush faces, tangent silhouettes.
fn subject(random: &mut Random, number: usize) -> Solid {
    let depth = number % 4;
    let solid = match number % 10 {
        8 => {
            // Faces on each other, and one that another ends at.
            let half = random.range(0.3, 0.7);
            let block = Solid::cuboid(DVec3::splat(2.0 * half));
            let beside = Solid::cuboid(DVec3::splat(half)).translate(DVec3::X * 1.5 * half);
            let cut = Solid::cuboid(DVec3::splat(half)).translate(DVec3::Z * 0.5 * half);
            if random.chance(0.5) { block | beside } else { block - cut }
        }
        9 => {
            let (inner, outer) = (random.range(0.4, 0.8), random.log_range(1e-4, 1e-2));
            Solid::sphere(inner + outer) - Solid::sphere(inner)
        }
        7 => {
            let e = [0.05, 0.1, 1.0, 2.0, 2.5];
            Solid::superellipsoid(random.vector(0.2, 0.9), random.pick(&e), random.pick(&e))
        }
        6 => random_leaf(random),
        _ => random_solid(random, depth),
    };
    if solid.bounds().is_ok_and(|bounds| bounds.is_finite()) { solid } else { solid & Solid::sphere(2.5) }
}

/// What came of many rays.
#[derive(Debug, Default)]
struct Tally {
    rays: usize,
    hits: usize,
    grazing: usize,
    /// Hits somewhere on a stretch along which the value is 0 but for rounding.
    level: usize,
    /// Crossings of what is thinner than pieces are short.
    thin: usize,
    unknown: usize,
    wrong: Vec<String>,
}

impl Tally {
    fn compare(&mut self, number: usize, solid: &Solid, frame: &Bounds, rays: &[(DVec3, DVec3)]) {
        let program = solid.surface_program().unwrap();
        let size = frame.longest_side();
        let found = solid.scene().unwrap().first_hits(rays);
        for (&(origin, direction), found) in rays.iter().zip(&found) {
            let far = origin.distance(frame.center()) + frame.size().length();
            let answer = isolated(&program, size, origin, direction, far);
            self.rays += 1;
            self.hits += usize::from(found.is_hit());
            self.unknown += usize::from(answer == Answer::Unknown);
            let single = solid.raycast(origin, direction).unwrap().map_or(f64::INFINITY, |hit| hit.distance);
            for (who, found) in [("scene", found.distance), ("raycast", single)] {
                if agree(answer, found, size) {
                    continue;
                }
                // A ray beside it, no further than a tangent may be, sees the same.
                let side = direction.any_orthonormal_vector();
                let turn =
                    |i: u32| glam::DQuat::from_axis_angle(direction, f64::from(i) * std::f64::consts::TAU / 64.0);
                let shifts = (0..64).map(|i| turn(i) * side);
                let grazes = shifts
                    .map(|shift| isolated(&program, size, origin + 1e-5 * size * shift, direction, far))
                    .any(|answer| agree(answer, found, size));
                let from = if let Answer::Hit(t) = answer { t } else { far };
                let on_the_way = (0..=64).map(|i| from + f64::from(i) / 64.0 * (found - from));
                let is_level = |t: f64| program.value(origin + t * direction).abs() <= 1e-15 * size;
                let value = |t: f64| program.value(origin + t * direction);
                let inside = |t: f64| value(t) > 0.0;
                let crosses = [1e-12, 1e-10, 1e-8].iter().any(|d| inside(found - d * size) != inside(found + d * size));
                // Where it goes inside for less than the shortest of pieces either answer will do.
                let is_brief = from < far && inside(from - 1e-5 * size) == inside(from + 1e-5 * size);
                // It does so at what was found, if the value is above 0 at its crest there: a blade
                // is thinner than samples are apart.
                let crest = || {
                    let (mut low, mut high) = (found - 1e-8 * size, found + 1e-8 * size);
                    for _ in 0..120 {
                        let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
                        if value(a) < value(b) { low = a } else { high = b }
                    }
                    value(0.5 * (low + high))
                };
                let is_brief = is_brief
                    || found < f64::INFINITY
                        && !inside(found - 1e-5 * size)
                        && !inside(found + 1e-5 * size)
                        && crest() > 0.0;
                // In a face it is inside or outside by rounding.
                let in_face =
                    from < far && (1..32).all(|i| value(from + f64::from(i) * 1e-4 * size).abs() <= 1e-14 * size);
                if in_face {
                    self.level += 1;
                } else if found < from && crosses || is_brief {
                    self.thin += 1;
                } else if grazes {
                    self.grazing += 1;
                } else if found < f64::INFINITY && on_the_way.into_iter().all(is_level) {
                    self.level += 1;
                } else {
                    self.wrong.push(format!(
                        "subject {number}: {who} found {found} where {answer:?}, from {origin:?} along {direction:?}: {:?}",
                        [-1e-5, 0.0, 1e-5].map(|d| program.value(origin + (found + d * size) * direction))
                    ));
                }
            }
        }
    }
}

/// `RAYS=200x1000` in the environment is the full count.
#[test]
fn the_first_hit_is_found() {
    let asked = std::env::var("RAYS").unwrap_or_default();
    let count = |part: Option<&str>, default: usize| part.and_then(|n| n.parse().ok()).unwrap_or(default);
    let mut parts = asked.split('x');
    let (subjects, rays) = (count(parts.next(), 40), count(parts.next(), 15));
    let first = count(parts.next(), 0);
    let mut tally = Tally::default();
    for number in first..first + subjects {
        let mut random = Random::new(5000 + number as u64);
        let solid = subject(&mut random, number);
        let frame = frame_of(&solid);
        let rays: Vec<(DVec3, DVec3)> = (0..rays).map(|_| ray(&mut random, &frame)).collect();
        tally.compare(number, &solid, &frame, &rays);
    }
    let Tally { rays, hits, grazing, level, unknown, .. } = tally;
    println!("{rays} rays, {hits} hits, {grazing} grazing, {level} level, {unknown} not isolated");
    assert!(tally.wrong.is_empty(), "{} wrong:\n{}", tally.wrong.len(), tally.wrong.join("\n"));
    assert!(tally.grazing <= 2 + tally.rays / 200 && 4 * tally.hits > tally.rays, "{tally:?}");
}

/// Pieces were once judged by the values of a program before it was narrowed, and hits passed over.
#[test]
fn narrowing_changes_values_but_not_hits() {
    let pair = subject(&mut Random::new(5054), 54);
    let Form::Blend { blend, operands: [first, second], .. } = pair.form() else { panic!("{pair}") };
    let solid = first.difference_with(second, blend);
    let origin = DVec3::new(-0.6752307331073726, -0.30321878351103715, 0.5702222222936844);
    let direction = DVec3::new(0.5017764840795649, 0.8464782674287488, -0.17803062319604854);
    let single = solid.raycast(origin, direction).unwrap().unwrap();
    assert!((single.distance - 0.8520242297941252).abs() < 1e-6, "{single:?}");
    let found = solid.scene().unwrap().first_hit(origin, direction).unwrap();
    assert!((found.distance - single.distance).abs() < 1e-4, "{found:?}");
}

/// The gradient's direction by central differences, where those of two lengths and of both
/// sides agree.
fn differences(program: &Program, p: DVec3, size: f64) -> Option<DVec3> {
    let middle = program.value(p);
    let by = |h: f64| {
        let sides = DVec3::AXES.map(|axis| [program.value(p + h * axis), program.value(p - h * axis)]);
        let gradient = DVec3::from_array(sides.map(|[above, below]| (above - below) / (2.0 * h)));
        let kink = sides.iter().map(|[above, below]| ((above + below - 2.0 * middle) / h).abs()).fold(0.0, f64::max);
        (kink < 1e-3 * gradient.length()).then(|| gradient.normalize_or_zero())
    };
    let (fine, coarse) = (by(1e-6 * size)?, by(4e-5 * size)?);
    (fine.is_normalized() && fine.distance(coarse) < 1e-3).then_some(fine)
}

#[test]
fn depths_and_normals_are_those_of_the_surface() {
    let mut random = Random::new(77);
    let (mut compared, mut grazing) = (0, 0);
    for number in 0..40 {
        let solid = subject(&mut random, number);
        let program = solid.surface_program().unwrap();
        let frame = frame_of(&solid);
        let size = frame.longest_side();
        let rays: Vec<(DVec3, DVec3)> = (0..30).map(|_| ray(&mut random, &frame)).collect();
        let found = solid.scene().unwrap().first_hits(&rays);
        for (&(origin, direction), found) in rays.iter().zip(&found) {
            if !found.is_hit() {
                continue;
            }
            let at = |t: f64| program.value(origin + t * direction) > 0.0;
            let inside = at(0.0);
            let (before, after) = (found.distance - 1e-5 * size, found.distance + 1e-5 * size);
            let graze = at(before.max(0.0)) != inside || at(after) == inside;
            let point = origin + found.distance * direction;
            let Some(gradient) = differences(&program, point, size) else { continue };
            let facing = found.normal.as_dvec3().dot(direction);
            if graze {
                // A tip thinner than depths are exact.
                grazing += 1;
                continue;
            }
            if facing.abs() > 0.02 {
                assert_eq!(facing > 0.0, inside, "subject {number}: {found:?} from {origin:?} along {direction:?}");
            }
            compared += 1;
            let off = (found.normal.as_dvec3() + gradient).length();
            assert!(off < 5e-3, "subject {number}: {found:?}, {gradient}, from {origin:?} along {direction:?}");
        }
    }
    assert!(compared > 200 && 50 * grazing < compared, "{compared}, {grazing} grazing");
}

fn normal_image(scene: &Scene, camera: &Camera, threads: usize) -> Vec<Surface> {
    let run = Run { threads, ..Run::default() };
    let seen = scene.surfaces_with(&camera.rays(60, 44), Window::whole(60, 44), &run).unwrap();
    seen.surfaces().to_vec()
}

#[test]
fn pictures_see_what_single_rays_hit() {
    for model in [models::m1(), models::m2(), models::m4(), models::m6()] {
        compare_with_single_rays(model.name, &model.solid);
    }
}

/// What most rays meet is told without the fillets, which are united with others, cut off, cut into,
/// or in each other.
#[test]
fn pictures_of_fillets_see_what_single_rays_hit() {
    let fillet = |radius: f64| Blend::Fillet { radius };
    let plate = Solid::cuboid([2.0, 2.0, 0.4]);
    let post = Solid::superellipsoid([0.5, 0.5, 1.0], 0.3, 0.7);
    let wall = Solid::cuboid([0.3, 2.0, 1.2]).translate([-0.7, 0.0, 0.6]);
    let joint = plate.union_with(&post, fillet(0.15));
    let half = Solid::cuboid([4.0, 4.0, 4.0]).translate([0.0, -2.0, 0.0]);
    let solids = [
        ("plate and post", joint.clone()),
        ("all inner edges", (&plate | &wall).filleted(0.2)),
        ("a chamfered edge", plate.intersection_with(&post, Blend::Chamfer { leg: 0.1 })),
        ("bored through the fillet", &joint - Solid::cylinder(0.2, 3.0).translate([0.6, 0.1, 0.0])),
        ("walls", post.shell(0.1) - half),
    ];
    for (name, solid) in solids {
        let bounds = solid.bounds().unwrap();
        compare_view(name, &solid, &Camera::framing(&bounds));
        compare_view(name, &solid, &Camera::perspective(bounds.center(), bounds.max, DVec3::Z, deg(100.0)));
    }
}

/// Cells are divided for many rays, and not for one: a crossing just before the end of a cell is met
/// in either.
#[test]
fn many_rays_beside_a_fillet_hit_what_each_hits_alone() {
    let plate = Solid::cuboid([2.0, 2.0, 0.4]);
    let joint = plate.union_with(Solid::superellipsoid([0.5, 0.5, 1.0], 0.3, 0.7), Blend::Fillet { radius: 0.25 });
    let solid = joint - Solid::sphere(0.2).translate([0.0, 0.0, 1.0]);
    let (scene, mut random) = (solid.scene().unwrap(), Random::new(5));
    let joints = Bounds::new(DVec3::new(-0.8, -0.8, 0.2), DVec3::new(0.8, 0.8, 0.5));
    let mut eyes = 0;
    while eyes < 40 {
        let eye = random.point_in(&joints);
        if !(-0.03..-0.003).contains(&solid.value(eye).unwrap()) {
            continue;
        }
        eyes += 1;
        let rays: Vec<(DVec3, DVec3)> = (0..400).map(|_| (eye, random.direction())).collect();
        let together = scene.first_hits(&rays);
        for (ray, seen) in rays.iter().zip(together) {
            let alone = scene.first_hit(ray.0, ray.1).map_or(f64::INFINITY, |hit| hit.distance);
            assert!(alone == seen.distance || (alone - seen.distance).abs() < 1e-3, "{ray:?}: {alone} {seen:?}");
        }
    }
}

/// Rings and bars of a formula that chooses a lot, as a plate with a hole.
#[cfg(feature = "formula")]
#[test]
fn pictures_of_formulas_see_what_single_rays_hit() {
    use glam::DVec2;
    use rvachev::{PlaneBounds, Profile, rad};

    let (x, y, _) = fidget::context::Tree::axes();
    let ring = |cx: f32, cy: f32, r: f32| {
        let distance = ((x.clone() - cx).square() + (y.clone() - cy).square()).sqrt();
        (distance.clone() - r).max(-distance + 0.7 * r)
    };
    let bar = |cx: f32, cy: f32| (x.clone() - cx).abs().max((y.clone() - cy).abs() - 0.15) - 0.02;
    let at = |i: u8| f32::from(i) * 0.28 - 0.84;
    let spots: Vec<(f32, f32)> = (0..49).map(|i| (at(i % 7), at(i / 7))).collect();
    let first = ring(0.9, 0.9, 0.05);
    let text = spots.iter().fold(first, |all, &(cx, cy)| all.min(ring(cx, cy, 0.1)).min(bar(cx + 0.13, cy)));
    let profile = Profile::formula(&text, PlaneBounds { min: DVec2::NEG_ONE, max: DVec2::ONE });
    let plate = profile.extrude(0.1) - Solid::sphere(0.3).translate([0.2, 0.1, 0.0]);
    compare_with_single_rays("plate", &plate);
    // Seen along z, what is outside of the text is seen as well, and the text stands askew.
    let letters = profile.extrude(0.1).rotate_z(rad(0.4)).translate([0.1, 0.0, 0.06]);
    let base = Solid::cuboid([0.8, 0.9, 0.05]) | Solid::sphere(0.2).translate([-0.4, 0.1, 0.0]);
    compare_with_single_rays("letters on a base", &(&base | &letters));
    compare_with_single_rays("letters cut into a base", &(&base - &letters));
    // With a second text across it.
    compare_with_single_rays("two texts", &(&plate | profile.extrude(0.2).rotate_x(deg(90.0))));
}

/// A formula that jumps at planes of three kinds.
#[cfg(feature = "formula")]
fn steps() -> Solid {
    let (x, y, z) = fidget::context::Tree::axes();
    let saw = (x.clone() + 0.3 * y.clone()).modulo(0.5);
    let formula = z - saw - 0.2 * (y * 2.0).floor() + 0.1 * x.round();
    Solid::formula(&formula, Bounds::from_center(DVec3::ZERO, DVec3::splat(1.2)))
}

/// Blades thinner than a pixel, edges at which slopes have no bound, steps.
#[test]
fn pictures_of_blades_and_steps_see_what_single_rays_hit() {
    let g = Gielis::new;
    let blades = Solid::from(Supershape::new(g(5.0, 0.3, 0.3, 0.3), g(4.0, 2.0, 2.0, 2.0)));
    compare_with_single_rays("blades", &(blades.rotate_x(deg(20.0)) | Solid::sphere(0.3).translate([0.5, 0.5, 0.1])));
    let pinched = |e1, e2| Solid::superellipsoid([1.0, 0.8, 0.6], e1, e2);
    compare_with_single_rays("pinched", &(pinched(3.0, 0.3).rotate_y(deg(30.0)) - pinched(2.5, 2.5)));
    #[cfg(feature = "formula")]
    compare_with_single_rays("steps", &(steps() & Solid::cuboid([2.0, 1.6, 1.8])));
}

/// Faces whose planes turn with what they are held by, and what a ball leaves: rays look for them
/// up to where they meet the operands.
#[test]
fn pictures_of_chamfers_and_fillets_see_what_single_rays_hit() {
    let plate = Solid::cuboid([2.0, 2.0, 0.4]);
    let spike = Solid::superellipsoid([0.5, 0.5, 1.0], 0.3, 0.7).rotate_x(deg(12.0));
    let joint = |blend| plate.union_with(&spike, blend);
    let angle = (&plate | Solid::cuboid([0.4, 2.0, 1.6]).translate([0.8, 0.0, 0.6])).filleted(0.2);
    let solids = [
        ("chamfered", joint(Blend::Chamfer { leg: 0.15 })),
        ("filleted", joint(Blend::Fillet { radius: 0.15 })),
        ("an angle", angle),
    ];
    for (name, solid) in solids {
        compare_view(name, &solid, &Camera::framing(&solid.bounds().unwrap()));
    }
}

fn compare_with_single_rays(name: &str, solid: &Solid) {
    let bounds = solid.bounds().unwrap();
    let inside = Camera::perspective(bounds.center(), bounds.max, DVec3::Z, deg(100.0));
    let above = Camera::orthographic(bounds.center() + DVec3::Z * 9.0, bounds.center(), DVec3::Y, bounds.size().y);
    let within = Camera::orthographic(bounds.center(), bounds.center() - DVec3::Z, DVec3::Y, 0.7 * bounds.size().y);
    let below = Camera::orthographic(bounds.min - DVec3::Z, bounds.min, DVec3::new(0.3, 1.0, 0.0), 4.0);
    for camera in [Camera::framing(&bounds), Camera::framing_orthographic(&bounds), inside, above, within, below] {
        compare_view(name, solid, &camera);
    }
}

fn compare_view(name: &str, solid: &Solid, camera: &Camera) {
    let scene = solid.scene().unwrap();
    let seen = normal_image(&scene, camera, 1);
    // Fresh or used, on one thread or several: the same to the bit. The last view is kept: a pixel
    // is looked at by itself first.
    drop(scene.surfaces(&camera.rays(60, 44), Window { width: 1, height: 1, ..Window::whole(60, 44) }));
    assert!(seen == normal_image(&scene, camera, 2), "{name}");
    assert!(seen == normal_image(&solid.scene().unwrap(), camera, 3), "{name}");
    let size = solid.bounds().unwrap().longest_side();
    let mut differ = 0;
    for (i, seen) in seen.iter().enumerate().step_by(37) {
        let (origin, direction) = camera.ray((i % 60) as f64 + 0.5, (i / 60) as f64 + 0.5, 60, 44);
        let hit = solid.raycast(origin, direction).unwrap();
        let distance = hit.map_or(f64::INFINITY, |hit| hit.distance);
        let close = distance == seen.distance || (distance - seen.distance).abs() < 1e-5 * size;
        differ += usize::from(!close);
    }
    assert!(differ <= 2, "{name} {camera:?}: {differ}");
}

#[test]
fn windows_are_parts_of_the_picture() {
    let scene = models::m2().solid.scene().unwrap();
    let camera = Camera::framing(&scene.bounds());
    let rays = camera.rays(150, 110);
    let whole = scene.surfaces(&rays, Window::whole(150, 110));
    let window = Window { left: 33, top: 21, width: 90, height: 70, ..Window::whole(150, 110) };
    let part = scene.surfaces(&rays, window);
    for y in 0..70 {
        for x in 0..90 {
            let (a, b) = (part.at(x, y), whole.at(x + 33, y + 21));
            assert_eq!(a.is_hit(), b.is_hit());
            assert!(a == b || (a.distance - b.distance).abs() < 1e-6);
        }
    }
    assert!(!part.at(90, 0).is_hit());
}

#[test]
fn scenes_of_any_size_and_place() {
    let ball = Solid::sphere(1.0);
    for (scale, place) in [(1e-6, 0.0), (1.0, 1e5), (1e6, 1.0)] {
        let solid = ball.scale(scale).translate(DVec3::X * place * scale);
        let scene = solid.scene().unwrap();
        for far in [3.0, 1e6] {
            let origin = DVec3::new(place, 0.3, far) * scale;
            let hit = scene.first_hit(origin, -DVec3::Z).expect("aimed at it");
            near(hit.distance / scale, far - 0.91f64.sqrt(), 2e-5 + 1e-9 * far);
            assert!(hit.normal.dot(DVec3::new(0.0, 0.3, 0.91f64.sqrt())) > 0.9999);
        }
        assert!(scene.first_hit(DVec3::new(place + 1.1, 0.0, 9.0) * scale, -DVec3::Z).is_none());
        assert!(scene.first_hit(DVec3::new(place, 0.0, 9.0) * scale, DVec3::Z).is_none());
    }
    let nothing = Solid::sphere(1.0) & Solid::sphere(1.0).translate(DVec3::X * 5.0);
    assert!(nothing.scene().unwrap().first_hit(DVec3::Z * 9.0, -DVec3::Z).is_none());
    assert!((!ball).scene().is_err());
}
