//! The rasteriser: which pixels triangles cover, how deep, and what the near plane leaves.

use glam::{DVec3, Vec3};
use rvachev::{
    Camera, Mesh, deg,
    error::CameraError,
    raster::{Buffers, Facing, Fragments, LayerSource, RasterError, RasterView, Tile},
};

fn front(height: f64, pixels: u32) -> RasterView {
    let camera = Camera::orthographic(DVec3::new(0.0, -10.0, 0.0), DVec3::ZERO, DVec3::Z, height);
    RasterView::new(&camera, pixels, pixels).unwrap()
}

/// Triangles of the plane y = 0, anticlockwise seen from −y, given in pixels from the top left
/// of a picture of `front(n, n)`.
fn flat(n: u32, triangles: &[[[f64; 2]; 3]]) -> Mesh {
    let half = f64::from(n) / 2.0;
    let corner = |[x, y]: [f64; 2]| DVec3::new(x - half, 0.0, half - y).as_vec3();
    let positions = triangles.iter().flatten().map(|&p| corner(p)).collect();
    let corners = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    Mesh::new(positions, corners).unwrap()
}

/// How often each pixel is covered.
fn counts(view: &RasterView, mesh: &Mesh) -> Vec<i32> {
    let mut buffers = Buffers::new(view);
    // A sheet behind everything, so that there is a depth to count up to.
    struct Sheet(u32);
    impl LayerSource for Sheet {
        fn size(&self) -> [u32; 2] {
            [self.0, self.0]
        }
        fn layers(&self, tile: &Tile, sink: &mut dyn FnMut(&[Fragments])) {
            for y in tile.y..tile.y + tile.height {
                for x in tile.x..tile.x + tile.width {
                    sink(&[Fragments::pixel(tile.index(x, y), 1e9, Facing::Front, 0)]);
                }
            }
        }
    }
    buffers.draw(&Sheet(view.width()), 0, Facing::Front).unwrap();
    buffers.classify(&view.surface(mesh)).unwrap();
    let side = view.width();
    (0..side * side).map(|i| buffers.stencil(i % side, i / side)).collect()
}

#[test]
fn a_pixel_belongs_to_what_its_middle_is_in() {
    // Middles at 0.5, 1.5, ..: the left and the top edge belong to a triangle, the right and the
    // bottom ones do not.
    let square =
        |x0: f64, y0: f64, x1: f64, y1: f64| flat(8, &[[[x0, y0], [x0, y1], [x1, y1]], [[x0, y0], [x1, y1], [x1, y0]]]);
    let covered = |mesh: &Mesh| -> String {
        let counts = counts(&front(8.0, 8), mesh);
        counts
            .chunks(8)
            .map(|row| row.iter().map(|c| if *c > 0 { '#' } else { '.' }).collect::<String>() + "\n")
            .collect()
    };
    let expected = "........\n.###....\n.###....\n.###....\n........\n........\n........\n........\n";
    assert_eq!(covered(&square(1.5, 1.5, 4.5, 4.5)), expected);
    assert_eq!(covered(&square(1.0, 1.0, 4.0, 4.0)), expected);
    assert_eq!(covered(&square(1.4, 1.2, 4.3, 4.5)), expected);
}

#[test]
fn fans_and_strips_cover_every_pixel_once() {
    // Fans about middles and corners of pixels, also with slivers: every pixel of the disc's
    // square hull exactly once.
    let n = 64u32;
    for (cx, cy) in [(32.5, 32.5), (32.0, 32.0), (31.25, 40.1), (32.5, 7.0)] {
        for parts in [3u32, 7, 64, 501] {
            let rim = |i: u32| {
                // Around the square's border, corners included.
                let t = f64::from(i % parts) / f64::from(parts) * 4.0;
                let (side, u) = (t.floor(), t.fract() * 64.0);
                match side as i32 {
                    0 => [0.0, u],
                    1 => [u, 64.0],
                    2 => [64.0, 64.0 - u],
                    _ => [64.0 - u, 0.0],
                }
            };
            let fan: Vec<_> = (0..parts).map(|i| [[cx, cy], rim(i), rim(i + 1)]).collect();
            let counts = counts(&front(64.0, n), &flat(n, &fan));
            let least = if parts % 4 == 0 { 1 } else { 0 };
            assert!(counts.iter().all(|&c| c <= 1 && c >= least), "{parts}");
        }
    }
}

#[test]
fn depths_are_those_of_the_plane() {
    let eye = DVec3::new(0.4, -6.0, 1.0);
    let corners = [Vec3::new(-2.0, -1.0, -1.5), Vec3::new(2.5, 1.0, -1.0), Vec3::new(0.1, 2.0, 2.0)];
    let mesh = Mesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let normal = (b - a).cross(c - a);
    for camera in [
        Camera::perspective(eye, DVec3::ZERO, DVec3::Z, deg(40.0)),
        Camera::orthographic(eye, DVec3::ZERO, DVec3::Z, 5.0),
    ] {
        let view = RasterView::new(&camera, 90, 70).unwrap();
        let mut buffers = Buffers::new(&view);
        buffers.draw(&view.surface(&mesh), 3, Facing::Front).unwrap();
        let mut covered = 0;
        for y in 0..70 {
            for x in 0..90 {
                let (o, d) = camera.ray(f64::from(x) + 0.5, f64::from(y) + 0.5, 90, 70);
                let p = o + d * ((a - o).dot(normal) / d.dot(normal));
                if let Some(depth) = buffers.depth(x, y) {
                    assert!((view.project(p)[2] - depth).abs() < 1e-4, "{x} {y}");
                    assert!((buffers.point(x, y).unwrap() - p).length() < 2e-4);
                    let id = buffers.id(x, y).unwrap();
                    assert_eq!((id.operand, id.face, id.facing), (3, 0, Facing::Front));
                    covered += 1;
                } else {
                    assert_eq!(buffers.id(x, y), None);
                }
            }
        }
        assert!(covered > 500);
        let mut behind = Buffers::new(&view);
        behind.draw(&view.surface(&mesh), 0, Facing::Back).unwrap();
        assert!(behind.depths().iter().all(|d| *d == f64::INFINITY));
    }
}

