//! The parts of a mesh: triangles that hang together by shared vertices.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec3;
use rvachev_num::Meter;

use super::groups::Groups;
use crate::geom::{Findings, Mesh};
use crate::{Bounds, Cancelled, Run};

/// A part of a mesh: triangles that hang together by shared vertices, and none besides.
///
/// See [`Mesh::components`].
#[derive(Clone, Debug)]
pub struct Component {
    mesh: Arc<Mesh>,
    /// The numbers of its triangles, in order.
    triangles: Vec<u32>,
    volume: f64,
    area: f64,
    bounds: Bounds,
}

impl Component {
    /// The enclosed volume in cubic length units, as [`Mesh::volume`] has it: negative for the wall
    /// of a cavity, whose triangles face inwards.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// The area, in square length units.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The smallest box that holds it.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The numbers of its triangles in the mesh that it is a part of, in increasing order.
    #[must_use]
    pub fn triangles(&self) -> &[u32] {
        &self.triangles
    }

    /// The part alone, with the normals, colours, texture coordinates and owners that it has in the
    /// whole.
    #[must_use]
    pub fn mesh(&self) -> Mesh {
        // A run that nobody else holds is not cancelled.
        self.mesh_with(&Run::default()).unwrap_or_else(|Cancelled| Mesh::default())
    }

    /// [`mesh`](Component::mesh) with a cancel token and a progress sink; on one thread.
    ///
    /// ```
    /// use rvachev::{MeshSettings, Progress, Run, Solid};
    ///
    /// let mesh = Solid::sphere(1.0).mesh(&MeshSettings::default())?;
    /// let progress = Some(Progress::new(|part| println!("{:.0} %", 100.0 * part)));
    /// let run = Run { progress, ..Run::default() };
    /// assert_eq!(mesh.components_with(&run)?[0].mesh_with(&run)?.triangles().len(), mesh.triangles().len());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Cancelled`] if the token was.
    pub fn mesh_with(&self, run: &Run) -> Result<Mesh, Cancelled> {
        let run = run.stage(0.0, 1.0);
        let mesh = self.mesh.only(&self.triangles, &run.stage(0.0, 0.9))?;
        run.report(1.0);
        Ok(mesh)
    }
}

impl Mesh {
    /// The parts that do not hang together, in the order of their first triangles. Each has its
    /// volume, area and box, and can be had as a mesh. A hollow ball has two: its outside, and its
    /// cavity with a negative volume.
    ///
    /// Triangles that share a vertex hang together; those that only touch, each with a vertex of
    /// its own there, do not. Vertices that no triangle uses are of no part. The time grows with
    /// the mesh, whatever the number of parts.
    ///
    /// ```
    /// use rvachev::{MeshSettings, Solid};
    ///
    /// let pair = Solid::sphere(1.0) | Solid::cuboid([2.0, 2.0, 2.0]).translate([5.0, 0.0, 0.0]);
    /// let parts = pair.mesh(&MeshSettings::default())?.components();
    /// assert_eq!(parts.len(), 2);
    /// let largest = parts.iter().max_by(|a, b| a.volume().total_cmp(&b.volume())).unwrap();
    /// assert!((largest.volume() - 8.0).abs() < 1e-3 && largest.bounds().min.x > 3.9);
    /// assert!(largest.mesh().check().is_sound());
    /// # Ok::<(), rvachev::error::MeshingError>(())
    /// ```
    #[must_use]
    pub fn components(&self) -> Vec<Component> {
        // A run that nobody else holds is not cancelled.
        self.components_with(&Run::default()).unwrap_or_else(|Cancelled| Vec::new())
    }

    /// [`components`](Mesh::components) with a cancel token and a progress sink.
    ///
    /// # Errors
    /// [`Cancelled`] if the token was.
    pub fn components_with(&self, run: &Run) -> Result<Vec<Component>, Cancelled> {
        let run = run.stage(0.0, 1.0);
        let meter = Meter::new(&run, 3 * self.triangles().len());
        let mut groups = Groups::new(self.positions().len());
        for &[a, b, c] in self.triangles() {
            meter.step()?;
            groups.join(a, b);
            groups.join(b, c);
        }
        // The part that the vertices of a root are of.
        let mut parts = vec![u32::MAX; self.positions().len()];
        let mut lists: Vec<Vec<u32>> = Vec::new();
        for (number, triangle) in (0u32..).zip(self.triangles()) {
            meter.step()?;
            let part = &mut parts[groups.root(triangle[0]) as usize];
            if *part == u32::MAX {
                *part = lists.len() as u32;
                lists.push(Vec::new());
            }
            lists[*part as usize].push(number);
        }
        let mesh = Arc::new(self.clone());
        let component = |triangles: Vec<u32>| {
            meter.check()?;
            let (mut area, mut volume, mut min, mut max) = (0.0, 0.0, Vec3::INFINITY, Vec3::NEG_INFINITY);
            // From a point of the part the volumes of far ones do not cancel.
            let origin = mesh.corners(mesh.triangles()[triangles[0] as usize])[0];
            for number in &triangles {
                let triangle = mesh.triangles()[*number as usize];
                let [a, b, c] = mesh.corners(triangle).map(|p| p - origin);
                area += 0.5 * (b - a).cross(c - a).length();
                volume += a.dot(b.cross(c)) / 6.0;
                for p in triangle.map(|v| mesh.positions()[v as usize]) {
                    (min, max) = (min.min(p), max.max(p));
                }
            }
            meter.add(triangles.len() as u64);
            let bounds = Bounds::new(min.as_dvec3(), max.as_dvec3());
            Ok(Component { mesh: mesh.clone(), triangles, volume, area, bounds })
        };
        let found = lists.into_iter().map(component).collect::<Result<Vec<Component>, Cancelled>>()?;
        run.report(1.0);
        Ok(found)
    }

