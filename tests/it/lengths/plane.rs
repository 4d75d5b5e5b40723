//! Lengths of profiles: areas of offset polygons by closed forms, corners by points.

mod border;
mod laws;
mod outline;

use std::f64::consts::PI;

use glam::DVec2;
use rvachev::{Camera, Caps, Extrusion, Plane, Profile, camera::Window, deg};

use super::{CORNER, Outcome, TOLERANCE, fillet, l_profile};
use crate::support::near;

/// How far contours may be off.
const CONTOUR: f64 = 1e-4;

/// The area of a profile, and how many contours it has: holes count as negative.
fn area(profile: &Profile) -> Result<(f64, usize), Box<dyn std::error::Error>> {
    let contours = profile.extrude(1.0).slice(&Plane::xy(0.0))?.contours(CONTOUR)?;
    Ok((contours.iter().map(rvachev::Polyline::area).sum(), contours.len()))
}

/// Fails unless a profile has an area, its border being so long, by a length.
fn has_area(name: &str, profile: &Profile, want: f64, border: f64, length: f64, contours: usize) -> Outcome {
    let (got, count) = area(profile)?;
    println!("{name}: {got:.4}, want {want:.4}; {count} contours");
    near(got, want, (CONTOUR + TOLERANCE * length) * border);
    assert_eq!(count, contours, "{name}");
    Ok(())
}

#[test]
fn offset_polygons_have_their_areas() -> Outcome {
    let l = l_profile();
    // Five convex corners, each with a quarter circle; the strips overlap in the concave one.
    has_area("L, larger", &l.offset(1.0), 64.0 + 40.0 + 1.25 * PI - 1.0, 48.0, 1.0, 1)?;
    // Smaller, the concave corner becomes a quarter circle.
    has_area("L, smaller", &l.offset(-1.0), 64.0 - 40.0 + 5.0 - PI / 4.0, 40.0, 1.0, 1)?;
    let triangle = Profile::polygon([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]);
    has_area("triangle, larger", &triangle.offset(0.5), 6.0 + 6.0 + 0.25 * PI, 16.0, 0.5, 1)?;
    // The inner circle has radius 1.
    has_area("triangle, smaller", &triangle.offset(-0.5), 6.0 * 0.25, 6.0, 0.5, 1)?;
    has_area("triangle, opened", &triangle.rounded(0.5), 1.5 + 3.0 + 0.25 * PI, 12.0, 0.5, 1)?;
    // Two squares side by side are one rectangle.
    let square = Profile::rectangle([10.0; 2]);
    let both = square.translate([-5.0, 0.0]) | square.translate([5.0, 0.0]);
    has_area("two squares, smaller", &both.offset(-1.0), 18.0 * 8.0, 52.0, 1.0, 1)?;
    has_area("two squares, hollow", &both.shell(1.0), 200.0 - 144.0, 112.0, 1.0, 2)?;
    // A hole.
    let frame = Profile::rectangle([20.0, 10.0]) - Profile::rectangle([10.0, 4.0]);
    let larger = 200.0 + 60.0 + PI - 8.0 * 2.0;
    has_area("frame, larger", &frame.offset(1.0), larger, 90.0, 1.0, 2)?;
    has_area("frame, hole closed", &frame.filleted(2.5), 200.0, 60.0, 2.5, 1)?;
    Ok(())
}

/// Areas, lengths of borders and numbers of contours by shapely 2.2: `buffer(r, quad_segs=1024)`,
/// once or twice.
#[test]
fn polygons_with_holes_have_the_areas_that_shapely_finds() -> Outcome {
    let frame = Profile::polygon([[0.0, 0.0], [12.0, 0.0], [12.0, 8.0], [7.0, 9.5], [0.0, 8.0]])
        - Profile::polygon([[1.5, 1.5], [5.0, 1.5], [5.0, 6.5], [1.5, 6.0]])
        - Profile::polygon([[6.5, 2.0], [10.5, 1.5], [10.0, 6.5], [7.0, 5.5]]);
    let star = [[9.0, 0.0], [3.2, 2.1], [4.5, 8.2], [0.0, 3.4], [-6.0, 6.1], [-3.1, 0.4], [-7.2, -5.0], [-0.5, -3.3]];
    let star = star.into_iter().chain([[3.0, -8.5], [3.4, -1.9]]).collect::<Vec<_>>();
    let star = Profile::polygon(star) - Profile::polygon([[0.8, 0.0], [0.0, 1.1], [-0.9, -0.2]]);
    for (verb, moved, length, want, border, contours) in [
        ("larger", frame.offset(0.4), 0.4, 101.7644, 68.7, 3),
        ("smaller", frame.offset(-0.4), 0.4, 44.0368, 74.7, 3),
        ("much smaller", frame.offset(-0.9), 0.9, 10.6384, 36.3, 2),
        ("rounded", frame.rounded(0.8), 0.8, 62.08, 63.7, 3),
        ("filleted", frame.filleted(0.8), 0.8, 74.7013, 69.7, 3),
        ("star, larger", star.offset(0.4), 0.4, 117.1912, 67.0, 2),
        ("star, much smaller", star.offset(-0.9), 0.9, 34.9603, 53.2, 2),
        ("star, rounded", star.rounded(0.8), 0.8, 84.3154, 54.9, 2),
    ] {
        has_area(verb, &moved, want, border, length, contours)?;
    }
    Ok(())
}

