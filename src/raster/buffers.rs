//! The buffers of a picture: depth, stencil, and which operand's which face is seen.

use glam::DVec3;

use super::error::RasterError;
use super::layers::{Facing, LayerSource, Tile};
use super::target::{NOTHING, REVERSED, Target};
use super::view::RasterView;
use crate::{Cancelled, Image, Run};
use rvachev_num::{Meter, jobs};

/// What is seen at a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceId {
    /// The operand, by its number.
    pub operand: u32,
    /// The face of the operand: for a mesh, its triangle.
    pub face: u32,
    /// The side of the operand's surface that is seen: the back where the operand was cut away.
    pub facing: Facing,
}

/// A depth buffer, a stencil buffer and an id buffer.
///
/// [`RasterView::csg`] fills them with a whole tree. The passes that it is made of are methods
/// here, for pictures step by step and for methods of your own. This is the difference A − B of
/// two convex solids, as in the paper with its errors put right:
///
/// ```
/// use glam::DVec3;
/// use rvachev::raster::{Buffers, ClosedMesh, Facing, RasterView};
/// use rvachev::{Camera, CellSize, MeshSettings, Solid};
///
/// let settings = MeshSettings { cell: CellSize::LongestSide(24), ..MeshSettings::default() };
/// let mesh_a = Solid::sphere(1.0).mesh(&settings)?;
/// let mesh_b = Solid::sphere(0.8).translate([0.0, -1.0, 0.0]).mesh(&settings)?;
///
/// let camera = Camera::orthographic(DVec3::new(0.0, -5.0, 0.0), DVec3::ZERO, DVec3::Z, 3.0);
/// let view = RasterView::new(&camera, 64, 64)?;
/// let a = view.layers(ClosedMesh::new(&mesh_a)?);
/// let b = view.layers(ClosedMesh::new(&mesh_b)?);
///
/// // The front of A where it is outside of B …
/// let mut outer = Buffers::new(&view);
/// outer.draw(&a, 0, Facing::Front)?;
/// outer.classify(&b)?;
/// outer.keep(|count| count == 0);
/// // … and the back of B where it is inside of A; then the nearer of the two.
/// let mut inner = Buffers::new(&view);
/// inner.draw(&b, 1, Facing::Back)?;
/// inner.classify(&a)?;
/// inner.keep(|count| count != 0);
/// outer.merge(&inner)?;
///
/// let depth = outer.depth(32, 32).unwrap();
/// assert!((depth - 4.8).abs() < 0.01, "{depth}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Buffers {
    pub(super) view: RasterView,
    pub(super) tiles: Vec<Target>,
}

impl Buffers {
    /// Empty buffers for a view.
    #[must_use]
    pub fn new(view: &RasterView) -> Buffers {
        let [across, down] = Tile::grid(view.width, view.height);
        Buffers { view: *view, tiles: vec![Target::new(); (across * down) as usize] }
    }

    /// The view.
    #[must_use]
    pub fn view(&self) -> &RasterView {
        &self.view
    }

    /// Draws one side of the operand `number`: what is nearer than what is there replaces it.
    ///
    /// # Errors
    ///
    /// [`RasterError::Size`] if the layers were made for a picture of another size;
    /// [`RasterError::Setting`] for a number of 2³¹ − 1 or more.
    pub fn draw<L: LayerSource + ?Sized>(
        &mut self,
        layers: &L,
        number: u32,
        facing: Facing,
    ) -> Result<(), RasterError> {
        self.draw_with(layers, number, facing, &Run::default())
    }

    /// [`draw`](Buffers::draw) with a choice of threads, a cancel token and a progress sink. What
    /// is cancelled has drawn a part.
    ///
    /// # Errors
    ///
    /// Those of [`draw`](Buffers::draw), and [`RasterError::Cancelled`].
    pub fn draw_with<L: LayerSource + ?Sized>(
        &mut self,
        layers: &L,
        number: u32,
        facing: Facing,
        run: &Run,
    ) -> Result<(), RasterError> {
        if number >= REVERSED - 1 {
            let allowed = "numbers below 2147483647";
            return Err(RasterError::Setting { setting: "number", value: number.to_string(), allowed });
        }
        self.pass(layers, run, |target, tile| target.draw(layers, number, Some(facing), tile))
    }

    /// Adds to the stencil, for each stored point, the number of front less that of back faces
    /// up to it: that is 0 where the point is outside of the solid. Depths and ids stay.
    ///
    /// # Errors
    ///
    /// [`RasterError::Size`].
    pub fn classify<L: LayerSource + ?Sized>(&mut self, layers: &L) -> Result<(), RasterError> {
        self.classify_with(layers, &Run::default())
    }

    /// [`classify`](Buffers::classify) with a choice of threads, a cancel token and a progress
    /// sink. What is cancelled has counted in a part.
    ///
    /// # Errors
    ///
    /// Those of [`classify`](Buffers::classify), and [`RasterError::Cancelled`].
    pub fn classify_with<L: LayerSource + ?Sized>(&mut self, layers: &L, run: &Run) -> Result<(), RasterError> {
        self.pass(layers, run, |target, tile| target.classify(layers, tile))
    }

