//! The checker of meshes, itself checked: by constructed defects of each kind, and by random
//! triangles against whole-number arithmetic.

use std::sync::{Arc, Mutex};

use glam::{DQuat, DVec3, EulerRot, Vec3};
use rvachev::{
    CancelToken, Cancelled, CellSize, Mesh, MeshReport, MeshSettings, MinimalSurface, Progress, Run, SheetLattice,
    Solid,
};

const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn tetrahedron(at: Vec3, size: f32) -> Mesh {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|p| at + size * p);
    Mesh::new(corners.into(), TETRAHEDRON.into()).unwrap()
}

/// Several meshes as one.
fn together(parts: &[Mesh]) -> Mesh {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for part in parts {
        let first = positions.len() as u32;
        positions.extend_from_slice(part.positions());
        triangles.extend(part.triangles().iter().map(|t| t.map(|i| i + first)));
    }
    Mesh::new(positions, triangles).unwrap()
}

fn moved(mesh: &Mesh, by: impl Fn(DVec3) -> DVec3) -> Mesh {
    let positions = mesh.positions().iter().map(|p| by(p.as_dvec3()).as_vec3()).collect();
    Mesh::new(positions, mesh.triangles().to_vec()).unwrap()
}

fn check(positions: &[Vec3], triangles: &[[u32; 3]]) -> MeshReport {
    Mesh::new(positions.to_vec(), triangles.to_vec()).unwrap().check()
}

/// A cube of n × n squares a side, each of two triangles.
fn cube(n: u32) -> Mesh {
    let mut places = std::collections::HashMap::new();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for (axis, side) in [(0, 0), (0, n), (1, 0), (1, n), (2, 0), (2, n)] {
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut vertex = |i: u32, j: u32| {
                let mut place = [0; 3];
                place[axis] = side;
                place[(axis + 1) % 3] = i;
                place[(axis + 2) % 3] = j;
                *places.entry(place).or_insert_with(|| {
                    positions.push(Vec3::from_array(place.map(|x| x as f32 / n as f32)));
                    positions.len() as u32 - 1
                })
            };
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            let [b, d] = if side == 0 { [d, b] } else { [b, d] };
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Mesh::new(positions, triangles).unwrap()
}

#[test]
fn sound_meshes_are_sound_wherever_they_are() {
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.7, 1.1);
    for shift in [0.0, 1e3, 1e4] {
        let mesh = moved(&cube(20), |p| turn * p + shift);
        let report = mesh.check();
        assert!(report.is_sound(), "{report}");
        assert_eq!((report.genus, report.euler_characteristic, report.shells), (Some(0), 2, 1));
        // Nothing is said of a mesh that was not extracted.
        assert!(mesh.possibly_lost() == 0 && mesh.warnings().is_empty() && mesh.thin_features().is_none());
    }
    // Tiny and huge ones: no underflow, no overflow.
    for scale in [1e-30, 1e30] {
        let report = moved(&cube(4), |p| p * scale).check();
        assert_eq!((report.self_intersections, report.degenerate_triangles), (0, 0), "{scale}");
    }
}

#[test]
fn an_edge_through_a_face() {
    let big = tetrahedron(Vec3::ZERO, 4.0);
    let apart = together(&[big.clone(), tetrahedron(Vec3::splat(4.0), 1.0)]).check();
    assert_eq!((apart.self_intersections, apart.shells), (0, 2));
    assert!(apart.is_sound());
    let inside = together(&[big.clone(), tetrahedron(Vec3::splat(0.1), 0.5)]).check();
    assert_eq!(inside.self_intersections, 0, "a shell within another does not touch it");
    // A corner sticks out through one face: its three faces cross that face.
    let out = together(&[big, tetrahedron(Vec3::new(0.5, 0.5, -0.25), 0.5)]).check();
    assert_eq!(out.self_intersections, 3);
    assert_eq!(out.intersecting_pairs, [[0, 5], [0, 6], [0, 7]]);
    assert!(out.is_manifold() && out.is_closed() && !out.is_sound());
    let far = |p: DVec3| p + DVec3::new(65536.0, -32768.0, 1024.0);
    let out = together(&[tetrahedron(Vec3::ZERO, 4.0), tetrahedron(Vec3::new(0.5, 0.5, -0.25), 0.5)]);
    assert_eq!(moved(&out, far).check().self_intersections, 3);
}

