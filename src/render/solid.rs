//! Rendering a solid: `solid.render(..)`.

use std::io;
use std::path::Path;
use std::sync::Arc;

use super::draft::Draft;
use super::draft_mesh::DraftMesh;
use super::materials::Materials;
use super::occlusion::Obstacles;
use super::picture::{Picture, Pixel};
use super::scene::Scene;
use super::settings::{Background, Quality, RenderError, RenderSettings, check_memory};
use super::shade::Studio;
use crate::geom::to_8bit;
use crate::io::save_rows;
use crate::{Camera, Cancelled, Image, Run, Solid};

impl Solid {
    /// A picture of the solid.
    ///
    /// With [`Quality::Fine`](crate::Quality::Fine), the default, the surface is found with
    /// certainty: along each ray, pieces are discarded only where an interval, of the value or of
    /// its slope in the block, shows that no surface crosses them. (A crossing and back within
    /// 8·10⁻⁵ of the solid's size counts as a touch; the crossing itself is found to 10⁻⁵.)
    /// Shading, lights and colours are described at [`RenderSettings`]; the lights move with the
    /// camera. A camera inside the solid sees its walls from behind.
    ///
    /// ```no_run
    /// use rvachev::{Camera, RenderSettings, Solid};
    /// use glam::DVec3;
    ///
    /// let part = Solid::superellipsoid(DVec3::new(3.0, 2.0, 1.0), 0.3, 0.3) - Solid::cylinder(0.8, 3.0);
    /// let camera = Camera::framing(&part.bounds()?);
    /// part.render(&camera, &RenderSettings::default())?.save("part.png")?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the solid, the camera or the settings: see [`RenderError`]. An
    /// unbounded solid is one of them; intersect it with something bounded.
    pub fn render(&self, camera: &Camera, settings: &RenderSettings) -> Result<Image, RenderError> {
        self.render_with(camera, settings, &Run::default())
    }

    /// [`render`](Solid::render) with a choice of threads, a cancel token and a progress sink.
    ///
    /// The result is the same to the byte for any number of threads.
    ///
    /// # Errors
    /// What is wrong with the solid, the camera or the settings, or that the work was
    /// cancelled: see [`RenderError`].
    pub fn render_with(&self, camera: &Camera, settings: &RenderSettings, run: &Run) -> Result<Image, RenderError> {
        settings.check()?;
        camera.check()?;
        let run = run.stage(0.0, 1.0);
        run.install(|| {
            let scene = self.scene_with(&run.stage(0.0, 0.1))?;
            scene.picture(camera, settings, &run.stage(0.1, 1.0), to_8bit)
        })
    }

    /// A picture of any size, written to a PNG band by band: see [`Scene::render_to`].
    ///
    /// # Errors
    /// What is wrong with the solid, the camera, the settings or the file, or that the work was
    /// cancelled: see [`RenderError`].
    pub fn render_to(
        &self,
        path: impl AsRef<Path>,
        camera: &Camera,
        settings: &RenderSettings,
        run: &Run,
    ) -> Result<(), RenderError> {
        self.scene_with(&run.stage(0.0, 0.1))?.render_to(path, camera, settings, &run.stage(0.1, 1.0))
    }
}

impl Scene {
    /// A picture of the solid: see [`Solid::render`].
    ///
    /// # Errors
    /// What is wrong with the camera or the settings.
    pub fn render(&self, camera: &Camera, settings: &RenderSettings) -> Result<Image, RenderError> {
        self.render_with(camera, settings, &Run::default())
    }

    /// [`render`](Scene::render) with a choice of threads, a cancel token and a progress sink.
    ///
    /// # Errors
    /// What is wrong with the camera or the settings, or that the work was cancelled.
    pub fn render_with(&self, camera: &Camera, settings: &RenderSettings, run: &Run) -> Result<Image, RenderError> {
        settings.check()?;
        camera.check()?;
        let run = run.stage(0.0, 1.0);
        run.install(|| self.picture(camera, settings, &run, to_8bit))
    }

    /// The same as linear light, weighted by alpha, before it becomes bytes: with
    /// [`Transfer::Srgb`](crate::layers::Transfer::Srgb) the radiances themselves, else what the
    /// transfer makes of them. Saved as EXR, or as PNG of 8 or 16 bits.
    ///
    /// ```
    /// use rvachev::{Camera, RenderSettings, Run, Solid};
    ///
    /// let scene = Solid::sphere(1.0).scene()?;
    /// let settings = RenderSettings { width: 32, height: 24, ..RenderSettings::default() };
    /// let light = scene.light(&Camera::framing(&scene.bounds()), &settings, &Run::default())?;
    /// light.to_16bit().save(std::env::temp_dir().join("rvachev_light.png"))?;
    /// # std::fs::remove_file(std::env::temp_dir().join("rvachev_light.png"))?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the camera or the settings, or that the work was cancelled.
    pub fn light(&self, camera: &Camera, settings: &RenderSettings, run: &Run) -> Result<Image<[f32; 4]>, RenderError> {
        settings.check()?;
        camera.check()?;
        let run = run.stage(0.0, 1.0);
        run.install(|| self.picture(camera, settings, &run, |light| light))
    }

