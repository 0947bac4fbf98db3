use std::f64::consts::FRAC_PI_2;

use nalgebra::{Vector2, Vector3};

use super::curved_section::{Section, Sector};
use crate::body::Parts;
use crate::generator::Corner;
use crate::mass_properties::{MassProperties, gauss_legendre};
use crate::normal_cone::{NormalCone, SurfaceSet};
use crate::polyhedron::{anchors, area_and_centroid};
use crate::{Arc, Body, Cone, Draft, Edge, Face, Generator, GeometryError, HalfSpace, Support, Surface};

const CONE: u16 = 0;
/// The end planes at negative and at positive `y`.
const ENDS: [u16; 2] = [1, 2];
const CHORD: u16 = 3;
/// The side planes at `-W/2` and `+W/2`.
const SIDES: [u16; 2] = [4, 5];
/// Chord corners: `2 side + end`. Arcs: `4 + side`. Corner curves: `6 + end`.
const fn inner(side: u16, end: u16) -> u16 {
    2 * side + end
}
const ARC: u16 = 4;
const CORNER: u16 = 6;
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

struct Shape {
    sector: Sector,
    width: f64,
    slope: f64,
    angle: f64,
    sections: [Section; 2],
}

fn mirrored(point: Vector2<f64>, end: u16) -> Vector2<f64> {
    if end == 0 { Vector2::new(-point.x, point.y) } else { point }
}

impl Shape {
    fn x(&self, side: u16) -> f64 {
        if side == 0 { -0.5 * self.width } else { 0.5 * self.width }
    }

    fn placed(&self, side: u16, point: Vector2<f64>) -> Vector3<f64> {
        Vector3::new(self.x(side), point.x, point.y)
    }

    fn inner_corner(&self, side: u16, end: u16) -> Vector3<f64> {
        self.placed(side, mirrored(self.sections[usize::from(side)].inner_corner, end))
    }

    fn outer_corner(&self, side: u16, end: u16) -> Vector3<f64> {
        self.placed(side, mirrored(self.sections[usize::from(side)].outer_corner, end))
    }

    fn has_corner_curves(&self) -> bool {
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

    fn faces(&self) -> Vec<Face> {
        let mut faces = Vec::new();
        let corner = |end: u16| self.has_corner_curves().then_some(CORNER + end);
        for (end, surface) in (0..).zip(ENDS) {
            let mut generators = vec![inner(0, end), inner(1, end), ARC, ARC + 1];
            generators.extend(corner(end));
            let neighbours = vec![
                (CHORD, Support::Line(inner(0, end), inner(1, end))),
                (SIDES[0], Support::Line(inner(0, end), ARC)),
                (SIDES[1], Support::Line(inner(1, end), ARC + 1)),
                (CONE, corner(end).map_or(Support::Line(ARC, ARC + 1), Support::Point)),
            ];
            let (area, centroid) = self.end_area(end);
            let outline = [0, 1].map(|side| [self.inner_corner(side, end), self.outer_corner(side, end)]);
            faces.push(Face {
                surface,
                anchors: anchors(&outline.concat()),
                generators,
                neighbours,
                area,
                area_centroid: centroid,
                line_length: 0.0,
                line_centroid: centroid,
            });
        }

        let bridge = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(side, end)| self.inner_corner(side, end));
        let mut neighbours = Vec::new();
        for k in 0..2 {
            neighbours.push((ENDS[usize::from(k)], Support::Line(inner(0, k), inner(1, k))));
            neighbours.push((SIDES[usize::from(k)], Support::Line(inner(k, 0), inner(k, 1))));
        }
        faces.push(Face {
            surface: CHORD,
            anchors: anchors(&bridge),
            generators: vec![inner(0, 0), inner(0, 1), inner(1, 0), inner(1, 1)],
            neighbours,
            area: 0.0,
            area_centroid: area_and_centroid(&bridge).1,
            line_length: (bridge[3] - bridge[0]).norm() + (bridge[2] - bridge[1]).norm(),
            line_centroid: bridge.iter().sum::<Vector3<f64>>() / 4.0,
        });

        for (side, surface) in (0..).zip(SIDES) {
            let section = &self.sections[usize::from(side)];
            let moments = section.moments();
            let centroid = self.placed(side, Vector2::from(moments.first) / moments.area);
            let mut generators = vec![inner(side, 0), inner(side, 1), ARC + side];
            generators.extend([0, 1].into_iter().filter_map(corner));
            let top = self.placed(side, Vector2::new(0.0, section.outer_radius));
            faces.push(Face {
                surface,
                anchors: anchors(&[self.inner_corner(side, 0), self.inner_corner(side, 1), top]),
                generators,
                neighbours: vec![
                    (CONE, Support::Point(ARC + side)),
                    (ENDS[0], Support::Line(inner(side, 0), ARC + side)),
                    (ENDS[1], Support::Line(inner(side, 1), ARC + side)),
                    (CHORD, Support::Line(inner(side, 0), inner(side, 1))),
                ],
                area: moments.area,
                area_centroid: centroid,
                line_length: 0.0,
                line_centroid: centroid,
            });
        }
        faces
    }

    /// `A = ∫ (s_o - s_i) √(1 + tan²φ) dx` over the wall's end.
    fn end_area(&self, end: u16) -> (f64, Vector3<f64>) {
        let stretch = (1.0 + self.slope * self.slope).sqrt();
        let mut area = 0.0;
        let mut moment = Vector3::zeros();
        for (x, weight) in gauss_legendre(self.x(0), self.x(1)) {
            let section = self.sector.section((x - self.x(0)) * self.slope);
            let (p, q) = (mirrored(section.inner_corner, end), mirrored(section.outer_corner, end));
            let strip = weight * stretch * (q - p).norm();
            area += strip;
            moment += strip * Vector3::new(x, 0.5 * (p.x + q.x), 0.5 * (p.y + q.y));
        }
        (area, moment / area)
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