#[test]
fn touching_counts() {
    let big = tetrahedron(Vec3::ZERO, 4.0);
    // The corner of another one exactly on a face, and one bit of f32 clear of it.
    let below = |z: f32| moved(&tetrahedron(Vec3::ZERO, 0.5), |p| DVec3::new(1.0 + p.x, 1.0 - p.y, f64::from(z) - p.z));
    assert_eq!(
        together(&[big.clone(), below(0.0)]).check().self_intersections,
        4,
        "three corners of a face and itself"
    );
    assert_eq!(together(&[big.clone(), below(-f32::MIN_POSITIVE)]).check().self_intersections, 0);
    let tip = |z: f32| {
        let corners = [[1.0, 1.0, z], [1.5, 1.0, z - 1.0], [1.0, 1.5, z - 1.0], [0.5, 0.5, z - 1.0]];
        Mesh::new(corners.map(Vec3::from).into(), TETRAHEDRON.into()).unwrap()
    };
    assert_eq!(together(&[big.clone(), tip(0.0)]).check().self_intersections, 3, "at a vertex");
    assert_eq!(together(&[big.clone(), tip(-1e-30)]).check().self_intersections, 0);
    // Two vertices at the same place: every triangle there meets every one of the others.
    let twice = together(&[big.clone(), moved(&big, |p| -p)]).check();
    assert_eq!((twice.self_intersections, twice.duplicate_vertices), (9, 1));
}

#[test]
fn coplanar_overlap() {
    let square = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]];
    let plane = |points: [[f32; 2]; 3], turn: &DQuat| points.map(|[x, y]| turn.as_quat() * Vec3::new(x, y, 0.0));
    let cases = [
        ([[0.5, 0.5], [3.0, 0.5], [0.5, 3.0]], 1, "corners inside"),
        ([[0.25, 0.25], [0.5, 0.25], [0.25, 0.5]], 1, "one within the other"),
        ([[-1.0, 0.5], [3.0, 0.5], [3.0, 0.75]], 1, "sides cross"),
        ([[2.0, 0.0], [3.0, 0.0], [3.0, 1.0]], 1, "touching at a corner"),
        ([[1.0, 1.0], [3.0, 1.0], [3.0, 3.0]], 1, "a corner on a side"),
        ([[0.5, 0.0], [1.5, 0.0], [1.0, -1.0]], 1, "along a part of a side"),
        ([[1.5, 1.5], [3.0, 1.5], [1.5, 3.0]], 0, "apart though their boxes overlap"),
        ([[3.0, 0.0], [5.0, 0.0], [3.0, 2.0]], 0, "apart"),
    ];
    for axis in [DQuat::IDENTITY, DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2)] {
        for (other, expected, what) in cases {
            let positions = [plane(square, &axis), plane(other, &axis)].concat();
            for triangles in [[[0, 1, 2], [3, 4, 5]], [[0, 1, 2], [3, 5, 4]]] {
                let report = check(&positions, &triangles);
                assert_eq!(report.self_intersections, expected, "{what}");
            }
        }
    }
}

#[test]
fn folded_along_a_shared_edge() {
    let corners = |d: Vec3| [Vec3::ZERO, Vec3::X, Vec3::new(0.3, 1.0, 0.0), d];
    let triangles = [[0, 1, 2], [1, 0, 3]];
    let crossing = |d: [f32; 3]| check(&corners(d.into()), &triangles).self_intersections;
    assert_eq!(crossing([0.5, -1.0, 0.0]), 0, "flat, side by side");
    assert_eq!(crossing([0.5, 1.0, 1.0]), 0, "bent");
    assert_eq!(crossing([0.5, 1.0, 1e-30]), 0, "all but folded");
    assert_eq!(crossing([0.5, 1.0, 0.0]), 1, "folded onto one another");
    assert_eq!(crossing([0.4, 0.2, 0.0]), 1, "one within the other");
    let report = check(&corners(Vec3::Z), &[[0, 1, 2], [2, 1, 0]]);
    assert_eq!((report.duplicate_triangles, report.self_intersections), (1, 1));
    let report = check(&corners(Vec3::Z), &[[0, 1, 2], [1, 2, 0], [0, 1, 2]]);
    assert_eq!((report.duplicate_triangles, report.self_intersections), (2, 3));
}

