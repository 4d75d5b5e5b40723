//! Meshes as solids: distance and sign against brute force, what is made of them, and what they
//! came from.

mod brute;
mod laws;

use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};

use glam::{DVec3, Vec3};
use rvachev::{
    Blend, Camera, CellSize, ContourSettings, Mesh, MeshSettings, MeshSolid, OpenEdges, Paint, RenderSettings, Run,
    Solid, deg, rad,
};

/// A mesh from corners and numbers.
pub(super) fn mesh(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh::new(positions, triangles).expect("numbers are in range")
}

pub(super) fn solid(mesh: &Mesh) -> Solid {
    Solid::from_mesh(mesh, MeshSolid::default())
}

/// A box of 12 triangles between corners.
pub(super) fn block(min: [f32; 3], max: [f32; 3]) -> Mesh {
    let at = |c: usize| Vec3::from_array([0, 1, 2].map(|axis| if c >> axis & 1 == 1 { max[axis] } else { min[axis] }));
    let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    mesh((0..8).map(at).collect(), quads.into_iter().flat_map(halves).collect())
}

/// Several meshes as one.
pub(super) fn together(parts: &[Mesh]) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for part in parts {
        let first = positions.len() as u32;
        positions.extend_from_slice(part.positions());
        triangles.extend(part.triangles().iter().map(|corners| corners.map(|v| v + first)));
    }
    mesh(positions, triangles)
}

pub(super) fn meshed(solid: &Solid, cells: u32) -> Mesh {
    let settings = MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() };
    solid.mesh(&settings).unwrap_or_else(|error| panic!("{error}"))
}

/// Two blocks side by side, and within each other.
#[test]
fn overlapping_triangles_count_once() {
    let parts =
        [block([0.0; 3], [2.0, 1.0, 1.0]), block([1.0, -0.5, 0.2], [3.0, 0.5, 0.7]), block([0.0; 3], [2.0, 1.0, 1.0])];
    let pile = together(&parts);
    let solid = solid(&pile);
    // 2 + 0.5, without what both have.
    let report = meshed(&solid, 60).check();
    let volume = 2.0 + 2.0 * 0.5 - 0.25;
    assert!((report.volume / volume - 1.0).abs() < 2e-3, "{} for {volume}", report.volume);
    assert!(report.is_sound() && report.shells == 1, "{report}");
    assert_eq!(pile.open_edges(), OpenEdges::default());
}

#[test]
fn offsets_and_shells_have_no_dust() {
    let box_solid = solid(&block([-5.0; 3], [5.0; 3]));
    let shell = meshed(&box_solid.shell(1.0), 40).check();
    assert!(shell.is_sound() && shell.shells == 2, "{shell}");
    assert!((shell.volume / 488.0 - 1.0).abs() < 1e-3, "{}", shell.volume);
    let grown = meshed(&box_solid.offset(1.0), 40).check();
    let pi = std::f64::consts::PI;
    let volume = 1000.0 + 600.0 + 12.0 * 10.0 * pi / 4.0 + 4.0 / 3.0 * pi;
    assert!(grown.is_sound() && (grown.volume / volume - 1.0).abs() < 3e-3, "{} for {volume}", grown.volume);
    let twisted = meshed(&(Solid::cuboid([2.0, 2.0, 4.0]) - Solid::cylinder(0.5, 5.0)).twist(rad(0.3)), 40);
    let shell = meshed(&solid(&twisted).shell(0.1), 60).check();
    assert!(shell.is_sound() && shell.shells == 2, "{shell}");
    let opened = meshed(&solid(&block([-5.0; 3], [5.0; 3])).rounded(2.0), 40).check();
    assert!(opened.shells == 1 && (opened.volume / 907.705 - 1.0).abs() < 3e-3, "{}", opened.volume);
}

