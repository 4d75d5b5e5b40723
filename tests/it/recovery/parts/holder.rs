use rvachev::{RFunction, Solid};

pub fn holder() -> Solid {
    let length = 12.7;
    let cylinder_1_length = 6.35;
    let cut_cylinder_1_length = 9.525;
    let x = 22.225;
    // cylinder, ⌀ 76.2, 12.7 high; 63.2 % of the surface
    let cylinder_1 = Solid::cylinder(38.1, length)
        .translate([0.0, 0.0, cylinder_1_length])
        .named("cylinder 1");
    // hole, ⌀ 25.4, 7.9375 deep, 4 of them on a circle, ⌀ 44.45; 24.8 % of the surface
    let cut_cylinder_1 = Solid::cylinder(length, cut_cylinder_1_length)
        .translate([x, 0.0, cut_cylinder_1_length])
        .named("cut cylinder 1");
    // hole, ⌀ 12.7, through; 3.7 % of the surface
    let cut_cylinder_3 = Solid::cylinder(cylinder_1_length, 15.875)
        .translate([0.0, 0.0, cylinder_1_length])
        .named("cut cylinder 3");
    // hole, ⌀ 19.05, through, 4 of them on a circle, ⌀ 44.45; 8.4 % of the surface
    let cut_cylinder_6 = Solid::cylinder(cut_cylinder_1_length, 7.9375)
        .translate([x, 0.0, 2.38125])
        .named("cut cylinder 6");
    let parts = [
        cut_cylinder_1.repeat_polar(4),
        cut_cylinder_3,
        cut_cylinder_6.repeat_polar(4),
    ];
    cylinder_1.difference_all(parts, RFunction::MIN_MAX)
}
