//! From points to a solid: what a scan is of, how sure that is, and where a part is off.
//!
//! | what there is | what is wanted | verb |
//! |---|---|---|
//! | points of one round object, whole or of one side | the object | [`fit::superellipsoid`](crate::fit::superellipsoid()) |
//! | points of a star, gear, prism, flower | its curves and their symmetry numbers | [`fit::supershape`](crate::fit::supershape()) |
//! | points of a bent, twisted or tapered object | the object and how it is bent | [`fit::deformed`](crate::fit::deformed()) |
//! | a mesh of a whole part | its tree of leaves | [`fit::part`](crate::fit::part()) |
//! | a scan of a whole part | the same | [`fit::part_of_points`](crate::fit::part_of_points()) |
//! | a surface cut into segments | a union of supershapes with holes | [`fit::supershape_union`](crate::fit::supershape_union()) |
//! | a scan of a known part | where the part is | [`fit::register`](crate::fit::register()) |
//! | a scan of a known part, in place | where it is off, and by how much | [`fit::inspect`](crate::fit::inspect()) |
//!
//! Points come from [files](crate::PointCloud), from the renderer's [range
//! images](crate::layers::Layers::range_image) or those of the [depth
//! buffer](crate::raster::Buffers::range_image), or from anything that gives coordinates. How the
//! fits work, with all the figures that were measured: [`fit`](crate::fit). At the shell the
//! example `fit_cloud` prints a fit of a file as one line of JSON.
//!
//! # Points among others
//!
#![doc = picture!("scans_strewn" = "docs/scans/strewn.png")]
//!
//! *Grey: 1000 points of a superellipsoid with 1 % noise, and 1500 that are strewn about it. Blue:
//! those whose weight is above a half, and the solid.*
//!
//! Nothing is said of how many points are outliers, nor of the noise: both are found.
//! [`superellipsoid`](crate::fit::superellipsoid()) takes up to 60 % of outliers, and leaves out a
//! table that the object stands on. [`supershape`](crate::fit::supershape()) takes some 20 %, and
//! knows of no tables. Every point has a weight, the chance that it is of the surface.
//!
//! ```
//! use rvachev::fit::{FitSettings, superellipsoid};
//! use rvachev::surface::ParametricSurface;
//! use rvachev::{PointCloud, Superellipsoid};
//!
//! let sampled = ParametricSurface::of(&Superellipsoid::new([1.2, 0.8, 2.0], 0.4, 1.3))?.sample(600, 1)?;
//! let mut points: Vec<glam::DVec3> = sampled.iter().map(|sample| sample.point).collect();
//! // A fifth of what there is comes from elsewhere.
//! let strewn = |i: u32| [0.754_877, 0.569_840, 0.438_579].map(|step| (f64::from(i) * step).fract() * 6.0 - 3.0);
//! points.extend((0..150).map(|i| glam::DVec3::from_array(strewn(i))));
//! let fit = superellipsoid(&PointCloud::new(points)?, &FitSettings::default())?;
//! assert!((fit.inliers() - 0.8).abs() < 0.03);
//! assert!(fit.weights()[..600].iter().filter(|weight| **weight > 0.5).count() > 590);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Kinds of solids
//!
#![doc = picture!("scans_kinds" = "docs/scans/kinds.png")]
//!
//! *Above: points with noise. Below: what [`superellipsoid`](crate::fit::superellipsoid()),
//! [`supershape`](crate::fit::supershape()) and [`deformed`](crate::fit::deformed()) find in them.*
//!
//! The latter two give a plain superellipsoid where that explains the points as well. Which of
//! several fits of one cloud explains it best is told by
//! [`Fit::criterion`](crate::fit::Fit::criterion). A fit is a [`Solid`](crate::Solid) like any
//! other: to be meshed, cut, joined, written as code.
//!
//! # What points do not tell
//!
#![doc = picture!("scans_depth" = "docs/scans/depth.png")]
//!
//! *Grey: points of the upper face of an object, drawn from beside. Blue: the solid that was found.
//! Red: one that is deeper by two standard deviations, whose upper face is the same.*
//!
//! | what is not told | how one sees it |
//! |---|---|
//! | the depth of what is seen along one of its axes | a large [deviation](crate::fit::Covariance::deviation) of that axis' `ln a`, and of the shift along it |
//! | a turn about an axis of revolution; the twist of a round section; a bend of a ball | a large deviation of that turn, twist or bend |
//! | which axis of a box is the polar one; a square prism or its dual, turned by 45° | nothing: parameters differ, the surfaces do not; compare these |
//! | the scale of a supershape's exponents where they are large, and sizes against exponents | large deviations of `ln n`, `ln a`; their covariances are near those of a straight line |
//! | symmetry numbers where no radii repeat, or little is seen | [`symmetry_unclear`](crate::fit::SearchReport::symmetry_unclear), [`one_sided`](crate::fit::SearchReport::one_sided) |
//! | the far side of anything that is seen from one side | [`one_sided`](crate::fit::SearchReport::one_sided): the smallest solid that fits is taken |
//! | along which faces a registered part may slide | a large deviation of a shift or turn of the [`Registration`](crate::fit::Registration) |
//!
//! ```
//! use rvachev::fit::{FitSettings, superellipsoid};
//! use rvachev::surface::ParametricSurface;
//! use rvachev::{PointCloud, Superellipsoid};
//!
//! let sampled = ParametricSurface::of(&Superellipsoid::new([1.0, 1.4, 0.8], 0.3, 0.8))?.sample(2000, 1)?;
//! let all: Vec<glam::DVec3> = sampled.iter().map(|sample| sample.point).collect();
//! let upper = all.iter().copied().filter(|p| p.z > 0.4 && p.x.abs() < 0.95).collect();
//! let deviations = [all, upper].map(|points| {
//!     // A hash as noise of 0.01.
//!     let noise = |i: usize| ((i as f64 * 0.754_877).fract() - 0.5) * 0.035;
//!     let points = points.iter().enumerate().map(|(i, p)| *p * (1.0 + noise(i))).collect();
//!     let fit = superellipsoid(&PointCloud::new(points).unwrap(), &FitSettings::default()).unwrap();
//!     let of = |name: &str| fit.covariance().deviation(name).unwrap();
//!     of("ln a1").max(of("ln a2")).max(of("ln a3"))
//! });
//! assert!(deviations[1] > 5.0 * deviations[0], "of the whole, and of the upper face: {deviations:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Range images
//!
#![doc = picture!("scans_grasp" = "docs/scans/grasp.png")]
//!
//! *Six objects on a table, by rays on the left, by a depth buffer on the right; the solids that
//! were found are drawn over the images. The example `grasp` prints them beside the truth.*
//!
//! A range image gives points of one side, with the normals if it was rendered. Noise of a range
//! finder is added by [`with_noise`](crate::range_image::RangeImage::with_noise). The example
//! takes off the plane of the table, splits the rest into parts that do not touch, and fits each.
//!
//! # Parts against their models
//!
#![doc = picture!("scans_inspect" = "docs/scans/inspect.png")]
//!
//! *A scan of a bracket whose hole was drilled 0.3 beside its place and whose boss is 2 % too high,
//! by its deviations from the model: red outside, blue inside.*
//!
//! [`register`](crate::fit::register()) finds the pose, [`inspect`](crate::fit::inspect()) the
//! deviation of each point and of each named leaf: its shift, its growth, and whether that is more
//! than noise. The example `inspect` makes this picture, a coloured PLY and JSON.
//!
//! # Beside others
//!
//! Of 200 random superellipsoids of 1000 points so many per cent come out within 2 % of their size;
//! of the published methods as published, of EMS and its variants the best:
//!
//! | condition | here | EMS, published | ms, published |
//! |---|---|---|---|
//! | clean | 100 | 99.0 | 17.6 |
//! | 1 % noise | 100 | 99.5 | 46–80 |
//! | + 20 % outliers | 100 | 98.5 | 46–80 |
//! | + 40 % outliers | 100 | 99.5 | 46–80 |
//! | + 60 % outliers, share unknown | 100 | 9.5 (97 of a known share) | 187 |
//! | one-sided view | 94 | 65.5 | |
//! | view + 20 % outliers | 94.5 | 56 | |
//! | on a table, 40 % of the points | 100 | 86.5 | |
//!
//! Published times are of Python. `cargo bench --bench fit` prints those of this crate: on one
//! thread of a machine that did other things as well, 0.4 ms clean, 1.0 of 60 % outliers, 1.0 of
//! views, 1.9 on a table, 0.9 deformed, 8.3 for a supershape, and 29 of a million points.
//! Published residuals, symmetry numbers and rational radii are options
//! ([`Cost`](crate::fit::Cost), [`Symmetry`](crate::fit::Symmetry), [`Start`](crate::fit::Start)),
//! so that the comparison can be repeated; [`fit`](crate::fit) says what they reach with this
//! search.
//!
//! Sources: F. Solina, R. Bajcsy, *Recovery of parametric models from range images: the case for
//! superquadrics with global deformations* (1990); W. Liu, Y. Wu, S. Ruan, G. Chirikjian, *Robust
//! and accurate superquadric recovery: a probabilistic approach* (2022); Y. D. Fougerolle et al.,
//! *Rational supershapes for surface reconstruction*.
