use rvachev::error::FormulaError;
use rvachev::glam::{DAffine2, DAffine3};
use rvachev::law::{LinearLaw, SineWave, SmoothStep};
use rvachev::{
    Blend, Bounds, Caps, Extrusion, Formula, GeneralisedSuperquadric, Gielis, Helix,
    MinimalSurface, NetworkLattice, Paint, Polygon, Profile, RFunction, Radius, SheetLattice,
    Solid, Superhyperboloid, Supershape, Turns, deg, rad,
};

pub fn sphere() -> Solid {
    Solid::sphere(1.0)
}

pub fn cuboid() -> Solid {
    Solid::cuboid([4.0, 2.0, 1.0])
}

pub fn rounded_cuboid() -> Solid {
    let size = 2.0;
    Solid::rounded_cuboid([4.0, size, size], 0.5)
}

pub fn cylinder() -> Solid {
    Solid::cylinder(1.0, 3.0)
}

pub fn cone() -> Solid {
    Solid::cone(3.0, 0.0, 4.0)
}

pub fn capsule() -> Solid {
    Solid::capsule(1.0, 6.0)
}

pub fn torus() -> Solid {
    Solid::torus(3.0, 1.0)
}

pub fn ellipsoid() -> Solid {
    Solid::ellipsoid([5.0, 2.0, 1.0])
}

pub fn prism() -> Solid {
    Solid::prism(6, 2.0, 3.0)
}

pub fn pyramid() -> Solid {
    Solid::pyramid(4, 3.0, 2.0)
}

pub fn wedge() -> Solid {
    Solid::wedge([8.0, 2.0, 6.0])
}

pub fn half_space() -> Solid {
    Solid::half_space([0.0, 0.0, 1.0], 0.5)
}

pub fn slab() -> Solid {
    Solid::slab([0.0, 0.0, 1.0], 2.0)
}

pub fn superellipsoid() -> Solid {
    Solid::superellipsoid([1.0, 2.0, 3.0], 0.5, 1.5)
}

pub fn supertoroid() -> Solid {
    Solid::supertoroid([1.2, 0.8, 0.6], 1.5, 0.3, 0.7)
}

pub fn superhyperboloid() -> Solid {
    let semi_axes = 2.0;
    let superhyperboloid = Superhyperboloid::one_sheet([semi_axes, semi_axes, 3.0], 1.0, 0.8, 8.0);
    Solid::from(superhyperboloid)
}

pub fn generalised_superquadric() -> Solid {
    let generalised_superquadric = GeneralisedSuperquadric::new([1.0, 1.5, 2.0], [5.0, 3.0, 1.5]);
    Solid::from(generalised_superquadric)
}

pub fn supershape() -> Solid {
    let scale = 2.0;
    let supershape = Supershape::with(
        Gielis::new(6.0, 2.0, 7.0, 7.0),
        Gielis::new(4.0, 10.0, 10.0, 10.0),
        [scale, scale, 1.0],
        Radius::Standard,
    );
    Solid::from(supershape)
}

pub fn sheet_lattice() -> Solid {
    let sheet_lattice = SheetLattice {
        surface: MinimalSurface::Gyroid,
        cell: 8.0,
        thickness: 0.5,
    };
    Solid::from(sheet_lattice)
}

pub fn network_lattice() -> Solid {
    let network_lattice = NetworkLattice {
        surface: MinimalSurface::SchwarzP,
        cell: 6.0,
        fraction: 0.3,
    };
    Solid::from(network_lattice)
}

pub fn formula() -> Result<Solid, FormulaError> {
    let text = "\
_0 var-x
_1 var-y
_2 var-z
_3 square _0
_4 square _1
_5 square _2
_6 add _3 _4
_7 add _6 _5
_8 sqrt _7
_9 const 1.0
_10 sub _8 _9
";
    let bounds = Bounds::new([-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]);
    let formula = Solid::from(Formula::from_vm(text, bounds)?);
    Ok(formula)
}

pub fn circle() -> Profile {
    Profile::circle(1.0)
}

pub fn rectangle() -> Profile {
    Profile::rounded_rectangle([4.0, 2.0], 0.5)
}

pub fn regular_polygon() -> Profile {
    Profile::regular_polygon(6, 2.0)
}

pub fn polygon() -> Profile {
    let x = 4.0;
    let length = 3.0;
    let length_2 = 1.0;
    let length_3 = 2.0;
    let contour = vec![[0.0, 0.0], [x, 0.0], [x, length], [0.0, length]];
    let contour_2 = vec![
        [length_2, length_2],
        [length, length_2],
        [length_3, length_3],
    ];
    Profile::from(Polygon::new([contour, contour_2]))
}

