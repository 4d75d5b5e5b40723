//! Every format, written and read back: the same triangles, the same vertices, and what they
//! carry.

use std::fs;
use std::path::PathBuf;

use glam::Vec3;
use rvachev::{
    LengthUnit, Mesh, SaveSettings,
    error::SaveError,
    io::{write_glb, write_obj, write_ply, write_stl, write_stl_ascii},
};

/// A cube from 0 to `size`, its sides not parallel to anything, of 8 shared vertices.
fn cube() -> Mesh {
    let turn = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, 1.1);
    let at = |c: u32| turn * Vec3::new((c & 1) as f32, (c >> 1 & 1) as f32, (c >> 2) as f32) * 3.7;
    let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    Mesh::new((0..8).map(at).collect(), quads.into_iter().flat_map(halves).collect()).unwrap()
}

const PAINT: [[u8; 4]; 3] = [[255, 0, 0, 255], [10, 200, 30, 255], [0, 0, 0, 128]];

/// The cube with a normal, a colour and an owner for each side.
fn painted() -> Mesh {
    let mesh = cube();
    let normal = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions()[i as usize]);
        (b - a).cross(c - a).normalize()
    };
    // The two halves of a side get exactly the same.
    let normals: Vec<[Vec3; 3]> = (0..12).map(|t| [normal(&mesh.triangles()[t / 2 * 2]); 3]).collect();
    let colors = (0..12).map(|t| [PAINT[t / 4]; 3]).collect();
    let texture = (0..12)
        .map(|t| if t % 2 == 0 { [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]] } else { [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0]] });
    let texture = texture.collect();
    let mesh = mesh.with_corner_normals(normals).unwrap().with_corner_colors(colors).unwrap();
    mesh.with_corner_texture(texture).unwrap().with_owners((0..12).map(|t| t / 2).collect()).unwrap()
}

/// The cube with a normal and a colour for each vertex.
fn smooth() -> Mesh {
    let mesh = cube();
    let middle: Vec3 = mesh.positions().iter().sum::<Vec3>() / 8.0;
    let normals = mesh.positions().iter().map(|&p| (p - middle).normalize()).collect();
    let colors = mesh.triangles().iter().map(|t| t.map(|i| [30 * i as u8, 7, 9, 255])).collect();
    mesh.with_normals(normals).unwrap().with_corner_colors(colors).unwrap()
}

fn written(write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(&mut bytes).expect("a vector takes everything");
    bytes
}

fn text(write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) -> String {
    String::from_utf8(written(write)).unwrap()
}

#[test]
fn stl_text_has_the_facets_of_the_binary() {
    let mesh = cube();
    let ascii = text(|out| write_stl_ascii(&mesh, out));
    assert!(ascii.starts_with("solid ") && ascii.trim_end().ends_with("endsolid rvachev"));
    let numbers = |line: &str, what: &str| -> Vec<f32> {
        line.trim().strip_prefix(what).unwrap().split_whitespace().map(|x| x.parse().unwrap()).collect()
    };
    let read: Vec<f32> = ascii
        .lines()
        .filter_map(|line| match line.split_whitespace().next()? {
            "facet" => Some(numbers(line, "facet normal")),
            "vertex" => Some(numbers(line, "vertex")),
            _ => None,
        })
        .flatten()
        .collect();
    let binary = written(|out| write_stl(&mesh, out));
    let facets = binary[84..].chunks(50).flat_map(|f| f[..48].chunks(4));
    let expected: Vec<f32> = facets.map(|x| f32::from_le_bytes(x.try_into().unwrap())).collect();
    assert_eq!(read, expected);
}

/// An OBJ file: positions, texture coordinates, normals, and the corners that refer to them.
#[derive(Default)]
struct Obj {
    lists: [Vec<Vec<f32>>; 3],
    faces: Vec<Vec<Vec<Option<usize>>>>,
}

fn read_obj(text: &str) -> Obj {
    let mut obj = Obj::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let kind = words.next().unwrap();
        if let Some(list) = ["v", "vt", "vn"].iter().position(|&k| k == kind) {
            obj.lists[list].push(words.map(|x| x.parse().unwrap()).collect());
        } else if kind == "f" {
            let place = |x: &str| x.parse::<usize>().ok().map(|i| i - 1);
            obj.faces.push(words.map(|corner| corner.split('/').map(place).collect()).collect());
        }
    }
    obj
}

