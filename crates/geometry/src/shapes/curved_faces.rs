use nalgebra::{Vector2, Vector3};

use super::curved::{ARC, CHORD, CONE, CORNER, ENDS, SIDES, Shape, inner, mirrored};
use crate::mass_properties::gauss_legendre;
use crate::polyhedron::{anchors, area_and_centroid};
use crate::{Face, Support};

impl Shape {
    /// The two ends of the wall, the chord, which is bridged by air between its two lines, and the two sides.
    pub(super) fn faces(&self) -> Vec<Face> {
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
}
