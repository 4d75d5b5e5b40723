//! The edges of shadows, and the dark in corners.

use glam::{DVec2, DVec3};
use rvachev::{Background, Camera, Image, Profile, RenderSettings, Solid, Style, deg, layers::Transfer};

/// Pixels per length unit of the pictures here.
const SCALE: f64 = 10.0;
const SIDE: u32 = 400;

/// The angle that walls and ribs are turned by, out of the axes of the grid that light is traced
/// in.
const TURN: f64 = 25.0;

fn plate() -> Solid {
    Solid::cuboid([40.0, 40.0, 2.0]).translate([0.0, 0.0, -1.0])
}

/// Seen from above; nothing but the light that is asked for.
fn picture(solid: &Solid, softness: f64, (shadows, occlusion): (bool, bool)) -> Image<[f32; 4]> {
    picture_from([0.0, 0.0, 50.0], DVec3::Y, solid, softness, (shadows, occlusion))
}

/// The same from another side.
fn picture_from(
    eye: [f64; 3],
    up: DVec3,
    solid: &Solid,
    softness: f64,
    (shadows, occlusion): (bool, bool),
) -> Image<[f32; 4]> {
    let camera = Camera::orthographic(eye, DVec3::ZERO, up, f64::from(SIDE) / SCALE);
    let settings = RenderSettings {
        width: SIDE,
        height: SIDE,
        samples: 1,
        style: Style::Clay,
        shadows,
        occlusion,
        softness: deg(softness),
        transfer: Transfer::Srgb,
        background: Background::Plain([0; 3]),
        ground: false,
        ..RenderSettings::default()
    };
    solid.scene().unwrap().light(&camera, &settings, &Default::default()).unwrap()
}

/// The light at a point of the plane of the picture, between the middles of pixels.
fn light(image: &Image<[f32; 4]>, p: DVec2) -> f64 {
    let at = DVec2::new(0.5 * f64::from(SIDE) + SCALE * p.x, 0.5 * f64::from(SIDE) - SCALE * p.y) - 0.5;
    let (low, part) = (at.floor(), at - at.floor());
    let value = |dx: f64, dy: f64| f64::from(image.pixel((low.x + dx) as u32, (low.y + dy) as u32).unwrap()[1]);
    let row = |dy: f64| value(0.0, dy) * (1.0 - part.x) + value(1.0, dy) * part.x;
    row(0.0) * (1.0 - part.y) + row(1.0) * part.y
}

/// How far the edge of a shadow strays from a straight line, in pixels. The edge is where the light
/// is half of that between the ends of lines from `start` + s·`along`, s in `range`, to `across`
/// beyond them.
fn strays(image: &Image<[f32; 4]>, (start, along, across): (DVec2, DVec2, DVec2), range: [f64; 2]) -> f64 {
    let count = ((range[1] - range[0]) * SCALE) as usize;
    let places: Vec<DVec2> = (0..=count)
        .map(|i| {
            let from = start + (range[0] + i as f64 / SCALE) * along;
            let at = |k: f64| light(image, from + k * across);
            let half = 0.5 * (at(0.0) + at(1.0));
            let steps = (across.length() * SCALE) as usize;
            let step = (1..=steps).find(|k| at(*k as f64 / steps as f64) > half).expect("the far end is lit");
            let (low, high) = ((step - 1) as f64 / steps as f64, step as f64 / steps as f64);
            let share = (half - at(low)) / (at(high) - at(low));
            DVec2::new(i as f64, (low + share * (high - low)) * across.length() * SCALE)
        })
        .collect();
    let mean = places.iter().sum::<DVec2>() / places.len() as f64;
    let slope = places.iter().map(|p| (p.x - mean.x) * (p.y - mean.y)).sum::<f64>()
        / places.iter().map(|p| (p.x - mean.x).powi(2)).sum::<f64>();
    places.iter().map(|p| (p.y - mean.y - slope * (p.x - mean.x)).abs()).fold(0.0, f64::max)
}

#[test]
fn edges_of_shadows_are_straight() {
    let (along, out) = (DVec2::from_angle(TURN.to_radians()), -DVec2::from_angle((TURN + 90.0).to_radians()));
    let wall = Solid::cuboid([16.0, 2.0, 6.0]).translate([0.0, 0.0, 3.0]).rotate_z(deg(TURN));
    // From (−8, 0) up to (8, 8) along its own length.
    let rib = Profile::polygon([[-8.0, -0.5], [8.0, -0.5], [8.0, 8.0]]).extrude(1.5).rotate_x(deg(90.0));
    let rib = rib.rotate_z(deg(TURN));
    // The softer it is, the less a ray more or less tells where the edge is.
    for (softness, most) in [(3.0, 0.7), (14.0, 0.8)] {
        let image = picture(&(plate() | wall.clone()), softness, (true, false));
        let found = strays(&image, (1.6 * out, along, 11.0 * out), [-4.0, 6.0]);
        assert!(found < most, "of a wall: {found:.2} pixels, {softness}°");
        let image = picture(&(plate() | rib.clone()), softness, (true, false));
        let found = strays(&image, (1.2 * out, along, 14.0 * out), [-2.0, 6.0]);
        assert!(found < most, "of a rib: {found:.2} pixels, {softness}°");
    }
}

/// At the same distance from a crease it is equally dark.
#[test]
fn corners_are_evenly_dark() {
    let wall = Solid::cuboid([20.0, 2.0, 6.0]).translate([0.0, 0.0, 3.0]).rotate_z(deg(TURN));
    let image = picture(&(plate() | wall), 14.0, (false, true));
    let (along, out) = (DVec2::from_angle(TURN.to_radians()), -DVec2::from_angle((TURN + 90.0).to_radians()));
    for pixels in [1.5, 3.0, 6.0, 12.0] {
        let values: Vec<f64> =
            (-40..=40).map(|i| light(&image, (1.0 + pixels / SCALE) * out + f64::from(i) / SCALE * along)).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let deviation = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt();
        assert!(deviation < 0.012 * mean, "{pixels} pixels off: {:.1} % of the light", 100.0 * deviation / mean);
    }
}

/// A formula that jumps, clipped to a box: of its front no part hides light from another.
#[cfg(feature = "formula")]
#[test]
fn faces_that_end_at_jumps_are_evenly_lit() {
    let (x, _, z) = fidget::context::Tree::axes();
    let half = DVec3::new(20.0, 12.0, 12.0);
    let saw = Solid::formula(&(z - x.modulo(8.0)), rvachev::Bounds::from_center(DVec3::ZERO, half))
        & Solid::cuboid(1.9 * half);
    for light in [(true, false), (false, true)] {
        let image = picture_from([0.0, -50.0, 0.0], DVec3::Z, &saw, 10.0, light);
        let mut lit: Vec<f32> = image.pixels().iter().map(|p| p[0]).filter(|light| *light > 1e-3).collect();
        lit.sort_unstable_by(f32::total_cmp);
        let usual = lit[lit.len() / 2];
        let dark = lit.iter().filter(|light| **light < 0.97 * usual).count();
        assert!(lit.len() > 50_000 && dark == 0, "{dark} of {} pixels are dark", lit.len());
    }
}