#[test]
fn obj_keeps_vertices_shared_whatever_the_corners_carry() {
    let mesh = painted();
    let all = SaveSettings { crease_normals: true, ..SaveSettings::default() };
    let obj = read_obj(&text(|out| write_obj(&mesh, &all, out)));
    let [positions, texture, normals] = &obj.lists;
    assert_eq!((positions.len(), obj.faces.len()), (8, 12));
    assert_eq!(normals.len(), 24, "three at each of the eight corners");
    for (t, face) in obj.faces.iter().enumerate() {
        for (k, corner) in face.iter().enumerate() {
            let [v, vt, vn] = corner[..].try_into().unwrap();
            let (v, vt, vn): (usize, usize, usize) = (Option::unwrap(v), Option::unwrap(vt), Option::unwrap(vn));
            assert_eq!(v as u32, mesh.triangles()[t][k]);
            assert_eq!(positions[v], mesh.positions()[v].to_array());
            assert_eq!(normals[vn], mesh.corner_normals().unwrap()[t][k].to_array());
            assert_eq!(texture[vt], mesh.corner_texture().unwrap()[t][k]);
        }
    }
    let obj = read_obj(&text(|out| write_obj(&mesh, &SaveSettings::default(), out)));
    assert_eq!((obj.lists[2].len(), obj.lists[1].is_empty()), (0, false), "no normals at creases unless asked for");
    let obj = read_obj(&text(|out| write_obj(&smooth(), &SaveSettings::default(), out)));
    assert_eq!((obj.lists[1].len(), obj.lists[2].len()), (0, 8));
    assert!(obj.faces.iter().flatten().all(|corner| corner[1].is_none() && corner[0] == corner[2]));
}

/// The header's lines of a PLY file and the bytes that follow.
fn read_ply(bytes: &[u8]) -> (Vec<String>, &[u8]) {
    let end = b"end_header\n";
    let at = bytes.windows(end.len()).position(|w| w == end).unwrap() + end.len();
    (std::str::from_utf8(&bytes[..at]).unwrap().lines().map(String::from).collect(), &bytes[at..])
}

#[test]
fn ply_has_colours_of_vertices_or_of_faces() {
    let mesh = smooth();
    let bytes = written(|out| write_ply(&mesh, out));
    let (header, body) = read_ply(&bytes);
    assert_eq!(header[..2], ["ply", "format binary_little_endian 1.0"]);
    let face = header.iter().position(|line| line == "element face 12").unwrap();
    assert!(
        header[..face].contains(&"element vertex 8".into()) && header[..face].contains(&"property uchar red".into())
    );
    assert_eq!(body.len(), 8 * 28 + 12 * 13);
    for (v, vertex) in body[..8 * 28].chunks(28).enumerate() {
        let x: Vec<f32> = vertex[..24].chunks(4).map(|x| f32::from_le_bytes(x.try_into().unwrap())).collect();
        assert_eq!(x[..3], mesh.positions()[v].to_array());
        assert_eq!(x[3..], mesh.normals().unwrap()[v].to_array());
        assert_eq!(vertex[24..], [30 * v as u8, 7, 9, 255]);
    }

    let mesh = painted();
    let bytes = written(|out| write_ply(&mesh, out));
    let (header, body) = read_ply(&bytes);
    let face = header.iter().position(|line| line == "element face 12").unwrap();
    assert!(
        header[face..].contains(&"property uchar alpha".into())
            && header[face..].contains(&"property uint owner".into())
    );
    assert_eq!(body.len(), 8 * 24 + 12 * 21, "no vertex is split");
    for (t, face) in body[8 * 24..].chunks(21).enumerate() {
        let index = |k: usize| u32::from_le_bytes(face[1 + 4 * k..][..4].try_into().unwrap());
        assert_eq!((face[0], [0, 1, 2].map(index)), (3, mesh.triangles()[t]));
        assert_eq!(face[13..17], PAINT[t / 4]);
        assert_eq!(u32::from_le_bytes(face[17..].try_into().unwrap()), t as u32 / 2);
    }
}