#[test]
fn crossing_at_a_shared_vertex() {
    let first = [Vec3::ZERO, Vec3::new(2.0, -1.0, 0.0), Vec3::new(2.0, 1.0, 0.0)];
    let crossing = |c: [f32; 3], d: [f32; 3]| {
        let positions = [&first[..], &[c.into(), d.into()]].concat();
        check(&positions, &[[0, 1, 2], [0, 3, 4]]).self_intersections
    };
    assert_eq!(crossing([1.0, 0.0, -1.0], [1.0, 0.0, 1.0]), 1, "short, upright, through it");
    assert_eq!(crossing([4.0, 0.0, -1.0], [4.0, 0.0, 1.0]), 1, "long, upright, through it");
    assert_eq!(crossing([-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0]), 0, "upright, on the other side");
    assert_eq!(crossing([1.0, 2.0, -1.0], [1.0, 2.0, 1.0]), 0, "upright, beside it");
    assert_eq!(crossing([1.0, 0.0, 0.0], [1.0, 0.0, 1.0]), 1, "with a side in it");
    assert_eq!(crossing([1.0, 0.0, 1.0], [1.0, 1.0, 1.0]), 0, "above");
    assert_eq!(crossing([-1.0, 0.0, 0.0], [-1.0, 1.0, 0.0]), 0, "coplanar, apart");
    assert_eq!(crossing([1.0, 0.0, 0.0], [0.0, 3.0, 0.0]), 1, "coplanar, overlapping");
    assert_eq!(crossing([1.0, 0.25, 0.0], [1.0, -0.25, 0.0]), 1, "coplanar, within");
    assert_eq!(crossing([4.0, 2.0, 0.0], [0.0, 3.0, 0.0]), 1, "along a part of a side");
}

/// A fan of n triangles about the origin, its rim at the given angles and heights.
fn fan(n: u32, rim: impl Fn(f64) -> DVec3) -> Mesh {
    let mut positions = vec![Vec3::ZERO];
    positions.extend((0..n).map(|i| rim(f64::from(i) / f64::from(n)).as_vec3()));
    Mesh::new(positions, (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect()).unwrap()
}

#[test]
fn fans_that_go_round_twice() {
    use std::f64::consts::TAU;
    // Rounded, so that a whole turn ends where it began.
    let round = |x: f64| (x * 1048576.0).round() / 1048576.0;
    let around = |turns: f64, s: f64, z: f64| {
        let angle = TAU * turns * s;
        DVec3::new(round(angle.cos()), round(angle.sin()), z)
    };
    for n in [3, 6, 7, 40] {
        assert_eq!(fan(n, |s| around(1.0, s, 0.0)).check().self_intersections, 0);
        assert_eq!(fan(n, |s| around(1.0, s, 0.3 * (2.0 * TAU * s).sin())).check().self_intersections, 0, "a saddle");
        assert_eq!(fan(n, |s| around(1.0, s, 30.0)).check().self_intersections, 0, "a spike");
    }
    for n in [7, 9, 41] {
        assert!(fan(n, |s| around(2.0, s, 0.0)).check().self_intersections > 0, "flat, twice round");
        assert!(fan(n, |s| around(2.0, s, 0.1 * (TAU * s).sin())).check().self_intersections > 0, "twice round");
    }
    // A path of less than a turn, of just one, of more: the last triangle is left out.
    let open = |turns: f64| {
        let ring = fan(9, |s| around(turns * 9.0 / 8.0, s, 0.0));
        let triangles = ring.triangles()[..8].to_vec();
        Mesh::new(ring.positions().to_vec(), triangles).unwrap().check()
    };
    assert_eq!(open(0.95).self_intersections, 0);
    assert!(open(1.0).self_intersections >= 1, "meeting where it began, in another vertex");
    assert!(open(1.1).self_intersections >= 1);
    assert_eq!((open(0.95).non_manifold_vertices, open(0.95).boundary_edges), (0, 10));
}

#[test]
fn incidence_defects_are_counted() {
    let at = |c: [f32; 3]| Vec3::from(c);
    let book = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 0.1, 0.0], [0.0, 1.0, 0.0]].map(at);
    let report = check(&book, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
    assert_eq!((report.non_manifold_edges, report.boundary_edges), (1, 6));
    assert_eq!((report.non_manifold_vertices, report.shells, report.self_intersections), (2, 1, 0));
    // Four pages, of which two pairs could be told apart by their directions.
    let report = check(&[&book[..], &[-Vec3::Y]].concat(), &[[0, 1, 2], [1, 0, 3], [0, 1, 4], [1, 0, 5]]);
    assert_eq!((report.non_manifold_edges, report.shells), (1, 1));
    let report = check(&book, &[[0, 1, 2], [0, 1, 3]]);
    assert_eq!((report.non_manifold_edges, report.shells), (1, 1), "in the same direction");
    // Two fans at a vertex, on both sides of a plane.
    let positions = [&book[..], &[at([2.0, 2.0, 2.0])]].concat();
    let report = check(&positions, &[[0, 1, 2], [0, 4, 3]]);
    assert_eq!((report.non_manifold_vertices, report.non_manifold_edges), (1, 0));
    assert_eq!((report.shells, report.unused_vertices, report.self_intersections), (2, 1, 0));
    // A ring and a path that begins in it.
    let cone = fan(5, |s| DVec3::new((s * 6.3).cos(), (s * 6.3).sin(), 1.0));
    let positions = [cone.positions(), &[Vec3::new(1.0, 0.0, -3.0), Vec3::new(0.0, 1.0, -3.0)]].concat();
    let report = check(&positions, &[cone.triangles(), &[[0, 6, 7]]].concat());
    assert_eq!((report.non_manifold_vertices, report.self_intersections), (1, 0));
}