pub fn superellipse() -> Profile {
    Profile::superellipse([2.0, 1.0], 0.5)
}

pub fn superpolygon() -> Profile {
    Profile::superpolygon(Gielis::new(5.0, 2.0, 2.0, 2.0), 3.0)
}

pub fn taper() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).taper(0.5, -0.4, 4.0)
}

pub fn twist() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).twist(rad(0.6))
}

pub fn bend() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).bend(0.3, rad(0.5))
}

pub fn elongate() -> Solid {
    let length = 1.0;
    Solid::cuboid([length, 1.5, 2.0]).elongate([length, 0.0, 4.0])
}

pub fn taper_by() -> Solid {
    let length = 2.0;
    let x_law = SmoothStep {
        from: (-1.0, 1.0),
        to: (1.0, 0.5),
    };
    let y_law = SineWave {
        mean: 1.0,
        amplitude: 0.25,
        wavelength: length,
        phase: rad(0.5),
    };
    Solid::cuboid([1.0, 1.5, length]).taper_by(x_law, y_law)
}

pub fn twist_by() -> Solid {
    let law = LinearLaw {
        at_zero: 0.5,
        slope: 1.0,
    };
    Solid::cuboid([1.0, 1.5, 2.0]).twist_by(rad(0.5), law)
}

pub fn extrude() -> Solid {
    let length = 2.0;
    Profile::rectangle([length, 1.0])
        .translate([length, 0.0])
        .extrude(4.0)
}

pub fn extrude_with() -> Solid {
    let length = 2.0;
    let rectangle = Profile::rectangle([length, 1.0]).translate([length, 0.0]);
    let extrusion = Extrusion {
        height: 4.0,
        twist: rad(0.5),
        scale: 0.75,
        caps: Caps::Chamfered(0.125),
    };
    rectangle.extrude_with(&extrusion)
}

pub fn revolve() -> Solid {
    let length = 2.0;
    Profile::rectangle([length, 1.0])
        .translate([length, 0.0])
        .revolve()
}

pub fn revolve_by() -> Solid {
    let length = 2.0;
    Profile::rectangle([length, 1.0])
        .translate([length, 0.0])
        .revolve_by(rad(2.0))
}

pub fn sweep_helix() -> Solid {
    let length = 2.0;
    let rectangle = Profile::rectangle([length, 1.0]).translate([length, 0.0]);
    let helix = Helix {
        radius: 8.0,
        pitch: 6.0,
        turns: 1.5,
        left_handed: true,
        ends: Caps::Flat,
    };
    rectangle.sweep_helix(&helix)
}

pub fn column() -> Solid {
    let length = 2.0;
    Profile::rectangle([length, 1.0])
        .translate([length, 0.0])
        .column()
}

pub fn profile_formula() -> Result<Profile, FormulaError> {
    let text = "\
_0 var-x
_1 var-y
_2 abs _0
_3 abs _1
_4 add _2 _3
_5 const 1.0
_6 sub _4 _5
";
    let bounds = Bounds::new([-1.0, -1.0, f64::NEG_INFINITY], [1.0, 1.0, f64::INFINITY]);
    let formula = Profile::from(Formula::from_vm(text, bounds)?);
    Ok(formula)
}

pub fn union() -> Solid {
    let length = 1.0;
    let sphere = Solid::sphere(1.25).translate([length, 0.0, 0.0]);
    Solid::sphere(length) | sphere
}

pub fn intersection() -> Solid {
    let length = 1.0;
    let sphere = Solid::sphere(1.25).translate([length, 0.0, 0.0]);
    Solid::sphere(length).intersection(sphere, RFunction::Associative(3.0))
}

pub fn difference() -> Solid {
    let length = 1.0;
    let sphere = Solid::sphere(1.25).translate([length, 0.0, 0.0]);
    Solid::sphere(length).difference(sphere, RFunction::MIN_MAX)
}

pub fn symmetric_difference() -> Solid {
    let length = 1.0;
    let sphere = Solid::sphere(1.25).translate([length, 0.0, 0.0]);
    Solid::sphere(length).symmetric_difference(sphere, RFunction::Alpha(0.5))
}

pub fn complement() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).complement()
}

pub fn union_with() -> Solid {
    let length = 1.0;
    let sphere = Solid::sphere(1.25).translate([length, 0.0, 0.0]);
    Solid::sphere(length).union_with(sphere, Blend::Fillet { radius: 0.25 })
}

