//! Solids as Rust code: what is written compiles and makes the same solid again, and is formatted
//! as rustfmt does.
//!
//! `generated.rs` has the examples of the catalogue and some more, and is compiled with the tests;
//! `BLESS=1` writes it anew. The ignored run compiles random solids with `rustc`.

#[rustfmt::skip]
#[allow(clippy::approx_constant, clippy::type_complexity, clippy::eq_op, reason = "what is written is not chosen")]
mod generated;
mod random;

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use glam::{DAffine3, DQuat, DVec3};
use rvachev::code::{RustFile, RustSettings};
use rvachev::field::{Field, Real};
use rvachev::law::Law;
use rvachev::{
    Blend, Bounds, Caps, Extrusion, Gielis, Helix, Mesh, MeshSolid, Paint, ParamError, Polygon, Profile, RFunction,
    Solid, Turns, catalogue, catalogue::Part, deg, rad,
};

/// Parts with a name each: the examples of the catalogue, and what no example has.
fn parts() -> Vec<(String, Part)> {
    let examples = catalogue().iter().map(|entry| (entry.name().to_string(), entry.example()));
    let examples = examples.filter(|(_, part)| !matches!(part, Part::Value(_)));
    let more = others().into_iter().map(|(name, solid)| (name.to_string(), Part::Solid(solid)));
    let profiles = profiles().into_iter().map(|(name, profile)| (name.to_string(), Part::Profile(profile)));
    examples.chain(more).chain(profiles).collect()
}

fn others() -> Vec<(&'static str, Solid)> {
    let ball = || Solid::sphere(1.0);
    let pin = Solid::cylinder(0.5, 3.0).named("Pin #1");
    let pins = [-1.0, 1.0, 3.0].map(|x| pin.translate([x, 0.0, 0.25]));
    let plate = Solid::cuboid([12.0, 8.0, 1.5]).paint([10, 20, 30]).named("plate");
    let hole = Solid::cylinder(0.75, 4.0).named("hole");
    let holes = hole.translate([2.5, 0.0, 0.0]).repeat_polar(5);
    let curve = Gielis { m: 3.0, n1: 2.0, n2: 3.0, n3: 3.0, a: 1.0, b: 1.25, turns: Turns::Outer };
    let long = (0..9).fold(ball(), |solid, i| solid.translate([0.1, f64::from(i), -0.0]).rotate_z(deg(10.0)));
    vec![
        ("several", plate.difference_all([holes.clone(), hole.clone()], RFunction::MIN_MAX)),
        ("shared", Solid::union_all(&pins, RFunction::Alpha(0.5)) - &pins[0]),
        ("twice", pin.union(&pin, RFunction::default())),
        ("by_method", pin.union(&pin, RFunction::Zero { m: 2 })),
        ("filleted_all", plate.difference_all_with(pins.clone(), Blend::Fillet { radius: 0.25 })),
        ("one_operand", Solid::union_all([ball()], RFunction::P(3.0))),
        ("no_operands", Solid::union_all(Vec::<Solid>::new(), RFunction::P(3.0))),
        ("no_holes", ball().difference_all(Vec::<Solid>::new(), RFunction::MIN_MAX)),
        ("odd_numbers", ball().translate([-0.0, 1e300, f64::INFINITY]).scale(1e-7).scale_axes([f64::NAN, 1e22, 0.1])),
        ("long_numbers", Solid::superellipsoid([0.1 + 0.2, 1.0 / 3.0, 2.0 / 7.0], 1.0 / 3.0, 1.0 / 7.0)),
        ("turned", ball().rotate(DQuat::from_rotation_y(0.3) * DQuat::from_rotation_x(0.1))),
        ("turned_about", ball().rotate_about([1.0, 1.0, 1.0], deg(120.0)).rotate_about([0.0, 3.0, 4.0], deg(30.0))),
        ("mirror", Solid::capsule(0.5, 2.0).reflect([3.0, 4.0, 0.0], 0.5).mirrored_x()),
        ("long_chain", long.named("type").paint(Paint { color: [1, 2, 3], roughness: 0.25 })),
        ("curves", Profile::superpolygon(curve, 2.0).extrude(1.0)),
        ("thread", Profile::circle(0.5).sweep_helix(&Helix { ends: Caps::Rounded(0.1), ..Helix::new(4.0, 2.0, 3.0) })),
        (
            "twisted",
            Profile::rectangle([2.0, 1.0]).extrude_with(&Extrusion { twist: deg(45.0), ..Extrusion::new(4.0) }),
        ),
        ("tolerated", plate.rounded(0.25).with_tolerance(0.001).shell(0.1)),
        ("quoted", ball().named("a \"b\" \\ ø {}").named("fn").named("")),
        ("impl", !(plate.symmetric_difference(&pin, RFunction::default()) & !ball())),
    ]
}