/// Turned, it is as large as its corners reach, and not as its box does.
#[test]
fn turned_meshes_stand_where_their_corners_are() {
    let settings = MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() };
    let disc = solid(&Solid::cylinder(20.0, 3.0).mesh(&settings).unwrap());
    for turn in [disc.rotate_z(deg(45.0)), disc.rotate_z(deg(10.0)).translate([0.0, 0.0, 1.0])] {
        let bounds = turn.bounds().unwrap();
        assert!((bounds.max.x - 20.0).abs() < 0.05 && (bounds.min.y + 20.0).abs() < 0.05, "{bounds:?}");
    }
    // It stands on the ground, and not above it.
    let cube = solid(&block([-1.0; 3], [1.0; 3])).rotate_x(deg(45.0)).rotate_y(deg(30.0)).on_ground();
    let lowest = cube.mesh(&settings).unwrap().bounds().min.z;
    assert!(lowest.abs() < 1e-3, "{lowest}");
}

#[test]
fn it_is_a_leaf_like_any_other() {
    let ball = meshed(&Solid::sphere(1.0), 24);
    let imported = solid(&ball);
    let part = (&imported - Solid::cylinder(0.3, 3.0)).translate([4.0, 0.0, 0.0]);
    let own = (Solid::sphere(1.0) - Solid::cylinder(0.3, 3.0)).translate([4.0, 0.0, 0.0]);
    for solid in [&part, &part.twist(rad(0.4)), &(imported.scale(2.0) & Solid::cuboid([3.0, 3.0, 3.0]))] {
        let report = meshed(solid, 30).check();
        assert!(report.is_sound(), "{report}");
    }
    let volumes = [&part, &own].map(|solid| meshed(solid, 40).volume());
    assert!((volumes[0] / volumes[1] - 1.0).abs() < 0.02, "{volumes:?}");
    let filleted = imported.union_with(Solid::cuboid([3.0, 3.0, 0.5]), Blend::Fillet { radius: 0.2 });
    assert!(meshed(&filleted, 40).check().is_sound());
    let near = imported.closest_surface_point([2.0, 0.0, 0.0]).unwrap().expect("there is a surface");
    assert!((near - DVec3::X).length() < 0.02, "{near}");
    assert!(imported.to_string().contains("mesh"), "{imported}");
    let settings = RenderSettings { width: 24, height: 24, ..RenderSettings::default() };
    let camera = Camera::framing(&imported.bounds().unwrap());
    let picture = imported.render(&camera, &settings).unwrap();
    let pixels = picture.pixels();
    assert_ne!(pixels[0], pixels[12 * 24 + 12]);
}

#[test]
fn solids_are_equal_by_content() {
    let a = solid(&block([0.0; 3], [1.0; 3]));
    let b = solid(&block([0.0; 3], [1.0; 3]));
    let c = solid(&block([0.0; 3], [1.0, 1.0, 1.5]));
    assert_eq!(a, b);
    assert_ne!(a, c);
    let hash = |solid: &Solid| {
        let mut hasher = DefaultHasher::new();
        solid.hash(&mut hasher);
        hasher.finish()
    };
    assert_eq!(hash(&a), hash(&b));
    assert_ne!(hash(&a), hash(&c));
    let red = block([0.0; 3], [1.0; 3]).with_corner_colors(vec![[[255, 0, 0, 255]; 3]; 12]).unwrap();
    assert_ne!(solid(&red), a);
    assert_eq!(Solid::from_mesh(&red, MeshSolid { colors: false, ..MeshSolid::default() }), a);
}

#[test]
fn meshes_without_triangles_are_errors() {
    let error = solid(&Mesh::default()).contains([0.0; 3]).unwrap_err();
    assert_eq!(error.to_string(), "mesh: triangles is 0, allowed: 1 or more");
    let error = (Solid::sphere(1.0) | solid(&mesh(vec![Vec3::X], vec![]))).mesh(&MeshSettings::default()).unwrap_err();
    assert!(error.to_string().starts_with("union[1] / mesh: triangles is 0"), "{error}");
}