#[test]
fn degenerates_and_repeats() {
    let line = [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [1.0, 0.0, 0.0]].map(Vec3::from);
    let report = check(&line, &[[0, 1, 2], [0, 1, 1], [0, 1, 3]]);
    assert_eq!((report.degenerate_triangles, report.repeated_indices), (2, 1));
    assert_eq!(report.self_intersections, 0, "the thin ones take no part");
    // One part in 2²³ off the line: no f32 triangle is too thin to tell.
    let mut bent = line;
    bent[2].z = f32::from_bits(bent[2].z.to_bits() + 1);
    assert_eq!(check(&bent, &[[0, 1, 2]]).degenerate_triangles, 0);
    let long = [[1e30, 1.0, 0.0], [0.0, 1.0, 0.0], [-1e30, 1.0, 1e-30]].map(Vec3::from);
    assert_eq!(check(&long, &[[0, 1, 2]]).degenerate_triangles, 0);
}

#[test]
fn the_list_of_pairs_is_short_and_in_order() {
    let stack: Vec<Mesh> = (0..40).map(|i| tetrahedron(Vec3::splat(0.01 * i as f32), 1.0)).collect();
    let report = together(&stack).check();
    assert!(report.self_intersections > 1000);
    assert_eq!(report.intersecting_pairs.len(), 16);
    assert!(report.intersecting_pairs.is_sorted() && report.intersecting_pairs.iter().all(|[a, b]| a < b));
    let text = report.to_string();
    assert!(text.contains("closed, manifold, with self-intersections"), "{text}");
    assert!(text.contains(&format!("{} pairs of triangles that intersect", report.self_intersections)), "{text}");
}

#[test]
fn threads_do_not_change_the_report() {
    let stack: Vec<Mesh> = (0..9).map(|i| moved(&cube(12), |p| p + 0.11 * f64::from(i))).collect();
    let mesh = together(&stack);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| mesh.check())
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn checking_tells_how_far_it_is_and_can_be_cancelled() {
    let gyroid = SheetLattice { surface: MinimalSurface::Gyroid, cell: 0.5, thickness: 0.05 };
    let ball = Solid::new(gyroid) & Solid::sphere(1.0);
    let mesh = ball.mesh(&MeshSettings { cell: CellSize::LongestSide(96), ..MeshSettings::default() }).unwrap();
    let report = mesh.check();
    assert!(report.is_sound());
    for threads in [1, 2] {
        let told = Arc::new(Mutex::new(Vec::new()));
        let sink = told.clone();
        let progress = Some(Progress::new(move |fraction| sink.lock().unwrap().push(fraction)));
        assert_eq!(mesh.check_with(&Run { threads, progress, ..Run::default() }), Ok(report.clone()));
        let told = told.lock().unwrap();
        assert!(told.is_sorted() && told.last() == Some(&1.0));
        assert!(told.len() > 50 && told.windows(2).all(|two| two[1] - two[0] < 0.2), "{told:?}");
    }
    for at in [0.0, 0.05, 0.2, 0.4, 0.6, 0.8, 0.99] {
        let cancel = CancelToken::new();
        let token = cancel.clone();
        let progress = move |fraction| {
            if fraction >= at {
                token.cancel()
            }
        };
        let run = Run { cancel, progress: Some(Progress::new(progress)), ..Run::default() };
        assert_eq!(mesh.check_with(&run), Err(Cancelled), "at {at}");
        assert_eq!(mesh.check(), report);
    }
    assert_eq!(Mesh::default().check(), MeshReport::default());
}

