//! What the extraction of a mesh found besides its shape: plain numbers.

use glam::DVec3;

use super::Mesh;
use crate::geom::ThinReport;
use crate::geom::figures::point;
use rvachev_num::figures;

/// What was found when a mesh was extracted from a solid.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Findings {
    /// The side of a cell, in length units; 0 if the mesh was not extracted.
    pub(crate) cell: f64,
    /// How many blocks of cells the surface may cross.
    pub(crate) blocks: usize,
    /// See [`Mesh::clamped_vertices`].
    pub(crate) clamped_vertices: Option<usize>,
    /// See [`Mesh::possibly_lost`].
    pub(crate) possibly_lost: usize,
    /// The middles of the blocks that are counted, unless the mesh was moved since.
    pub(crate) lost_at: Vec<DVec3>,
    /// How far the mesh may be off its surface, and how far was asked for, in length units.
    pub(crate) deviation: Option<[f64; 2]>,
    /// See [`Mesh::thin_features`].
    pub(crate) thin: Option<ThinReport>,
}

impl Findings {
    /// Those of a mesh that is moved or deformed: counts hold, places and sizes do not.
    fn without_places(&self) -> Findings {
        Findings { cell: 0.0, lost_at: Vec::new(), deviation: None, thin: None, ..self.clone() }
    }
}

impl Mesh {
    pub(crate) fn with_findings(mut self, findings: Findings) -> Mesh {
        self.findings = findings;
        self
    }

    pub(crate) fn findings(&self) -> &Findings {
        &self.findings
    }

    /// The same mesh with the counts that were found for another one, of which it is a moved copy.
    pub(crate) fn with_counts_of(self, other: &Mesh) -> Mesh {
        let findings = other.findings.without_places();
        self.with_findings(findings)
    }

    /// How many vertices keep clear of a node that the surface is closer to, or are off the surface
    /// for another reason; `None` if the mesh was not made from a solid. See
    /// [`MeshReport::clamped_vertices`](crate::MeshReport::clamped_vertices).
    #[must_use]
    pub fn clamped_vertices(&self) -> Option<usize> {
        self.findings.clamped_vertices
    }

    /// How many blocks of 8³ cells may have lost a feature thinner than a cell when the mesh was
    /// extracted from a solid; 0 if it was not made from a solid. Within the limits below it is
    /// conservative: a block counts unless it is shown to have lost nothing.
    ///
    /// It is counted in every extraction, in a small part of its time.
    /// [`Solid::thin_features`](crate::Solid::thin_features) searches for the places and their
    /// sizes, which takes longer.
    ///
    /// ```
    /// use rvachev::{CellSize, MeshSettings, Solid};
    ///
    /// let settings = MeshSettings { cell: CellSize::Length(0.1), ..MeshSettings::default() };
    /// assert_eq!(Solid::cuboid([1.0, 1.0, 1.0]).mesh(&settings)?.possibly_lost(), 0);
    /// // A sheet of a fortieth of a cell passes between the samples: the mesh is empty.
    /// let sheet = Solid::cuboid([1.0, 1.0, 0.0025]).mesh(&settings)?;
    /// assert!(sheet.triangles().is_empty() && sheet.possibly_lost() > 0);
    /// # Ok::<(), rvachev::error::MeshingError>(())
    /// ```
    ///
    /// # Details
    ///
    #[doc = include_str!("possibly_lost.md")]
    #[must_use]
    pub fn possibly_lost(&self) -> usize {
        self.findings.possibly_lost
    }

    /// How far triangles and surface are apart, in length units, where a mesh was made
    /// [within a tolerance](crate::CellSize::Tolerance); `None` if it was not. It is what was found
    /// at the vertices and in the middles of triangles and sides, beyond sides where faces meet at
    /// an acute angle, and at the corners of [meshes](crate::Solid::from_mesh) that the solid is
    /// made of.
    #[must_use]
    pub fn deviation(&self) -> Option<f64> {
        self.findings.deviation.map(|[found, _]| found)
    }

    /// The thin features that were searched for when the mesh was made, with
    /// [`ThinFeatures::Count`](crate::ThinFeatures::Count); `None` if they were not.
    #[must_use]
    pub fn thin_features(&self) -> Option<&ThinReport> {
        self.findings.thin.as_ref()
    }

