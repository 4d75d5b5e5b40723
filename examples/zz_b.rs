use glam::DVec3;
use rvachev::Solid;
fn main() {
    let two =
        Solid::cuboid([10.0; 3]).translate([-5.0, 0.0, 0.0]) | Solid::cuboid([10.0; 3]).translate([5.0, 0.0, 0.0]);
    for d in [DVec3::X, DVec3::Z, DVec3::new(1.0, 0.3, 0.1).normalize()] {
        println!("{:?}", two.raycast(-20.0 * d + DVec3::new(1.0, 0.2, 0.1), d));
    }
    let t = std::time::Instant::now();
    let mut s = Solid::sphere(1.0);
    for i in 0..6 {
        s = s.shell(0.01);
        println!("{i} {:?} {:?}", s.value([0.2, 0.1, 0.3]), t.elapsed());
    }
}
