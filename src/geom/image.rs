//! A picture in memory.
//!
//! ```text
//!      (0, 0) +------------+ x → width
//!             |            |
//!             |            |     rows from the top, pixels of a row from the left
//!             +------------+
//!           y ↓ height
//! ```

use rvachev_num::{Meter, jobs};

use super::transfer::{from_linear, to_byte};
use crate::{Cancelled, Run};

/// A picture: rows of pixels from top to bottom. What a pixel is says what the picture is of:
///
/// | pixel | picture |
/// |---|---|
/// | `[u8; 4]` | colour and alpha: sRGB, alpha straight and linear |
/// | `[u16; 4]` | the same in 16 bits |
/// | `[f32; 4]` | linear light, weighted by alpha |
/// | `f64` | depths or values, in length units; infinite where there is nothing |
/// | [`Vec3`](glam::Vec3) | normals, 0 where there is nothing |
/// | [`DVec3`](glam::DVec3) | positions, infinite where there is nothing |
/// | `bool` | a mask |
/// | [`Option<u32>`](Option) | the number of the leaf that is seen |
/// | `u8`, `u16` | greys: sRGB |
///
/// ```
/// use rvachev::Image;
///
/// let image = Image::new(2, 1, vec![[255, 0, 0, 255], [0, 0, 255, 255]])?;
/// assert_eq!(image.pixel(1, 0), Some([0, 0, 255, 255]));
/// assert_eq!(image.pixel(2, 0), None);
/// # Ok::<(), rvachev::error::ImageError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image<P = [u8; 4]> {
    width: u32,
    height: u32,
    pixels: Vec<P>,
}

/// Why a picture cannot be built from the given parts.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// A picture needs at least one pixel.
    #[error("an image of {width} × {height} pixels; each side must be at least 1")]
    NoPixels {
        /// The width asked for.
        width: u32,
        /// The height asked for.
        height: u32,
    },
    /// The number of pixels is not width × height.
    #[error("{pixels} pixels given for an image of {width} × {height}")]
    Count {
        /// Number of pixels given.
        pixels: usize,
        /// The width asked for.
        width: u32,
        /// The height asked for.
        height: u32,
    },
}

impl<P> Image<P> {
    /// A picture from its pixels, row by row from the top left.
    ///
    /// # Errors
    ///
    /// If a side is 0, or the number of pixels is not `width · height`.
    pub fn new(width: u32, height: u32, pixels: Vec<P>) -> Result<Image<P>, ImageError> {
        if width == 0 || height == 0 {
            return Err(ImageError::NoPixels { width, height });
        }
        if pixels.len() as u64 != u64::from(width) * u64::from(height) {
            return Err(ImageError::Count { pixels: pixels.len(), width, height });
        }
        Ok(Image { width, height, pixels })
    }

    /// Pixels in a row.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, row by row from the top left.
    #[must_use]
    pub fn pixels(&self) -> &[P] {
        &self.pixels
    }

    /// The pixel in column `x` and row `y`; `None` beyond the picture.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Option<P>
    where
        P: Copy,
    {
        if x >= self.width || y >= self.height {
            return None;
        }
        let index = u64::from(y) * u64::from(self.width) + u64::from(x);
        self.pixels.get(usize::try_from(index).ok()?).copied()
    }

    /// The picture of what `f` makes of each pixel, row by row from the top left.
    #[must_use]
    pub fn map<Q>(&self, f: impl FnMut(&P) -> Q) -> Image<Q> {
        Image { width: self.width, height: self.height, pixels: self.pixels.iter().map(f).collect() }
    }
}

impl<P: Copy + Send + Sync> Image<P> {
    /// A picture of `width` × `height`, neither of them 0, whose rows are `blank` before `fill`
    /// makes them, given their number, on the threads of a run.
    pub(crate) fn by_rows(
        [width, height]: [u32; 2],
        blank: P,
        run: &Run,
        fill: impl Fn(u32, &mut [P]) + Sync,
    ) -> Result<Image<P>, Cancelled> {
        let meter = Meter::new(run, height);
        let mut pixels = vec![blank; width as usize * height as usize];
        run.install(|| {
            jobs::try_chunks_mut(&mut pixels, width as usize, |y, row| {
                meter.check()?;
                fill(y as u32, row);
                meter.add(1);
                Ok::<_, Cancelled>(())
            })
        })?;
        Ok(Image { width, height, pixels })
    }

    /// [`map`](Image::map) on the threads of a run.
    pub(crate) fn map_on<Q: Copy + Send + Sync>(
        &self,
        blank: Q,
        run: &Run,
        f: impl Fn(&P) -> Q + Sync,
    ) -> Result<Image<Q>, Cancelled> {
        Image::by_rows([self.width, self.height], blank, run, |y, row| {
            let from = &self.pixels[y as usize * self.width as usize..];
            for (to, from) in row.iter_mut().zip(from) {
                *to = f(from);
            }
        })
    }
}

impl Image {
    /// Whether every pixel has alpha 255.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.pixels.iter().all(|p| p[3] == 255)
    }
}

/// A pixel of linear light, weighted by alpha, as 8-bit sRGB.
#[inline]
pub(crate) fn to_8bit([r, g, b, alpha]: [f32; 4]) -> [u8; 4] {
    if alpha.is_nan() || alpha <= 0.0 {
        return [0; 4];
    }
    if alpha == 1.0 {
        return [to_byte(r), to_byte(g), to_byte(b), 255];
    }
    let color = |c: f32| to_byte(c / alpha);
    [color(r), color(g), color(b), (255.0 * alpha).round() as u8]
}

impl Image<[f32; 4]> {
    /// As 8-bit sRGB; light beyond what a screen shows is cut off.
    #[must_use]
    pub fn to_8bit(&self) -> Image {
        self.map(|light| to_8bit(*light))
    }

