//! The nodes of a glTF scene that hold meshes, and where they are.

use glam::{DAffine3, DMat4, DQuat, DVec3};
use serde_json::Value;

use super::super::ReadError;
use super::super::limits::Limits;
use super::wrong;

/// The meshes of the default scene, or of all nodes if there is no scene, and their maps.
pub(super) fn nodes(json: &Value, settings: &Limits<'_>) -> Result<Vec<(usize, DAffine3)>, ReadError> {
    let all = json["nodes"].as_array().map(Vec::as_slice).unwrap_or_default();
    let scene = json["scene"].as_u64().unwrap_or(0) as usize;
    let mut open: Vec<(usize, DAffine3)> = match &json["scenes"][scene]["nodes"] {
        Value::Array(roots) => places(roots, "nodes of the scene")?.map(|node| (node, DAffine3::IDENTITY)).collect(),
        _ => {
            let children: Vec<usize> =
                all.iter().flat_map(children).filter_map(Value::as_u64).map(|i| i as usize).collect();
            (0..all.len()).filter(|node| !children.contains(node)).map(|node| (node, DAffine3::IDENTITY)).collect()
        }
    };
    open.reverse();
    let mut met = vec![false; all.len()];
    let mut found = Vec::new();
    while let Some((at, above)) = open.pop() {
        let Some(node) = all.get(at) else {
            return Err(wrong(&format!("a node from 0, of {} nodes", all.len()), at.to_string()));
        };
        // Else few nodes might stand for any number of meshes, or hold themselves.
        if std::mem::replace(&mut met[at], true) {
            return Err(wrong("nodes that make a tree", format!("node {at} twice")));
        }
        let map = above * map(node)?;
        if let Some(mesh) = node["mesh"].as_u64() {
            settings.points(found.len() + 1)?;
            found.push((mesh as usize, map));
        }
        let below = children(node);
        open.extend(places(below, "children of a node")?.rev().map(|child| (child, map)));
    }
    Ok(found)
}

fn children(node: &Value) -> &[Value] {
    node["children"].as_array().map(Vec::as_slice).unwrap_or_default()
}

/// Whole numbers.
fn places<'a>(list: &'a [Value], what: &str) -> Result<impl DoubleEndedIterator<Item = usize> + 'a, ReadError> {
    if let Some(other) = list.iter().find(|value| value.as_u64().is_none()) {
        return Err(wrong(&format!("whole numbers as {what}"), other.to_string()));
    }
    Ok(list.iter().filter_map(Value::as_u64).map(|i| i as usize))
}

/// The map of a node: a matrix, or scale, rotation and translation.
fn map(node: &Value) -> Result<DAffine3, ReadError> {
    let map = match numbers::<16>(node, "matrix")? {
        Some(matrix) => DAffine3::from_mat4(DMat4::from_cols_array(&matrix)),
        None => {
            let scale = numbers(node, "scale")?.map_or(DVec3::ONE, DVec3::from_array);
            let rotation = numbers(node, "rotation")?.map_or(DQuat::IDENTITY, DQuat::from_array);
            let translation = numbers(node, "translation")?.map_or(DVec3::ZERO, DVec3::from_array);
            let length = rotation.length();
            if !(length > 1e-6 && length.is_finite()) {
                return Err(wrong("a rotation of length 1", length.to_string()));
            }
            DAffine3::from_scale_rotation_translation(scale, rotation.normalize(), translation)
        }
    };
    if map.is_finite() { Ok(map) } else { Err(wrong("a finite map of a node", map.to_string())) }
}

/// Numbers of a node; nothing where there are none.
fn numbers<const N: usize>(node: &Value, name: &str) -> Result<Option<[f64; N]>, ReadError> {
    if node[name].is_null() {
        return Ok(None);
    }
    let list = node[name].as_array().map(Vec::as_slice).unwrap_or_default();
    let list: Vec<f64> = list.iter().filter_map(Value::as_f64).collect();
    match <[f64; N]>::try_from(list) {
        Ok(numbers) => Ok(Some(numbers)),
        Err(_) => Err(wrong(&format!("{N} numbers as {name}"), node[name].to_string())),
    }
}
