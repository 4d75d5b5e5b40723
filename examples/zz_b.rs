use rvachev::{deg, Solid};
fn main() {
    let two = Solid::cuboid([2.0; 3]).translate([-1.0, 0.0, 0.0]) | Solid::cuboid([2.0; 3]).translate([1.0, 0.0, 0.0]);
    let t = std::time::Instant::now();
    let r = two.rounded(0.2).rotate_z(deg(20.0)).scale(2.5);
    println!("{:?} {:?}", r.bounds(), t.elapsed());
    let r = r.offset(0.05);
    println!("{:?} {:?}", r.bounds(), t.elapsed());
    // lattice
    let lattice = rvachev::NetworkLattice { surface: rvachev::MinimalSurface::SchwarzP, cell: 0.3, fraction: 0.7 };
    let s = Solid::new(lattice).shell(0.02);
    println!("{:?} {:?}", s.value([0.1, 0.2, 0.3]), t.elapsed());
    println!("{:?} {:?}", s.value([5.1, 0.2, 0.3]), t.elapsed());
}
