mod cuboid;
mod curved;
mod curved_section;
mod ellipsoid;
mod hull;
mod hull_facets;
mod spiked;
mod spiked_ends;
