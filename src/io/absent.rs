//! Formats that this build leaves out: their extensions are known, and say which feature brings
//! them back.

use std::io::{self, Write};

#[cfg(not(feature = "exr"))]
pub(super) fn write_exr_on<P>(_: &crate::geom::Image<P>, _: &crate::Run, _: impl Write) -> io::Result<()> {
    Err(lacks("exr"))
}

#[cfg(not(feature = "threemf"))]
pub(super) fn write_3mf_on(
    _: &crate::geom::Mesh,
    _: &super::SaveSettings,
    _: &crate::Run,
    _: impl Write,
) -> io::Result<()> {
    Err(lacks("threemf"))
}

fn lacks(feature: &str) -> io::Error {
    io::Error::new(io::ErrorKind::Unsupported, format!("this build of rvachev lacks the feature `{feature}`"))
}
