//! The example that others script: what it takes and what it prints.

use glam::{DMat3, DVec2, DVec3};
use rvachev::PointCloud;
use serde_json::Value;

use super::bent::Bent;
use super::clouds::{CONDITIONS, Quadric, cloud};
use super::shapes::Shaped;
use crate::support::Random;

#[path = "../../../examples/fit_cloud/task.rs"]
mod task;

use task::{Arguments, Kind, fitted, line};

fn quadric() -> Quadric {
    Quadric {
        e: [0.4, 1.3],
        semi_axes: DVec3::new(1.2, 0.8, 2.0),
        rotation: DMat3::from_rotation_z(0.8),
        center: DVec3::new(0.1, 0.0, -0.3),
    }
}

fn printed(points: Vec<DVec3>, kind: Kind) -> Value {
    let text = line(&fitted(&PointCloud::new(points).unwrap(), kind, 0).unwrap(), 0.5);
    assert!(!text.contains('\n'), "{text}");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn keys(of: &Value) -> Vec<&str> {
    of.as_object().unwrap().keys().map(String::as_str).collect()
}

fn vector(of: &Value, key: &str) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|i| of[key][i].as_f64().unwrap()))
}

const POSE: [&str; 6] = ["rotation", "translation", "noise", "inliers", "evaluations", "ms"];

fn check_keys(of: &Value, own: &[&str]) {
    let mut wanted: Vec<&str> = ["kind"].into_iter().chain(own.iter().copied()).chain(POSE).collect();
    let mut found = keys(of);
    wanted.sort_unstable();
    found.sort_unstable();
    assert_eq!(found, wanted);
}

#[test]
fn the_line_is_the_solid() {
    let truth = quadric();
    let points = cloud(&truth, CONDITIONS[1], 600, &mut Random::new(3));
    for kind in [Kind::Superellipsoid, Kind::Auto] {
        let found = printed(points.clone(), kind);
        assert_eq!(found["kind"], "superellipsoid");
        check_keys(&found, &["semi_axes", "exponents"]);
        assert!((vector(&found, "translation") - truth.center).length() < 0.02, "{found}");
        assert!(found["ms"] == 0.5 && found["evaluations"].as_u64().unwrap() > 1000);
        // World point = R · local + t: points of the cloud are of the printed solid.
        let turn: Vec<f64> = found["rotation"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        let [x, y, z, w] = turn.try_into().unwrap();
        let rotation = DMat3::from_quat(glam::DQuat::from_xyzw(x, y, z, w));
        let e = [0, 1].map(|i| found["exponents"][i].as_f64().unwrap());
        let solid =
            Quadric { e, semi_axes: vector(&found, "semi_axes"), rotation, center: vector(&found, "translation") };
        assert!(points.iter().all(|p| (solid.gauge(*p) - 1.0).abs() < 0.1));
    }
}

#[test]
fn each_kind_has_its_keys() {
    let star = Shaped::star();
    let points = star.cloud(CONDITIONS[0], 600, &mut Random::new(1));
    for kind in [Kind::Supershape, Kind::Auto] {
        let found = printed(points.clone(), kind);
        assert!(found["kind"] == "supershape" && found["m"] == 5 && found["m2"] == 4, "{found}");
        check_keys(&found, &["m", "n", "m2", "n2", "semi_axes"]);
    }
    let base = Quadric { e: [0.4, 0.6], rotation: DMat3::IDENTITY, ..quadric() };
    let truth = Bent { base, taper: [0.4, 0.1], twist: 0.0, bend: DVec2::new(0.3, 0.1) };
    let points = truth.cloud(CONDITIONS[1], 700, &mut Random::new(2));
    for kind in [Kind::Deformed, Kind::Auto] {
        let found = printed(points.clone(), kind);
        assert_eq!(found["kind"], "deformed", "{found}");
        check_keys(&found, &["semi_axes", "exponents", "taper", "bend", "twist"]);
        assert!(found["taper"].as_array().unwrap().len() == 2 && found["bend"].as_array().unwrap().len() == 2);
    }
}

#[test]
fn command_lines_are_read_or_refused() {
    let read = |words: &str| Arguments::read(words.split_whitespace().map(str::to_owned));
    let all = read("scan.ply --kind supershape --seed 7").unwrap();
    assert_eq!(all, Arguments { file: Some("scan.ply".into()), kind: Kind::Supershape, seed: 7 });
    assert_eq!(read("--kind auto").unwrap(), Arguments { file: None, kind: Kind::Auto, seed: 0 });
    let refused = |words: &str| read(words).unwrap_err().to_string();
    assert!(refused("a.ply --kind ball").contains("allowed: superellipsoid, supershape, deformed, auto"));
    assert!(refused("a.ply --seed -1").contains("whole numbers") && refused("--seed").contains("whole numbers"));
    assert!(refused("a.ply b.ply").contains("b.ply") && refused("--fast").contains("--kind"));
}
