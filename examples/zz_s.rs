use rvachev::*;
use std::time::Instant;
fn run(name: &str, make: impl Fn() -> Solid, z: f64, tol: f64) {
    let t = Instant::now();
    let s = make();
    let _ = s.bounds().unwrap();
    let c0 = t.elapsed();
    let slice = s.slice(&Plane::xy(z)).unwrap();
    let t = Instant::now();
    let c = slice.contours(tol).unwrap();
    println!(
        "{name:22} compile {:8.1?} contours {:9.1?} lines {} points {} area {:.4} unresolved {}",
        c0,
        t.elapsed(),
        c.len(),
        c.iter().map(|l| l.points().len()).sum::<usize>(),
        c.area(),
        c.unresolved()
    );
}
fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().unwrap();
    let only = std::env::args().nth(1);
    let on = |n: &str| only.as_deref().is_none_or(|o| n.contains(o));
    macro_rules! go {
        ($n:expr, $m:expr, $z:expr, $t:expr) => {
            if on($n) {
                run($n, || $m, $z, $t)
            }
        };
    }
    go!(
        "plate",
        Solid::cuboid([600.0, 400.0, 2.0])
            - Solid::cylinder(1.5, 20.0).repeat([58, 38, 1], [10.0, 10.0, 1.0]).translate([-285.0, -185.0, 0.0]),
        0.0,
        0.01
    );
    go!(
        "slot",
        (Profile::rectangle([600.0, 400.0]) - Profile::rectangle([500.0, 1.5]).rotate(rad(0.3))).extrude(1.0),
        0.0,
        0.01
    );
    go!("sphere", Solid::sphere(1.0), 0.0, 1e-4);
    go!("superellipsoid", Solid::superellipsoid([30.0, 20.0, 10.0], 0.3, 0.4), 0.1, 1e-3);
    go!("se cusp", Solid::superellipsoid([1.0, 0.8, 0.6], 2.5, 2.5), 0.1, 1e-3);
    let g = |m, n1, n2, n3| Gielis::new(m, n1, n2, n3);
    go!("supershape s1", Solid::from(Supershape::new(g(6.0, 1.0, 1.7, 1.7), g(6.0, 1.0, 1.7, 1.7))), 0.1, 1e-3);
    go!("supershape s5", Solid::from(Supershape::new(g(24.0, 0.3, 1.7, 1.7), g(4.0, 2.0, 2.0, 2.0))), 0.1, 1e-3);
    go!(
        "gyroid",
        Solid::from(SheetLattice { surface: MinimalSurface::Gyroid, cell: 1.0, thickness: 0.1 }) & Solid::sphere(5.0),
        0.1,
        1e-3
    );
    go!("twisted", Solid::superellipsoid([30.0, 20.0, 40.0], 0.3, 0.4).twist(rad(0.02)), 0.1, 1e-3);
    go!(
        "smooth",
        Solid::cuboid([2.0, 2.0, 0.4])
            .union_with(Solid::superellipsoid([0.5, 0.5, 1.0], 0.3, 0.7), Blend::Smooth { radius: 0.15 }),
        0.1,
        1e-4
    );
    go!(
        "fillet",
        Solid::cuboid([2.0, 2.0, 0.4]).union_with(Solid::cylinder(0.5, 2.0), Blend::Fillet { radius: 0.15 }),
        0.25,
        1e-4
    );
    go!(
        "chamfer",
        Solid::cuboid([2.0, 2.0, 0.4]).union_with(Solid::cylinder(0.5, 2.0), Blend::Chamfer { leg: 0.15 }),
        0.25,
        1e-4
    );
    go!("shell", (Solid::cuboid([20.0, 14.0, 8.0]) | Solid::cylinder(5.0, 14.0)).shell(1.0), 0.5, 1e-2);
    go!("shell fine", (Solid::cuboid([20.0, 14.0, 8.0]) | Solid::cylinder(5.0, 14.0)).shell(1.0), 0.5, 1e-3);
    go!("rounded", (Solid::cuboid([20.0, 14.0, 8.0]) | Solid::cylinder(5.0, 14.0)).rounded(1.0), 3.5, 1e-3);
    go!("shell twisted", Solid::superellipsoid([30.0, 20.0, 40.0], 0.3, 0.4).twist(rad(0.02)).shell(1.0), 0.1, 1e-3);
    go!(
        "tower",
        Solid::cuboid([20.0, 20.0, 10.0]) | Solid::cuboid([20.0, 20.0, 10.0]).translate([0.0, 0.0, 10.0]),
        5.0,
        1e-6
    );
    go!("cyl tower", Solid::cylinder(20.0, 10.0) | Solid::cone(20.0, 5.0, 10.0).translate([0.0, 0.0, 10.0]), 5.0, 1e-4);
    go!(
        "L tower",
        Profile::polygon([[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [4.0, 4.0], [4.0, 10.0], [0.0, 10.0]]).extrude(10.0)
            | Solid::cuboid([2.0, 2.0, 10.0]).translate([1.0, 1.0, 10.0]),
        5.0,
        1e-5
    );
    go!(
        "polygon 20000",
        {
            let n = 20000;
            Profile::polygon(
                (0..n)
                    .map(|i| {
                        let t = i as f64 / n as f64 * std::f64::consts::TAU;
                        let r = 1.0 + 0.15 * (40.0 * t).sin() + 0.02 * (1000.0 * t).sin();
                        [r * t.cos(), r * t.sin()]
                    })
                    .collect::<Vec<_>>(),
            )
            .extrude(0.5)
        },
        0.1,
        1e-4
    );
    go!("supertoroid", Solid::from(Torus { radius: 2.0, tube: 0.5 }), 0.1, 1e-4);
    go!("se bottom", Solid::superellipsoid([1.0, 1.0, 1.0], 0.1, 0.1), 1.0, 1e-4);
    go!("sphere top", Solid::sphere(1.0), 1.0, 1e-4);
    go!("plug", (Solid::cuboid([10.0; 3]) - Solid::cylinder(3.0, 10.0)) | Solid::cylinder(3.0, 10.0), 1.0, 1e-3);
    go!("plug 2", (Solid::cuboid([10.0; 3]) - Solid::cylinder(3.0, 10.0)) | Solid::cylinder(3.0, 12.0), 1.0, 1e-3);
    go!("bent", Solid::cuboid([2.0, 1.0, 10.0]).bend(0.1, rad(3.0)), 0.1, 1e-3);
    go!("torus tangent", Solid::from(Torus { radius: 2.0, tube: 0.5 }), 0.5, 1e-4);
}
