//! Laws: functions of z that [`Solid::taper_by`](crate::Solid::taper_by) and
//! [`Solid::twist_by`](crate::Solid::twist_by) follow.

#[doc(inline)]
pub use rvachev_field::{BuiltInLaw, Law, LawTable, LinearLaw, SineWave, SmoothStep};
