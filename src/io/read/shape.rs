//! What a file holds, before it is a mesh or a point cloud.

use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::error::FilePlace;
use super::limits::Limits;
use super::text::{expected_coordinate, is_coordinate, is_position};
use super::{LoadSettings, ReadError};
use crate::geom::{Mesh, PointCloud};

/// Opaque white: the colour of what has none beside parts that have.
const WHITE: [u8; 4] = [255; 4];

/// Vertices and triangles with what they carry. Lists are as long as that of the vertices or of the
/// triangles, and indices are in range.
#[derive(Default)]
pub(super) struct Shape {
    pub(super) positions: Vec<DVec3>,
    pub(super) normals: Option<Vec<Vec3>>,
    pub(super) colors: Option<Vec<[u8; 4]>>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) corner_normals: Option<Vec<[Vec3; 3]>>,
    pub(super) corner_colors: Option<Vec<[[u8; 4]; 3]>>,
    pub(super) corner_texture: Option<Vec<[[f32; 2]; 3]>>,
    pub(super) owners: Option<Vec<u32>>,
    /// Points whose coordinates are none, by their numbers, and the place of the first ones.
    pub(super) invalid: Vec<usize>,
    pub(super) places: Vec<FilePlace>,
}

/// The places of so many points without coordinates are told.
const TOLD: usize = 5;

impl Shape {
    /// Adds a point, whose coordinates may be none.
    pub(super) fn push(&mut self, coordinates: [f64; 3], place: impl FnOnce() -> FilePlace) {
        if !is_position(coordinates) {
            self.invalid.push(self.positions.len());
            if self.places.len() < TOLD {
                self.places.push(place());
            }
        }
        self.positions.push(DVec3::from_array(coordinates));
    }

    /// Leaves out points whose coordinates are none, as far as the settings allow it: those of
    /// triangles never.
    pub(super) fn skip(&mut self, settings: &LoadSettings) -> Result<(), ReadError> {
        let Some(first) = self.invalid.first() else { return Ok(()) };
        let count = self.invalid.len();
        let is_allowed = self.triangles.is_empty() && count as u64 <= settings.most_skipped;
        if let (false, Some(place)) = (is_allowed, self.places.first()) {
            let p = self.positions[*first].to_array();
            let found = p.into_iter().find(|x| !is_coordinate(*x)).unwrap_or(f64::NAN);
            let (points, expected) = (self.positions.len(), expected_coordinate());
            let mut found = format!("{found:?}");
            if count > 1 {
                let others: Vec<String> = self.places[1..].iter().map(FilePlace::to_string).collect();
                let more = if count > self.places.len() { ", …" } else { "" };
                found += &format!("; {count} of {points} points are like this: also {}{more}", others.join(", "));
            }
            if self.triangles.is_empty() {
                found += &format!("; LoadSettings::most_skipped = {count} leaves them out");
            }
            return Err(ReadError::content(place.clone(), expected, found));
        }
        let mut invalid = std::mem::take(&mut self.invalid).into_iter().peekable();
        let kept: Vec<bool> = (0..self.positions.len()).map(|i| invalid.next_if_eq(&i).is_none()).collect();
        keep(&mut self.positions, &kept);
        self.normals.iter_mut().for_each(|normals| keep(normals, &kept));
        self.colors.iter_mut().for_each(|colors| keep(colors, &kept));
        Ok(())
    }

    /// As a mesh; lengths are multiplied by `scale`.
    pub(super) fn into_mesh(mut self, scale: f64) -> Result<Mesh, ReadError> {
        if self.triangles.is_empty() && !self.positions.is_empty() {
            let found = format!("{} vertices alone, which make a PointCloud", self.positions.len());
            return Err(ReadError::content(FilePlace::Byte(0), "a file with triangles", found));
        }
        self.gather();
        let positions = self.positions.iter().map(|p| (*p * scale).as_vec3()).collect();
        let of_vertices = self.colors.take().map(|colors| corners_of(&self.triangles, &colors));
        let mut mesh = Mesh::new(positions, self.triangles)?;
        if let Some(normals) = self.normals {
            mesh = mesh.with_normals(normals)?;
        }
        if let Some(normals) = self.corner_normals {
            mesh = mesh.with_corner_normals(normals)?;
        }
        if let Some(colors) = self.corner_colors.or(of_vertices) {
            mesh = mesh.with_corner_colors(colors)?;
        }
        if let Some(texture) = self.corner_texture {
            mesh = mesh.with_corner_texture(texture)?;
        }
        if let Some(owners) = self.owners {
            mesh = mesh.with_owners(owners)?;
        }
        Ok(mesh)
    }

    /// The vertices as points; lengths are multiplied by `scale`.
    pub(super) fn into_cloud(mut self, scale: f64) -> Result<PointCloud, ReadError> {
        self.gather();
        let colors = match (self.colors, self.corner_colors) {
            (None, Some(corners)) => of_vertices(&self.triangles, &corners, self.positions.len(), WHITE),
            (colors, _) => colors,
        };
        if scale != 1.0 {
            self.positions.iter_mut().for_each(|p| *p *= scale);
        }
        let mut cloud = PointCloud::new(self.positions)?;
        if let Some(normals) = self.normals {
            cloud = cloud.with_normals(normals)?;
        }
        if let Some(colors) = colors {
            cloud = cloud.with_colors(colors.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())?;
        }
        Ok(cloud)
    }

