//! A mesh turned inside out.

use super::Mesh;

impl Mesh {
    /// The same mesh inside out: every triangle is turned over, and normals point the other way. Of
    /// a mesh whose triangles are seen clockwise from outside, as some programs write them, this
    /// makes one that encloses its inside: see [`Solid::from_mesh`](crate::Solid::from_mesh).
    ///
    /// Each triangle keeps its number and its first corner; the other two change places, and so do
    /// their colours, texture coordinates and normals.
    ///
    /// ```
    /// use rvachev::{MeshSettings, MeshSolid, Solid};
    ///
    /// let mesh = Solid::cuboid([4.0, 2.0, 2.0]).mesh(&MeshSettings::default())?;
    /// let inside_out = mesh.flipped();
    /// assert!(inside_out.volume() < 0.0);
    /// let error = Solid::from_mesh(&inside_out, MeshSolid::default()).contains([0.0; 3]).unwrap_err();
    /// assert!(error.to_string().contains("the mesh is inside out"));
    /// let again = inside_out.flipped();
    /// assert_eq!(again, mesh);
    /// assert!(Solid::from_mesh(&again, MeshSolid::default()).contains([0.0; 3])?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn flipped(&self) -> Mesh {
        let turned = Mesh {
            positions: self.positions.clone(),
            triangles: self.triangles.iter().map(|corners| over(*corners)).collect(),
            attributes: self.attributes.flipped(),
            corner_normals: None,
            findings: self.findings.clone(),
        };
        let Some(normals) = self.corner_normals() else { return turned };
        let normals = normals.iter().map(|corners| over(corners.map(|normal| -normal))).collect();
        turned.with_corner_normals(normals).unwrap_or_else(|_| unreachable!("there are as many, and as finite"))
    }
}

/// What three corners have, the other way round.
pub(super) fn over<T>([a, b, c]: [T; 3]) -> [T; 3] {
    [a, c, b]
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn corners_keep_what_they_have() {
        let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]).unwrap();
        let mesh = mesh.with_normals(vec![Vec3::Z; 3]).unwrap();
        let mesh = mesh.with_corner_normals(vec![[Vec3::Z, Vec3::X, Vec3::Y]]).unwrap().with_owners(vec![7]).unwrap();
        let mesh = mesh.with_corner_colors(vec![[[1; 4], [2; 4], [3; 4]]]).unwrap();
        let mesh = mesh.with_corner_texture(vec![[[0.0; 2], [0.5; 2], [1.0; 2]]]).unwrap();
        let flipped = mesh.flipped();
        assert_eq!(flipped.triangles(), [[0, 2, 1]]);
        assert_eq!(flipped.normals(), Some(&[Vec3::NEG_Z; 3][..]));
        assert_eq!(flipped.corner_normals(), Some(&[[Vec3::NEG_Z, Vec3::NEG_Y, Vec3::NEG_X]][..]));
        assert_eq!(flipped.corner_colors(), Some(&[[[1; 4], [3; 4], [2; 4]]][..]));
        assert_eq!(flipped.corner_texture(), Some(&[[[0.0; 2], [1.0; 2], [0.5; 2]]][..]));
        assert_eq!(flipped.owners(), Some(&[7][..]));
        assert_eq!(flipped.flipped(), mesh);
        assert_eq!(Mesh::default().flipped(), Mesh::default());
    }
}