    /// As 16-bit sRGB; light beyond what a screen shows is cut off.
    #[must_use]
    pub fn to_16bit(&self) -> Image<[u16; 4]> {
        // A run that nobody else holds is not cancelled.
        self.to_16bit_with(&Run::default()).unwrap_or_else(|Cancelled| self.map(|_| [0; 4]))
    }

    /// [`to_16bit`](Image::to_16bit) with a choice of threads, a cancel token and a progress sink.
    ///
    /// ```
    /// use rvachev::{Image, Run};
    ///
    /// let light = Image::new(1, 1, vec![[1.0_f32, 0.0, 0.0, 1.0]])?;
    /// let picture = light.to_16bit_with(&Run { threads: 1, ..Run::default() })?;
    /// assert_eq!(picture.pixels(), [[65535, 0, 0, 65535]]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Cancelled`].
    pub fn to_16bit_with(&self, run: &Run) -> Result<Image<[u16; 4]>, Cancelled> {
        let level = |c: f32| (65535.0 * c).round() as u16;
        self.map_on([0; 4], &run.stage(0.0, 1.0), |light| encoded(*light).map(level))
    }
}

impl Image<f64> {
    /// The least and the greatest finite pixel; none if no pixel is finite.
    #[must_use]
    pub fn range(&self) -> Option<(f64, f64)> {
        let finite = self.pixels.iter().filter(|v| v.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
        (low <= high).then_some((low, high))
    }

    /// As 8-bit grey: what is `white` or less is white, `black` or more is nearly black, and
    /// what is not finite is black, as is all if `white` or `black` is NaN.
    #[must_use]
    pub fn to_grey8(&self, white: f64, black: f64) -> Image<u8> {
        self.map(|v| grey(*v, white, black, f64::from(u8::MAX)) as u8)
    }

    /// As 16-bit grey: what is `white` or less is white, `black` or more is nearly black, and
    /// what is not finite is black, as is all if `white` or `black` is NaN.
    #[must_use]
    pub fn to_grey16(&self, white: f64, black: f64) -> Image<u16> {
        self.map(|v| grey(*v, white, black, f64::from(u16::MAX)) as u16)
    }
}

/// A depth as a grey from 1 to `most`; 0 where there is none.
pub(crate) fn grey(v: f64, white: f64, black: f64, most: f64) -> f64 {
    if !v.is_finite() {
        return 0.0;
    }
    let span = black - white;
    let down = if span == 0.0 { 0.0 } else { ((v - white) / span).clamp(0.0, 1.0) };
    // A tenth of the greys is kept from what there is, to tell it from nothing.
    (most * (1.0 - 0.9 * down)).round()
}

/// Linear light, weighted by alpha, as sRGB (IEC 61966-2-1) and straight alpha from 0 to 1.
fn encoded([r, g, b, alpha]: [f32; 4]) -> [f32; 4] {
    if alpha.is_nan() || alpha <= 0.0 {
        return [0.0; 4];
    }
    let color = |c: f32| from_linear((c / alpha).clamp(0.0, 1.0)).clamp(0.0, 1.0);
    [color(r), color(g), color(b), alpha.min(1.0)]
}

#[cfg(test)]
mod tests {
    use super::super::transfer::to_linear;
    use super::*;

    #[test]
    fn rows_and_columns() {
        let pixels = (0..6).map(|i| [i, 0, 0, 255]).collect();
        let image = Image::new(3, 2, pixels).unwrap();
        assert_eq!(image.pixel(2, 1), Some([5, 0, 0, 255]));
        assert_eq!(image.pixel(0, 1), Some([3, 0, 0, 255]));
        assert_eq!(image.pixel(3, 0), None);
        assert_eq!(image.pixel(0, 2), None);
        assert!(image.is_opaque());
    }

    #[test]
    fn bad_sizes() {
        assert_eq!(
            Image::<u8>::new(0, 2, vec![]).unwrap_err().to_string(),
            "an image of 0 × 2 pixels; each side must be at least 1"
        );
        assert!(matches!(Image::<u8>::new(u32::MAX, u32::MAX, vec![]), Err(ImageError::Count { pixels: 0, .. })));
    }

    #[test]
    fn bytes_survive_the_transfer() {
        for byte in 0..=255u8 {
            let c = to_linear(f32::from(byte) / 255.0);
            let half = Image::new(2, 1, vec![[c, c, c, 1.0], [0.5 * c, 0.5 * c, 0.5 * c, 0.5]]).unwrap();
            assert_eq!(half.to_8bit().pixels(), [[byte, byte, byte, 255], [byte, byte, byte, 128]]);
            assert_eq!(half.to_16bit().pixels()[0][0], u16::from(byte) * 257);
        }
        let odd = Image::new(2, 1, vec![[f32::NAN; 4], [9.0, -1.0, 0.0, 2.0]]).unwrap();
        assert_eq!(odd.to_8bit().pixels(), [[0; 4], [255, 0, 0, 255]]);
    }

    #[test]
    fn depths_as_greys() {
        let depth = Image::new(4, 1, vec![2.0, 4.0, f64::INFINITY, 3.0]).unwrap();
        assert_eq!(depth.range(), Some((2.0, 4.0)));
        assert_eq!(depth.to_grey8(2.0, 4.0).pixels(), [255, 25, 0, 140]);
        assert_eq!(depth.to_grey16(2.0, 2.0).pixels()[0], 65535);
        assert_eq!(depth.to_grey8(f64::NAN, 4.0).pixels(), [0; 4]);
        assert_eq!(depth.to_grey16(2.0, f64::NAN).pixels(), [0; 4]);
    }
}