fn profiles() -> Vec<(&'static str, Profile)> {
    let disc = Profile::circle(1.0);
    let ring = Polygon::new([
        vec![[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]],
        vec![[1.0, 1.0], [1.0, 2.0], [2.0, 2.0]],
        vec![[1.0 / 3.0, 4.0], [1.0, 6.0], [2.0, 6.0]],
    ]);
    let many = (0..40).map(|i| [f64::from(i), f64::from(i * i)]);
    vec![
        ("flat_moves", disc.translate([1.0, -2.0]).rotate(rad(0.7)).scale(-0.3).reflect([0.6, 0.8], 0.5).mirrored_y()),
        ("flat_axes", disc.scale_axes([2.0, 0.1]).affine(glam::DAffine2::from_scale([2.0, 3.0].into()))),
        ("flat_map", disc.affine_in_space(DAffine3::from_scale(DVec3::new(2.0, 3.0, 1.0)))),
        ("flat_copies", disc.repeat([3, 2], [4.0, 5.0]).repeat_linear(2, [20.0, 0.5]).repeat_polar(3)),
        ("flat_lengths", disc.elongate([1.0, 0.5]).level(0.1).offset(-0.2).named("slot").paint([1, 2, 3])),
        ("flat_joins", Profile::union_all([disc.clone(), disc.translate([0.5, 0.0])], RFunction::MIN_MAX) ^ &disc),
        ("flat_simpler", disc.rotate(rad(0.7)).scale(3.0).translate([1.0, 2.0]).scale_axes([2.0, 3.0]).simplified()),
        ("with_holes", ring.into()),
        ("of_many_points", Profile::polygon(many)),
        ("empty_contour", Polygon::new([Vec::<[f64; 2]>::new()]).into()),
        ("no_contours", Polygon::new(Vec::<Vec<[f64; 2]>>::new()).into()),
    ]
}

/// A file of functions with a table of them.
fn file(parts: &[(String, Part)]) -> String {
    let mut file = RustFile::new(RustSettings::default());
    let mut tables = [const { String::new() }; 3];
    for (name, part) in parts {
        let mut alone = RustFile::default();
        for file in [&mut file, &mut alone] {
            match part {
                Part::Solid(solid) => file.add(name, solid),
                Part::Profile(profile) => file.add_profile(name, profile),
                other => panic!("{other:?}"),
            }
        }
        let text = alone.to_string();
        let head = text.lines().find(|line| line.starts_with("pub fn ")).expect("a function");
        let function = head["pub fn ".len()..].split('(').next().expect("a name");
        let table = if head.contains("Result") { 2 } else { usize::from(matches!(part, Part::Profile(_))) };
        writeln!(tables[table], "    ({name:?}, {function}),").expect("a string");
    }
    let [solids, profiles, formulas] = tables;
    let kinds = [("Solid", "SOLIDS", solids), ("Profile", "PROFILES", profiles)];
    let mut text = file.to_string();
    for (kind, table, rows) in kinds {
        let (list, count) = (rows.trim_end(), rows.lines().count());
        writeln!(text, "\npub const {table}: [(&str, fn() -> {kind}); {count}] = [\n{list}\n];").expect("a string");
    }
    let kind = "(&str, fn() -> Result<Solid, FormulaError>)";
    let solids: String = formulas.lines().filter(|line| !line.contains("profile")).collect();
    if !solids.is_empty() {
        writeln!(text, "\npub const FORMULAS: &[{kind}] = &[{}];", solids.trim().trim_end_matches(','))
            .expect("a string");
    }
    text
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/code")
}