    /// Normals of corners as those of vertices, where each vertex has one.
    fn gather(&mut self) {
        if let Some(corners) = &self.corner_normals
            && let Some(normals) = of_vertices(&self.triangles, corners, self.positions.len(), Vec3::ZERO)
        {
            (self.normals, self.corner_normals) = (Some(normals), None);
        }
    }

    /// Moves it by an affine map.
    pub(super) fn moved(mut self, map: &DAffine3) -> Shape {
        let matrix = map.matrix3;
        self.positions.iter_mut().for_each(|p| *p = map.transform_point3(*p));
        let is_scaling = matrix == DMat3::from_diagonal(DVec3::splat(matrix.x_axis.x)) && matrix.x_axis.x > 0.0;
        if !is_scaling {
            // Of a singular map, which leaves no normals, any will do.
            let flat = matrix.determinant() == 0.0;
            let turn = if flat { DMat3::IDENTITY } else { matrix.inverse().transpose() };
            let turned = |n: &mut Vec3| *n = (turn * n.as_dvec3()).normalize_or_zero().as_vec3();
            self.normals.iter_mut().flatten().for_each(turned);
            self.corner_normals.iter_mut().flatten().flatten().for_each(turned);
        }
        if matrix.determinant() < 0.0 {
            self.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
            self.corner_normals.iter_mut().flatten().for_each(|corners| corners.swap(1, 2));
            self.corner_colors.iter_mut().flatten().for_each(|corners| corners.swap(1, 2));
            self.corner_texture.iter_mut().flatten().for_each(|corners| corners.swap(1, 2));
        }
        self
    }

    /// Several parts as one. Normals and texture are kept if all parts with triangles have them,
    /// per corner; parts without colours beside others with some are white.
    pub(super) fn joined(parts: Vec<Shape>, settings: &Limits<'_>) -> Result<Shape, ReadError> {
        let solid = |has: fn(&Shape) -> bool| parts.iter().filter(|part| !part.triangles.is_empty()).all(has);
        let all_normals = solid(|part| part.corner_normals.is_some());
        let all_texture = solid(|part| part.corner_texture.is_some());
        let some_colors = parts.iter().any(|part| part.corner_colors.is_some());
        let points_have_normals = parts.iter().all(|part| part.normals.is_some());
        let points_have_colors = parts.iter().any(|part| part.colors.is_some());
        let mut all = Shape::default();
        let (mut normals, mut colors, mut texture) = (Vec::new(), Vec::new(), Vec::new());
        let (mut of_points, mut colors_of_points) = (Vec::new(), Vec::new());
        for part in parts {
            let first = all.positions.len() as u32;
            let (count, points) = (part.triangles.len(), part.positions.len());
            settings.points(all.positions.len() + points)?;
            settings.triangles(all.triangles.len() + count)?;
            settings.run.check()?;
            all.positions.extend(part.positions);
            all.triangles.extend(part.triangles.into_iter().map(|corners| corners.map(|v| v + first)));
            normals.extend(part.corner_normals.filter(|_| all_normals).into_iter().flatten());
            texture.extend(part.corner_texture.filter(|_| all_texture).into_iter().flatten());
            if some_colors {
                colors.extend(part.corner_colors.unwrap_or_else(|| vec![[WHITE; 3]; count]));
            }
            of_points.extend(part.normals.filter(|_| points_have_normals).into_iter().flatten());
            if points_have_colors {
                colors_of_points.extend(part.colors.unwrap_or_else(|| vec![WHITE; points]));
            }
        }
        let has_triangles = !all.triangles.is_empty();
        all.corner_normals = (has_triangles && all_normals).then_some(normals);
        all.corner_texture = (has_triangles && all_texture).then_some(texture);
        all.corner_colors = (has_triangles && some_colors).then_some(colors);
        all.normals = (points_have_normals && !of_points.is_empty()).then_some(of_points);
        all.colors = points_have_colors.then_some(colors_of_points);
        Ok(all)
    }
}

/// What vertices carry, for each corner.
pub(super) fn corners_of<T: Copy>(triangles: &[[u32; 3]], values: &[T]) -> Vec<[T; 3]> {
    triangles.iter().map(|corners| corners.map(|v| values[v as usize])).collect()
}

/// What corners carry, for each vertex, if all corners of each agree. Vertices without corners get
/// the `default`.
fn of_vertices<T: Copy + PartialEq>(
    triangles: &[[u32; 3]],
    values: &[[T; 3]],
    count: usize,
    default: T,
) -> Option<Vec<T>> {
    let mut found: Vec<Option<T>> = vec![None; count];
    let mut corners = triangles.as_flattened().iter().zip(values.as_flattened());
    let agree = corners.all(|(v, value)| *found[*v as usize].get_or_insert(*value) == *value);
    agree.then(|| found.into_iter().map(|value| value.unwrap_or(default)).collect())
}

/// Leaves out what is not kept.
fn keep<T>(items: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    items.retain(|_| kept.next().copied().unwrap_or(true));
}