pub fn intersection_with() -> Solid {
    let length = 1.0;
    let sphere = Solid::sphere(1.25).translate([length, 0.0, 0.0]);
    Solid::sphere(length).intersection_with(sphere, Blend::Chamfer { leg: 0.25 })
}

pub fn difference_with() -> Solid {
    let length = 1.0;
    let sphere = Solid::sphere(1.25).translate([length, 0.0, 0.0]);
    Solid::sphere(length).difference_with(sphere, Blend::Smooth { radius: 0.5 })
}

pub fn level() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).level(0.25)
}

pub fn offset() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).offset(0.25)
}

pub fn shell() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).shell(0.125)
}

pub fn rounded() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).rounded(0.125)
}

pub fn filleted() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).filleted(0.125)
}

pub fn with_tolerance() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0])
        .offset(0.25)
        .with_tolerance(0.001)
}

pub fn translate() -> Solid {
    let length = 1.0;
    let length_2 = 2.0;
    Solid::cuboid([length, 1.5, length_2]).translate([length, -length_2, 0.0])
}

pub fn rotate_x() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).rotate_x(rad(0.5))
}

pub fn rotate_y() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).rotate_y(rad(-0.75))
}

pub fn rotate_z() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).rotate_z(rad(1.0))
}

pub fn rotate_about() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).rotate_about([1.0, 1.0, 1.0], rad(0.25))
}

pub fn scale() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).scale(2.0)
}

pub fn scale_axes() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).scale_axes([2.0, 0.5, 1.0])
}

pub fn reflect() -> Solid {
    let length = 1.0;
    Solid::cuboid([length, 1.5, 2.0]).reflect([1.0, 0.0, 0.0], length)
}

pub fn mirrored() -> Solid {
    let length = 1.0;
    let cuboid = Solid::cuboid([length, 1.5, 2.0]);
    let cuboid_2 = cuboid.reflect([0.0, 1.0, 0.0], -length);
    cuboid.union(cuboid_2, RFunction::MIN_MAX)
}

pub fn affine() -> Solid {
    let columns = [
        [1.0, 0.25, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.5, 0.0, 0.0],
    ];
    Solid::cuboid([1.0, 1.5, 2.0]).affine(DAffine3::from_cols_array_2d(&columns))
}

pub fn repeat() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).repeat([4, 4, 4], [3.0, 4.0, 5.0])
}

pub fn repeat_linear() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).repeat_linear(4, [3.0, 0.0, 4.0])
}

pub fn repeat_polar() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).repeat_polar(5)
}

pub fn named() -> Solid {
    Solid::cuboid([1.0, 1.5, 2.0]).named("knob")
}

pub fn paint() -> Solid {
    let paint = Paint {
        color: [192, 128, 64],
        roughness: 0.25,
    };
    Solid::cuboid([1.0, 1.5, 2.0]).paint(paint)
}

pub fn several() -> Solid {
    let plate = Solid::cuboid([12.0, 8.0, 1.5])
        .paint([10, 20, 30])
        .named("plate");
    let hole = Solid::cylinder(0.75, 4.0).named("hole");
    let holes = hole.translate([2.5, 0.0, 0.0]).repeat_polar(5);
    plate.difference_all([&holes, &hole], RFunction::MIN_MAX)
}

pub fn shared() -> Solid {
    let length = 3.0;
    let x = 1.0;
    let z = 0.25;
    let pin_1 = Solid::cylinder(0.5, length).named("Pin #1");
    let pin_1_2 = pin_1.translate([-x, 0.0, z]);
    let parts = [
        &pin_1_2,
        &pin_1.translate([x, 0.0, z]),
        &pin_1.translate([length, 0.0, z]),
    ];
    let union = Solid::union_all(parts, RFunction::Alpha(0.5));
    union - &pin_1_2
}

pub fn twice() -> Solid {
    let pin_1 = Solid::cylinder(0.5, 3.0).named("Pin #1");
    pin_1.union(&pin_1, RFunction::P(2.0))
}

pub fn by_method() -> Solid {
    let pin_1 = Solid::cylinder(0.5, 3.0).named("Pin #1");
    pin_1.union(&pin_1, RFunction::Zero { m: 2 })
}

