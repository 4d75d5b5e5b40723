use glam::DVec3;
use rvachev::{Blend, Bounds, CellSize, MeshSettings, Run, Solid};
fn main() {
    let cube = Solid::cuboid(DVec3::splat(2.0));
    let boss = cube.union_with(Solid::cylinder(0.6, 4.0), Blend::Fillet { radius: 0.2 });
    let settings = MeshSettings { cell: CellSize::LongestSide(64), ..MeshSettings::default() };
    let r = boss.thin_features(&settings, &Run::default()).unwrap();
    println!("{} {}", r.cells, r.count);
    for p in r.places.iter().take(6) {
        println!("{p:?}");
    }
    let program = boss.surface_program().unwrap();
    let b = Bounds::new(r.places[0].position - 0.01, r.places[0].position + 0.01);
    let c = b.center();
    let h = 4.0 / 128.0;
    for h in [0.0001, 0.001, 0.01, 0.02, 0.03] {
        let reg = Bounds::new(c - h, c + h);
        println!("{h} {:?}", program.range(&reg));
    }
    for q in [c, b.min + h, DVec3::new(0.74, 0.0, 1.03), DVec3::new(0.62, 0.0, 1.15), DVec3::new(0.66, 0.0, 1.06)] {
        let reg = Bounds::new(q - h, q + h);
        println!(
            "{q} {:?} leaves {} {:?}",
            program.range(&reg),
            match program.narrow(&reg) {
                rvachev::program::Region::Surface(p) => p.leaf_count() as i32,
                _ => -1,
            },
            program.value(q)
        );
    }
}
