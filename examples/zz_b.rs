use glam::{DVec2, DVec3};
use rvachev::{Blend, Solid};
fn pins(rows: [u32; 2]) -> (Solid, Vec<(DVec3, f64)>) {
    let pitch = 0.7;
    let size = DVec2::new(f64::from(rows[0]), f64::from(rows[1])) * pitch;
    let plate = Solid::cuboid([size.x, size.y, 0.4]);
    let places = (0..rows[0]).flat_map(|i| (0..rows[1]).map(move |j| (i, j))).map(|(i, j)| {
        let middle = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) * pitch - 0.5 * size;
        (middle.extend(0.0), 0.1 + 0.05 * f64::from((7 * i + 3 * j) % 10) / 9.0)
    });
    (plate, places.collect())
}
fn main() {
    let (plate, places) = pins([6, 5]);
    let r = 0.05;
    let s = std::iter::once(plate.clone()).chain(places.iter().map(|(p, a)| Solid::cylinder(*a, 1.0).translate(*p)));
    let s = Solid::union_all_with(s, Blend::Fillet { radius: r });
    for &(place, a) in &places {
        for (side, up) in [(DVec3::X, 1.0), (DVec3::Y, -1.0), (-DVec3::X, 1.0), (-DVec3::Y, 1.0)] {
            let ball = place + (a + r) * side + up * (0.2 + r) * DVec3::Z;
            let towards = (-side - up * DVec3::Z).normalize();
            let (mut lo, mut hi) = (0.5, 1.3);
            for _ in 0..40 {
                let m: f64 = 0.5 * (lo + hi);
                if s.contains(ball + m * r * towards).unwrap() { hi = m } else { lo = m }
            }
            if (lo - 1.0).abs() > 0.003 { println!("{place} {a} {side} {up}: {lo}"); }
        }
    }
    println!("{:?}", s.bounds());
}
