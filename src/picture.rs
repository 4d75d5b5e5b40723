//! Pictures in the documentation.

/// The pictures of an item, side by side, for its documentation:
/// `#[doc = picture!("name" = "path")]` on a line of its own between two blank ones. Paths are
/// those from the crate's root. Without the feature `doc-images` there are none.
#[cfg(feature = "doc-images")]
macro_rules! picture {
    ($($name:literal = $path:literal),+ $(,)?) => {
        concat!($("![", $name, "][", $name, "] ",)+ "\n\n", $(::embed_doc_image::embed_image!($name, $path), "\n",)+)
    };
}

#[cfg(not(feature = "doc-images"))]
macro_rules! picture {
    ($($name:literal = $path:literal),+ $(,)?) => {
        ""
    };
}