/// Exact intersection of triangles with whole-number corners, by separating directions.
mod whole {
    pub type P = [i128; 3];

    fn minus(a: P, b: P) -> P {
        [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
    }

    fn cross(a: P, b: P) -> P {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    }

    fn dot(a: P, b: P) -> i128 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    fn separates(direction: P, a: &[P], b: &[P]) -> bool {
        let range = |points: &[P]| {
            let along = points.iter().map(|&p| dot(direction, p));
            (along.clone().min().unwrap(), along.max().unwrap())
        };
        let ((a_low, a_high), (b_low, b_high)) = (range(a), range(b));
        a_high < b_low || b_high < a_low
    }

    fn sides(points: &[P]) -> Vec<P> {
        let n = points.len();
        (0..n).map(|i| minus(points[(i + 1) % n], points[i])).collect()
    }

    /// Whether two triangles or segments meet: no face of their Minkowski difference has the
    /// origin beyond it.
    pub fn meet(a: &[P], b: &[P]) -> bool {
        let (s, t) = (sides(a), sides(b));
        let mut directions: Vec<P> = s.iter().flat_map(|&s| t.iter().map(move |&t| cross(s, t))).collect();
        for of in [&s, &t] {
            let normal = cross(of[0], of[1]);
            directions.push(normal);
            directions.extend(s.iter().chain(&t).map(|&side| cross(normal, side)));
        }
        !directions.into_iter().any(|d| separates(d, a, b))
    }

    pub fn is_degenerate(t: [P; 3]) -> bool {
        cross(minus(t[1], t[0]), minus(t[2], t[0])) == [0; 3]
    }

    /// Whether triangles of a mesh meet in more than what they share.
    pub fn crosses(at: &[P], s: [u32; 3], t: [u32; 3]) -> bool {
        let of = |t: [u32; 3]| t.map(|i| at[i as usize]);
        let rest = |of: [u32; 3], besides: [u32; 3]| -> Vec<P> {
            of.into_iter().filter(|v| !besides.contains(v)).map(|i| at[i as usize]).collect()
        };
        let (own, other) = (rest(s, t), rest(t, s));
        match own.len() {
            3 => meet(&of(s), &of(t)),
            2 => meet(&own, &of(t)) || meet(&other, &of(s)),
            1 => {
                let shared: Vec<P> = s.into_iter().filter(|v| t.contains(v)).map(|i| at[i as usize]).collect();
                let side = minus(shared[1], shared[0]);
                let (n, m) = (cross(side, minus(own[0], shared[0])), cross(side, minus(other[0], shared[0])));
                cross(n, m) == [0; 3] && dot(n, m) > 0
            }
            _ => true,
        }
    }
}

/// A sequence of random numbers, the same every time.
struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) % n
    }
}

/// Random triangles over random vertices with whole coordinates of `bits` bits, times `unit`.
fn soup(
    random: &mut Random,
    vertices: u64,
    triangles: usize,
    bits: u32,
    plane: bool,
) -> (Vec<whole::P>, Vec<[u32; 3]>) {
    let mut coordinate = |thin: bool| if thin { 0 } else { i128::from(random.below(1 << bits)) - (1 << (bits - 1)) };
    let at: Vec<whole::P> = (0..vertices).map(|_| [coordinate(false), coordinate(false), coordinate(plane)]).collect();
    let mut corner = || random.below(vertices) as u32;
    let triangles = (0..triangles).map(|_| [corner(), corner(), corner()]).collect();
    (at, triangles)
}