#[test]
fn what_reaches_behind_the_eye_is_cut_at_the_near_plane() {
    // A floor from far behind the eye to far in front of it.
    let far = 1e6;
    let corners = vec![
        Vec3::new(-far, -far, -1.0),
        Vec3::new(far, -far, -1.0),
        Vec3::new(far, far, -1.0),
        Vec3::new(-far, far, -1.0),
    ];
    let floor = Mesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    let camera = Camera::perspective(DVec3::ZERO, DVec3::Y, DVec3::Z, deg(90.0));
    for near in [1e-3, 0.5, 3.0] {
        let view = RasterView::new(&camera, 101, 101).unwrap().with_near(near).unwrap();
        let mut buffers = Buffers::new(&view);
        buffers.draw(&view.surface(&floor), 0, Facing::Front).unwrap();
        for y in 0..101 {
            for x in 0..101 {
                // Row y looks down by a slope; the floor is 1 below.
                let slope = (f64::from(y) + 0.5 - 50.5) / 50.5;
                let expected = (slope > 0.0 && 1.0 / slope > near).then(|| 1.0 / slope);
                match (buffers.depth(x, y), expected) {
                    (Some(a), Some(b)) => assert!((a / b - 1.0).abs() < 1e-4, "{y}: {a} {b}"),
                    (a, b) => assert_eq!(a, b, "{y}"),
                }
            }
        }
    }
}

#[test]
fn triangles_of_any_size_and_place() {
    // Huge ones whose picture is far larger than the view, and ones smaller than a pixel.
    let view = front(8.0, 40);
    let mut buffers = Buffers::new(&view);
    let huge = Mesh::new(
        vec![Vec3::new(-1e7, 1.0, -1e7), Vec3::new(1e7, 1.0, -1e7), Vec3::new(0.0, 1.0, 1e7)],
        vec![[0, 1, 2]],
    )
    .unwrap();
    buffers.draw(&view.surface(&huge), 0, Facing::Front).unwrap();
    assert!(buffers.depths().iter().all(|d| (d - 11.0).abs() < 1e-6));
    let tiny = Mesh::new(vec![Vec3::ZERO, Vec3::X * 1e-30, Vec3::Z * 1e-30], vec![[0, 1, 2], [0, 0, 1]]).unwrap();
    buffers.draw(&view.surface(&tiny), 1, Facing::Front).unwrap();
    assert!((0..40).all(|i| buffers.id(i, i).unwrap().operand == 0));
}

#[test]
fn a_depth_and_a_pixel_make_a_point() {
    let eye = DVec3::new(3.0, -4.0, 5.0);
    for camera in [
        Camera::perspective(eye, DVec3::ONE, DVec3::Z, deg(50.0)),
        Camera::orthographic(eye, DVec3::ONE, DVec3::Z, 7.0),
    ] {
        let view = RasterView::new(&camera, 640, 480).unwrap();
        for p in [DVec3::ZERO, DVec3::new(0.5, 1.0, -2.0)] {
            let [x, y, depth] = view.project(p);
            assert!((view.point(x, y, depth) - p).length() < 1e-12);
            let (o, d) = camera.ray(x, y, 640, 480);
            assert!((p - o).cross(d).length() < 1e-12);
            assert!((view.distance(x, y, depth) - (p - o).length()).abs() < 1e-12);
            assert_eq!(view.direction(x, y), d);
        }
    }
}

#[test]
fn errors() {
    let camera = Camera::perspective(DVec3::ONE, DVec3::ZERO, DVec3::Z, deg(40.0));
    let text = |result: Result<RasterView, RasterError>| result.unwrap_err().to_string();
    assert_eq!(text(RasterView::new(&camera, 0, 10)), "width is 0; allowed: 1 to 16384 pixels");
    assert_eq!(text(RasterView::new(&camera, 10, 16385)), "height is 16385; allowed: 1 to 16384 pixels");
    let blind = Camera { target: camera.eye, ..camera };
    let error = RasterView::new(&blind, 10, 10).unwrap_err();
    assert!(matches!(error, RasterError::Camera(CameraError { parameter: "target", .. })));
    let far = Camera { eye: DVec3::splat(1e200), ..camera };
    assert!(text(RasterView::new(&far, 10, 10)).starts_with("eye is ["));
    let view = RasterView::new(&camera, 10, 10).unwrap();
    assert_eq!(text(view.with_near(0.0)), "near is 0; allowed: 1e-60 to 1e60 with perspective");
    assert_eq!(text(view.with_near(f64::NAN)), "near is NaN; allowed: 1e-60 to 1e60 with perspective");
    front(1.0, 4).with_near(-3.0).unwrap();
    let mut buffers = Buffers::new(&view);
    let nothing = Mesh::default();
    let layers = view.surface(&nothing);
    assert!(matches!(
        buffers.draw(&layers, u32::MAX, Facing::Front),
        Err(RasterError::Setting { setting: "number", .. })
    ));
    let other = RasterView::new(&camera, 11, 10).unwrap();
    assert!(matches!(buffers.classify(&other.surface(&nothing)), Err(RasterError::Size { .. })));
    assert!(matches!(buffers.merge(&Buffers::new(&other)), Err(RasterError::Size { .. })));
}
