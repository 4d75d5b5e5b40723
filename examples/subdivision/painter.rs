//! A small painter: shaded faces with a depth buffer, and lines.
//!
//! ```text
//!     view    what is seen, parallel to a direction      place   a view put into a panel
//!     canvas  colours and depths, twice as fine as the picture
//! ```

use glam::{DMat3, DVec2, DVec3};
use rvachev::{Image, error::ImageError, surface::QuadMesh};

/// Pixels of the canvas to a pixel of the picture, each way.
const FINE: u32 = 2;

const PAPER: [f64; 3] = [0.97, 0.97, 0.96];

/// The side from which light comes: from above, the left and the viewer.
const LIGHT: DVec3 = DVec3::new(-0.45, 0.55, 0.70);

/// A direction to look in, and what is to be seen.
pub struct View {
    /// Rows: to the right, up, towards the viewer.
    axes: DMat3,
    min: DVec2,
    max: DVec2,
}

impl View {
    /// Points of the plane, from above.
    pub fn of_plane(points: impl Iterator<Item = DVec2>) -> View {
        View::new(DMat3::IDENTITY, points.map(|p| p.extend(0.0)))
    }

    /// Points of space, from a corner above.
    pub fn of_space(points: impl Iterator<Item = DVec3>) -> View {
        let towards = DVec3::new(0.55, -0.75, 0.5).normalize();
        let right = DVec3::Z.cross(towards).normalize();
        View::new(DMat3::from_cols(right, towards.cross(right), towards).transpose(), points)
    }

    fn new(axes: DMat3, points: impl Iterator<Item = DVec3>) -> View {
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for p in points {
            let seen = (axes * p).truncate();
            (min, max) = (min.min(seen), max.max(seen));
        }
        View { axes, min, max }
    }
}

/// A view in a panel of a canvas.
pub struct Place {
    axes: DMat3,
    scale: f64,
    offset: DVec2,
}

impl Place {
    /// Across, down and towards the viewer, in pixels of the canvas.
    fn seen(&self, p: DVec3) -> DVec3 {
        let p = self.axes * p * self.scale;
        DVec3::new(self.offset.x + p.x, self.offset.y - p.y, p.z)
    }
}

pub struct Canvas {
    width: u32,
    height: u32,
    colors: Vec<[f64; 3]>,
    depths: Vec<f64>,
}

impl Canvas {
    /// A canvas for a picture of so many pixels.
    pub fn new(width: u32, height: u32) -> Canvas {
        let (width, height) = (FINE * width, FINE * height);
        let count = (width * height) as usize;
        Canvas { width, height, colors: vec![PAPER; count], depths: vec![f64::NEG_INFINITY; count] }
    }

    /// Puts a view into one of several panels, side by side.
    pub fn panel(&self, index: u32, of: u32, view: &View) -> Place {
        let size = DVec2::new(f64::from(self.width) / f64::from(of), f64::from(self.height));
        let scale = (0.9 * size / (view.max - view.min)).min_element();
        let middle = 0.5 * (view.min + view.max) * scale;
        let center = DVec2::new(size.x * (f64::from(index) + 0.5), 0.5 * size.y);
        Place { axes: view.axes, scale, offset: DVec2::new(center.x - middle.x, center.y + middle.y) }
    }

    fn paint(&mut self, x: i64, y: i64, color: [f64; 3], share: f64) {
        if (0..i64::from(self.width)).contains(&x) && (0..i64::from(self.height)).contains(&y) {
            let pixel = &mut self.colors[(y * i64::from(self.width) + x) as usize];
            for (c, new) in pixel.iter_mut().zip(color) {
                *c += (new - *c) * share;
            }
        }
    }

    /// A straight line `width` pixels of the picture wide; what lies behind faces is faint, unless
    /// all is to be seen.
    fn line(&mut self, from: DVec3, to: DVec3, color: [f64; 3], width: f64, all: bool) {
        let radius = 0.5 * width * f64::from(FINE);
        let along = (to - from).truncate();
        let length_squared = along.length_squared().max(1e-12);
        let min = from.truncate().min(to.truncate()) - radius - 1.0;
        let max = from.truncate().max(to.truncate()) + radius + 1.0;
        for y in min.y as i64..=max.y as i64 {
            for x in min.x as i64..=max.x as i64 {
                let p = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let t = ((p - from.truncate()).dot(along) / length_squared).clamp(0.0, 1.0);
                let distance = p.distance(from.truncate() + along * t);
                let cover = (radius + 0.5 - distance).clamp(0.0, 1.0);
                if cover == 0.0 || x < 0 || y < 0 || x >= i64::from(self.width) || y >= i64::from(self.height) {
                    continue;
                }
                let depth = from.z + (to.z - from.z) * t;
                let hidden = self.depths[(y * i64::from(self.width) + x) as usize] > depth + 3.0;
                self.paint(x, y, color, cover * if hidden { if all { 0.35 } else { 0.0 } } else { 1.0 });
            }
        }
    }

