//! What is not whole, or not what its name says, is told with its place and the remedy.

use glam::DVec3;
use rvachev::io::{FileFormat, LoadSettings, write_3mf, write_stl_ascii};
use rvachev::{Mesh, PointCloud};

use super::{EXACT, bytes, error, part, read};

fn cloud(format: FileFormat, text: &str) -> Result<PointCloud, String> {
    PointCloud::read(format, text.as_bytes(), &LoadSettings::default()).map_err(|error| error.to_string())
}

#[test]
fn what_is_no_obj_is_an_error() {
    for (text, place) in [("hello world\n", "line 1"), ("v 0 0 0\n\n<html>\n", "line 3"), ("\u{1}\u{2}v 1\n", "line 1")]
    {
        let text = error(FileFormat::Obj, text.as_bytes());
        assert!(text.starts_with(place) && text.contains("can be taken out"), "{text}");
    }
    let all = b"mtllib a.mtl\no thing\ng part\ns off\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\np 1\nf 1 2 3\n";
    assert_eq!(read(FileFormat::Obj, all).triangles().len(), 1);
}

#[test]
fn stl_as_text_that_was_cut_off_is_an_error() {
    let whole = bytes(|out| write_stl_ascii(&part(), out));
    let text = String::from_utf8(whole).expect("text");
    let end = text.rfind("endfacet").expect("a facet") + "endfacet".len();
    // Behind a facet all looks well.
    let message = error(FileFormat::Stl, &text.as_bytes()[..end]);
    assert!(message.contains("endsolid") && message.contains("cut off"), "{message}");
    let line = text[..end].lines().count();
    assert!(message.starts_with(&format!("line {line}: ")), "{message}");
    assert_eq!(read(FileFormat::Stl, text.as_bytes()).triangles().len(), part().triangles().len());
}

#[test]
fn models_of_3mf_that_end_early_are_errors() {
    use std::io::{Cursor, Read, Write};
    let whole = bytes(|out| write_3mf(&part(), &EXACT, out));
    let mut archive = zip::ZipArchive::new(Cursor::new(&whole[..])).expect("an archive");
    let mut model = String::new();
    archive.by_name("3D/3dmodel.model").expect("a model").read_to_string(&mut model).expect("text");
    let packed = |model: &str| {
        let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
        writer.start_file("3D/3dmodel.model", zip::write::SimpleFileOptions::default()).expect("a part");
        writer.write_all(model.as_bytes()).expect("a part");
        writer.finish().expect("an archive").into_inner()
    };
    assert_eq!(read(FileFormat::ThreeMf, &packed(&model)).triangles().len(), part().triangles().len());
    // Behind any whole element there is an end that looks well.
    for end in ["<vertices>", "</vertices>", "</object>", "</resources>", "</build>"] {
        let at = model.find(end).expect("it is there") + end.len();
        let message = error(FileFormat::ThreeMf, &packed(&model[..at]));
        assert!(message.contains("cut off"), "{end}: {message}");
    }
    let start = model.find("<build").expect("a build");
    let end = model.find("</build>").expect("its end") + "</build>".len();
    let message = error(FileFormat::ThreeMf, &packed(&(model[..start].to_string() + &model[end..])));
    assert!(message.contains("expected a build"), "{message}");
}

#[test]
fn columns_that_nothing_tells_are_left_out() {
    let seven = cloud(FileFormat::Xyz, "1 2 3 200 10 20 30\n4 5 6 100 40 50 60\n").expect("points");
    assert_eq!((seven.len(), seven.colors(), seven.normals()), (2, None, None));
    let four = cloud(FileFormat::Xyz, "1 2 3 0.5\n4 5 6 0.25\n").expect("points");
    assert_eq!((four.len(), four.colors(), four.normals()), (2, None, None));
    // A row of names tells.
    let named = cloud(FileFormat::Xyz, "x y z intensity r g b\n1 2 3 200 10 20 30\n").expect("points");
    assert_eq!(named.colors(), Some(&[[10, 20, 30]][..]));
    let six = cloud(FileFormat::Xyz, "1 2 3 200 10 20\n").expect("points");
    assert_eq!(six.colors(), Some(&[[200, 10, 20]][..]));
    // A comma behind the last column is none.
    let trailing = cloud(FileFormat::Xyz, "1,2,3,\n4,5,6,\n").expect("points");
    assert_eq!(trailing.positions(), [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)]);
    assert_eq!(cloud(FileFormat::Xyz, "x;y;z;\n1;2;3;\n").expect("points").len(), 1);
}

