//! Readers of meshes and points: what our writers and others' wrote, what is damaged, and noise.

mod faults;
mod fuzz;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use crate::runs::{heeds, laden};
use glam::{DVec3, Vec3};
use rvachev::error::{LoadError, ReadError, SaveError};
use rvachev::io::{
    FileFormat, FilePlace, LoadSettings, write_3mf, write_glb, write_glb_on, write_obj, write_obj_on, write_ply,
    write_ply_on, write_ply_points, write_ply_points_on, write_stl, write_stl_ascii, write_stl_ascii_on, write_stl_on,
};
use rvachev::{CancelToken, CellSize, LengthUnit, Mesh, MeshSettings, PointCloud, Progress, Run, SaveSettings, Solid};

/// What a closed solid gives, with creases, colours and owners.
pub(super) fn part() -> Mesh {
    let part = Solid::cuboid([3.0, 2.0, 1.0]) - Solid::cylinder(0.4, 3.0).paint([200, 30, 10]);
    let mesh = part.mesh(&MeshSettings { cell: CellSize::LongestSide(16), ..MeshSettings::default() }).unwrap();
    mesh.painted(&part, [250, 250, 240].into()).unwrap()
}

/// The same with one normal a vertex and texture.
fn smooth() -> Mesh {
    let mesh = Solid::sphere(1.3).mesh(&MeshSettings { cell: CellSize::LongestSide(8), ..MeshSettings::default() });
    let mesh = mesh.unwrap();
    let texture = mesh.triangles().iter().map(|t| t.map(|v| [v as f32 * 0.25, 1.0 / (1.0 + v as f32)])).collect();
    mesh.with_corner_texture(texture).unwrap()
}

pub(super) fn bytes(write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(&mut bytes).expect("a vector takes everything");
    bytes
}

fn read(format: FileFormat, bytes: &[u8]) -> Mesh {
    Mesh::read(format, bytes, &LoadSettings::default()).expect("what was written can be read")
}

fn error(format: FileFormat, bytes: &[u8]) -> String {
    Mesh::read(format, bytes, &LoadSettings::default()).unwrap_err().to_string()
}

/// Corners of the triangles.
fn corners(mesh: &Mesh) -> Vec<[Vec3; 3]> {
    mesh.triangles().iter().map(|t| t.map(|v| mesh.positions()[v as usize])).collect()
}

/// Normals of the corners.
fn normals(mesh: &Mesh) -> Option<Vec<[Vec3; 3]>> {
    let of_vertices = |normals: &[Vec3]| mesh.triangles().iter().map(|t| t.map(|v| normals[v as usize])).collect();
    mesh.corner_normals().map(<[_]>::to_vec).or_else(|| mesh.normals().map(of_vertices))
}

const EXACT: SaveSettings = SaveSettings { unit: LengthUnit::Millimeter, ascii: false, crease_normals: true };

#[test]
fn stl_comes_back_closed() {
    for mesh in [part(), smooth()] {
        for bytes in [bytes(|out| write_stl(&mesh, out)), bytes(|out| write_stl_ascii(&mesh, out))] {
            let found = read(FileFormat::Stl, &bytes);
            assert_eq!(corners(&found), corners(&mesh));
            assert_eq!(found.positions().len(), mesh.positions().len());
            assert!(found.check().is_sound());
        }
    }
}

#[test]
fn obj_comes_back_as_it_was() {
    for mesh in [part(), smooth()] {
        let found = read(FileFormat::Obj, &bytes(|out| write_obj(&mesh, &EXACT, out)));
        assert_eq!((found.positions(), found.triangles()), (mesh.positions(), mesh.triangles()));
        assert_eq!(found.corner_texture(), mesh.corner_texture());
        assert_near(normals(&found), normals(&mesh));
    }
}

/// Writers make normals of length 1.
fn assert_near(found: Option<Vec<[Vec3; 3]>>, expected: Option<Vec<[Vec3; 3]>>) {
    assert_eq!(found.is_some(), expected.is_some());
    for (found, expected) in found.iter().flatten().flatten().zip(expected.iter().flatten().flatten()) {
        assert!(found.distance(expected.normalize()) < 1e-3, "{found} {expected}");
    }
}

