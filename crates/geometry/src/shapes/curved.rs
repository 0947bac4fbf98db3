use std::f64::consts::FRAC_PI_2;

use nalgebra::{Vector2, Vector3};

use super::curved_section::{Section, Sector};
use crate::body::Parts;
use crate::generator::Corner;
use crate::mass_properties::MassProperties;
use crate::normal_cone::{NormalCone, SurfaceSet};
use crate::{Arc, Body, Cone, Draft, Edge, Generator, GeometryError, HalfSpace, Surface};

pub(super) const CONE: u16 = 0;
/// The end planes at negative and at positive `y`.
pub(super) const ENDS: [u16; 2] = [1, 2];
pub(super) const CHORD: u16 = 3;
/// The side planes at `-W/2` and `+W/2`.
pub(super) const SIDES: [u16; 2] = [4, 5];
/// Chord corners: `2 side + end`. Arcs: `4 + side`. Corner curves: `6 + end`.
pub(super) const fn inner(side: u16, end: u16) -> u16 {
    2 * side + end
}
pub(super) const ARC: u16 = 4;
pub(super) const CORNER: u16 = 6;
/// Below this `tan φ` a corner curve is straight to rounding, and the arcs' ends are enough.
const STRAIGHT: f64 = 1e-6;
const ARC_STEPS: usize = 32;

impl Body {
    /// A prism over an annular sector of half angle `half_angle` (radians) about `+z`, concave side down.
    pub fn curved(
        outer_radius: f64,
        inner_radius: f64,
        half_angle: f64,
        width: f64,
        draft: Draft,
    ) -> Result<Self, GeometryError> {
        GeometryError::positive("outer radius", outer_radius)?;
        GeometryError::positive("inner radius", inner_radius)?;
        GeometryError::positive("half angle", half_angle)?;
        GeometryError::positive("width", width)?;
        GeometryError::less("inner radius", inner_radius, outer_radius)?;
        GeometryError::less("half angle", half_angle, FRAC_PI_2)?;
        let sector = Sector { outer_radius, inner_radius, half_angle };
        let slope = draft.slope()?;
        let sections = [sector.section(0.0), sector.inset(width * slope, draft.angle_rad)?];
        let shape = Shape { sector, width, slope, angle: draft.angle_rad, sections };
        Ok(shape.parts().centred())
    }
}

/// The surfaces, generators and edges by the indices above.
pub(super) struct Shape {
    pub(super) sector: Sector,
    width: f64,
    pub(super) slope: f64,
    angle: f64,
    pub(super) sections: [Section; 2],
}

/// A profile point at positive `y` taken to one of the ends.
pub(super) fn mirrored(point: Vector2<f64>, end: u16) -> Vector2<f64> {
    if end == 0 { Vector2::new(-point.x, point.y) } else { point }
}

impl Shape {
    pub(super) fn x(&self, side: u16) -> f64 {
        if side == 0 { -0.5 * self.width } else { 0.5 * self.width }
    }

    pub(super) fn placed(&self, side: u16, point: Vector2<f64>) -> Vector3<f64> {
        Vector3::new(self.x(side), point.x, point.y)
    }

    pub(super) fn inner_corner(&self, side: u16, end: u16) -> Vector3<f64> {
        self.placed(side, mirrored(self.sections[usize::from(side)].inner_corner, end))
    }

    pub(super) fn outer_corner(&self, side: u16, end: u16) -> Vector3<f64> {
        self.placed(side, mirrored(self.sections[usize::from(side)].outer_corner, end))
    }

    pub(super) fn has_corner_curves(&self) -> bool {
        self.slope > STRAIGHT
    }

    fn end_normal(&self, end: u16) -> Vector2<f64> {
        let (sin, cos) = self.sector.half_angle.sin_cos();
        mirrored(Vector2::new(cos, -sin), end)
    }

    fn parts(&self) -> Parts {
        let surfaces = self.surfaces();
        let (edges, edge_cones) = self.edges(&surfaces);
        Parts {
            generators: self.generators(),
            faces: self.faces(),
            edges,
            point_cones: self.point_cones(&surfaces),
            edge_cones,
            mass_properties: MassProperties::of_sections(self.width, |x| {
                self.sector.section((x + 0.5 * self.width) * self.slope).moments()
            }),
            hull_perimeter: 2.0
                * (self.sector.half_angle * self.sector.outer_radius
                    + (self.sector.outer_radius - self.sector.inner_radius)
                    + self.sector.half_angle.sin() * self.sector.inner_radius),
            outline: self.outline(),
            surfaces,
        }
    }

    fn surfaces(&self) -> Vec<Surface> {
        let Sector { outer_radius, inner_radius, half_angle } = self.sector;
        let length = (1.0 + self.slope * self.slope).sqrt();
        let tilted = |normal: Vector2<f64>, offset: f64| {
            Surface::HalfSpace(HalfSpace {
                normal: Vector3::new(self.slope, normal.x, normal.y) / length,
                offset: (offset - 0.5 * self.width * self.slope) / length,
            })
        };
        let side = |normal| Surface::HalfSpace(HalfSpace { normal, offset: 0.5 * self.width });
        let cone = Cone { x0: self.x(0), y0: 0.0, z0: 0.0, radius: outer_radius, draft: self.angle };
        vec![
            Surface::Cone(cone),
            tilted(self.end_normal(0), 0.0),
            tilted(self.end_normal(1), 0.0),
            tilted(Vector2::new(0.0, -1.0), -inner_radius * half_angle.cos()),
            side(-Vector3::x()),
            side(Vector3::x()),
        ]
    }