#[test]
fn points_without_coordinates_are_counted_and_can_be_left_out() {
    let rows = "x,y,z,nx,ny,nz\n1,2,3,0,0,1\nnan,nan,nan,0,0,1\n4,5,6,0,1,0\n7,inf,8,1,0,0\n";
    let message = cloud(FileFormat::Xyz, rows).unwrap_err();
    assert!(message.starts_with("line 3: ") && message.contains("2 of 4 points"), "{message}");
    assert!(message.contains("also line 5") && message.contains("most_skipped = 2"), "{message}");
    let settings = |most_skipped| LoadSettings { most_skipped, ..LoadSettings::default() };
    assert!(PointCloud::read(FileFormat::Xyz, rows.as_bytes(), &settings(1)).is_err());
    let kept = PointCloud::read(FileFormat::Xyz, rows.as_bytes(), &settings(2)).expect("points");
    assert_eq!(kept.positions(), [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)]);
    assert_eq!(kept.normals().map(<[_]>::len), Some(2));
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 0\nproperty list uchar int vertex_indices\nend_header\n0 0 0\nnan nan nan\n1 1 1\n";
    assert_eq!(PointCloud::read(FileFormat::Ply, ply.as_bytes(), &settings(9)).expect("points").len(), 2);
    // Corners of triangles are not left out.
    let obj = "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n";
    let message = Mesh::read(FileFormat::Obj, obj.as_bytes(), &settings(9)).unwrap_err().to_string();
    assert!(message.starts_with("line 2: ") && !message.contains("most_skipped"), "{message}");
    let message = PointCloud::new(vec![DVec3::X, DVec3::NAN, DVec3::INFINITY]).unwrap_err().to_string();
    assert!(message.contains("point 1") && message.contains("2 of the points"), "{message}");
}

/// A 3MF archive of parts by their names.
fn archive(parts: &[(&str, &str)]) -> Vec<u8> {
    use std::io::{Cursor, Write};
    let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in parts {
        writer.start_file(*name, zip::write::SimpleFileOptions::default()).expect("a part");
        writer.write_all(text.as_bytes()).expect("a part");
    }
    writer.finish().expect("an archive").into_inner()
}

#[test]
fn objects_of_3mf_in_other_parts_are_read() {
    let tetrahedron = "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>\
        <vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"6\"/></vertices><triangles>\
        <triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/>\
        <triangle v1=\"2\" v2=\"0\" v3=\"3\"/></triangles></mesh>";
    let main = |unit: &str| {
        format!(
            "<model unit=\"{unit}\"><resources><object id=\"1\"><components>\
             <component p:path=\"/3D/own.model\" objectid=\"7\" transform=\"1 0 0 0 1 0 0 0 1 100 0 0\"/>\
             </components></object></resources><build><item objectid=\"1\"/>\
             <item p:path=\"/3D/own.model\" objectid=\"1\"/></build></model>"
        )
    };
    // Its own objects by their numbers, and its own unit.
    let own = format!(
        "<model unit=\"centimeter\"><resources><object id=\"1\">{tetrahedron}</object><object id=\"7\"><components>\
         <component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 3 0 0\"/></components></object></resources></model>"
    );
    for (unit, far) in [("centimeter", 1040.0), ("millimeter", 140.0)] {
        let mesh = read(FileFormat::ThreeMf, &archive(&[("3D/3dmodel.model", &main(unit)), ("3D/own.model", &own)]));
        assert!((mesh.volume() - 2000.0).abs() < 1e-3, "{unit}: {}", mesh.volume());
        assert!((mesh.bounds().max.x - far).abs() < 1e-3, "{unit}: {:?}", mesh.bounds());
    }
    let message = error(FileFormat::ThreeMf, &archive(&[("3D/3dmodel.model", &main("inch"))]));
    assert!(message.contains("expected an archive with 3D/own.model"), "{message}");
    // Parts that want each other, and an object that holds itself by way of another part.
    let ring = |of: &str| {
        format!(
            "<model><resources><object id=\"1\"><components><component p:path=\"/3D/{of}.model\" objectid=\"1\"/>\
             </components></object></resources><build><item objectid=\"1\"/></build></model>"
        )
    };
    let message =
        error(FileFormat::ThreeMf, &archive(&[("3D/3dmodel.model", &ring("b")), ("3D/b.model", &ring("3dmodel"))]));
    assert!(message.contains("deep"), "{message}");
}

