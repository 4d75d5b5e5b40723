use rvachev::{Blend, CellSize, MeshSettings, Profile, Solid};
use std::time::Instant;
fn show(name: &str, s: &Solid, cells: u32) {
    let t = Instant::now();
    let b = s.bounds();
    let t1 = t.elapsed().as_secs_f64();
    let b = match b {
        Ok(b) => b,
        Err(e) => {
            println!("{name}: {e}");
            return;
        }
    };
    if b.is_empty() {
        println!("{name}: empty ({t1:.3})");
        return;
    }
    let t = Instant::now();
    match s.mesh(&MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() }) {
        Ok(m) => {
            let r = m.check();
            println!(
                "{name}: volume {:.4} shells {} euler {} closed {} tris {} lost {} box {:.4?} {:.4?} compile {t1:.3} mesh {:.3}",
                m.volume(),
                r.shells,
                r.euler_characteristic,
                r.is_closed(),
                m.triangles().len(),
                m.possibly_lost(),
                m.bounds().min.to_array(),
                m.bounds().max.to_array(),
                t.elapsed().as_secs_f64()
            );
        }
        Err(e) => println!("{name}: {e}"),
    }
}
fn main() {
    let arg = std::env::args().nth(1).unwrap_or_default();
    let c = Solid::cuboid([10.0; 3]);
    let two = c.translate([-5.0, 0.0, 0.0]) | c.translate([5.0, 0.0, 0.0]);
    let n = 100;
    let l = Profile::polygon([[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [4.0, 4.0], [4.0, 10.0], [0.0, 10.0]]);
    let bottle = Solid::cylinder(20.0, 40.0) | Solid::cylinder(8.0, 20.0).translate([0.0, 0.0, 30.0]);
    let se = Solid::superellipsoid([30.0, 20.0, 10.0], 0.3, 0.4);
    let tw = Solid::superellipsoid([30.0, 20.0, 40.0], 0.3, 0.4).twist(rvachev::rad(0.02));
    let f = Blend::Fillet { radius: 2.0 };
    let cases: Vec<(&str, Solid)> = vec![
        ("two plain", two.clone()),
        ("two shell 848", two.shell(1.0)),
        ("two offset-1 1152", two.offset(-1.0)),
        ("cube open 2 907.705", c.offset(-2.0).offset(2.0)),
        ("cube open 5.5 empty", c.offset(-5.5).offset(5.5)),
        ("cube close 2 1000", c.offset(2.0).offset(-2.0)),
        ("L close 2 64.858*10", l.offset(2.0).offset(-2.0).extrude(10.0)),
        ("L open 1.5 61.586*10", l.offset(-1.5).offset(1.5).extrude(10.0)),
        ("L shell 1", l.shell(1.0).extrude(10.0)),
        ("bottle shell", bottle.shell(1.5)),
        ("se", se.clone()),
        ("se shell", se.shell(1.0)),
        ("tw", tw.clone()),
        ("tw shell", tw.shell(1.0)),
        ("twist offset", Solid::cuboid([2.0, 2.0, 4.0]).twist(rvachev::rad(1.0)).offset(0.1)),
        (
            "flush l fillet 1504.292",
            Solid::cuboid([10.0, 10.0, 5.0])
                .translate([5.0, 5.0, 0.0])
                .union_with(Solid::cuboid([10.0, 20.0, 5.0]).translate([15.0, 10.0, 0.0]), f),
        ),
    ];
    let fr = |radius| Blend::Fillet { radius };
    let rim = Profile::circle(20.0)
        .column()
        .intersection_with(Solid::slab([0.0, 0.0, 1.0], 30.0), f)
        .difference_with(Solid::sphere(14.0).translate([20.0, 0.0, 0.0]), f);
    let plate = Solid::cuboid([60.0, 40.0, 4.0]);
    let post = Solid::cylinder(6.0, 30.0).translate([0.0, 0.0, 15.0]);
    let rib = Solid::cuboid([40.0, 4.0, 20.0]).translate([10.0, 0.0, 10.0]);
    let three = plate.union_with(&post, fr(3.0)).union_with(&rib, fr(2.0));
    let mut chain = Solid::cuboid([32.2, 2.0, 1.0]).translate([15.6, 0.0, 0.0]);
    for i in 0..39 {
        chain = chain.union_with(Solid::cylinder(0.3, 2.0).translate([i as f64 * 0.8, 0.0, 0.5]), fr(0.1));
    }
    let flush_c =
        |b| Solid::cuboid([10.0, 10.0, 10.0]).translate([5.0, 5.0, 0.0]).union_with(Solid::cylinder(5.0, 10.0), b);
    let pins = |n: usize| {
        let k = (n as f64).sqrt().ceil() as usize;
        let w = 0.6 * k as f64;
        let mut all = vec![Solid::cuboid([w, w, 0.4])];
        for i in 0..n {
            let (x, y) = ((i % k) as f64, (i / k) as f64);
            all.push(Solid::cylinder(0.1 + 0.05 * ((i * 7) % 10) as f64 / 10.0, 1.0).translate([
                -0.5 * w + 0.6 * (x + 0.5),
                -0.5 * w + 0.6 * (y + 0.5),
                0.0,
            ]));
        }
        Solid::union_all_with(all, fr(0.05))
    };
    let gear = || {
        let n = 96;
        Profile::polygon((0..n).map(|i| {
            let a = i as f64 / n as f64 * std::f64::consts::TAU;
            let r = if (i / 3) % 2 == 0 { 10.0 } else { 8.5 };
            [r * a.cos(), r * a.sin()]
        }))
    };
    let mut cases = cases;
    cases.extend([
        ("flush c fillet top 5", flush_c(f)),
        ("flush c chamfer top 5", flush_c(Blend::Chamfer { leg: 2.0 })),
        ("flush c smooth", flush_c(Blend::Smooth { radius: 2.0 })),
        ("cube rounded 2 907.705", c.rounded(2.0)),
        ("L filleted 2 64.858*10", l.filleted(2.0).extrude(10.0)),
        ("two filleted 2000", two.filleted(2.0)),
        ("rim", rim),
        ("three", three.clone()),
        ("chain", chain),
        ("pins 10", pins(10)),
        ("pins 100", pins(100)),
        ("pins 1000", pins(1000)),
        ("gear rounded", gear().extrude(5.0).rounded(0.5)),
        ("se rounded", se.rounded(1.0)),
        ("bracket filleted", l.extrude(5.0).filleted(2.0).rounded(1.0)),
    ]);
    for (name, s) in &cases {
        if name.contains(&arg) {
            show(name, s, n);
        }
    }
    println!("bottle open at [0,0,20]: {:?}", bottle.shell(1.5).contains([0.0, 0.0, 20.0]));
}
