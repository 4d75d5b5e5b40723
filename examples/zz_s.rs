use rvachev::*;
fn main() {
    let c = Solid::cuboid([10.0; 3]);
    let two = c.clone() | c.translate([10.0, 4.0, 0.0]);
    let two1 = c.clone() | c.translate([10.0, 0.0, 0.0]);
    for s in [two1, two] {
        let c = s.slice(&Plane::xy(1.0)).unwrap().contours(1e-3).unwrap();
        for l in &c {
            println!("{} points {:?}", l.points().len(), &l.points()[..l.points().len().min(12)]);
        }
    }
}