fn agrees(at: &[whole::P], triangles: &[[u32; 3]], unit: f32) -> usize {
    let positions: Vec<Vec3> = at.iter().map(|p| Vec3::from_array(p.map(|x| x as f32)) * unit).collect();
    let report = check(&positions, triangles);
    let is_thin = |t: [u32; 3]| whole::is_degenerate(t.map(|i| at[i as usize]));
    let thin = triangles.iter().filter(|&&t| is_thin(t)).count();
    assert_eq!(report.degenerate_triangles, thin);
    let mut pairs = Vec::new();
    for (i, &s) in triangles.iter().enumerate().filter(|(_, s)| !is_thin(**s)) {
        for (j, &t) in triangles.iter().enumerate().skip(i + 1).filter(|(_, t)| !is_thin(**t)) {
            if whole::crosses(at, s, t) {
                pairs.push([i as u32, j as u32]);
            }
        }
    }
    let listed = &pairs[..pairs.len().min(16)];
    assert_eq!(
        (report.self_intersections, &report.intersecting_pairs[..]),
        (pairs.len(), listed),
        "{at:?} {triangles:?}"
    );
    pairs.len()
}

#[test]
fn random_triangles_agree_with_whole_number_arithmetic() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (mut meeting, mut free) = (0, 0);
    for round in 0..3000u32 {
        // Coarse coordinates give every coincidence, fine ones every rounding.
        let bits = [2, 3, 4, 8, 16, 24][round as usize % 6];
        let vertices = 4 + random.below(12);
        let count = 2 + random.below(10) as usize;
        let (at, triangles) = soup(&mut random, vertices, count, bits, round % 7 == 0);
        let unit = [1.0, 1.0 / 1024.0, 1e-20_f32.log2().round().exp2()][round as usize % 3];
        let found = agrees(&at, &triangles, unit);
        meeting += found;
        free += count * (count - 1) / 2 - found;
    }
    assert!(meeting > 1000 && free > 1000, "{meeting} {free}");
}

#[test]
fn closed_meshes_with_displaced_vertices_agree_with_whole_number_arithmetic() {
    let mut random = Random(77);
    let mesh = cube(3);
    let mut sound = 0;
    for round in 0..60 {
        let reach = [1, 200, 400, 800][round % 4];
        let at: Vec<whole::P> = mesh
            .positions()
            .iter()
            .map(|p| p.to_array().map(|x| i128::from((x * 900.0).round() as i32) + i128::from(random.below(reach))))
            .collect();
        sound += usize::from(agrees(&at, mesh.triangles(), 0.125) == 0);
    }
    assert!((15..45).contains(&sound), "{sound} of 60");
}

#[test]
fn reports_have_the_same_figures_at_any_size() {
    let ball = Solid::superellipsoid([1.0, 0.8, 0.6], 1.0, 1.0);
    let settings = MeshSettings { cell: CellSize::LongestSide(24), ..MeshSettings::default() };
    let lines = |scale: f64| {
        let mesh = ball.scale(scale).mesh(&settings).expect("the solid is valid");
        mesh.check().to_string()
    };
    let plain = lines(1.0);
    assert!(plain.contains("\n1.99642 x 1.59751 x 1.19873"), "{plain}");
    for scale in [1e-6, 1e-3, 1e3] {
        let report = lines(scale);
        // All that is told of a small part are its figures, never 0.000000.
        let numbers = |text: &str| -> Vec<f64> {
            let words = text.split([' ', ',', '(', ')', '\n']);
            words.filter_map(|word| word.parse().ok()).collect()
        };
        let (own, plain) = (numbers(&report), numbers(&plain));
        assert_eq!(own.len(), plain.len(), "{report}");
        let ratio = |n: usize, power: i32| own[n] / (plain[n] * scale.powi(power));
        // Triangles, vertices, shells and the genus; volume and area; the centroid; the sides.
        assert!((ratio(4, 3) - 1.0).abs() < 1e-3 && (ratio(5, 2) - 1.0).abs() < 1e-3, "{report}");
        for n in 9..12 {
            assert!((ratio(n, 1) - 1.0).abs() < 1e-3, "{report}");
        }
    }
}