/// The text as rustfmt has it by its defaults; `None` where there is no rustfmt.
fn formatted(text: &str) -> Option<String> {
    let settings = std::env::temp_dir().join(format!("rustfmt-defaults-{}", std::process::id()));
    std::fs::create_dir_all(&settings).expect("a folder");
    std::fs::write(settings.join("rustfmt.toml"), "style_edition = \"2024\"\n").expect("a file");
    let mut command = Command::new("rustfmt");
    command.args(["--edition", "2024", "--config-path"]).arg(&settings);
    let child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
    let Ok(mut child) = child else {
        println!("skipped: there is no rustfmt");
        return None;
    };
    child.stdin.take().expect("a pipe").write_all(text.as_bytes()).expect("a pipe");
    let output = child.wait_with_output().expect("an end");
    let _ = std::fs::remove_dir_all(&settings);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).expect("text"))
}

/// The first lines that differ.
#[track_caller]
fn assert_same(found: &str, wanted: &str, what: &str) {
    let differ = found.lines().zip(wanted.lines()).position(|(a, b)| a != b);
    let at = differ.unwrap_or_else(|| found.lines().count().min(wanted.lines().count()));
    let around = |text: &str| text.lines().skip(at.saturating_sub(4)).take(12).collect::<Vec<_>>().join("\n");
    assert!(found == wanted, "{what}, line {}:\n{}\n--- wanted\n{}", at + 1, around(found), around(wanted));
}

#[test]
fn the_checked_in_file_is_what_is_written() {
    let (path, text) = (folder().join("generated.rs"), file(&parts()));
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, &text).expect("a file");
        return;
    }
    let wanted = std::fs::read_to_string(&path).expect("BLESS=1 writes it");
    assert_same(&text, &wanted, "BLESS=1 writes it anew");
}

#[test]
fn what_is_compiled_makes_the_same_parts() {
    let mut parts = parts();
    let mut part = |name: &str| parts.remove(parts.iter().position(|(own, _)| own == name).expect("a part")).1;
    for (name, make) in generated::SOLIDS {
        assert_eq!(Part::Solid(make()), part(name), "{name}");
    }
    for (name, make) in generated::PROFILES {
        assert_eq!(Part::Profile(make()), part(name), "{name}");
    }
    for (name, make) in generated::FORMULAS {
        assert_eq!(Part::Solid(make().expect("a formula")), part(name), "{name}");
    }
    assert_eq!(Part::Profile(generated::profile_formula().expect("a formula")), part("profile_formula"));
    assert!(parts.is_empty(), "{parts:?}");
    // To the bit.
    for (name, make) in generated::SOLIDS {
        let example = catalogue().iter().find(|entry| entry.name() == name && !entry.parameters().is_empty());
        let Some(Part::Solid(example)) = example.map(|entry| entry.example()) else { continue };
        for p in [DVec3::ZERO, DVec3::new(0.3, -0.7, 0.2), DVec3::new(5.0, 1.0 / 3.0, -2.0)] {
            let bits = |solid: &Solid| solid.value(p).map(f64::to_bits).ok();
            assert_eq!(bits(&make()), bits(&example), "{name} at {p}");
        }
    }
}

#[test]
fn lines_are_broken_as_rustfmt_does() {
    let text = file(&parts());
    if let Some(wanted) = formatted(&text) {
        assert_same(&text, &wanted, "rustfmt");
    }
}