#[test]
fn meshes_of_any_kind_are_taken() {
    // A single triangle, and triangles without area: nothing is inside.
    let single = mesh(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]);
    let thread = mesh(vec![Vec3::ZERO, Vec3::X, 2.0 * Vec3::X], vec![[0, 1, 2], [0, 0, 1], [2, 1, 0]]);
    let point = mesh(vec![Vec3::ONE], vec![[0, 0, 0]]);
    for mesh in [single.flipped(), single, thread, point] {
        let solid = solid(&mesh);
        for p in [[0.3, 0.3, 0.3], [1.0, 1.0, 1.0], [0.3, 0.3, -1e-3], [0.3, 0.0, 0.0]] {
            assert!(!solid.contains(p).unwrap() && solid.value(p).unwrap().is_finite());
        }
        // What has no size has no cells.
        if mesh.bounds().longest_side() > 0.0 {
            assert_eq!(meshed(&solid, 12).triangles().len(), 0);
        }
    }
    // However large or small.
    for size in [1e-6, 1e6, 1e12] {
        let solid = solid(&block([-size; 3], [size; 3]));
        let value = solid.value([0.0, 0.0, f64::from(size) * 0.5]).unwrap();
        assert!(value > 0.0 && value.is_finite(), "{value} of {size}");
    }
}

#[test]
fn meshes_that_are_inside_out_or_too_large_say_so() {
    let error = |mesh: &Mesh| solid(mesh).mesh(&MeshSettings::default()).unwrap_err().to_string();
    let wanted = "allowed: above 0; the mesh is inside out, Mesh::flipped turns it";
    let turned = block([0.0; 3], [2.0; 3]).flipped();
    assert_eq!(error(&turned), format!("mesh: volume is -8, {wanted}"));
    assert!((meshed(&solid(&turned.flipped()), 16).volume() - 8.0).abs() < 1e-3);
    let open = bowl(0.7).flipped();
    assert!(error(&open).ends_with(wanted), "{}", error(&open));
    assert!(solid(&open.flipped()).contains([0.0, 0.0, -0.8]).unwrap());
    // A cavity is turned over as it should be, and so is what is left of one part of two.
    let hollow = together(&[block([0.0; 3], [3.0; 3]), block([1.0; 3], [2.0; 3]).flipped()]);
    assert!(solid(&hollow).contains([0.5; 3]).unwrap() && !solid(&hollow).contains([1.5; 3]).unwrap());
    assert!(error(&hollow.flipped()).ends_with(wanted));
    let half = together(&[block([0.0; 3], [3.0; 3]).flipped(), block([5.0; 3], [6.0; 3])]);
    assert!(solid(&half).contains([5.5; 3]).unwrap() && !solid(&half).contains([1.5; 3]).unwrap());
    // In metres of a galaxy.
    let far = error(&block([-1e30; 3], [1e30; 3]));
    assert!(far.starts_with("mesh: coordinate is -1000000015047466"), "{far}");
    assert!(far.ends_with("allowed: -1e12 to 1e12; scale the mesh"), "{far}");
    assert!(error(&block([-3e38; 3], [3e38; 3])).ends_with("allowed: -1e12 to 1e12; scale the mesh"));
}

/// Right above a large face, squares of a slice are large all the same.
#[test]
fn slices_close_to_a_face_are_quick() {
    let settings = ContourSettings { tolerance: 0.05, ..ContourSettings::default() };
    let plate = together(&[block([-40.0, -30.0, 0.0], [40.0, 30.0, 5.0]), block([-5.0, -5.0, 0.0], [5.0, 5.0, 9.0])]);
    let openings = mesh(plate.positions().to_vec(), plate.triangles()[..23].to_vec());
    for (plate, above) in [(&plate, [0.01, 1e-3, 1e-4]), (&openings, [0.02, 0.01, 3e-3])] {
        let heights = above.map(|above| 5.0 + above);
        let found = solid(plate).slices(&heights, &settings, &Run::default()).unwrap();
        for contours in &found {
            assert!(contours.len() == 1 && (contours.area() - 100.0).abs() < 1.0, "{}", contours.area());
        }
    }
}

