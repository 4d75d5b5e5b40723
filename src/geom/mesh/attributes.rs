//! What a mesh may carry besides its shape.
//!
//! ```text
//!   per vertex     normals
//!   per triangle   owners
//!   per corner     corner_normals, corner_colors, corner_texture
//!
//!               c            Corner k of triangle t belongs to vertex triangles[t][k].
//!              /2\           Two triangles that share a vertex may give it different
//!             /   \          values: at a crease its normal, at the border of two
//!            /0   1\         parts its colour, at a seam its texture coordinates.
//!           a-------b
//! ```
//!
//! The shape stays welded all the while: a file format that has room for one value a vertex
//! splits the vertices that carry several when it is written, and only those.

use glam::Vec3;

use super::corner_normals::CornerNormals;
use super::flipped::over;
use super::{Mesh, MeshError, first};

/// What a mesh carries besides positions and triangles; `None` where it has no such values.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Attributes {
    normals: Option<Vec<Vec3>>,
    corner_colors: Option<Vec<[[u8; 4]; 3]>>,
    corner_texture: Option<Vec<[[f32; 2]; 3]>>,
    owners: Option<Vec<u32>>,
}

impl Attributes {
    /// Those of the mesh with its triangles turned over.
    pub(super) fn flipped(&self) -> Attributes {
        Attributes {
            normals: self.normals.as_ref().map(|normals| normals.iter().map(|normal| -normal).collect()),
            corner_colors: self.corner_colors.as_ref().map(|all| all.iter().map(|corners| over(*corners)).collect()),
            corner_texture: self.corner_texture.as_ref().map(|all| all.iter().map(|corners| over(*corners)).collect()),
            owners: self.owners.clone(),
        }
    }
}

impl Mesh {
    /// The same mesh with a unit normal per vertex, pointing out of the solid, in place of
    /// any that it had.
    ///
    /// # Errors
    ///
    /// [`MeshError::Normals`] if their number is not that of the vertices, and
    /// [`MeshError::Normal`] if one of them is NaN or infinite.
    pub fn with_normals(mut self, normals: Vec<Vec3>) -> Result<Mesh, MeshError> {
        if normals.len() != self.positions.len() {
            return Err(MeshError::Normals { normals: normals.len(), vertices: self.positions.len() });
        }
        if let Some(vertex) = normals.iter().position(|normal| !normal.is_finite()) {
            return Err(MeshError::Normal { vertex });
        }
        // Corners keep the normals that they have.
        let _ = self.corner_normals();
        self.attributes.normals = Some(normals);
        Ok(self)
    }

    /// The same mesh with a unit normal per corner, pointing out of the solid, in place of
    /// any that it had. At a smooth vertex all corners have the same one, at a crease each
    /// has that of its side. They go before [`normals`](Mesh::normals).
    ///
    /// ```
    /// use glam::Vec3;
    /// use rvachev::Mesh;
    ///
    /// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]])?;
    /// let mesh = mesh.with_corner_normals(vec![[Vec3::Z; 3]])?;
    /// assert_eq!(mesh.corner_normals(), Some(&[[Vec3::Z; 3]][..]));
    /// # Ok::<(), rvachev::error::MeshError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`MeshError::Corners`] if there are not three for each triangle, and
    /// [`MeshError::NotFinite`] if one of them is NaN or infinite.
    pub fn with_corner_normals(mut self, normals: Vec<[Vec3; 3]>) -> Result<Mesh, MeshError> {
        self.fits_triangles("normals of corners", normals.len())?;
        finite("normal", &normals, |n| n.is_finite())?;
        self.corner_normals = Some(CornerNormals::given(normals));
        Ok(self)
    }

    /// The same mesh with a colour per corner, in place of any that it had: red, green, blue
    /// and opacity from 0 to 255, in sRGB as pictures have them.
    ///
    /// # Errors
    ///
    /// [`MeshError::Corners`] if there are not three for each triangle.
    pub fn with_corner_colors(mut self, colors: Vec<[[u8; 4]; 3]>) -> Result<Mesh, MeshError> {
        self.fits_triangles("colours of corners", colors.len())?;
        self.attributes.corner_colors = Some(colors);
        Ok(self)
    }

    /// The same mesh with texture coordinates u, v per corner, in place of any that it had:
    /// u to the right and v upwards in the picture, which spans 0 to 1.
    ///
    /// # Errors
    ///
    /// [`MeshError::Corners`] if there are not three for each triangle, and
    /// [`MeshError::NotFinite`] if one of them is NaN or infinite.
    pub fn with_corner_texture(mut self, texture: Vec<[[f32; 2]; 3]>) -> Result<Mesh, MeshError> {
        self.fits_triangles("texture coordinates of corners", texture.len())?;
        finite("texture coordinate", &texture, |uv| uv.iter().all(|x| x.is_finite()))?;
        self.attributes.corner_texture = Some(texture);
        Ok(self)
    }