    /// Clears the points whose stencil does not pass the test.
    pub fn keep(&mut self, test: impl Fn(i32) -> bool + Sync) {
        self.each(&|_, target| target.keep(&test));
    }

    /// Takes what is nearer in `other`.
    ///
    /// # Errors
    ///
    /// [`RasterError::Size`] if it is of another size.
    pub fn merge(&mut self, other: &Buffers) -> Result<(), RasterError> {
        self.view.fits([other.view.width, other.view.height])?;
        self.each(&|number, target| target.merge(&other.tiles[number]));
        Ok(())
    }

    /// Sets the stencil to 0 everywhere.
    pub fn clear_stencil(&mut self) {
        self.each(&|_, target| target.stencil.fill(0));
    }

    /// Clears depths and ids. The stencil stays.
    pub fn clear_depth(&mut self) {
        self.each(&|_, target| target.clear_depth());
    }

    /// Does a job on each tile, given its number.
    fn each(&mut self, job: &(dyn Fn(usize, &mut Target) + Sync)) {
        jobs::for_chunks_mut(&mut self.tiles, 1, |number, own| own.iter_mut().for_each(|target| job(number, target)));
    }

    fn pass<L: LayerSource + ?Sized>(
        &mut self,
        layers: &L,
        run: &Run,
        pass: impl Fn(&mut Target, &Tile) + Sync,
    ) -> Result<(), RasterError> {
        self.view.fits(layers.size())?;
        let RasterView { width, height, .. } = self.view;
        let run = run.stage(0.0, 1.0);
        let meter = Meter::new(&run, self.tiles.len());
        let tiles = &mut self.tiles;
        run.install(|| {
            jobs::try_chunks_mut(tiles, 1, |number, own| {
                meter.check()?;
                let tile = Tile::number(number as u32, width, height);
                if layers.touches(&tile) {
                    own.iter_mut().for_each(|target| pass(target, &tile));
                }
                meter.add(1);
                Ok::<_, Cancelled>(())
            })
        })?;
        Ok(())
    }

    /// The depth that is stored at a pixel, in length units; `None` where nothing is, and beyond
    /// the picture.
    #[must_use]
    pub fn depth(&self, x: u32, y: u32) -> Option<f64> {
        let (target, i) = self.place(x, y)?;
        let depth = target.depth[i];
        (depth < f64::INFINITY).then_some(depth)
    }

    /// What is seen at a pixel.
    #[must_use]
    pub fn id(&self, x: u32, y: u32) -> Option<SurfaceId> {
        let (target, i) = self.place(x, y)?;
        (target.operand[i] != NOTHING).then(|| target.id(i))
    }

    /// The stencil of a pixel; 0 beyond the picture.
    ///
    /// After [`RasterView::csg`] it is, by the method, the last pass's count of front less back
    /// faces, the number of sweeps that the pixel needed, or the number of its layers.
    #[must_use]
    pub fn stencil(&self, x: u32, y: u32) -> i32 {
        self.place(x, y).map_or(0, |(target, i)| target.stencil[i])
    }

    /// The point of space that is seen at a pixel.
    #[must_use]
    pub fn point(&self, x: u32, y: u32) -> Option<DVec3> {
        let depth = self.depth(x, y)?;
        Some(self.view.point(f64::from(x) + 0.5, f64::from(y) + 0.5, depth))
    }

    /// All depths in length units, row by row from the top left; +∞ where nothing is.
    #[must_use]
    pub fn depths(&self) -> Vec<f64> {
        // A run that nobody else holds is not cancelled.
        self.depth_image(&Run::default()).map_or_else(|Cancelled| Vec::new(), |image| image.pixels().to_vec())
    }

    /// All [depths](Buffers::depths) as a picture.
    pub(super) fn depth_image(&self, run: &Run) -> Result<Image<f64>, Cancelled> {
        const SIDE: usize = Tile::SIDE as usize;
        let RasterView { width, height, .. } = self.view;
        let [across, _] = Tile::grid(width, height);
        Image::by_rows([width, height], f64::INFINITY, run, |y, row| {
            let (band, line) = ((y / Tile::SIDE * across) as usize, (y % Tile::SIDE) as usize * SIDE);
            for (part, target) in row.chunks_mut(SIDE).zip(&self.tiles[band..]) {
                part.copy_from_slice(&target.depth[line..line + part.len()]);
            }
        })
    }

    fn place(&self, x: u32, y: u32) -> Option<(&Target, usize)> {
        let RasterView { width, height, .. } = self.view;
        if x >= width || y >= height {
            return None;
        }
        let [across, _] = Tile::grid(width, height);
        let number = y / Tile::SIDE * across + x / Tile::SIDE;
        let index = y % Tile::SIDE * Tile::SIDE + x % Tile::SIDE;
        Some((&self.tiles[number as usize], index as usize))
    }
}

impl RasterView {
    /// Whether something of this size is for this picture.
    pub(super) fn fits(&self, layers: [u32; 2]) -> Result<(), RasterError> {
        let picture = [self.width, self.height];
        if layers == picture { Ok(()) } else { Err(RasterError::Size { layers, picture }) }
    }
}
