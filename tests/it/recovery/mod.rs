//! Solids from points: gates on random clouds, and what every fit must keep.

mod bent;
mod clouds;
mod deformed;
mod every_kind;
mod fit_cloud;
mod inspection;
mod parts;
mod registration;
mod scanned_parts;
mod shapes;
mod superellipsoids;
mod supershapes;
mod unions;