    /// The same mesh with an owner per triangle, in place of any that it had: a number that
    /// tells which part of the solid the triangle belongs to.
    ///
    /// # Errors
    ///
    /// [`MeshError::Corners`] if there is not one for each triangle.
    pub fn with_owners(mut self, owners: Vec<u32>) -> Result<Mesh, MeshError> {
        self.fits_triangles("owners", owners.len())?;
        self.attributes.owners = Some(owners);
        Ok(self)
    }

    /// The unit normals of the vertices, if the mesh has them.
    #[must_use]
    pub fn normals(&self) -> Option<&[Vec3]> {
        self.attributes.normals.as_deref()
    }

    /// The colours of the corners, if the mesh has them: three for each triangle, each red,
    /// green, blue and opacity in sRGB, 0 to 255.
    #[must_use]
    pub fn corner_colors(&self) -> Option<&[[[u8; 4]; 3]]> {
        self.attributes.corner_colors.as_deref()
    }

    /// The texture coordinates u, v of the corners, if the mesh has them: three for each
    /// triangle, u to the right and v upwards.
    #[must_use]
    pub fn corner_texture(&self) -> Option<&[[[f32; 2]; 3]]> {
        self.attributes.corner_texture.as_deref()
    }

    /// The owners of the triangles, if the mesh has them: one for each triangle.
    #[must_use]
    pub fn owners(&self) -> Option<&[u32]> {
        self.attributes.owners.as_deref()
    }

    fn fits_triangles(&self, what: &'static str, given: usize) -> Result<(), MeshError> {
        let triangles = self.triangles.len();
        if given == triangles { Ok(()) } else { Err(MeshError::Corners { what, given, triangles }) }
    }
}

fn finite<T: Copy + Sync>(
    what: &'static str,
    values: &[[T; 3]],
    is_finite: impl Fn(T) -> bool + Sync,
) -> Result<(), MeshError> {
    let is_bad = |value: &T| !is_finite(*value);
    match first(values, |corners| corners.iter().any(is_bad)) {
        None => Ok(()),
        Some(triangle) => {
            let corner = values[triangle].iter().position(is_bad).unwrap_or_default();
            Err(MeshError::NotFinite { what, triangle, corner })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Mesh {
        Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]).unwrap()
    }

    #[test]
    fn what_is_given_comes_back() {
        let plain = triangle();
        assert_eq!((plain.normals(), plain.corner_normals(), plain.owners()), (None, None, None));
        assert_eq!((plain.corner_colors(), plain.corner_texture()), (None, None));
        let colors = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 128]];
        let texture = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let mesh = plain.with_normals(vec![Vec3::Z; 3]).unwrap();
        let mesh = mesh.with_corner_normals(vec![[Vec3::Z, Vec3::X, Vec3::Y]]).unwrap();
        let mesh = mesh.with_corner_colors(vec![colors]).unwrap().with_corner_texture(vec![texture]).unwrap();
        let mesh = mesh.with_owners(vec![7]).unwrap();
        assert_eq!(mesh.normals().unwrap().len(), 3);
        assert_eq!(mesh.corner_normals().unwrap()[0][1], Vec3::X);
        assert_eq!(mesh.corner_colors(), Some(&[colors][..]));
        assert_eq!(mesh.corner_texture(), Some(&[texture][..]));
        assert_eq!(mesh.owners(), Some(&[7][..]));
        // Normals of the corners do not follow other normals of the vertices.
        let turned = mesh.clone().with_normals(vec![Vec3::X; 3]).unwrap();
        assert_eq!(turned.corner_normals(), mesh.corner_normals());
        assert_ne!(turned, mesh);
    }

    #[test]
    fn wrong_counts_are_named() {
        let error = triangle().with_corner_colors(vec![]).unwrap_err();
        assert_eq!(error.to_string(), "colours of corners for 0 triangles, but there are 1; every triangle needs them");
        let errors = [
            triangle().with_corner_normals(vec![[Vec3::Z; 3]; 2]).unwrap_err(),
            triangle().with_corner_texture(vec![]).unwrap_err(),
            triangle().with_owners(vec![1, 2]).unwrap_err(),
        ];
        assert!(errors.iter().all(|error| matches!(error, MeshError::Corners { triangles: 1, .. })));
    }

    #[test]
    fn values_that_are_not_finite_are_named() {
        let error = triangle().with_corner_texture(vec![[[0.0, 0.0], [1.0, f32::NAN], [0.0, 1.0]]]).unwrap_err();
        assert_eq!(error.to_string(), "the texture coordinate at corner 1 of triangle 0 is not finite");
        let error = triangle().with_corner_normals(vec![[Vec3::Z, Vec3::Z, Vec3::INFINITY]]).unwrap_err();
        assert_eq!(error, MeshError::NotFinite { what: "normal", triangle: 0, corner: 2 });
        let error = triangle().with_normals(vec![Vec3::Z, Vec3::NAN, Vec3::Z]).unwrap_err();
        assert_eq!(error.to_string(), "the normal of vertex 1 is not finite");
    }
}