#[test]
fn glb_splits_at_creases_and_only_there() {
    for (mesh, vertices) in [(cube(), 8), (smooth(), 8), (painted(), 24)] {
        let bytes = written(|out| write_glb(&mesh, &SaveSettings::default(), out));
        let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(&bytes).expect("a valid file");
        let blob = blob.unwrap();
        let node = document.nodes().next().unwrap();
        let (_, rotation, scale) = node.transform().decomposed();
        assert_eq!(scale, [0.001; 3]);
        let up = glam::Quat::from_array(rotation) * Vec3::Z;
        assert!((up - Vec3::Y).length() < 1e-6, "z is up in a model, y in glTF");

        let primitive = node.mesh().unwrap().primitives().next().unwrap();
        let reader = primitive.reader(|_| Some(&blob));
        let positions: Vec<Vec3> = reader.read_positions().unwrap().map(Vec3::from).collect();
        let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
        assert_eq!((positions.len(), indices.len()), (vertices, 36));
        let corners = mesh.triangles().as_flattened();
        for (&index, &corner) in indices.iter().zip(corners) {
            assert_eq!(positions[index as usize], mesh.positions()[corner as usize]);
        }
        let normals: Option<Vec<Vec3>> = reader.read_normals().map(|n| n.map(Vec3::from).collect());
        assert_eq!(normals.is_some(), mesh.normals().is_some() || mesh.corner_normals().is_some());
        if let (Some(read), Some(given)) = (&normals, mesh.corner_normals()) {
            let given = given.as_flattened();
            assert!(indices.iter().zip(given).all(|(&i, given)| read[i as usize] == *given));
        }
        if let Some(given) = mesh.corner_colors() {
            let read: Vec<[f32; 4]> = reader.read_colors(0).unwrap().into_rgba_f32().collect();
            for (&i, given) in indices.iter().zip(given.as_flattened()) {
                // The inverse of what the writer does.
                let srgb = |x: f32| if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
                let [r, g, b, a] = read[i as usize];
                let back = [srgb(r), srgb(g), srgb(b), a].map(|x| (255.0 * x).round() as u8);
                assert_eq!(back, *given);
            }
        }
        if let Some(given) = mesh.corner_texture() {
            let read: Vec<[f32; 2]> = reader.read_tex_coords(0).unwrap().into_f32().collect();
            let given = given.as_flattened();
            assert!(indices.iter().zip(given).all(|(&i, &[u, v])| read[i as usize] == [u, 1.0 - v]));
        }
    }
}

#[test]
fn glb_of_many_vertices_of_none_and_of_bad_normals() {
    let read = |mesh: &Mesh| {
        let bytes = written(|out| write_glb(mesh, &SaveSettings::default(), out));
        gltf::Gltf::from_slice(&bytes).expect("a valid file")
    };
    assert_eq!(read(&Mesh::default()).document.meshes().count(), 0);
    for count in [65_535u32, 65_536] {
        let positions = (0..count).map(|i| Vec3::new(i as f32, (i % 7) as f32, (i % 11) as f32)).collect();
        let triangles = (0..count / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).chain([[0, 1, count - 1]]).collect();
        let gltf = read(&Mesh::new(positions, triangles).unwrap());
        let primitive = gltf.meshes().next().unwrap().primitives().next().unwrap();
        let highest = primitive.reader(|_| gltf.blob.as_deref()).read_indices().unwrap().into_u32().max();
        assert_eq!(highest, Some(count - 1));
    }
    let normals = vec![Vec3::ZERO, Vec3::X * 7.0, Vec3::Z * 1e-30];
    let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]).unwrap().with_normals(normals).unwrap();
    let gltf = read(&mesh);
    let primitive = gltf.meshes().next().unwrap().primitives().next().unwrap();
    let normals: Vec<[f32; 3]> = primitive.reader(|_| gltf.blob.as_deref()).read_normals().unwrap().collect();
    assert_eq!(normals, [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
}

#[cfg(feature = "threemf")]
/// The model inside a 3MF archive.
fn read_3mf(mesh: &Mesh, unit: LengthUnit) -> String {
    let bytes = written(|out| rvachev::io::write_3mf(mesh, &SaveSettings { unit, ..SaveSettings::default() }, out));
    use std::io::Read;

    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    let names: Vec<String> = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
    assert_eq!(names, ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"]);
    let mut model = String::new();
    archive.by_name("3D/3dmodel.model").unwrap().read_to_string(&mut model).unwrap();
    model
}

#[cfg(feature = "threemf")]
/// The value of an attribute of an XML element.
fn attribute<'a>(element: &'a str, name: &str) -> Option<&'a str> {
    let from = element.find(&format!(" {name}=\""))? + name.len() + 3;
    element[from..].split('"').next()
}

