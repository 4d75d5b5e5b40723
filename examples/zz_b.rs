//! Scratch.
use rvachev::{CellSize, MeshSettings, Solid};
fn main() {
    for r in [1.52, 1.55, 1.6, 1.7, 1.8, 1.9] {
        let t = std::time::Instant::now();
        let s = (Solid::cuboid([14.0, 9.0, 4.0]) - Solid::cylinder(r, 20.0)).filleted(1.5);
        let c = s.contains([r - 0.03, 0.0, 0.0]);
        let t1 = t.elapsed();
        let m = s.mesh(&MeshSettings { cell: CellSize::LongestSide(100), ..MeshSettings::default() }).unwrap();
        println!("{r}: {c:?} {t1:?} volume {} of {}", m.volume(), 14.0 * 9.0 * 4.0 - 4.0 * std::f64::consts::PI * r * r);
    }
    for w in [3.05, 3.1, 4.0] {
        let t = std::time::Instant::now();
        let s = (Solid::cuboid([20.0; 3]) | Solid::cuboid([w, 40.0, 10.0])).rounded(1.5);
        println!("{w} {:?} {:?}", s.contains([1.495, 15.0, 0.0]), t.elapsed());
        let t = std::time::Instant::now();
        let s = (Solid::cuboid([14.0, 9.0, 4.0]) - Solid::cuboid([w, 20.0, 20.0])).filleted(1.5);
        println!("{w} {:?} {:?}", s.contains([0.5 * w - 0.01, 0.0, 0.0]), t.elapsed());
    }
}
