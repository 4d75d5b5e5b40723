//! Damaged files: a reader returns, whatever the bytes.

use rvachev::io::{
    FileFormat, LoadSettings, write_3mf, write_glb, write_obj, write_ply, write_ply_points, write_stl, write_stl_ascii,
};
use rvachev::{Mesh, PointCloud, SaveSettings};

use super::bytes;

/// A generator of whole numbers.
struct Random(u64);

impl Random {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % most.max(1)
    }
}

/// Words that formats have a meaning for, and numbers at the ends of their ranges.
const WORDS: [&[u8]; 24] = [
    b"-1",
    b"4294967295",
    b"99999999999999999999",
    b"nan",
    b"inf",
    b"1e39",
    b"-",
    b"/",
    b"//",
    b"\\\n",
    b"\n",
    b"solid",
    b"facet",
    b"f",
    b"v",
    b"element face 3\n",
    b"property list uchar int vertex_indices\n",
    b"end_header\n",
    b"{",
    b"[0]",
    b"\xff\xff\xff\xff",
    b"\x00\x00\xc0\x7f",
    b"</object>",
    b"<item objectid=\"2\"/>",
];

/// Changes a few bytes, words and lengths.
fn damaged(random: &mut Random, original: &[u8]) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for _ in 0..1 + random.below(4) {
        let at = random.below(bytes.len());
        match random.below(6) {
            0 => bytes.truncate(at),
            1 | 2 if !bytes.is_empty() => bytes[at] = random.below(256) as u8,
            3 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            4 => {
                let word = WORDS[random.below(WORDS.len())];
                let end = (at + word.len() * random.below(2)).min(bytes.len());
                bytes.splice(at..end, word.iter().copied());
            }
            _ => {
                // A piece again, or away.
                let end = (at + random.below(40)).min(bytes.len());
                let piece = bytes[at..end].to_vec();
                let to = random.below(bytes.len() + 1);
                if random.below(2) == 0 { drop(bytes.drain(at..end)) } else { drop(bytes.splice(to..to, piece)) }
            }
        }
    }
    bytes
}

fn originals() -> Vec<(FileFormat, Vec<u8>)> {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.5, 0.0], [0.0, 0.0, 2.0]].map(glam::Vec3::from_array);
    let mesh = Mesh::new(corners.to_vec(), vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap();
    let mesh = mesh.with_normals(vec![glam::Vec3::Z; 4]).unwrap().with_owners(vec![0, 1, 2, 3]).unwrap();
    let mesh = mesh.with_corner_colors(vec![[[1, 2, 3, 255], [4, 5, 6, 7], [0; 4]]; 4]).unwrap();
    let settings = SaveSettings::default();
    let cloud = PointCloud::new(corners.map(|p| p.as_dvec3()).to_vec()).unwrap();
    let text = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n3 0 1 2\n";
    let big = b"ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty char x\nproperty char y\n\
        property char z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n\
        \x00\x00\x00\x01\x00\x00\x00\x01\x00\x03\x00\x01\x02";
    vec![
        (FileFormat::Stl, bytes(|out| write_stl(&mesh, out))),
        (FileFormat::Stl, bytes(|out| write_stl_ascii(&mesh, out))),
        (FileFormat::Obj, bytes(|out| write_obj(&mesh, &settings, out))),
        (FileFormat::Ply, bytes(|out| write_ply(&mesh, out))),
        (FileFormat::Ply, bytes(|out| write_ply_points(&cloud, out))),
        (FileFormat::Ply, text.to_vec()),
        (FileFormat::Ply, big.to_vec()),
        (FileFormat::Glb, bytes(|out| write_glb(&mesh, &settings, out))),
        (FileFormat::ThreeMf, bytes(|out| write_3mf(&mesh, &settings, out))),
        (FileFormat::Xyz, b"x,y,z,nx,ny,nz\n1,2,3,0,0,1\n4,5,6,0,1,0\n".to_vec()),
        (FileFormat::Xyz, b"3\n1 2 3 255 0 0\n4 5 6 1 2 3\n# end\n".to_vec()),
    ]
}

fn run(count: usize, seed: u64, is_chosen: impl Fn(FileFormat) -> bool) {
    let settings = LoadSettings { most_bytes: 1 << 20, ..LoadSettings::default() };
    for (format, original) in originals().into_iter().filter(|(format, _)| is_chosen(*format)) {
        let mut random = Random(seed);
        let mut good = 0;
        for _ in 0..count {
            let bytes = damaged(&mut random, &original);
            match Mesh::read(format, &bytes[..], &settings) {
                Ok(mesh) => {
                    good += 1;
                    assert!(mesh.positions().iter().all(|p| p.is_finite()));
                }
                Err(error) => assert!(!error.to_string().is_empty()),
            }
            let _ = PointCloud::read(format, &bytes[..], &settings);
        }
        println!("{format:?}: {good} of {count} read");
    }
}

#[test]
fn damaged_files_are_errors() {
    run(2_000, 1, |_| true);
}

/// Ten million inputs of each file of a format.
fn many(format: FileFormat) {
    run(10_000_000, 2, |other| other == format);
}

#[test]
#[ignore = "takes minutes"]
fn many_damaged_stl_files_are_errors() {
    many(FileFormat::Stl);
}

#[test]
#[ignore = "takes minutes"]
fn many_damaged_obj_files_are_errors() {
    many(FileFormat::Obj);
}

#[test]
#[ignore = "takes minutes"]
fn many_damaged_ply_files_are_errors() {
    many(FileFormat::Ply);
}

#[test]
#[ignore = "takes an hour"]
fn many_damaged_glb_files_are_errors() {
    many(FileFormat::Glb);
}

/// A million: each is unpacked, and most of them end at a checksum.
#[test]
#[ignore = "takes minutes"]
fn many_damaged_3mf_files_are_errors() {
    run(1_000_000, 2, |other| other == FileFormat::ThreeMf);
}

#[test]
#[ignore = "takes minutes"]
fn many_damaged_rows_are_errors() {
    many(FileFormat::Xyz);
}
