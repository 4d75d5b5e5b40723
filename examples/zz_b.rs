use glam::DVec3;
use rvachev::{deg, Blend, Solid, RFunction};
fn main() {
    let pipe = Solid::cylinder(1.0, 9.0).rotate_y(deg(90.0));
    let thin = Solid::cylinder(0.6, 9.0);
    for leg in [0.02, 0.024, 0.03, 0.05, 0.1] {
        let part = pipe.difference_with(&thin, Blend::Chamfer { leg });
        let plain = pipe.difference(&thin, RFunction::MIN_MAX);
        let ball = plain.offset(-16.0 * leg);
        println!("{leg}: {:?}", ball.bounds());
        for q in [DVec3::new(0.61, 0.0, 0.99), DVec3::new(0.62, 0.0, 0.99), DVec3::new(0.605, 0.0, 0.995)] {
            println!("{:?} {:?} {:?}", part.value(q), plain.value(q), ball.value(q));
        }
    }
}