pub fn filleted_all() -> Solid {
    let length = 3.0;
    let x = 1.0;
    let length_2 = 0.25;
    let plate = Solid::cuboid([12.0, 8.0, 1.5])
        .paint([10, 20, 30])
        .named("plate");
    let pin_1 = Solid::cylinder(0.5, length).named("Pin #1");
    let pin_1_2 = pin_1.translate([length, 0.0, length_2]);
    let parts = [
        pin_1.translate([-x, 0.0, length_2]),
        pin_1.translate([x, 0.0, length_2]),
        pin_1_2,
    ];
    plate.difference_all_with(parts, Blend::Fillet { radius: length_2 })
}

pub fn one_operand() -> Solid {
    Solid::union_all([Solid::sphere(1.0)], RFunction::P(3.0))
}

pub fn no_operands() -> Solid {
    Solid::union_all(Vec::<Solid>::new(), RFunction::P(3.0))
}

pub fn no_holes() -> Solid {
    Solid::sphere(1.0).difference_all(Vec::<Solid>::new(), RFunction::MIN_MAX)
}

pub fn odd_numbers() -> Solid {
    Solid::sphere(1.0)
        .translate([-0.0, 1e300, f64::INFINITY])
        .scale(1e-7)
        .scale_axes([f64::NAN, 1e22, 0.1])
}

pub fn long_numbers() -> Solid {
    let semi_axes = [0.30000000000000004, 0.3333333333333333, 0.2857142857142857];
    Solid::superellipsoid(semi_axes, 0.3333333333333333, 0.14285714285714285)
}

pub fn turned() -> Solid {
    let columns = [
        [0.955336489125606, 0.0, -0.2955202066613396],
        [
            0.029502791919178276,
            0.9950041652780258,
            0.09537450575679464,
        ],
        [
            0.29404383655185584,
            -0.09983341664682814,
            0.9505637859220634,
        ],
        [0.0, 0.0, 0.0],
    ];
    Solid::sphere(1.0).affine(DAffine3::from_cols_array_2d(&columns))
}

pub fn turned_about() -> Solid {
    Solid::sphere(1.0)
        .rotate_about([1.0, 1.0, 1.0], deg(120.0))
        .rotate_about([0.0, 0.75, 1.0], deg(30.0))
}

pub fn mirror() -> Solid {
    let columns = [
        [0.2799999999999998, -0.9600000000000002, 0.0],
        [-0.9600000000000002, -0.28000000000000025, 0.0],
        [0.0, 0.0, 1.0],
        [0.6000000000000001, 0.8, 0.0],
    ];
    let capsule = Solid::capsule(0.5, 2.0).affine(DAffine3::from_cols_array_2d(&columns));
    let capsule_2 = capsule.reflect([1.0, 0.0, 0.0], 0.0);
    capsule.union(capsule_2, RFunction::MIN_MAX)
}

pub fn long_chain() -> Solid {
    let length = 1.0;
    let x = 0.1;
    let sphere = Solid::sphere(length)
        .translate([x, 0.0, -0.0])
        .rotate_z(deg(10.0))
        .translate([x, length, -0.0])
        .rotate_z(deg(10.0))
        .translate([x, 2.0, -0.0])
        .rotate_z(deg(10.0));
    let sphere_2 = sphere
        .translate([x, 3.0, -0.0])
        .rotate_z(deg(10.0))
        .translate([x, 4.0, -0.0])
        .rotate_z(deg(10.0))
        .translate([x, 5.0, -0.0])
        .rotate_z(deg(10.0));
    let sphere_3 = sphere_2
        .translate([x, 6.0, -0.0])
        .rotate_z(deg(10.0))
        .translate([x, 7.0, -0.0])
        .rotate_z(deg(10.0))
        .translate([x, 8.0, -0.0])
        .rotate_z(deg(10.0));
    let type_sphere = sphere_3.named("type");
    let paint = Paint {
        color: [1, 2, 3],
        roughness: 0.25,
    };
    type_sphere.paint(paint)
}

pub fn curves() -> Solid {
    let curve = Gielis {
        m: 3.0,
        n1: 2.0,
        n2: 3.0,
        n3: 3.0,
        a: 1.0,
        b: 1.25,
        turns: Turns::Outer,
    };
    Profile::superpolygon(curve, 2.0).extrude(1.0)
}

pub fn thread() -> Solid {
    let circle = Profile::circle(0.5);
    let helix = Helix {
        radius: 4.0,
        pitch: 2.0,
        turns: 3.0,
        left_handed: false,
        ends: Caps::Rounded(0.1),
    };
    circle.sweep_helix(&helix)
}