    /// The mesh with only those of its [components](Mesh::components) that are to be kept: of a
    /// scan or an import, what is large enough, or all but the dust. What they carry is kept as it
    /// is.
    ///
    /// The wall of a cavity is a component of its own, of a negative volume.
    ///
    /// ```
    /// use rvachev::{MeshSettings, Solid};
    ///
    /// let dusty = Solid::cuboid([4.0, 4.0, 4.0]) | Solid::sphere(0.3).translate([5.0, 0.0, 0.0]);
    /// let mesh = dusty.mesh(&MeshSettings::default())?;
    /// let clean = mesh.keep_components(|part| part.volume().abs() > 1.0);
    /// assert_eq!((mesh.components().len(), clean.components().len()), (2, 1));
    /// // By size, against the largest one.
    /// let longest = mesh.bounds().longest_side();
    /// let large = mesh.keep_components(|part| part.bounds().longest_side() > 0.5 * longest);
    /// assert_eq!(large.triangles(), clean.triangles());
    /// # Ok::<(), rvachev::error::MeshingError>(())
    /// ```
    #[must_use]
    pub fn keep_components(&self, is_kept: impl Fn(&Component) -> bool) -> Mesh {
        // A run that nobody else holds is not cancelled.
        self.keep_components_with(is_kept, &Run::default()).unwrap_or_else(|Cancelled| Mesh::default())
    }

    /// [`keep_components`](Mesh::keep_components) with a cancel token and a progress sink.
    ///
    /// # Errors
    /// [`Cancelled`] if the token was.
    pub fn keep_components_with(&self, is_kept: impl Fn(&Component) -> bool, run: &Run) -> Result<Mesh, Cancelled> {
        let run = run.stage(0.0, 1.0);
        let [finding, keeping, _] = run.stages([2.0, 7.0, 1.0]);
        let parts = self.components_with(&finding)?;
        let mut kept: Vec<u32> =
            parts.iter().filter(|part| is_kept(part)).flat_map(|part| part.triangles.iter().copied()).collect();
        kept.sort_unstable();
        let mesh = self.only(&kept, &keeping)?;
        run.report(1.0);
        Ok(mesh)
    }

    /// Some triangles alone, with their vertices and all that they carry.
    fn only(&self, chosen: &[u32], run: &Run) -> Result<Mesh, Cancelled> {
        let meter = Meter::new(run, chosen.len());
        let mut numbers = HashMap::with_capacity(chosen.len());
        let mut vertices: Vec<usize> = Vec::new();
        let mut triangles = Vec::with_capacity(chosen.len());
        for number in chosen {
            meter.step()?;
            triangles.push(self.triangles()[*number as usize].map(|vertex| {
                *numbers.entry(vertex).or_insert_with(|| {
                    vertices.push(vertex as usize);
                    vertices.len() as u32 - 1
                })
            }));
        }
        let positions = vertices.iter().map(|v| self.positions()[*v]).collect();
        let part = |mesh: Mesh| {
            let mut part = mesh.with_findings(Findings { cell: self.findings().cell, ..Findings::default() });
            if let Some(normals) = self.normals() {
                part = part.with_normals(vertices.iter().map(|v| normals[*v]).collect())?;
            }
            if let Some(normals) = self.corner_normals() {
                part = part.with_corner_normals(of(chosen, normals))?;
            }
            if let Some(colors) = self.corner_colors() {
                part = part.with_corner_colors(of(chosen, colors))?;
            }
            if let Some(texture) = self.corner_texture() {
                part = part.with_corner_texture(of(chosen, texture))?;
            }
            match self.owners() {
                Some(owners) => part.with_owners(of(chosen, owners)),
                None => Ok(part),
            }
        };
        // What is of a mesh is right for a part of it.
        Ok(Mesh::new(positions, triangles).and_then(part).unwrap_or_default())
    }
}

/// What belongs to some triangles.
fn of<T: Copy>(chosen: &[u32], all: &[T]) -> Vec<T> {
    chosen.iter().map(|number| all[*number as usize]).collect()
}