/// A ball with an opening in each of some hundred places.
#[test]
fn many_small_openings_let_little_out() {
    let ball = meshed(&Solid::sphere(10.0), 40);
    let kept = (0..).zip(ball.triangles()).filter(|(n, _)| n % 23 != 0).map(|(_, triangle)| *triangle);
    let sieve = mesh(ball.positions().to_vec(), kept.collect());
    assert!(sieve.open_edges().edges > 500);
    let solid = solid(&sieve);
    let size = solid.bounds().unwrap().size();
    assert!(size.max_element() < 1.05 * ball.bounds().size().max_element(), "{size}");
    assert!(solid.contains([0.0, 0.0, 9.0]).unwrap() && !solid.contains([0.0, 0.0, 10.3]).unwrap());
}

#[test]
fn colors_are_kept() {
    let block = block([-1.0; 3], [1.0; 3]);
    let middle = |t: &[u32; 3]| t.iter().map(|v| block.positions()[*v as usize]).sum::<Vec3>() / 3.0;
    let color = |p: Vec3| if p.x > 0.5 { [200, 0, 0, 255] } else { [0, 0, 200, 255] };
    let colors = block.triangles().iter().map(|t| [color(middle(t)); 3]).collect();
    let solid = solid(&block.clone().with_corner_colors(colors).unwrap()) - Solid::sphere(0.8).paint([0, 200, 0]);
    let mesh = meshed(&solid, 16);
    let mesh = mesh.painted(&solid, Paint::default()).unwrap();
    let found = mesh.corner_colors().unwrap();
    for (t, corners) in mesh.triangles().iter().zip(found) {
        let middle = t.iter().map(|v| mesh.positions()[*v as usize]).sum::<Vec3>() / 3.0;
        if middle.abs().max_element() > 0.95 && middle.abs().min_element() < 0.85 {
            let [r, g, b, a] = color(middle + 0.45 * Vec3::X * f32::from(middle.x < 0.95) * -1.0);
            let expected = if middle.x > 0.95 { [200, 0, 0, 255] } else { [r, g, b, a] };
            let all = corners.iter().all(|corner| *corner == expected);
            assert!(all || middle.x.abs() > 0.9, "{corners:?} at {middle}");
        }
    }
    let count = |color: [u8; 4]| found.iter().flatten().filter(|corner| **corner == color).count();
    assert!(count([200, 0, 0, 255]) > 50 && count([0, 0, 200, 255]) > 250);
    assert_eq!(solid.palette().unwrap().at(0, [1.0, 0.2, 0.1]), Some(Paint::from([200, 0, 0])));
    // What is painted is painted.
    let painted = solid.paint([1, 2, 3]);
    assert_eq!(painted.palette().unwrap().at(0, [1.0, 0.2, 0.1]), Some(Paint::from([1, 2, 3])));
}