#[test]
fn comments_names_and_lengths_make_code_to_edit() {
    let hole = Solid::cylinder(6.35, 25.4).named("hole");
    let ring = hole.translate([19.05, 0.0, 0.0]).repeat_polar(5);
    let body = Solid::cuboid([76.2, 76.2, 25.4]).named("body");
    let mut settings = RustSettings::default();
    settings.comments.insert("hole".into(), "hole, ⌀ 12.7, through\n5 of them on a circle".into());
    let mut file = RustFile::new(settings.clone());
    let holder = body.difference_all([ring, hole.rotate_x(deg(90.0))], RFunction::MIN_MAX);
    file.add("Holder!", &holder);
    assert_same(
        &file.to_string(),
        "use rvachev::{RFunction, Solid, deg};

pub fn holder() -> Solid {
    let size = 76.2;
    let height = 25.4;
    let body = Solid::cuboid([size, size, height]).named(\"body\");
    // hole, ⌀ 12.7, through
    // 5 of them on a circle
    let hole = Solid::cylinder(6.35, height).named(\"hole\");
    let holes = hole.translate([19.05, 0.0, 0.0]).repeat_polar(5);
    body.difference_all([holes, hole.rotate_x(deg(90.0))], RFunction::MIN_MAX)
}
",
        "code",
    );
    let mut plain = RustFile::new(RustSettings { lengths: false, ..settings });
    plain.add("Holder!", &holder);
    plain.add("holder", &Solid::sphere(1.0));
    let text = plain.to_string();
    assert!(text.contains("Solid::cylinder(6.35, 25.4)") && text.contains("pub fn holder_2() -> Solid"), "{text}");
}

/// A leaf of a user's own.
#[derive(Debug)]
struct Half;

impl Field for Half {
    fn name(&self) -> &'static str {
        "half"
    }

    fn eval<R: Real>(&self, [_, _, z]: [R; 3]) -> R {
        -z
    }

    fn bounds(&self) -> Bounds {
        Bounds::ALL
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }
}

/// A law of a user's own.
#[derive(Clone, Debug)]
struct Turning;

impl Law for Turning {
    fn at<R: Real>(&self, z: R) -> R {
        z * 0.5
    }
}

#[test]
fn what_has_no_code_becomes_a_parameter() {
    let mesh = Mesh::new(vec![glam::Vec3::ZERO, glam::Vec3::X, glam::Vec3::Y], vec![[0, 1, 2]]).expect("a mesh");
    let mesh = Solid::from_mesh(&mesh, MeshSolid::default());
    let half = Solid::new(Half);
    let bar = Solid::cuboid([1.0, 1.0, 4.0]).twist_by(rad(1.0), Turning);
    let part = (&half & Solid::sphere(2.0)).union(&half, RFunction::MIN_MAX) | bar | mesh.named("scan");
    let text = part.to_rust("part");
    assert_same(
        &text,
        "use rvachev::{RFunction, Solid};

/// `half`: the leaf `half`, which has no code. Give it as a `Solid`.
/// `twist_by`: what is deformed by `twist_by`, which has no code. Give it as a `Solid`.
/// `mesh`: the leaf `mesh`, which has no code. Give it as a `Solid`.
pub fn part(half: &Solid, twist_by: &Solid, mesh: &Solid) -> Solid {
    let intersection = half & Solid::sphere(2.0);
    let union = intersection.union(half, RFunction::MIN_MAX);
    let scan = mesh.named(\"scan\");
    let union_2 = union | twist_by;
    union_2 | scan
}
",
        "code",
    );
    assert!(half.to_rust("half").ends_with("pub fn half(half: &Solid) -> Solid {\n    half.clone()\n}\n"));
}

#[test]
fn long_chains_are_written() {
    let chain = (0..5000).fold(Solid::sphere(1.0), |all, i| all | Solid::sphere(f64::from(i)));
    let moved = (0..5000).fold(chain, |all, _| all.translate([0.0, 0.0, 1.0]));
    let text = moved.to_rust("chain");
    let longest = text.lines().map(str::len).max();
    assert!(text.lines().count() > 5800 && longest <= Some(100), "{} {longest:?}", text.lines().count());
}