pub fn twisted() -> Solid {
    let rectangle = Profile::rectangle([2.0, 1.0]);
    let extrusion = Extrusion {
        height: 4.0,
        twist: deg(45.0),
        scale: 1.0,
        caps: Caps::Flat,
    };
    rectangle.extrude_with(&extrusion)
}

pub fn tolerated() -> Solid {
    let plate = Solid::cuboid([12.0, 8.0, 1.5])
        .paint([10, 20, 30])
        .named("plate");
    plate.rounded(0.25).with_tolerance(0.001).shell(0.1)
}

pub fn quoted() -> Solid {
    let a_b = Solid::sphere(1.0).named("a \"b\" \\ ø {}");
    let fn_a_b = a_b.named("fn");
    fn_a_b.named("")
}

pub fn impl_part() -> Solid {
    let plate = Solid::cuboid([12.0, 8.0, 1.5])
        .paint([10, 20, 30])
        .named("plate");
    let pin_1 = Solid::cylinder(0.5, 3.0).named("Pin #1");
    let either = plate ^ pin_1;
    (either & Solid::sphere(1.0).complement()).complement()
}

pub fn flat_moves() -> Profile {
    let length = 1.0;
    let columns = [[0.28, -0.96], [-0.96, -0.28000000000000025], [0.6, 0.8]];
    let circle = Profile::circle(length)
        .translate([length, -2.0])
        .rotate(rad(0.7))
        .scale(-0.3)
        .affine(DAffine2::from_cols_array_2d(&columns));
    circle.union(circle.reflect([0.0, 1.0], 0.0), RFunction::MIN_MAX)
}

pub fn flat_axes() -> Profile {
    let map = DAffine2::from_cols_array_2d(&[[2.0, 0.0], [0.0, 3.0], [0.0, 0.0]]);
    Profile::circle(1.0).scale_axes([2.0, 0.1]).affine(map)
}

pub fn flat_map() -> Profile {
    let columns = [
        [2.0, 0.0, 0.0],
        [0.0, 3.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, 0.0],
    ];
    Profile::circle(1.0).affine_in_space(DAffine3::from_cols_array_2d(&columns))
}

pub fn flat_copies() -> Profile {
    Profile::circle(1.0)
        .repeat([3, 2], [4.0, 5.0])
        .repeat_linear(2, [20.0, 0.5])
        .repeat_polar(3)
}

pub fn flat_lengths() -> Profile {
    let length = 1.0;
    let slot = Profile::circle(length)
        .elongate([length, 0.5])
        .level(0.1)
        .offset(-0.2)
        .named("slot");
    slot.paint([1, 2, 3])
}

pub fn flat_joins() -> Profile {
    let circle = Profile::circle(1.0);
    let union = circle.union(circle.translate([0.5, 0.0]), RFunction::MIN_MAX);
    union ^ &circle
}

pub fn flat_simpler() -> Profile {
    let columns = [
        [4.589053123706931, 5.797959185139219, 0.0],
        [-3.865306123426146, 6.883579685560396, 0.0],
        [0.0, 0.0, 6.0],
        [2.0, 6.0, 0.0],
    ];
    Profile::circle(1.0).affine_in_space(DAffine3::from_cols_array_2d(&columns))
}

pub fn with_holes() -> Profile {
    let length = 9.0;
    let length_2 = 1.0;
    let length_3 = 2.0;
    let y = 6.0;
    let contour = vec![[0.0, 0.0], [length, 0.0], [length, length], [0.0, length]];
    let contour_2 = vec![
        [length_2, length_2],
        [length_2, length_3],
        [length_3, length_3],
    ];
    let contour_3 = vec![[0.3333333333333333, 4.0], [length_2, y], [length_3, y]];
    let polygon = Polygon::new([contour, contour_2, contour_3]);
    Profile::from(polygon)
}

pub fn of_many_points() -> Profile {
    let contour = vec![
        [0.0, 0.0],
        [1.0, 1.0],
        [2.0, 4.0],
        [3.0, 9.0],
        [4.0, 16.0],
        [5.0, 25.0],
        [6.0, 36.0],
        [7.0, 49.0],
        [8.0, 64.0],
        [9.0, 81.0],
        [10.0, 100.0],
        [11.0, 121.0],
        [12.0, 144.0],
        [13.0, 169.0],
        [14.0, 196.0],
        [15.0, 225.0],
        [16.0, 256.0],
        [17.0, 289.0],
        [18.0, 324.0],
        [19.0, 361.0],
        [20.0, 400.0],
        [21.0, 441.0],
        [22.0, 484.0],
        [23.0, 529.0],
        [24.0, 576.0],
        [25.0, 625.0],
        [26.0, 676.0],
        [27.0, 729.0],
        [28.0, 784.0],
        [29.0, 841.0],
        [30.0, 900.0],
        [31.0, 961.0],
        [32.0, 1024.0],
        [33.0, 1089.0],
        [34.0, 1156.0],
        [35.0, 1225.0],
        [36.0, 1296.0],
        [37.0, 1369.0],
        [38.0, 1444.0],
        [39.0, 1521.0],
    ];
    Profile::polygon(contour)
}

