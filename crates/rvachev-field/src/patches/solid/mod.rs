//! The solid that triangles enclose, as a leaf: distance to the triangles, sign by winding numbers.
//!
//! ```text
//!     value(x) = ± min(|x − y|, m(x)),     + where w(x) > ½
//! ```
//!
//! y is the nearest point of the triangles, w the generalised winding number. Where the triangles
//! leave no opening, m is infinite and the value is the true distance. Else the surface goes on
//! across openings where w = ½, which is told of by m: see [`Rim`].
//!
//! Triangles that overlap count as their union; those within it, where w does not pass ½, are no
//! surface, though the distance is measured from them too.

mod between;
mod crossings;
mod flood;
mod gaps;
mod near;
mod rim;
mod turned;
mod values;
mod winding;
mod winding_field;

use std::fmt;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use rvachev_num::{Cancelled, Run};

use self::gaps::Gaps;
use self::rim::{Membrane, Rim};
use self::winding::Winding;
use super::{Foot, Patch, Patches, SurfaceDistance, gathered};
use crate::Bounds;

/// The solid that triangles enclose.
#[derive(Clone)]
pub struct MeshLeaf {
    distance: SurfaceDistance,
    /// The corners of the triangles, as they were given, but one at each position.
    vertices: Arc<[[u32; 3]]>,
    winding: Arc<Winding>,
    /// Around openings, where there are any.
    membrane: Option<Arc<Membrane>>,
    bounds: Bounds,
    /// The volume, below 0, of triangles that are inside out.
    turned: Option<f64>,
    colors: Option<Arc<[[[u8; 3]; 3]]>>,
    owners: Option<Arc<Owners>>,
    hash: u64,
}

/// Which parts triangles are of.
struct Owners {
    /// The numbers of the parts, sorted, each once.
    numbers: Vec<u32>,
    /// The place of each triangle's part among them.
    places: Vec<u32>,
}

impl Owners {
    fn new(owners: &[u32]) -> Owners {
        let mut numbers = owners.to_vec();
        numbers.sort_unstable();
        numbers.dedup();
        let place = |number: &u32| numbers.binary_search(number).map_or(0, |at| at as u32);
        Owners { places: owners.iter().map(place).collect(), numbers }
    }
}

/// How far from closed triangles are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OpenEdges {
    /// Edges that have more triangles on one side than on the other.
    pub edges: usize,
    /// How long they are together, each as often as triangles are missing.
    pub length: f64,
}

impl OpenEdges {
    /// Of triangles, by positions and their numbers. Vertices at one position are one vertex.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if the run is stopped.
    pub fn of(positions: &[Vec3], triangles: &[[u32; 3]], run: &Run) -> Result<OpenEdges, Cancelled> {
        let edges = rim::open_edges(positions, triangles, run)?;
        let length = |edge: &rim::OpenEdge| f64::from(edge.missing) * edge.ends[0].distance(edge.ends[1]);
        Ok(OpenEdges { edges: edges.len(), length: edges.iter().map(length).sum() })
    }
}

