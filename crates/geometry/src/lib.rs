//! Convex bodies for the contact problem of `docs/model.md`: their bounding surfaces `f_i`, the generators whose convex
//! hull they are, their mass properties, and what of them really touches a plane.
//!
//! All quantities are SI. The body frame has `x` along the width, `y` along the length, `z` along the height, and its
//! origin is the centre of mass. Directions are unit vectors of the body frame.

#![warn(missing_docs)]

mod body;
mod edge;
mod error;
mod face;
mod generator;
mod mass_properties;
mod normal_cone;
mod parry_math;
mod patch;
mod polyhedron;
mod prism;
mod profile;
mod queries;
mod shapes;
mod support;
mod surface;

pub use body::Body;
pub use edge::Edge;
pub use error::GeometryError;
pub use face::Face;
pub use generator::{Arc, Corner, EllipsoidGenerator, Generator};
pub use patch::{ContactMode, Patch};
pub use profile::{Draft, DraftModel};
pub use support::Support;
pub use surface::{Cone, EllipsoidSurface, HalfSpace, Surface};
