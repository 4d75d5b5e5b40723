use rvachev::{Blend, Solid};
fn main() {
    let s = Solid::cuboid([10.0, 10.0, 5.0])
        .translate([5.0, 5.0, 0.0])
        .union_with(Solid::cuboid([10.0, 20.0, 5.0]).translate([15.0, 10.0, 0.0]), Blend::Fillet { radius: 2.0 });
    for z in [0.0, 1.0, 2.0, 2.4, -1.3] {
        for ang in [0.3f64, 0.6, 0.785, 1.2] {
            let (mut lo, mut hi) = (1.5, 2.6);
            let d = [ang.cos(), -ang.sin()];
            for _ in 0..50 {
                let m: f64 = 0.5 * (lo + hi);
                if s.contains([8.0 + m * d[0], 12.0 + m * d[1], z]).unwrap() { hi = m } else { lo = m }
            }
            print!("{:.5} ", lo);
        }
        println!();
    }
    let two =
        Solid::cuboid([10.0; 3]).translate([-5.0, 0.0, 0.0]) | Solid::cuboid([10.0; 3]).translate([5.0, 0.0, 0.0]);
    let sh = two.shell(1.0);
    println!("{:?} {:?} {:?}", sh.value([0.0; 3]), sh.value([0.0, 4.5, 0.0]), two.value([0.0; 3]));
}