impl MeshLeaf {
    /// What triangles enclose, given by finite positions and their numbers, counter-clockwise as
    /// seen from outside; `colors` are those of their corners, `owners` the numbers of the parts
    /// that they are of.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if the run is stopped.
    pub fn new(
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        colors: Option<Vec<[[u8; 3]; 3]>>,
        owners: Option<&[u32]>,
        run: &Run,
    ) -> Result<MeshLeaf, Cancelled> {
        let [to_build, to_weld, to_open, to_wind, to_close] = run.stages([0.6, 0.12, 0.12, 0.06, 0.1]);
        let corner = |v: u32| positions[v as usize].as_dvec3();
        let flat = gathered(triangles.iter().map(|corners| Patch::flat(corners.map(corner))), &to_build)?;
        let patches = Arc::new(Patches::new(&flat, &to_build)?);
        drop(flat);
        run.check()?;
        let vertices = rim::welded(positions, triangles, &to_weld)?;
        to_weld.report(1.0);
        let open = rim::open_edges_of(positions, &vertices, &to_open)?;
        to_open.report(1.0);
        let winding = Arc::new(Winding::new(patches.clone(), open.is_empty(), &to_wind)?);
        to_wind.report(1.0);
        let [to_rim, to_gaps] = to_close.stages([0.4, 0.6]);
        let rim = Rim::new(&open, &to_rim)?;
        let mut bounds = patches.bounds();
        let membrane = match rim {
            None => None,
            Some(rim) => {
                let membrane = Membrane { winding: winding.clone(), rim };
                bounds = membrane.bounds(bounds, &Gaps::new(&open, &to_gaps)?, &to_gaps)?;
                Some(Arc::new(membrane))
            }
        };
        let hash = hash_of(patches.hash, colors.as_deref(), owners);
        let turned = winding.volume_if_turned();
        let distance = SurfaceDistance::new(patches, winding.clone(), 0.0, None, bounds);
        run.report(1.0);
        Ok(MeshLeaf {
            distance,
            vertices: vertices.into(),
            winding,
            membrane,
            bounds,
            turned,
            colors: colors.map(Arc::from),
            owners: owners.map(|owners| Arc::new(Owners::new(owners))),
            hash,
        })
    }

    /// How many triangles there are.
    pub fn len(&self) -> usize {
        self.patches().len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.patches().is_empty()
    }

    /// Whether the triangles leave an opening.
    pub fn is_open(&self) -> bool {
        self.membrane.is_some()
    }

    /// The generalised winding number at a point: 1 inside of closed triangles, 0 outside.
    pub fn winding_number(&self, p: DVec3) -> f64 {
        self.winding.number(p)
    }

    /// The nearest point of the triangles.
    pub fn nearest(&self, p: DVec3) -> Option<Foot> {
        self.patches().nearest(p)
    }

    /// The memory that it takes.
    pub fn bytes(&self) -> usize {
        self.patches().bytes() + self.winding.bytes() + size_of_val(&*self.vertices)
    }

    fn patches(&self) -> &Patches {
        self.distance.patches()
    }

    /// The place of the part that the nearest triangle is of.
    fn part_near(&self, p: DVec3) -> usize {
        let local = self.patches().frame.into_local(p).to_array();
        let at = self.patches().search_one(local).which as usize;
        let number = self.patches().numbers.get(at).map(|number| *number as usize);
        let place = number.zip(self.owners.as_ref()).and_then(|(number, owners)| owners.places.get(number));
        place.map_or(0, |place| *place as usize)
    }

    /// The colour at the nearest point of the triangles, in sRGB, if they have colours.
    fn color_near(&self, p: DVec3) -> Option<[u8; 3]> {
        let colors = self.colors.as_ref()?;
        let local = self.patches().frame.into_local(p).to_array();
        let at = self.patches().search_one(local).which as usize;
        let corners = colors.get(*self.patches().numbers.get(at)? as usize)?;
        let [s, t] = self.patches().closest(at, local).coordinates;
        let mix = |k: usize| {
            let [a, b, c] = corners.map(|color| f64::from(color[k]));
            (a + s * (b - a) + t * (c - a)).round().clamp(0.0, 255.0) as u8
        };
        Some([mix(0), mix(1), mix(2)])
    }
}

/// A number that tells contents apart (FNV-1a).
fn hash_of(shape: u64, colors: Option<&[[[u8; 3]; 3]]>, owners: Option<&[u32]>) -> u64 {
    let mut hash = shape;
    let bytes = colors.into_iter().flatten().flatten().flatten().map(|byte| u64::from(*byte));
    let owners = owners.into_iter().flatten().map(|owner| u64::from(*owner) + (1 << 32));
    for part in bytes.chain(owners) {
        hash = (hash ^ part).wrapping_mul(0x0100_0000_01b3);
    }
    hash
}

impl fmt::Debug for MeshLeaf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} triangles, {:016x}", self.len(), self.hash)
    }
}