/// Owners of a mesh are told apart in the solid, through joins and in meshes of it.
#[test]
fn owners_are_kept() {
    let part = Solid::cuboid([2.0, 2.0, 2.0]) - Solid::cylinder(0.5, 3.0);
    let settings = MeshSettings { cell: CellSize::LongestSide(16), owners: true, ..MeshSettings::default() };
    let mesh = part.mesh(&settings).unwrap();
    let bore = part.owner([0.5, 0.0, 0.2]).unwrap().index;
    let numbers: Vec<u32> = mesh.owners().unwrap().iter().map(|owner| 7 + 10 * u32::from(*owner == bore)).collect();
    let mesh = mesh.with_owners(numbers).unwrap();
    let joined = solid(&mesh).rotate_z(rad(0.3)) | Solid::sphere(0.5).translate([0.0, 0.0, 3.0]);
    let [outer, inner, ball] = [[1.0, 0.6, 0.3], [0.5, 0.0, 0.2], [0.0, 0.0, 3.5]].map(|p| {
        let p = glam::DQuat::from_rotation_z(0.3) * DVec3::from_array(p);
        joined.owner(p).unwrap()
    });
    assert!(outer.path.ends_with("mesh[7]") && inner.path.ends_with("mesh[17]"), "{} {}", outer.path, inner.path);
    assert!(ball.path.ends_with("sphere") && outer.index != inner.index && outer.index != ball.index);
    let again = joined.mesh(&settings).unwrap();
    let mut count = [0; 3];
    for (t, owner) in again.triangles().iter().zip(again.owners().unwrap()) {
        let middle = t.iter().map(|v| again.positions()[*v as usize]).sum::<Vec3>() / 3.0;
        let is = [outer.index, inner.index, ball.index].iter().position(|index| index == owner).expect("one of three");
        count[is] += 1;
        let expected = match middle.truncate().length() {
            _ if middle.z > 2.0 => Some(2),
            far if far < 0.51 && middle.z.abs() < 0.9 => Some(1),
            far => (far > 0.52).then_some(0),
        };
        assert!(expected.is_none_or(|expected| is == expected), "{is} at {middle}");
    }
    assert!(count.iter().all(|count| *count > 20), "{count:?}");
    // Paint of a part is that of all its owners.
    let painted = joined.paint([1, 2, 3]);
    let index = painted.owner(glam::DQuat::from_rotation_z(0.3) * DVec3::new(0.5, 0.0, 0.2)).unwrap().index;
    assert_eq!(painted.palette().unwrap().of(index), Some(Paint::from([1, 2, 3])));
    // They are content, and may be left out.
    let without = Solid::from_mesh(&mesh, MeshSolid { owners: false, ..MeshSolid::default() });
    assert_ne!(solid(&mesh), without);
    assert_eq!(without.owner([0.5, 0.0, 0.2]).unwrap().path, "mesh");
}

/// However many owners there are, in more than one mesh.
#[test]
fn thousands_of_owners_are_told_apart() {
    let ball = meshed(&Solid::sphere(1.0), 32);
    let count = ball.triangles().len() as u32;
    assert!(count > 3000);
    let numbered = ball.with_owners((0..count).collect()).unwrap();
    let imported = solid(&numbered);
    let part = Solid::sphere(0.5).translate([3.0, 0.0, 0.0]) | &imported | imported.translate([6.0, 0.0, 0.0]);
    let mut seen = HashSet::new();
    for n in (0..count).step_by(97).chain([count - 1]) {
        let corners = numbered.triangles()[n as usize].map(|v| numbered.positions()[v as usize].as_dvec3());
        for along in [0.0, 6.0] {
            let owner = part.owner(corners.iter().sum::<DVec3>() / 3.0 + along * DVec3::X).unwrap();
            assert!(owner.path.ends_with(&format!("mesh[{n}]")), "{} of {n}", owner.path);
            assert!(seen.insert(owner.index), "{} of {n} is another's", owner.index);
        }
    }
    assert!(part.owner([3.0, 0.0, 0.5]).unwrap().path.ends_with("sphere"));
}

/// A ball without its top.
fn bowl(cut: f32) -> Mesh {
    let ball = meshed(&Solid::sphere(1.0), 16);
    let below = |t: &&[u32; 3]| t.iter().all(|v| ball.positions()[*v as usize].z < cut);
    mesh(ball.positions().to_vec(), ball.triangles().iter().filter(below).copied().collect())
}

#[test]
fn open_meshes_are_closed_by_a_film() {
    for cut in [0.0, 0.7] {
        let bowl = bowl(cut);
        let open_edges = bowl.open_edges();
        let around = 2.0 * std::f64::consts::PI * f64::from(1.0 - cut * cut).sqrt();
        assert!(!open_edges.is_closed() && (open_edges.length / around - 1.0).abs() < 0.4, "{open_edges:?}");
        let solid = solid(&bowl);
        assert!(solid.contains([0.0, 0.0, -0.8]).unwrap() && !solid.contains([0.0, 0.0, 1.5]).unwrap());
        let mesh = meshed(&solid, 16);
        let report = mesh.check();
        assert!(report.is_closed() && report.shells == 1, "{cut}: {report}");
        // More than half a ball less a cap, and less than the whole one.
        assert!(report.volume > 0.7 && report.volume < 4.3, "{}", report.volume);
        assert!(solid.bounds().unwrap().contains_bounds(&mesh.bounds()));
    }
}