    /// A picture of any size as a PNG of 8 bits, written band by band: it never is in memory.
    ///
    /// The file appears complete or not at all. Missing directories are not made.
    ///
    /// ```no_run
    /// use rvachev::{Camera, RenderSettings, Run, Solid};
    ///
    /// let scene = Solid::superellipsoid([3.0, 2.0, 1.0], 0.3, 0.3).scene()?;
    /// let poster = RenderSettings { width: 40_000, height: 30_000, ..RenderSettings::default() };
    /// scene.render_to("poster.png", &Camera::framing(&scene.bounds()), &poster, &Run::default())?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the camera, the settings or the file, or that the work was cancelled.
    pub fn render_to(
        &self,
        path: impl AsRef<Path>,
        camera: &Camera,
        settings: &RenderSettings,
        run: &Run,
    ) -> Result<(), RenderError> {
        settings.check()?;
        camera.check()?;
        let run = run.stage(0.0, 1.0);
        let has_alpha = settings.background == Background::Transparent;
        let path = path.as_ref();
        run.install(|| {
            let [to_find, to_prepare, to_draw] = run.stages(times(settings));
            let subject = self.subject(settings, &to_find)?;
            let picture = subject.picture(camera, settings, &to_prepare)?;
            let mut failed = None;
            let saved = save_rows(path, [settings.width, settings.height], has_alpha, |rows| {
                let written = picture.rows(&to_draw, to_8bit, |pixels| rows(pixels).map_err(Stopped::Write));
                written.map_err(|stopped| match stopped {
                    Stopped::Write(error) => error,
                    Stopped::Cancelled(cancelled) => {
                        failed = Some(cancelled);
                        io::Error::other(cancelled)
                    }
                })
            });
            failed.map_or(Ok(()), Err)?;
            Ok(saved?)
        })
    }

    /// The picture whose pixels `finish` makes of linear light.
    fn picture<P: Pixel>(
        &self,
        camera: &Camera,
        settings: &RenderSettings,
        run: &Run,
        finish: impl Fn([f32; 4]) -> P + Sync,
    ) -> Result<Image<P>, RenderError> {
        let RenderSettings { width, height, .. } = *settings;
        check_memory(width, height)?;
        let [to_find, to_prepare, to_draw] = run.stages(times(settings));
        let subject = self.subject(settings, &to_find)?;
        let picture = subject.picture(camera, settings, &to_prepare)?;
        Ok(Image::new(width, height, picture.pixels(&to_draw, finish)?)?)
    }

    /// What is drawn.
    fn subject(&self, settings: &RenderSettings, run: &Run) -> Result<Subject<'_>, RenderError> {
        run.check()?;
        let is_draft = settings.quality == Quality::Draft;
        let [to_cut, to_mesh] = run.stages([1.0, if is_draft { 4.0 } else { 0.0 }]);
        let cut = match &settings.cut {
            Some(plane) => Some(self.kept_cut(plane, settings.cut_paint, &to_cut)?),
            None => None,
        };
        let scene = cut.as_deref().unwrap_or(self);
        let draft = if is_draft { Some(scene.shown(settings.draft_cells, &to_mesh)?) } else { None };
        run.report(1.0);
        Ok(Subject { whole: self, cut, draft })
    }
}

/// How long it takes to find what is drawn, to prepare what hides light, and to draw.
fn times(settings: &RenderSettings) -> [f64; 3] {
    let find = if settings.quality == Quality::Draft { 4.0 } else { 0.0 };
    [find + if settings.cut.is_some() { 0.2 } else { 0.0 }, 0.1, 1.0]
}

/// What a picture is of.
struct Subject<'a> {
    whole: &'a Scene,
    /// What is left of it.
    cut: Option<Arc<Scene>>,
    /// The mesh of a draft; an empty one if there is nothing to see.
    draft: Option<Arc<DraftMesh>>,
}