#[test]
fn ply_comes_back_as_it_was() {
    for mesh in [part(), smooth()] {
        let found = read(FileFormat::Ply, &bytes(|out| write_ply(&mesh, out)));
        assert_eq!((found.positions(), found.triangles()), (mesh.positions(), mesh.triangles()));
        assert_eq!(found.owners(), mesh.owners());
        assert_eq!(found.corner_colors(), mesh.corner_colors());
        assert_eq!(found.normals().is_some(), normals(&mesh).is_some());
    }
}

#[test]
fn glb_and_3mf_come_back_in_any_unit() {
    for mesh in [part(), smooth()] {
        for unit in [LengthUnit::Millimeter, LengthUnit::Inch, LengthUnit::Meter] {
            let settings = SaveSettings { unit, ..EXACT };
            let load = LoadSettings { unit, ..LoadSettings::default() };
            let glb = bytes(|out| write_glb(&mesh, &settings, out));
            let found = Mesh::read(FileFormat::Glb, &glb[..], &load).unwrap();
            assert_eq!(corners(&found), corners(&mesh));
            assert_eq!(found.positions().len(), mesh.positions().len());
            assert_eq!(found.corner_colors(), mesh.corner_colors());
            assert_near(normals(&found), normals(&mesh));
            let threemf = bytes(|out| write_3mf(&mesh, &settings, out));
            let found = Mesh::read(FileFormat::ThreeMf, &threemf[..], &load).unwrap();
            assert_eq!((found.positions(), found.triangles()), (mesh.positions(), mesh.triangles()));
            assert_eq!(found.corner_colors(), mesh.corner_colors());
        }
        let inches = bytes(|out| write_glb(&mesh, &SaveSettings { unit: LengthUnit::Inch, ..EXACT }, out));
        let found = read(FileFormat::Glb, &inches);
        assert!((found.volume() / mesh.volume() / 25.4f64.powi(3) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn units_of_files_without_are_asked_for() {
    let mesh = smooth();
    let stl = bytes(|out| write_stl(&mesh, out));
    let settings = LoadSettings { file_unit: Some(LengthUnit::Inch), ..LoadSettings::default() };
    let found = Mesh::read(FileFormat::Stl, &stl[..], &settings).unwrap();
    assert!((found.bounds().size() / mesh.bounds().size() - 25.4).abs().max_element() < 1e-4);
}

#[test]
fn clouds_come_back_exactly() {
    let positions: Vec<DVec3> = (0..50).map(|i| DVec3::new(f64::from(i).sin(), 1e-9 * f64::from(i), 1e9)).collect();
    let normals: Vec<Vec3> = positions.iter().map(|p| p.as_vec3().normalize()).collect();
    let cloud = PointCloud::new(positions).unwrap().with_normals(normals).unwrap();
    let cloud = cloud.with_colors((0..50).map(|i| [i, 2 * i, 255 - i]).collect()).unwrap();
    let ply = bytes(|out| write_ply_points(&cloud, out));
    assert_eq!(PointCloud::read(FileFormat::Ply, &ply[..], &LoadSettings::default()).unwrap(), cloud);
    let mut rows = String::from("x;y;z;nx;ny;nz;red;green;blue\n");
    for i in 0..50 {
        let (p, n) = (cloud.positions()[i], cloud.normals().unwrap()[i]);
        let [r, g, b] = cloud.colors().unwrap()[i];
        rows += &format!("{:?};{:?};{:?};{:?};{:?};{:?};{r};{g};{b}\r\n", p.x, p.y, p.z, n.x, n.y, n.z);
    }
    let read = |text: &str| PointCloud::read(FileFormat::Xyz, text.as_bytes(), &LoadSettings::default());
    assert_eq!(read(&rows).unwrap(), cloud);
    let bare = rows.split_once('\n').unwrap().1.replace(';', " ");
    assert_eq!(read(&bare).unwrap(), cloud);
    // A count, a comment, colours without names, more columns than are known.
    let cloud = read("2\n# made by hand\n0 0 1 255 0 10\n\n1 2 3 1 2 3\n").unwrap();
    assert_eq!((cloud.len(), cloud.normals()), (2, None));
    assert_eq!(cloud.colors(), Some(&[[255, 0, 10], [1, 2, 3]][..]));
    let lidar = read("0 0 1 17.5\n1 2 3 18\n").unwrap();
    assert_eq!((lidar.len(), lidar.normals(), lidar.colors()), (2, None, None));
    let error = read("1 2 3\n4 5\n").unwrap_err().to_string();
    assert_eq!(error, "line 2: expected a number in column 3, found 2 columns");
    // The vertices of a mesh.
    let stl = bytes(|out| write_stl(&smooth(), out));
    let points = PointCloud::read(FileFormat::Stl, &stl[..], &LoadSettings::default()).unwrap();
    assert_eq!(points.len(), smooth().positions().len());
}

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/import")
}

#[test]
fn what_others_wrote_is_read() {
    let mut count = 0;
    for entry in fs::read_dir(corpus()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let mesh = Mesh::load(&path).unwrap_or_else(|error| panic!("{error}"));
        count += 1;
        let unit = if name.ends_with("glb") { 1e9 } else { 1.0 };
        if name.contains("_box") {
            assert!((mesh.volume() / unit - 48.0).abs() < 1e-3, "{name}: {}", mesh.volume());
            assert!(mesh.check().is_sound() && mesh.triangles().len() == 12, "{name}");
        } else if name.contains("_two") {
            assert!((mesh.volume() / unit - 96.0).abs() < 1e-3, "{name}: {}", mesh.volume());
            let size = mesh.bounds().size() / unit.cbrt();
            assert!((size.max_element() - 12.0).abs() < 1e-4 && mesh.components().len() == 2, "{name}: {size}");
        } else {
            assert_eq!((mesh.area(), mesh.triangles().len()), (1.0, 2), "{name}");
        }
        if name.starts_with("trimesh_box") && (name.ends_with("ply") || name.ends_with("obj")) {
            let colors = mesh.corner_colors().expect("it has colours");
            let vertex = mesh.triangles()[3][1] as u8;
            assert_eq!(colors[3][1], [10 * vertex, 20 * vertex, 30 * vertex, 255], "{name}");
        }
    }
    assert!(count >= 11);
}

#[test]
fn parts_and_scans_are_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    if !folder.is_dir() {
        println!("skipped: no {}", folder.display());
        return;
    }
    let files = |name: &str| {
        let entries = fs::read_dir(folder.join(name)).unwrap().map(|entry| entry.unwrap().path());
        entries.filter(|path| path.extension().is_some_and(|extension| extension == "ply"))
    };
    let mut parts = 0;
    for path in files("parts") {
        let mesh = Mesh::load(&path).unwrap_or_else(|error| panic!("{error}"));
        let report = mesh.check();
        assert!(report.is_closed() && report.volume > 0.0, "{}", path.display());
        parts += 1;
    }
    let mut scans = 0;
    for path in files("ems") {
        let cloud = PointCloud::load(&path).unwrap_or_else(|error| panic!("{error}"));
        assert!(cloud.len() > 100, "{}", path.display());
        let error = Mesh::load(&path).unwrap_err().to_string();
        assert!(error.contains("which make a PointCloud"), "{error}");
        scans += 1;
    }
    assert_eq!((parts, scans), (14, 6));
}

#[test]
fn text_is_taken_as_it_is_written() {
    let ply = b"ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\n\
        property list uchar int tags\nproperty float z\nelement material 1\nproperty int kind\n\
        element face 1\nproperty list uchar int vertex_index\nproperty float quality\nend_header\n\
        0 0 2 7 7 0\n1 0 0 0\n1 1 1 9 0\n0 1 0 0\n5\n4 0 1 2 3 0.5\n";
    assert_eq!(read(FileFormat::Ply, ply).triangles(), [[0, 1, 2], [0, 2, 3]]);
    let obj = b"# a square\r\nv 0 0 0\r\nv 1 \\\r\n 0 0\r\nv 1 1 0\nv 0 1 0\no thing\nf -4 -3 -2 -1\n";
    assert_eq!(read(FileFormat::Obj, obj).triangles(), [[0, 1, 2], [0, 2, 3]]);
    let stl = b"SOLID two words\nFACET NORMAL nan nan nan OUTER LOOP VERTEX 0 0 0 VERTEX 1 0 0 VERTEX 0 1 0 ENDLOOP \
        ENDFACET\nendsolid\nsolid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 0 0 1e0\n\
        endloop\nendfacet\nendsolid";
    assert_eq!(read(FileFormat::Stl, stl).triangles(), [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn big_endian_is_read() {
    let mut ply = b"ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty double x\nproperty float y\n\
        property short z\nelement face 1\nproperty list uchar uint vertex_indices\nend_header\n"
        .to_vec();
    for [x, y, z] in [[0.0_f64, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, 2.5, -3.0]] {
        ply.extend(x.to_be_bytes());
        ply.extend((y as f32).to_be_bytes());
        ply.extend((z as i16).to_be_bytes());
    }
    ply.push(3);
    ply.extend([0u32, 1, 2].map(u32::to_be_bytes).as_flattened());
    let mesh = read(FileFormat::Ply, &ply);
    assert_eq!(mesh.positions(), [Vec3::ZERO, Vec3::new(1.5, 0.0, 0.0), Vec3::new(0.0, 2.5, -3.0)]);
}

#[test]
fn errors_say_where_and_what() {
    let stl = bytes(|out| write_stl(&smooth(), out));
    assert_eq!(
        error(FileFormat::Stl, &stl[..200]),
        "byte 184: expected 50 bytes of a facet, found the end of the file after 16 bytes"
    );
    let mut bad = stl.clone();
    bad[84 + 50 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let text = error(FileFormat::Stl, &bad);
    assert!(text.starts_with("byte 134: expected a coordinate from -3.4") && text.ends_with("found NaN"), "{text}");
    assert_eq!(
        error(FileFormat::Stl, b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0\n"),
        "line 4: expected a coordinate, found \"zero\""
    );
    assert_eq!(
        error(FileFormat::Obj, b"v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 4\n"),
        "line 5: expected a vertex from 1 to 3, or from -1 to -3, found \"4\""
    );
    let ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0 1\n";
    assert_eq!(error(FileFormat::Ply, ply.as_bytes()), "line 11: expected a vertex from 0, of 1 vertices, found 1");
    assert_eq!(error(FileFormat::Ply, b"plx\n"), "line 1: expected ply, found \"plx\"");
    let glb = bytes(|out| write_glb(&smooth(), &EXACT, out));
    assert!(error(FileFormat::Glb, &glb[..300]).starts_with("byte 20: expected "));
    assert!(error(FileFormat::ThreeMf, b"PK").starts_with("byte 0: expected a ZIP archive, found \"PK\""));
}

#[test]
fn marks_of_spreadsheets_are_known() {
    let cloud = |text: &[u8]| PointCloud::read(FileFormat::Xyz, text, &LoadSettings::default());
    let marked = cloud(b"\xef\xbb\xbfx;y;z\n1;2;3\n4;5;6\n").unwrap();
    assert_eq!(marked.positions(), [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)]);
    let obj = b"\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(read(FileFormat::Obj, obj).positions().len(), 3);
    // Commas of decimals are not taken for columns.
    let error = cloud(b"1,5;2,5;3,5\n").unwrap_err().to_string();
    assert!(error.contains("line 1") && error.contains("1,5"), "{error}");
}

#[test]
fn headers_are_not_believed() {
    let settings = LoadSettings::default();
    // Numbers that a header claims, and no bytes for them: gigabytes if it were believed.
    let claims = [
        "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty double x\nproperty double y\n\
        property double z\nend_header\n"
            .as_bytes()
            .to_vec(),
        "ply\nformat ascii 1.0\nelement nothing 18446744073709551615\nelement vertex 18446744073709551615\n\
        property float x\nproperty float y\nproperty float z\nend_header\n"
            .as_bytes()
            .to_vec(),
    ];
    for ply in claims {
        assert!(matches!(Mesh::read(FileFormat::Ply, &ply[..], &settings), Err(ReadError::Content { .. })));
    }
    let mut stl = vec![0; 80];
    stl.extend(u32::MAX.to_le_bytes());
    assert!(error(FileFormat::Stl, &stl).starts_with("byte 84: "));
}

#[test]
fn limits_hold() {
    let mesh = smooth();
    let triangles = LoadSettings { most_triangles: mesh.triangles().len() as u64 - 1, ..LoadSettings::default() };
    let points = LoadSettings { most_points: 10, ..LoadSettings::default() };
    let unpacked = LoadSettings { most_bytes: 5_000, ..LoadSettings::default() };
    let files = [
        (FileFormat::Stl, bytes(|out| write_stl(&mesh, out))),
        (FileFormat::Obj, bytes(|out| write_obj(&mesh, &EXACT, out))),
        (FileFormat::Ply, bytes(|out| write_ply(&mesh, out))),
        (FileFormat::Glb, bytes(|out| write_glb(&mesh, &EXACT, out))),
        (FileFormat::ThreeMf, bytes(|out| write_3mf(&mesh, &EXACT, out))),
    ];
    for (format, bytes) in files {
        for (settings, setting) in [(&triangles, "most_triangles"), (&points, "most_points"), (&unpacked, "most_bytes")]
        {
            let error = Mesh::read(format, &bytes[..], settings).unwrap_err();
            assert!(error.to_string().contains(setting), "{format:?}: {error}");
        }
    }
}

#[test]
fn nested_components_end() {
    // 39 objects, each of the next one twice, and at last no triangle.
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/nested_components.3mf");
    let error = Mesh::load(file).unwrap_err().to_string();
    assert!(error.contains("most_points"), "{error}");
}

#[test]
fn extensions_are_known() {
    let text = |error: rvachev::error::LoadError| error.to_string();
    assert_eq!(
        text(Mesh::load("points.xyz").unwrap_err()),
        "cannot load points.xyz: the extension .xyz is not known; known: .3mf, .glb, .obj, .ply, .stl"
    );
    assert!(text(Mesh::load("missing.STL").unwrap_err()).starts_with("cannot load missing.STL: cannot be read: "));
    assert!(text(PointCloud::load("points").unwrap_err()).ends_with(".stl, .csv, .xyz"));
    let place = FilePlace::Part { part: "3D/3dmodel.model".into(), byte: 7 };
    assert_eq!(place.to_string(), "byte 7 of 3D/3dmodel.model");
}

/// A wavy sheet of 80 000 triangles.
fn sheet() -> Mesh {
    const N: u32 = 200;
    let at = |v: u32| {
        let (x, y) = ((v % (N + 1)) as f32, (v / (N + 1)) as f32);
        Vec3::new(x, y, (0.3 * x).sin() * (0.2 * y).cos())
    };
    let cell = |k: u32| k / N * (N + 1) + k % N;
    let pair = |k: u32| [[cell(k), cell(k) + 1, cell(k) + N + 2], [cell(k), cell(k) + N + 2, cell(k) + N + 1]];
    Mesh::new((0..(N + 1) * (N + 1)).map(at).collect(), (0..N * N).flat_map(pair).collect()).unwrap()
}

/// A run that writes down what it is told, and is cancelled when that is more than `most`.
fn run_until(most: f64) -> (Run, Arc<Mutex<Vec<f64>>>) {
    let (cancel, told) = (CancelToken::new(), Arc::new(Mutex::new(Vec::new())));
    let (stop, list) = (cancel.clone(), told.clone());
    let progress = Progress::new(move |fraction| {
        list.lock().unwrap().push(fraction);
        if fraction > most {
            stop.cancel();
        }
    });
    (Run { cancel, progress: Some(progress), ..Run::default() }, told)
}

#[test]
fn files_are_written_and_read_under_a_run() {
    let (mesh, folder) = (sheet(), std::env::temp_dir().join(format!("rvachev-runs-{}", std::process::id())));
    fs::create_dir_all(&folder).unwrap();
    let cloud = PointCloud::new(mesh.positions().iter().map(|p| p.as_dvec3()).collect()).unwrap();
    let (saving, loading) = (SaveSettings::default(), LoadSettings::default());
    let is_progress = |told: &Mutex<Vec<f64>>| {
        let told = told.lock().unwrap();
        told.len() > 5 && told.is_sorted() && told.last() == Some(&1.0)
    };
    for extension in ["stl", "obj", "ply", "glb", "3mf"] {
        let path = folder.join(format!("sheet.{extension}"));
        let (run, told) = run_until(2.0);
        mesh.save_on(&path, &saving, &run).unwrap();
        assert!(is_progress(&told), "{extension}: {told:?}");
        let (run, told) = run_until(2.0);
        let whole = Mesh::load_on(&path, &loading, &run).unwrap();
        assert!(is_progress(&told) && whole.triangles().len() == 80_000, "{extension}: {told:?}");
        let (run, told) = run_until(2.0);
        assert_eq!(PointCloud::load_on(&path, &loading, &run).unwrap().len(), cloud.len());
        assert!(is_progress(&told), "{extension}: {told:?}");
        // While bytes arrive, and while they are looked at.
        for most in [0.0, 0.3] {
            let (run, told) = run_until(most);
            let stopped = Mesh::load_on(&path, &loading, &run);
            assert!(matches!(stopped, Err(LoadError::Cancelled(_))), "{extension}, {most}: {told:?}");
            let (run, told) = run_until(most);
            let stopped = PointCloud::load_on(&path, &loading, &run);
            assert!(matches!(stopped, Err(LoadError::Cancelled(_))), "{extension}, {most}: {told:?}");
        }
        fs::write(&path, "before").unwrap();
        let (run, told) = run_until(0.0);
        let stopped = mesh.save_on(&path, &saving, &run);
        assert!(matches!(stopped, Err(SaveError::Cancelled(_))), "{extension}: {told:?}");
        assert_eq!(fs::read(&path).unwrap(), b"before");
    }
    let path = folder.join("points.ply");
    let (run, told) = run_until(2.0);
    cloud.save_on(&path, &run).unwrap();
    assert!(is_progress(&told), "{told:?}");
    let stopped = cloud.save_on(&path, &run_until(0.0).0);
    assert!(matches!(stopped, Err(SaveError::Cancelled(_))));
    assert_eq!(PointCloud::load(&path).unwrap().len(), cloud.len());
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 6, "no temporary file is left");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn writers_heed_a_run() {
    let (mesh, settings) = (laden(), SaveSettings::default());
    let cloud = PointCloud::new(mesh.positions().iter().map(|p| p.as_dvec3()).collect()).unwrap();
    let bytes = Vec::<u8>::new;
    heeds("writing STL", 15, 0.3, |run| write_stl_on(&mesh, run, bytes()));
    heeds("writing STL as text", 15, 0.3, |run| write_stl_ascii_on(&mesh, run, bytes()));
    heeds("writing OBJ", 15, 0.6, |run| write_obj_on(&mesh, &settings, run, bytes()));
    heeds("writing PLY", 15, 0.5, |run| write_ply_on(&mesh, run, bytes()));
    heeds("writing GLB", 15, 0.5, |run| write_glb_on(&mesh, &settings, run, bytes()));
    heeds("writing points", 15, 0.3, |run| write_ply_points_on(&cloud, run, bytes()));
    heeds("writing 3MF", 15, 0.6, |run| rvachev::io::write_3mf_on(&mesh, &settings, run, bytes()));
    // What is written is the same.
    let (mut plain, mut on) = (bytes(), bytes());
    write_obj(&mesh, &settings, &mut plain).unwrap();
    write_obj_on(&mesh, &settings, &Run::default(), &mut on).unwrap();
    assert!(plain == on);
    let run = Run::default();
    run.cancel.cancel();
    let error = write_ply_on(&mesh, &run, bytes()).unwrap_err();
    assert!(error.get_ref().is_some_and(|inner| inner.is::<rvachev::Cancelled>()), "{error:?}");
}

#[test]
fn readers_heed_a_run() {
    let (mut bytes, settings) = (Vec::new(), LoadSettings::default());
    write_ply(&laden(), &mut bytes).unwrap();
    heeds("reading a mesh", 15, 0.35, |run| Mesh::read_on(FileFormat::Ply, &bytes[..], &settings, run));
    heeds("reading points", 5, 0.7, |run| PointCloud::read_on(FileFormat::Ply, &bytes[..], &settings, run));
}