#[test]
fn polygons_that_are_not_convex_become_triangles_within_them() {
    let section = [[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]];
    for first in 0..6 {
        let corner = |k: usize| section[(k + first) % 6];
        let vertices: String = (0..12).map(|k| format!("{} {} {}\n", corner(k)[0], corner(k)[1], k / 6)).collect();
        let mut faces = vec![(0..6).rev().collect::<Vec<usize>>(), (6..12).collect()];
        faces.extend((0..6).map(|k| vec![k, (k + 1) % 6, (k + 1) % 6 + 6, k + 6]));
        let mut obj = String::new();
        vertices.lines().for_each(|line| obj += &format!("v {line}\n"));
        let mut ply = "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\nproperty float z\n\
            element face 8\nproperty list uchar int vertex_indices\nend_header\n"
            .to_string() + &vertices;
        for face in &faces {
            let words = |by: usize| face.iter().map(|v| format!(" {}", v + by)).collect::<String>();
            obj += &format!("f{}\n", words(1));
            ply += &format!("{}{}\n", face.len(), words(0));
        }
        for (format, text) in [(FileFormat::Obj, obj), (FileFormat::Ply, ply)] {
            let mesh = read(format, text.as_bytes());
            assert_eq!((mesh.volume(), mesh.area()), (5.0, 22.0), "{format:?} from {first}");
            assert!(mesh.check().is_sound(), "{format:?} from {first}");
        }
    }
}

#[test]
fn lines_end_as_old_programs_end_them() {
    let whole = String::from_utf8(bytes(|out| write_stl_ascii(&part(), out))).expect("text");
    for end in ["\r", "\r\n"] {
        let found = read(FileFormat::Stl, whole.replace('\n', end).as_bytes());
        assert_eq!(found.triangles().len(), part().triangles().len());
        let cut = whole[..whole.len() / 2].replace('\n', end);
        let line = whole[..whole.len() / 2].lines().count();
        let message = error(FileFormat::Stl, cut.as_bytes());
        assert!(message.starts_with(&format!("line {line}: ")), "{message}");
    }
}

#[test]
fn sparse_elements_are_those_of_the_accessor() {
    let corpus = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/corpus/import/sparse_box.glb");
    let whole = std::fs::read(corpus).expect("a file");
    let changed = |from: &str, to: &str| {
        let at = whole.windows(from.len()).position(|part| part == from.as_bytes()).expect("it is there");
        let mut bytes = whole.clone();
        bytes[at..at + from.len()].copy_from_slice(to.as_bytes());
        error(FileFormat::Glb, &bytes)
    };
    let message = changed("\"sparse\": {\"count\": 2", "\"sparse\": {\"count\": 9");
    assert!(message.contains("as many sparse elements as there are bytes for"), "{message}");
    let message = changed("\"componentType\": 5123}, \"values\"", "\"componentType\": 5126}, \"values\"");
    assert!(message.contains("indices without sign in sparse"), "{message}");
    // Their numbers, which rise.
    let at = whole.windows(4).rposition(|part| part == [3, 0, 5, 0]).expect("they are there");
    for numbers in [[5, 0, 3, 0], [3, 0, 8, 0]] {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&numbers);
        let message = error(FileFormat::Glb, &bytes);
        assert!(message.contains("sparse indices that rise, below the count"), "{message}");
    }
}