    /// A chain of lines.
    pub fn polyline(&mut self, place: &Place, points: &[DVec3], closed: bool, color: [f64; 3], width: f64) {
        let seen: Vec<DVec3> = points.iter().map(|&p| place.seen(p)).collect();
        for pair in seen.windows(2) {
            self.line(pair[0], pair[1], color, width, true);
        }
        if let (true, Some(&first), Some(&last)) = (closed, seen.first(), seen.last()) {
            self.line(last, first, color, width, true);
        }
    }

    /// A dot at each point.
    pub fn dots(&mut self, place: &Place, points: &[DVec3], color: [f64; 3]) {
        for &p in points {
            let seen = place.seen(p);
            self.line(seen, seen, color, 6.0, true);
        }
    }

    /// The edges of a mesh; hidden ones faint if `all` are wanted, else not at all.
    pub fn edges(&mut self, place: &Place, mesh: &QuadMesh, color: [f64; 3], all: bool) {
        let seen: Vec<DVec3> = mesh.positions().iter().map(|&p| place.seen(p)).collect();
        let quads = mesh.quads().iter().map(|quad| quad.as_slice());
        let mut edges: Vec<[u32; 2]> = vec![];
        for face in quads.chain(mesh.triangles().iter().map(|triangle| triangle.as_slice())) {
            for i in 0..face.len() {
                let (a, b) = (face[i], face[(i + 1) % face.len()]);
                edges.push([a.min(b), a.max(b)]);
            }
        }
        edges.sort_unstable();
        edges.dedup();
        for [a, b] in edges {
            self.line(seen[a as usize], seen[b as usize], color, 1.2, all);
        }
    }

    /// The faces of a mesh: smooth if it has normals, else flat.
    pub fn faces(&mut self, place: &Place, mesh: &QuadMesh, color: [f64; 3]) {
        let positions = mesh.positions();
        let mut triangle = |corners: [u32; 3], normals: Option<[DVec3; 3]>| {
            let at = corners.map(|i| positions[i as usize]);
            let flat = (at[1] - at[0]).cross(at[2] - at[0]).normalize_or_zero();
            self.triangle(at.map(|p| place.seen(p)), normals.unwrap_or([flat; 3]).map(|n| place.axes * n), color);
        };
        for (i, &[a, b, c, d]) in mesh.quads().iter().enumerate() {
            let normals = mesh.quad_corners().get(i).map(|corners| corners.map(|corner| corner.normal));
            triangle([a, b, c], normals.map(|n| [n[0], n[1], n[2]]));
            triangle([a, c, d], normals.map(|n| [n[0], n[2], n[3]]));
        }
        for (i, &corners) in mesh.triangles().iter().enumerate() {
            triangle(corners, mesh.triangle_corners().get(i).map(|c| c.map(|corner| corner.normal)));
        }
    }

    fn triangle(&mut self, seen: [DVec3; 3], normals: [DVec3; 3], color: [f64; 3]) {
        let [a, b, c] = seen.map(|p| p.truncate());
        let area = (b - a).perp_dot(c - a);
        if area == 0.0 {
            return;
        }
        let clamp = |v: f64, limit: u32| v.clamp(0.0, f64::from(limit)) as u32;
        let (min, max) = (a.min(b).min(c), a.max(b).max(c));
        for y in clamp(min.y, self.height)..clamp(max.y + 1.0, self.height) {
            for x in clamp(min.x, self.width)..clamp(max.x + 1.0, self.width) {
                let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let u = (c - b).perp_dot(p - b) / area;
                let v = (a - c).perp_dot(p - c) / area;
                let w = 1.0 - u - v;
                if u < 0.0 || v < 0.0 || w < 0.0 {
                    continue;
                }
                let depth = u * seen[0].z + v * seen[1].z + w * seen[2].z;
                let index = (y * self.width + x) as usize;
                if depth > self.depths[index] {
                    let normal = (u * normals[0] + v * normals[1] + w * normals[2]).normalize_or_zero();
                    // Insides are seen where a surface is open.
                    let normal = if normal.z < 0.0 { -normal } else { normal };
                    let light = 0.35 + 0.65 * normal.dot(LIGHT.normalize()).max(0.0);
                    self.depths[index] = depth;
                    self.colors[index] = color.map(|c| c * light);
                }
            }
        }
    }

    /// The picture.
    pub fn image(&self) -> Result<Image, ImageError> {
        let (width, height) = (self.width / FINE, self.height / FINE);
        let mean = |x: u32, y: u32, channel: usize| {
            let fine = (0..FINE * FINE).map(|k| (FINE * x + k % FINE, FINE * y + k / FINE));
            let sum: f64 = fine.map(|(x, y)| self.colors[(y * self.width + x) as usize][channel]).sum();
            (255.0 * sum / f64::from(FINE * FINE)).round() as u8
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let pixels = pixels.map(|(x, y)| [mean(x, y, 0), mean(x, y, 1), mean(x, y, 2), 255]).collect();
        Image::new(width, height, pixels)
    }
}