    fn generators(&self) -> Vec<Generator> {
        let (sin, cos) = self.sector.half_angle.sin_cos();
        let mut generators = Vec::new();
        for side in 0..2 {
            for end in 0..2 {
                generators.push(Generator::Vertex(self.inner_corner(side, end)));
            }
        }
        for side in 0..2 {
            let section = &self.sections[usize::from(side)];
            let centre = Vector3::new(self.x(side), 0.0, 0.0);
            generators.push(Generator::Arc(Arc::new(centre, section.outer_radius, section.outer_half_angle)));
        }
        if self.has_corner_curves() {
            for end in 0..2 {
                let (normal, radial) = (self.end_normal(end), mirrored(Vector2::new(sin, cos), end));
                generators.push(Generator::Corner(Corner {
                    origin: Vector3::new(self.x(0), 0.0, 0.0),
                    normal: Vector3::new(0.0, normal.x, normal.y),
                    radial: Vector3::new(0.0, radial.x, radial.y),
                    radius: self.sector.outer_radius,
                    slope: self.slope,
                    width: self.width,
                }));
            }
        }
        generators
    }

    fn point_cones(&self, surfaces: &[Surface]) -> Vec<NormalCone> {
        let mut cones = Vec::new();
        for side in SIDES {
            for end in ENDS {
                cones.push(NormalCone::of_vertex(&[end, CHORD, side], surfaces));
            }
        }
        for side in SIDES {
            let clamped = ENDS.map(|end| SurfaceSet::new(&[CONE, side, end]));
            cones.push(NormalCone::Curved([SurfaceSet::new(&[CONE, side]), clamped[0], clamped[1]]));
        }
        if self.has_corner_curves() {
            for end in ENDS {
                let clamped = SIDES.map(|side| SurfaceSet::new(&[CONE, end, side]));
                cones.push(NormalCone::Curved([SurfaceSet::new(&[CONE, end]), clamped[0], clamped[1]]));
            }
        }
        cones
    }

    /// The wall's edges are real; those of the chord in the side planes are bridged by air.
    fn edges(&self, surfaces: &[Surface]) -> (Vec<Edge>, Vec<NormalCone>) {
        let mut edges = Vec::new();
        let mut cones = Vec::new();
        let mut push = |g: u16, h: u16, meeting: &[u16], cone: NormalCone, length: f64, midpoint: Vector3<f64>| {
            edges.push(Edge { generators: (g, h), surfaces: meeting.to_vec(), length, midpoint });
            cones.push(cone);
        };
        let mut straight = |g: u16, h: u16, meeting: [u16; 2], from: Vector3<f64>, to: Vector3<f64>, real: bool| {
            let length = if real { (to - from).norm() } else { 0.0 };
            push(g, h, &meeting, NormalCone::of_edge(meeting, surfaces), length, 0.5 * (from + to));
        };
        for (side, plane) in (0..).zip(SIDES) {
            let [from, to] = [0, 1].map(|end| self.inner_corner(side, end));
            straight(inner(side, 0), inner(side, 1), [CHORD, plane], from, to, false);
        }
        for (end, plane) in (0..).zip(ENDS) {
            let [from, to] = [0, 1].map(|side| self.inner_corner(side, end));
            straight(inner(0, end), inner(1, end), [plane, CHORD], from, to, true);
            for (side, side_plane) in (0..).zip(SIDES) {
                let (from, to) = (self.inner_corner(side, end), self.outer_corner(side, end));
                straight(inner(side, end), ARC + side, [plane, side_plane], from, to, true);
                if self.has_corner_curves() {
                    straight(inner(side, end), CORNER + end, [plane, side_plane], from, to, true);
                }
            }
        }
        let ruling = SurfaceSet::new(&[CONE]);
        let ends = ENDS.map(|end| SurfaceSet::new(&[CONE, end]));
        let middle = |side: u16| self.placed(side, Vector2::new(0.0, self.sections[usize::from(side)].outer_radius));
        let across = NormalCone::Curved([ruling, ends[0], ends[1]]);
        push(ARC, ARC + 1, &[CONE], across, (middle(1) - middle(0)).norm(), 0.5 * (middle(0) + middle(1)));
        if self.has_corner_curves() {
            for end in 0..2 {
                let corner = self.outer_corner(0, end);
                push(ARC, CORNER + end, &[CONE], NormalCone::Curved([ruling; 3]), 0.0, corner);
            }
        }
        (edges, cones)
    }

    fn outline(&self) -> Vec<Vec<Vector3<f64>>> {
        let [near, far] = [0, 1].map(|side| {
            let sampled = self.sections[usize::from(side)].sampled(ARC_STEPS);
            sampled.into_iter().map(|p| self.placed(side, p)).collect::<Vec<_>>()
        });
        let count = near.len();
        let mut polygons: Vec<Vec<Vector3<f64>>> = (0..count)
            .map(|k| {
                let next = (k + 1) % count;
                vec![near[k], near[next], far[next], far[k]]
            })
            .collect();
        polygons.push(near.into_iter().rev().collect());
        polygons.push(far);
        polygons
    }
}