/// Faces of OBJ may stand before the vertices that they are of; negative numbers count from those
/// before the face.
#[test]
fn faces_before_their_vertices_are_read() {
    let first =
        b"f 1//1 2//1 3//1\nv 0 0 0\nv 1 0 0\nf -2//-1 2//1 4//1\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 3//1 4//1\n";
    let message = error(FileFormat::Obj, first);
    assert!(message.contains("line 4: expected a normal from 1 to 1, found \"-2//-1\""), "{message}");
    let right = String::from_utf8_lossy(first).replace("-2//-1", "-2//1");
    let mesh = read(FileFormat::Obj, right.as_bytes());
    assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 1, 3], [0, 2, 3]]);
    assert_eq!(mesh.normals().map(|normals| normals.len()), Some(4));
    let message = error(FileFormat::Obj, b"f 1 2 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\n");
    assert_eq!(message, "line 1: expected a vertex from 1 to 3, found \"4\"");
    assert_eq!(
        error(FileFormat::Obj, b"f 1 2 4\n"),
        "line 1: expected a vertex of the file, which has none, found \"1\""
    );
    // What is not convex is divided by where its corners are.
    let arrow = b"f 1 2 3 4\nv 0 0 0\nv 2 1 0\nv 0 2 0\nv 1 1 0\n";
    assert!((read(FileFormat::Obj, arrow).area() - 1.0).abs() < 1e-6);
    // So many faces are too many, wherever the vertices are.
    let settings = LoadSettings { most_triangles: 2, ..LoadSettings::default() };
    let many = Mesh::read(FileFormat::Obj, &b"f 1 2 3\nf 1 2 3\nf 1 2 3\n"[..], &settings).unwrap_err().to_string();
    assert!(many.contains("most_triangles"), "{many}");
}

#[test]
fn strips_of_ply_are_read() {
    let head = |count: u32, list: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
             element tristrips {count}\nproperty list {list}\nend_header\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n"
        )
    };
    // As the scans of Stanford have them: one list, with -1 behind each strip.
    let one = head(1, "int int vertex_indices") + "12 0 2 1 3 -1 2 4 3 5 5 0 -1\n";
    let mesh = read(FileFormat::Ply, one.as_bytes());
    assert_eq!(mesh.triangles(), [[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]]);
    assert!((mesh.area() - 2.0).abs() < 1e-6);
    let two = head(2, "uchar int vertex_index") + "4 0 2 1 3\n4 2 4 3 5\n";
    assert_eq!(read(FileFormat::Ply, two.as_bytes()).triangles(), mesh.triangles());
    // Beside faces that carry colours.
    let faces = "element face 1\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\n\
                 property uchar blue\nend_header";
    let both = head(1, "uchar int vertex_index").replace("end_header", faces) + "4 0 2 1 3\n3 2 4 3 9 8 7\n";
    let colored = read(FileFormat::Ply, both.as_bytes());
    assert_eq!(colored.triangles().len(), 3);
    let colors = colored.corner_colors().expect("those of the face");
    assert_eq!([colors[0], colors[2]], [[[255; 4]; 3], [[9, 8, 7, 255]; 3]]);
    let message = error(FileFormat::Ply, (head(1, "int int vertex_indices") + "3 0 2 6\n").as_bytes());
    assert_eq!(message, "line 16: expected a vertex from 0, of 6 vertices, or -1 behind a strip, found 6");
    let message = error(FileFormat::Ply, (head(1, "int int vertex_indices") + "3 0 -2 1\n").as_bytes());
    assert!(message.ends_with("found -2"), "{message}");
    let message = error(FileFormat::Ply, (head(1, "int int corners") + "3 0 1 2\n").as_bytes());
    assert!(message.contains("line 7: expected a property list vertex_indices of the tristrips"), "{message}");
    let message = error(FileFormat::Ply, (head(1, "int int vertex_indices") + "400000000 0 1 2\n").as_bytes());
    assert!(message.contains("the end of the file"), "{message}");
    let settings = LoadSettings { most_triangles: 3, ..LoadSettings::default() };
    let many = Mesh::read(FileFormat::Ply, one.as_bytes(), &settings).unwrap_err().to_string();
    assert!(many.contains("most_triangles"), "{many}");
}