#[test]
fn corners_of_profiles_are_rounded_and_filled() -> Outcome {
    let l = l_profile();
    let (filled, rounded) = (l.filleted(2.0), l.rounded(1.5));
    let concave = |by: f64| DVec2::splat(6.0) - by * DVec2::ONE.normalize();
    // Of polygons, and of what is joined of them, closed forms are kept in single precision.
    assert!(filled.contains(concave(2.0001))? && !filled.contains(concave(1.9999))?);
    let convex = |by: f64| DVec2::new(8.5, 1.5) + by * DVec2::new(1.0, -1.0).normalize();
    assert!(rounded.contains(convex(1.4999))? && !rounded.contains(convex(1.5001))?);
    let arms =
        Profile::rectangle([10.0, 4.0]).translate([5.0, 2.0]) | Profile::rectangle([4.0, 10.0]).translate([2.0, 5.0]);
    for profile in [&filled, &rounded, &arms.filleted(2.0), &arms.rounded(1.5), &arms.offset(-1.0), &arms.shell(1.0)] {
        assert!(profile.accuracy()?.error <= 1e-5, "{profile}: {:?}", profile.accuracy()?);
    }
    // Convex corners stay when concave ones are filled, and the other way round, to the bit.
    assert!(filled.contains([1e-9, 1e-9])? && !filled.contains([-1e-9, 5.0])?);
    assert!(!rounded.contains([4.0 + 1e-9, 4.0 + 1e-9])? && rounded.contains([4.0 - 1e-9, 4.0 - 1e-9])?);
    // Both at once.
    let both = l.filleted(2.0).rounded(1.5);
    // In the plane, and not piece by piece as a column without end, whose error is not known.
    assert!(both.accuracy()?.error > 0.0);
    let want = 64.0 + 4.0 * CORNER - 5.0 * 2.25 * CORNER;
    has_area("L, both", &both, want, 40.0, 2.0, 1)
}

/// The disc has a thousandth of its radius to spare in the corridor, and in the pocket at its end.
#[test]
fn discs_that_only_just_fit_do() -> Outcome {
    let room =
        Profile::rectangle([2.002, 9.0]).translate([0.0, 4.5]) | Profile::regular_polygon(6, 2.004 / 3f64.sqrt());
    let plate = Profile::rectangle([30.0, 30.0]);
    assert!(room.rounded(1.0).contains([0.0, 5.0])? && !room.rounded(1.002).contains([0.0, 5.0])?);
    for kept in [(&plate - &room).filleted(1.0), plate.difference_with(&room, fillet(1.0))] {
        assert!(!kept.contains([0.0, 5.0])? && !kept.contains([0.0, -0.9])?, "{kept}");
    }
    assert!((&plate - &room).filleted(1.002).contains([0.0, 5.0])?);
    // Exactly as wide as the disc, it has no room.
    let slot = Profile::rectangle([2.0, 9.0]);
    assert!(!slot.rounded(1.0001).contains([0.0, 0.0])? && slot.rounded(0.9999).contains([0.0, 0.0])?);
    Ok(())
}

#[test]
fn a_filleted_union_in_the_plane_is_flush() -> Outcome {
    let low = Profile::rectangle([10.0; 2]).translate([5.0, 5.0]);
    let both = low.union_with(Profile::rectangle([10.0, 20.0]).translate([15.0, 10.0]), fillet(2.0));
    has_area("flush blocks", &both, 300.0 + 4.0 * CORNER, 80.0, 2.0, 1)?;
    assert!(!both.contains([9.99, -1e-9])? && both.contains([9.99, 1e-9])?);
    Ok(())
}

/// Beside a profile's border patches and field are not on the same side of every point.
#[test]
fn normals_of_rounded_caps_face_the_viewer() -> Outcome {
    let arm = Profile::rounded_rectangle([1.8, 0.8], 0.15);
    let cross = arm.rotate(deg(90.0)) | arm;
    for caps in [Caps::Rounded(0.2), Caps::Chamfered(0.15)] {
        let solid = cross.extrude_with(&Extrusion { caps, ..Extrusion::new(1.6) });
        let (scene, bounds) = (solid.scene()?, solid.bounds()?);
        for [width, height] in [[88, 66], [112, 84]] {
            let camera = Camera::framing(&bounds).fitted(&bounds, f64::from(width) / f64::from(height));
            let rays = camera.rays(width, height);
            let seen = scene.surfaces(&rays, Window::whole(width, height));
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                let (_, direction) = rays.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let surface = seen.at(x, y);
                let facing = surface.normal.as_dvec3().dot(direction);
                assert!(!surface.distance.is_finite() || facing < 0.05, "{facing} at {x}, {y} of {width}, {caps:?}");
            }
        }
    }
    Ok(())
}
