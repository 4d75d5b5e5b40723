//! Sections of clouds with the curve that was found, and rational beside exact radii.

use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;

use glam::{DVec2, DVec3};
use rvachev::fit::{FitSettings, Shape, Start, supershape};
use rvachev::surface::ParametricSurface;
use rvachev::{Gielis, PointCloud, Radius, Supershape, rad};

use super::canvas::{BLUE, INK, RED, Sheet};

const PANEL: [u32; 2] = [300, 300];

/// A curve of radii, closed.
fn outline(curve: Gielis, radius: Radius, scale: DVec2) -> Vec<DVec2> {
    let at = |k: i32| {
        let angle = TAU * f64::from(k) / 1440.0;
        curve.radius(rad(angle), radius) * scale * DVec2::from_angle(angle)
    };
    (0..1440).map(at).collect()
}

/// Where data are missing, by the angle about the axis.
type Missing = fn(f64) -> bool;

/// Sections of clouds that are complete, and that a part is missing of.
pub fn sections(folder: &Path) -> Result<(), Box<dyn Error>> {
    let meridian = Gielis::new(4.0, 10.0, 10.0, 10.0);
    let complete: Missing = |_| false;
    let gap: Missing = |angle| (0.3..1.9).contains(&angle);
    let half: Missing = |angle| angle < 0.0;
    let cases: [(&str, Gielis, Missing); 6] = [
        ("star 5 complete", Gielis::new(5.0, 1.3, 1.1, 1.1), complete),
        ("a quarter missing", Gielis::new(5.0, 1.3, 1.1, 1.1), gap),
        ("half missing", Gielis::new(5.0, 1.3, 1.1, 1.1), half),
        ("flower 6 complete", Gielis::new(6.0, 4.0, 6.0, 6.0), complete),
        ("a quarter missing", Gielis::new(6.0, 4.0, 6.0, 6.0), gap),
        ("round half missing", Gielis::circle(), half),
    ];
    let mut sheet = Sheet::new(3, 2, PANEL);
    println!("sections, 1 % noise:");
    for (seed, (title, equator, missing)) in (1u64..).zip(cases) {
        let truth = Supershape::with(equator, meridian, [1.0, 1.0, 0.7], Radius::Standard);
        let sampled = ParametricSurface::of(&truth)?.sample(2400, seed)?;
        let mut random = seed;
        let mut unit = || {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (random >> 33) as f64 / f64::from(1u32 << 31)
        };
        // Three uniform numbers make nearly a normal one of deviation 1/2.
        let mut noise = |p: DVec3| p + 0.02 * DVec3::from_array([(); 3].map(|()| unit() + unit() + unit() - 1.5));
        let seen = sampled.iter().map(|s| s.point).filter(|p| !missing(p.y.atan2(p.x)));
        let points: Vec<DVec3> = seen.map(&mut noise).collect();
        let settings = FitSettings { start: Start::Rational { tolerance: 0.1 }, ..FitSettings::default() };
        let fit = supershape(&PointCloud::new(points.clone())?, &settings)?;
        let (curve, axes) = match fit.shape() {
            Shape::Supershape(leaf) => (leaf.equator(), leaf.scale()),
            Shape::Superellipsoid(leaf) => {
                let n = 2.0 / leaf.exponents()[1];
                (Gielis::new(4.0, n, n, n), leaf.semi_axes())
            }
            _ => continue,
        };
        let mut panel = sheet.panel(title);
        panel.scale = 105.0;
        // A section across the axis that was found; where that is the true one, as it lies.
        let is_along = (fit.rotation() * DVec3::Z).z.abs() > 0.9;
        let place = |p: DVec2| {
            if is_along { (fit.rotation() * p.extend(0.0) + fit.translation()).truncate() } else { p }
        };
        for p in &points {
            let local = fit.rotation().inverse() * (*p - fit.translation());
            if local.z.abs() < 0.3 {
                let at = panel.pixel(place(local.truncate()));
                panel.dot(at, 1.2, INK);
            }
        }
        let found: Vec<DVec2> = outline(curve, Radius::Standard, axes.truncate()).into_iter().map(place).collect();
        panel.curve(&found, RED);
        println!(
            "  {title}: m = {} (true {}), rms {:.4}{}",
            curve.m,
            equator.m,
            fit.deviation().rms,
            if fit.search().symmetry_unclear { ", symmetry unclear" } else { "" }
        );
    }
    sheet.save(&folder.join("paper_sections.png"))?;
    Ok(())
}

/// Rational radii beside exact ones, by n and by m.
pub fn rational(folder: &Path) -> Result<(), Box<dyn Error>> {
    let by_n = [1.0, 2.0, 4.0, 10.0].map(|n| (format!("m 4 n {n}"), Gielis::new(4.0, n, n, n)));
    let by_m = [3.0, 5.0, 6.0, 8.0].map(|m| (format!("m {m} n 3 5 5"), Gielis::new(m, 3.0, 5.0, 5.0)));
    let mut sheet = Sheet::new(4, 2, [250, 250]);
    println!("rational (red) beside exact radii (blue), largest difference:");
    for (title, curve) in by_n.into_iter().chain(by_m) {
        let (exact, rational) =
            (outline(curve, Radius::Standard, DVec2::ONE), outline(curve, Radius::Rational, DVec2::ONE));
        let off = exact.iter().zip(&rational).map(|(e, r)| (r.length() / e.length() - 1.0).abs()).fold(0.0, f64::max);
        println!("  {title}: {:.1} %", 100.0 * off);
        let most = exact.iter().chain(&rational).map(|p| p.length()).fold(0.0, f64::max);
        let mut panel = sheet.panel(&title);
        panel.scale = 115.0 / most;
        panel.curve(&exact, BLUE);
        panel.curve(&rational, RED);
    }
    sheet.save(&folder.join("paper_rational.png"))?;
    Ok(())
}
