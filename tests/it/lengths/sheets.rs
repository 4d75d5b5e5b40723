//! Roundings by a ball that is as wide as a wall, a bar or a gap, or a little smaller: its centre
//! rolls on a sheet or along a line, however these are turned and wherever they taper off.

use super::*;
use rvachev::deg;

fn turned(solid: Solid) -> Solid {
    solid.rotate_x(deg(21.0)).rotate_y(deg(8.0))
}

/// Two plates, each as thick as a ball of .5 is wide.
fn plates() -> Solid {
    Solid::cuboid([8.0, 5.0, 1.0]) | at(Solid::cuboid([1.0, 5.0, 6.0]), [-3.5, 0.0, 2.5])
}

fn bars() -> Solid {
    Solid::cuboid([7.0, 1.0, 1.0]) | Solid::cuboid([1.0, 7.0, 1.0])
}

/// A cup with walls of about 1, upright or tapered.
fn cup(inner: [f64; 2]) -> Solid {
    let [low, high] = inner;
    Solid::cone(4.0, 5.0, 10.0) - at(Solid::cone(low, high, 10.0), [0.0, 0.0, 1.0])
}

#[test]
fn what_is_thinner_than_cells_is_known_as_well_as_the_rest() -> Outcome {
    let tube = Solid::cylinder(6.0, 20.0) - Solid::cylinder(5.0, 30.0);
    let bowl = Solid::sphere(10.0) - Solid::sphere(9.0) - at(Solid::cuboid([30.0, 30.0, 10.0]), [0.0, 0.0, 6.0]);
    let block = Solid::cuboid([3.0, 1.5, 2.0]) - at(Solid::cuboid([1.0, 2.5, 2.0]), [0.0, 0.0, 1.0]);
    for (name, rounded) in [
        ("plates", plates().rounded(0.5)),
        ("turned plates", turned(plates()).rounded(0.5)),
        ("turned bars", turned(bars()).rounded(0.5)),
        ("a cup", cup([3.0, 4.0]).rounded(0.5)),
        ("a cup of walls that taper", cup([3.5, 3.8]).rounded(0.5)),
        ("a tube", tube.rounded(0.49)),
        ("a bowl", bowl.rounded(0.5)),
        ("a ball in a ball", (Solid::sphere(10.0) - at(Solid::sphere(9.0), [0.3, 0.0, 0.0])).rounded(0.49)),
        ("a turned slot, filled", turned(block).filleted(0.5)),
    ] {
        let accuracy = rounded.accuracy()?;
        assert!(accuracy.error < 3e-3 && accuracy.tolerance < 2e-3, "{name}: {accuracy:?}");
    }
    Ok(())
}

/// Shells, cut open, have walls that end in edges of every kind.
#[test]
fn shells_that_are_cut_open_are_known_as_well() -> Outcome {
    let open = |solid: Solid| solid.shell(1.0) - at(Solid::cuboid([40.0, 40.0, 20.0]), [0.0, 0.0, 11.0]);
    let turned = |solid: Solid| open(solid).rotate_x(deg(33.0)).rounded(0.49);
    for (name, rounded) in [
        ("a box", turned(Solid::cuboid([12.0, 9.0, 7.0]))),
        ("a cylinder", turned(Solid::cylinder(5.0, 12.0))),
        ("a torus", turned(Solid::torus(8.0, 4.0))),
        ("an ellipsoid and a wedge", {
            let wedge = at(Solid::wedge([9.452, 10.207, 7.615]), [3.749, -0.764, -2.058]);
            let shell = (Solid::ellipsoid([7.657, 5.749, 5.98]) | wedge).shell(0.9482);
            shell.rotate_x(deg(-66.06)).rotate_y(deg(-1.4)).rounded(0.4741)
        }),
        ("a box and a cylinder", open(Solid::cuboid([12.0, 9.0, 7.0]) | Solid::cylinder(4.0, 16.0)).rounded(0.5)),
    ] {
        let accuracy = rounded.accuracy()?;
        assert!(accuracy.error < 1e-2 && accuracy.tolerance < 8e-3, "{name}: {accuracy:?}");
    }
    Ok(())
}

/// What is turned is rounded as it is at rest.
#[test]
fn sheets_and_lines_are_whole_however_they_are_turned() -> Outcome {
    let mut random = Random::new(36);
    let turn = DQuat::from_rotation_y(8f64.to_radians()) * DQuat::from_rotation_x(21f64.to_radians());
    for solid in [plates(), bars()] {
        let (still, moved) = (solid.rounded(0.5), turned(solid.clone()).rounded(0.5));
        let bounds = solid.bounds()?;
        let mut asked = 0;
        for _ in 0..4000 {
            let unit = DVec3::new(random.unit(), random.unit(), random.unit());
            let p = bounds.min + bounds.size() * unit;
            let value = still.value(p)?;
            if value.abs() > 3e-3 {
                asked += usize::from(value.abs() < 0.2);
                assert_eq!(moved.contains(turn * p)?, value > 0.0, "{solid:?} at {p}: {value}");
            }
        }
        assert!(asked > 300, "{asked}");
    }
    Ok(())
}
