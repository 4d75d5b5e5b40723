//! OpenEXR, through the `exr` crate: numbers as they are, in 32-bit floats.

use std::io::{self, Cursor, Write};

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image as File, Layer, LayerAttributes, WritableImage,
};
use glam::{DVec3, Vec3};

use super::watched::Watched;
use crate::Run;
use crate::geom::Image;

/// A picture whose pixels can be written as floats: linear light, depths and values, normals,
/// positions. This trait is closed.
pub trait Floats: sealed::Floats {}

mod sealed {
    /// The channels of a pixel.
    pub trait Floats {
        const NAMES: &'static [&'static str];
        fn channel(&self, index: usize) -> f32;
    }
}

impl Floats for [f32; 4] {}
impl sealed::Floats for [f32; 4] {
    const NAMES: &'static [&'static str] = &["R", "G", "B", "A"];
    fn channel(&self, index: usize) -> f32 {
        self[index]
    }
}

impl Floats for f64 {}
impl sealed::Floats for f64 {
    const NAMES: &'static [&'static str] = &["Z"];
    fn channel(&self, _: usize) -> f32 {
        *self as f32
    }
}

impl Floats for Vec3 {}
impl sealed::Floats for Vec3 {
    const NAMES: &'static [&'static str] = &["R", "G", "B"];
    fn channel(&self, index: usize) -> f32 {
        self[index]
    }
}

impl Floats for DVec3 {}
impl sealed::Floats for DVec3 {
    const NAMES: &'static [&'static str] = &["R", "G", "B"];
    fn channel(&self, index: usize) -> f32 {
        self[index] as f32
    }
}

/// Writes a picture of numbers as OpenEXR with 32-bit floats, compressed without loss: light as
/// R, G, B and A, depths and values as Z, normals and positions (x, y, z) as R, G and B.
/// Infinity stays what it is.
///
/// ```
/// use rvachev::io::write_exr;
/// use rvachev::Image;
///
/// let depth = Image::new(2, 1, vec![1.5, f64::INFINITY])?;
/// let mut file = Vec::new();
/// write_exr(&depth, &mut file)?;
/// assert_eq!(file[..4], [0x76, 0x2f, 0x31, 0x01]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// Those of the writer.
pub fn write_exr<P: Floats>(image: &Image<P>, out: impl Write) -> io::Result<()> {
    write_exr_on(image, &Run::default(), out)
}

/// [`write_exr`] on a [`Run`], which is told how much is compressed, and may be cancelled.
///
/// # Errors
///
/// Those of [`write_exr`], and one that holds a [`Cancelled`](crate::Cancelled) if cancelled:
/// what is written by then is no whole file.
pub fn write_exr_on<P: Floats>(image: &Image<P>, run: &Run, mut out: impl Write) -> io::Result<()> {
    run.check().map_err(io::Error::other)?;
    let channel = |index: usize| {
        let samples = image.pixels().iter().map(|pixel| pixel.channel(index)).collect();
        AnyChannel::new(P::NAMES[index], FlatSamples::F32(samples))
    };
    let channels = AnyChannels::sort((0..P::NAMES.len()).map(channel).collect());
    let size = (image.width() as usize, image.height() as usize);
    let layer = Layer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
    // The format wants to go back and write where its parts are.
    let mut bytes = Cursor::new(Vec::new());
    let file = File::from_layer(layer);
    let writing = file.write().non_parallel().on_progress(|fraction| run.report(fraction));
    let written = writing.to_buffered(Watched::new(&mut bytes, 0, run));
    written.map_err(|error| match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })?;
    out.write_all(&bytes.into_inner())
}