    /// What may be wrong with the mesh as a picture of its solid, in words, and what to do about
    /// it: one sentence or two each, empty if all is well. It repeats
    /// [`possibly_lost`](Mesh::possibly_lost), and [`thin_features`](Mesh::thin_features) where
    /// they were searched for; nothing is computed.
    ///
    /// ```
    /// use rvachev::{CellSize, MeshSettings, Solid};
    ///
    /// let settings = MeshSettings { cell: CellSize::Length(0.1), ..MeshSettings::default() };
    /// let mesh = Solid::cuboid([1.0, 1.0, 0.0025]).mesh(&settings)?;
    /// for warning in mesh.warnings() {
    ///     eprintln!("warning: {warning}");
    /// }
    /// assert!(mesh.warnings()[0].starts_with("the mesh is empty"));
    /// # Ok::<(), rvachev::error::MeshingError>(())
    /// ```
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let Findings { cell, clamped_vertices, possibly_lost, lost_at, deviation, thin, .. } = &self.findings;
        let mut warnings = Vec::new();
        let is_extracted = clamped_vertices.is_some();
        let is_empty = is_extracted && self.triangles.is_empty();
        if is_empty && *possibly_lost == 0 {
            warnings.push("the mesh is empty: the solid has no points within the bounds".to_owned());
        }
        if *possibly_lost > 0 {
            let empty = if is_empty { "the mesh is empty, and " } else { "" };
            let blocks = if *possibly_lost == 1 { "block" } else { "blocks" };
            let place =
                lost_at.first().map_or(String::new(), |at| format!(", the first of them near {}", point(*at, *cell)));
            let than = if *cell > 0.0 { format!(" ({})", figures(*cell, 5)) } else { String::new() };
            let half = if *cell > 0.0 {
                format!(", as `CellSize::Length({})`,", figures(0.5 * cell, 3))
            } else {
                String::new()
            };
            warnings.push(format!(
                "{empty}features thinner than a cell{than} may be lost in {possibly_lost} {blocks} of cells{place}; \
                 mesh with smaller cells{half} or `ThinFeatures::Refine`, or ask `Solid::thin_features` where they are"
            ));
        }
        if let Some([found, wanted]) = deviation.filter(|[found, wanted]| found > wanted) {
            warnings.push(format!(
                "triangles are up to {found:.3e} off the surface, {wanted:.3e} was asked for; a larger \
                 `CellSize::Tolerance` is reached, and where creases are cut off `Features::Sharp` keeps them"
            ));
        }
        if let Some(first) = thin.as_ref().and_then(|thin| thin.places.first().map(|place| (thin, place))) {
            let (thin, place) = first;
            let places = if thin.count == 1 { "1 place is" } else { &format!("{} places are", thin.count) };
            let size =
                place.thickness.map_or("of unknown thickness".to_owned(), |t| format!("about {} thick", figures(t, 4)));
            let half =
                place.thickness.map_or(String::new(), |t| format!(", as `CellSize::Length({})`,", figures(0.5 * t, 3)));
            warnings.push(format!(
                "{places} thinner than cells show, the largest near {}, {size}; \
                 cells of half the thickness{half} show it",
                point(place.position, thin.cell)
            ));
        }
        warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::ThinPlace;

    #[test]
    fn warnings_say_what_was_found() {
        assert_eq!(Mesh::default().warnings(), Vec::<String>::new());
        let found = Findings { cell: 0.5, clamped_vertices: Some(0), ..Findings::default() };
        let warnings = |findings: Findings| Mesh::default().with_findings(findings).warnings();
        assert_eq!(warnings(found.clone()), ["the mesh is empty: the solid has no points within the bounds"]);
        let lost = Findings { possibly_lost: 3, lost_at: vec![DVec3::new(1.0, 2.0, -0.5)], ..found };
        let said = warnings(lost.clone());
        assert!(said[0].starts_with("the mesh is empty, and features thinner than a cell (0.5)"), "{said:?}");
        assert!(said[0].contains("3 blocks of cells, the first of them near (1, 2, -0.5)"), "{said:?}");
        assert!(said[0].contains("mesh with smaller cells, as `CellSize::Length(0.25)`, or"), "{said:?}");
        let place = ThinPlace { position: DVec3::X, size: DVec3::ONE, thickness: Some(0.125), cells: 7 };
        let thin = Some(ThinReport { cell: 0.5, cells: 7, count: 1, places: vec![place] });
        let said = warnings(Findings { thin, ..lost.clone() });
        assert!(
            said[1].starts_with("1 place is thinner than cells show")
                && said[1].ends_with(
                    "about 0.125 thick; cells of half the thickness, as `CellSize::Length(0.0625)`, show it"
                ),
            "{said:?}"
        );
        // A copy that is moved keeps the count, and no place.
        let moved = Mesh::default().with_counts_of(&Mesh::default().with_findings(lost));
        assert_eq!((moved.possibly_lost(), moved.clamped_vertices()), (3, Some(0)));
        assert!(!moved.warnings()[0].contains("near"));
    }
}
