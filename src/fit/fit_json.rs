//! Fits as JSON.

use super::deformed::DeformedSuperellipsoid;
use super::json::{number, numbers};
use super::result::{Fit, Shape};
use crate::{Gielis, Superellipsoid};

impl Fit {
    /// The fit as one JSON object on one line, for other programs. Lengths are in length units;
    /// numbers are told in full.
    ///
    /// ```text
    /// {"kind": "superellipsoid", "semi_axes": [1.2, 0.8, 2.0], "exponents": [0.4, 1.3], "rotation": [0.0, 0.0, 0.38, 0.92],
    ///  "translation": [0.1, 0.0, -0.3], "noise": 0.011, "inliers": 0.8, "evaluations": 16800}
    /// ```
    ///
    /// | key | what it is |
    /// |---|---|
    /// | `kind` | `superellipsoid`, `supershape` or `deformed` |
    /// | `semi_axes` | along local x, y, z |
    /// | `exponents` | e1, e2 of a superellipsoid, deformed or not |
    /// | `m`, `n`, `m2`, `n2` | of a supershape: the equator's symmetry number and n1, n2, n3; the meridian's |
    /// | `taper` | along x and y |
    /// | `bend` | curvature times the unit vector to its centre, across the axis |
    /// | `twist` | radians a length unit |
    /// | `rotation` | a unit quaternion x, y, z, w |
    /// | `translation` | world point = rotation · local point + translation |
    /// | `noise` | standard deviation of the surface's points |
    /// | `inliers` | share of the points that are of the surface, 0 to 1 |
    /// | `evaluations` | [`SearchReport::evaluations`](super::SearchReport::evaluations) |
    ///
    /// ```
    /// use rvachev::fit::{FitSettings, superellipsoid};
    /// use rvachev::surface::ParametricSurface;
    /// use rvachev::{PointCloud, Superellipsoid};
    ///
    /// let sampled = ParametricSurface::of(&Superellipsoid::new([1.2, 0.8, 2.0], 0.4, 1.3))?.sample(400, 1)?;
    /// let cloud = PointCloud::new(sampled.iter().map(|s| s.point).collect())?;
    /// let line = superellipsoid(&cloud, &FitSettings::default())?.to_json();
    /// assert!(line.starts_with(r#"{"kind": "superellipsoid", "semi_axes": ["#) && !line.contains('\n'));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn to_json(&self) -> String {
        let quadric = |leaf: &Superellipsoid| {
            vec![("semi_axes", numbers(leaf.semi_axes())), ("exponents", numbers(leaf.exponents()))]
        };
        let (kind, mut fields) = match self.shape() {
            Shape::Superellipsoid(leaf) => ("superellipsoid", quadric(leaf)),
            Shape::Supershape(leaf) => {
                let n = |curve: Gielis| numbers([curve.n1, curve.n2, curve.n3]);
                // Symmetry numbers of fits are whole.
                let m = |curve: Gielis| format!("{:.0}", curve.m);
                let (equator, meridian) = (leaf.equator(), leaf.meridian());
                let sizes = ("semi_axes", numbers(leaf.scale()));
                let curves = [("m", m(equator)), ("n", n(equator)), ("m2", m(meridian)), ("n2", n(meridian))];
                ("supershape", curves.into_iter().chain([sizes]).collect())
            }
            Shape::Deformed(DeformedSuperellipsoid { leaf, taper, twist, bend }) => {
                let deformations = [("taper", numbers(*taper)), ("bend", numbers(*bend)), ("twist", number(*twist))];
                ("deformed", quadric(leaf).into_iter().chain(deformations).collect())
            }
        };
        fields.extend([
            ("rotation", numbers(self.rotation())),
            ("translation", numbers(self.translation())),
            ("noise", number(self.noise())),
            ("inliers", number(self.inliers())),
            ("evaluations", self.search().evaluations.to_string()),
        ]);
        let fields: Vec<String> = fields.iter().map(|(key, value)| format!("\"{key}\": {value}")).collect();
        format!("{{\"kind\": \"{kind}\", {}}}", fields.join(", "))
    }
}