#[cfg(feature = "threemf")]
#[test]
fn threemf_keeps_vertices_colours_and_unit() {
    for mesh in [cube(), painted(), smooth()] {
        let model = read_3mf(&mesh, LengthUnit::Inch);
        assert_eq!(attribute(&model, "unit"), Some("inch"));
        let elements = |name: &'static str| model.lines().filter(move |line| line.starts_with(&format!("<{name} ")));
        let number = |element: &str, name: &str| attribute(element, name).unwrap().parse::<f32>().unwrap();
        let positions: Vec<Vec3> =
            elements("vertex").map(|v| Vec3::from(["x", "y", "z"].map(|name| number(v, name)))).collect();
        assert_eq!(positions, mesh.positions());
        let index = |element: &str, name: &str| attribute(element, name).map(|i| i.parse::<usize>().unwrap());
        let triangles: Vec<[u32; 3]> =
            elements("triangle").map(|t| ["v1", "v2", "v3"].map(|name| index(t, name).unwrap() as u32)).collect();
        assert_eq!(triangles, mesh.triangles());
        let palette: Vec<[u8; 4]> = elements("m:color")
            .map(|color| {
                let hex = attribute(color, "color").unwrap().strip_prefix('#').unwrap();
                u32::from_str_radix(hex, 16).unwrap().to_be_bytes()
            })
            .collect();
        let Some(colors) = mesh.corner_colors() else {
            assert!(palette.is_empty());
            continue;
        };
        for (triangle, colors) in elements("triangle").zip(colors) {
            let first = index(triangle, "p1").unwrap();
            let read = ["p1", "p2", "p3"].map(|name| palette[index(triangle, name).unwrap_or(first)]);
            assert_eq!(read, *colors);
        }
    }
    assert_eq!(attribute(&read_3mf(&cube(), LengthUnit::default()), "unit"), Some("millimeter"));
    assert!(!read_3mf(&Mesh::default(), LengthUnit::Meter).contains("<object"));
    let repeated = Mesh::new(vec![Vec3::ZERO, Vec3::X], vec![[0, 1, 1]]).unwrap();
    let error = rvachev::io::write_3mf(&repeated, &SaveSettings::default(), Vec::new()).unwrap_err();
    assert!(error.to_string().contains("triangle 0 has a repeated index"));
}

#[test]
fn saving_by_extension_and_the_same_bytes_again() {
    let folder = std::env::temp_dir().join(format!("rvachev-export-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let mesh = painted();
    let settings = SaveSettings { ascii: true, unit: LengthUnit::Meter, crease_normals: true };
    let names = ["a.stl", "a.obj", "a.ply", "a.glb", "a.3mf", "A.GLB"];
    for name in names.into_iter().filter(|name| cfg!(feature = "threemf") || !name.ends_with("3mf")) {
        let path = folder.join(name);
        mesh.save(&path).unwrap();
        let plain = fs::read(&path).unwrap();
        mesh.save(&path).unwrap();
        assert_eq!(fs::read(&path).unwrap(), plain, "{name}");
        mesh.save_with(&path, &settings).unwrap();
        assert_eq!(fs::read(&path).unwrap() != plain, !name.contains("ply"), "{name}");
    }
    let missing: PathBuf = folder.join("none/a.glb");
    let error = mesh.save(&missing).unwrap_err();
    assert!(matches!(error, SaveError::Directory { .. }) && error.to_string().contains("a.glb"), "{error}");
    let error = mesh.save(folder.join("a.step")).unwrap_err().to_string();
    assert!(error.ends_with("known: .3mf, .glb, .obj, .ply, .stl"), "{error}");
    // On a file system that tells upper from lower case there is one more.
    let left = fs::read_dir(&folder).unwrap().count();
    fs::remove_dir_all(&folder).unwrap();
    assert!((4..=6).contains(&left), "no temporary file is left");
}

#[cfg(not(feature = "threemf"))]
#[test]
fn a_format_that_is_left_out_names_its_feature() {
    let path = std::env::temp_dir().join(format!("rvachev-left-out-{}.3mf", std::process::id()));
    let error = cube().save(&path).unwrap_err();
    assert!(
        matches!(&error, SaveError::Write { .. }) && format!("{error:?}").contains("feature `threemf`"),
        "{error:?}"
    );
    assert!(!path.exists());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_reported_by_every_writer() {
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let (mesh, settings) = (painted(), SaveSettings::default());
    let results = [
        write_stl(&mesh, full()),
        write_stl_ascii(&mesh, full()),
        write_obj(&mesh, &settings, full()),
        write_ply(&mesh, full()),
        write_glb(&mesh, &settings, full()),
        #[cfg(feature = "threemf")]
        rvachev::io::write_3mf(&mesh, &settings, full()),
    ];
    for result in results {
        assert_eq!(result.unwrap_err().kind(), std::io::ErrorKind::StorageFull);
    }
}