pub fn empty_contour() -> Profile {
    Profile::from(Polygon::new([Vec::<[f64; 2]>::new()]))
}

pub fn no_contours() -> Profile {
    Profile::from(Polygon::new(Vec::<Vec<[f64; 2]>>::new()))
}

pub const SOLIDS: [(&str, fn() -> Solid); 81] = [
    ("sphere", sphere),
    ("cuboid", cuboid),
    ("rounded_cuboid", rounded_cuboid),
    ("cylinder", cylinder),
    ("cone", cone),
    ("capsule", capsule),
    ("torus", torus),
    ("ellipsoid", ellipsoid),
    ("prism", prism),
    ("pyramid", pyramid),
    ("wedge", wedge),
    ("half_space", half_space),
    ("slab", slab),
    ("superellipsoid", superellipsoid),
    ("supertoroid", supertoroid),
    ("superhyperboloid", superhyperboloid),
    ("generalised_superquadric", generalised_superquadric),
    ("supershape", supershape),
    ("sheet_lattice", sheet_lattice),
    ("network_lattice", network_lattice),
    ("taper", taper),
    ("twist", twist),
    ("bend", bend),
    ("elongate", elongate),
    ("taper_by", taper_by),
    ("twist_by", twist_by),
    ("extrude", extrude),
    ("extrude_with", extrude_with),
    ("revolve", revolve),
    ("revolve_by", revolve_by),
    ("sweep_helix", sweep_helix),
    ("column", column),
    ("union", union),
    ("intersection", intersection),
    ("difference", difference),
    ("symmetric_difference", symmetric_difference),
    ("complement", complement),
    ("union_with", union_with),
    ("intersection_with", intersection_with),
    ("difference_with", difference_with),
    ("level", level),
    ("offset", offset),
    ("shell", shell),
    ("rounded", rounded),
    ("filleted", filleted),
    ("with_tolerance", with_tolerance),
    ("translate", translate),
    ("rotate_x", rotate_x),
    ("rotate_y", rotate_y),
    ("rotate_z", rotate_z),
    ("rotate_about", rotate_about),
    ("scale", scale),
    ("scale_axes", scale_axes),
    ("reflect", reflect),
    ("mirrored", mirrored),
    ("affine", affine),
    ("repeat", repeat),
    ("repeat_linear", repeat_linear),
    ("repeat_polar", repeat_polar),
    ("named", named),
    ("paint", paint),
    ("several", several),
    ("shared", shared),
    ("twice", twice),
    ("by_method", by_method),
    ("filleted_all", filleted_all),
    ("one_operand", one_operand),
    ("no_operands", no_operands),
    ("no_holes", no_holes),
    ("odd_numbers", odd_numbers),
    ("long_numbers", long_numbers),
    ("turned", turned),
    ("turned_about", turned_about),
    ("mirror", mirror),
    ("long_chain", long_chain),
    ("curves", curves),
    ("thread", thread),
    ("twisted", twisted),
    ("tolerated", tolerated),
    ("quoted", quoted),
    ("impl", impl_part),
];

pub const PROFILES: [(&str, fn() -> Profile); 17] = [
    ("circle", circle),
    ("rectangle", rectangle),
    ("regular_polygon", regular_polygon),
    ("polygon", polygon),
    ("superellipse", superellipse),
    ("superpolygon", superpolygon),
    ("flat_moves", flat_moves),
    ("flat_axes", flat_axes),
    ("flat_map", flat_map),
    ("flat_copies", flat_copies),
    ("flat_lengths", flat_lengths),
    ("flat_joins", flat_joins),
    ("flat_simpler", flat_simpler),
    ("with_holes", with_holes),
    ("of_many_points", of_many_points),
    ("empty_contour", empty_contour),
    ("no_contours", no_contours),
];

pub const FORMULAS: &[(&str, fn() -> Result<Solid, FormulaError>)] = &[("formula", formula)];