impl Subject<'_> {
    fn picture<'a>(
        &'a self,
        camera: &Camera,
        settings: &'a RenderSettings,
        run: &Run,
    ) -> Result<Picture<'a>, RenderError> {
        let RenderSettings { width, height, .. } = *settings;
        let scene = self.cut.as_deref().unwrap_or(self.whole);
        let stands = settings.ground && settings.style.has_shadows() && !scene.bounds().is_empty();
        let studio = Studio::new(camera, settings);
        let draft = match &self.draft {
            Some(mesh) => Some(Draft::new(scene, mesh, camera, settings)?),
            None => None,
        };
        let obstacles = match &draft {
            Some(_) => None,
            None => Obstacles::new(scene, studio.key(), settings, run)?,
        };
        run.report(1.0);
        Ok(Picture {
            scene,
            draft,
            materials: Materials::new(scene.palette(), &studio, settings.paint),
            studio,
            rays: camera.rays(width, height),
            settings,
            // Ground that nothing hides light from looks like what is behind it.
            ground: (stands && obstacles.is_some()).then(|| scene.lowest()),
            obstacles,
        })
    }
}

/// Why bands end.
enum Stopped {
    Write(io::Error),
    Cancelled(Cancelled),
}

impl From<Cancelled> for Stopped {
    fn from(cancelled: Cancelled) -> Stopped {
        Stopped::Cancelled(cancelled)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::{Background, CameraError, Cancelled, Projection, RFunction, SolidError, deg, rad};

    /// A camera on the −y side that sees `height` length units.
    fn front(height: f64) -> Camera {
        Camera::orthographic(DVec3::new(0.0, -10.0, 0.0), DVec3::ZERO, DVec3::Z, height)
    }

    fn transparent(width: u32, height: u32) -> RenderSettings {
        let background = Background::Transparent;
        RenderSettings { width, height, background, ground: false, ..RenderSettings::default() }
    }

    /// The picture's alpha: `#` from ¾ on, `+` from ¼ on.
    fn silhouette(image: &Image) -> String {
        let rows = image.pixels().chunks(image.width() as usize).map(|row| {
            let marks = row.iter().map(|p| [' ', '+', '+', '#'][usize::from(p[3]) / 64]);
            marks.collect::<String>().trim_end().to_string() + "\n"
        });
        rows.collect()
    }

    #[test]
    fn pictures_in_a_file_are_those_in_memory() -> Result<(), RenderError> {
        let solid = Solid::sphere(1.0) - Solid::sphere(0.7).translate(DVec3::X);
        let path = std::env::temp_dir().join(format!("rvachev-bands-{}.png", std::process::id()));
        // Several bands.
        let settings = RenderSettings {
            width: 60_000,
            height: 20,
            samples: 1,
            shadows: false,
            occlusion: false,
            ..Default::default()
        };
        for background in [Background::default(), Background::Transparent] {
            let settings = RenderSettings { background, ..settings.clone() };
            solid.render_to(&path, &front(3.0), &settings, &Run::default())?;
            let read = image::open(&path).unwrap().into_rgba8();
            let whole = solid.render(&front(3.0), &settings)?;
            assert!(read.as_raw() == whole.pixels().as_flattened());
            std::fs::remove_file(&path).unwrap();
        }
        let run = Run::default();
        run.cancel.cancel();
        let cancelled = solid.scene()?.render_to(&path, &front(3.0), &settings, &run);
        assert!(matches!(cancelled, Err(RenderError::Cancelled(_))) && !path.exists());
        let said = |width: u32, height: u32| {
            let settings = RenderSettings { width, height, ..settings.clone() };
            solid.render(&front(3.0), &settings).unwrap_err().to_string()
        };
        assert_eq!(said(65_536, 20), "width is 65536; allowed: 1 to 65 535 pixels");
        assert!(said(40_000, 40_000).contains("size is 40000 × 40000; allowed: 268 435 456 pixels in memory"));
        let error = solid.render_to("picture.jpg", &front(3.0), &settings, &Run::default()).unwrap_err();
        assert!(error.to_string().contains("known: .png"), "{error}");
        Ok(())
    }

    #[test]
    fn silhouette_of_a_sphere() {
        let image = Solid::sphere(1.0).render(&front(2.4), &transparent(24, 12)).unwrap();
        same(&image, SPHERE);
        let camera = Camera::perspective(DVec3::new(0.0, -100.0, 0.0), DVec3::ZERO, DVec3::Z, deg(1.375));
        let image = Solid::sphere(1.0).render(&camera, &transparent(24, 12)).unwrap();
        same(&image, SPHERE);
    }

    fn same(image: &Image, expected: &str) {
        let found = silhouette(image);
        assert!(found.trim_matches('\n') == expected.trim_matches('\n'), "found:\n{found}");
    }

    const SPHERE: &str = "
         +###+
        +######+
       +########
       #########+
       ##########
       ##########
       +#########
        ########+
        +######+
          +###+
";

    #[test]
    fn every_ray_hits_what_a_single_raycast_hits() {
        let part = (Solid::cuboid(DVec3::ONE) | Solid::sphere(0.4).translate(DVec3::X * 0.6)).rotate_x(rad(0.7))
            - Solid::cylinder(0.2, 4.0).twist(rad(1.0));
        let bounds = part.bounds().unwrap();
        let settings = RenderSettings { samples: 1, ..transparent(40, 30) };
        for camera in [Camera::framing(&bounds), Camera::framing_orthographic(&bounds)] {
            let image = part.render(&camera, &settings).unwrap();
            let mut hits = 0;
            for y in 0..30 {
                for x in 0..40 {
                    let (origin, direction) = camera.ray(f64::from(x) + 0.5, f64::from(y) + 0.5, 40, 30);
                    let hit = part.raycast(origin, direction).unwrap().is_some();
                    assert_eq!(image.pixel(x, y).unwrap()[3] == 255, hit, "({x}, {y})");
                    hits += usize::from(hit);
                }
            }
            assert!(hits > 200, "{hits}");
        }
    }

    #[test]
    fn faces_on_round_coordinates_have_no_holes() {
        // Borders of blocks, faces and edges of the cubes all fall together.
        let cubes = (0..8).map(|i| {
            Solid::cuboid(DVec3::ONE).translate(DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)))
        });
        let wall = Solid::union_all(cubes, RFunction::MIN_MAX);
        let camera = Camera::orthographic(DVec3::new(0.5, -8.0, 0.5), DVec3::splat(0.5), DVec3::Z, 2.0);
        let flat = RenderSettings { shadows: false, occlusion: false, ..transparent(64, 64) };
        let image = wall.render(&camera, &flat).unwrap();
        assert!(image.pixels().iter().all(|p| *p == image.pixels()[0] && p[3] == 255));
        let image = wall.render(&camera, &transparent(64, 64)).unwrap();
        // Where cubes meet, their facets are a little off; a hole is darker or shows the
        // background.
        let like = |p: &[u8; 4]| p.iter().zip(image.pixels()[0]).all(|(a, b)| a.abs_diff(b) <= 3);
        assert!(image.pixels().iter().all(|p| like(p) && p[3] == 255));
    }

    #[test]
    fn same_bytes_for_any_number_of_threads() {
        let part = Solid::superellipsoid(DVec3::new(1.0, 0.8, 0.6), 0.3, 0.7) - Solid::cylinder(0.3, 3.0);
        let camera = Camera::framing(&part.bounds().unwrap());
        let settings = RenderSettings { width: 90, height: 70, ..RenderSettings::default() };
        let with = |threads| part.render_with(&camera, &settings, &Run { threads, ..Run::default() }).unwrap();
        let one = with(1);
        assert!(one == with(2) && one == with(3));
    }

    #[test]
    fn from_inside_the_walls_are_seen() {
        let camera = Camera::perspective(DVec3::ZERO, DVec3::X, DVec3::Z, deg(90.0));
        let image = Solid::cuboid(DVec3::splat(2.0)).render(&camera, &transparent(20, 20)).unwrap();
        assert!(image.pixels().iter().all(|p| p[3] == 255 && p[0] > 30));
    }

    #[test]
    fn solids_of_any_size_and_place() {
        for size in [1e-3, 1.0, 1e5] {
            let ball = Solid::sphere(size).translate(DVec3::new(1e3 * size, 0.0, 0.0));
            let camera = Camera::framing_orthographic(&ball.bounds().unwrap());
            let image = ball.render(&camera, &transparent(32, 32)).unwrap();
            let area: f64 = image.pixels().iter().map(|p| f64::from(p[3]) / 255.0).sum();
            let Projection::Orthographic { height } = camera.projection else { unreachable!() };
            let radius = size / height * 32.0;
            assert!((area / (std::f64::consts::PI * radius * radius) - 1.0).abs() < 0.01, "{size}: {area}");
        }
        let nothing = Solid::sphere(1.0) & Solid::sphere(1.0).translate(DVec3::X * 5.0);
        let image = nothing.render(&front(4.0), &transparent(8, 8)).unwrap();
        assert!(image.pixels().iter().all(|p| *p == [0; 4]));
    }

    #[test]
    fn errors() {
        let ball = Solid::sphere(1.0);
        let settings = transparent(8, 8);
        let at_itself = Camera { target: front(1.0).eye, ..front(1.0) };
        let error = ball.render(&at_itself, &settings).unwrap_err();
        assert!(matches!(error, RenderError::Camera(CameraError { parameter: "target", .. })), "{error}");
        let error = ball.complement().render(&front(1.0), &settings).unwrap_err();
        assert!(matches!(error, RenderError::Solid(SolidError::Unbounded { .. })), "{error}");
        let run = Run::default();
        run.cancel.cancel();
        assert!(matches!(ball.render_with(&front(1.0), &settings, &run), Err(RenderError::Cancelled(Cancelled))));
    }
}
