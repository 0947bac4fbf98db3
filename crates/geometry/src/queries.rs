use nalgebra::Vector3;

use crate::body::NO_EDGE;
use crate::{Body, ContactMode, Edge, Generator, Patch, Support};

impl Body {
    /// The surface with the largest `f_i(ζ)`, and that value in m.
    #[inline]
    pub fn max_value(&self, point: &Vector3<f64>) -> (usize, f64) {
        let mut best = (0, f64::NEG_INFINITY);
        for (i, surface) in self.surfaces.iter().enumerate() {
            let value = surface.value(point);
            if value > best.1 {
                best = (i, value);
            }
        }
        best
    }

    /// The generator that reaches farthest along a direction, and its farthest point; the first of equals.
    #[inline]
    pub fn lowest(&self, direction: &Vector3<f64>) -> (u16, Vector3<f64>) {
        let mut lowest = 0;
        let mut height = f64::NEG_INFINITY;
        for (g, generator) in self.generators.iter().enumerate() {
            let reached = generator.height(direction);
            lowest = if reached > height { g } else { lowest };
            height = reached.max(height);
        }
        (lowest as u16, self.generators[lowest].support(direction))
    }

    #[inline]
    fn edge_index(&self, g: u16, h: u16) -> Option<usize> {
        let e = self.edge_table[usize::from(g) * self.generators.len() + usize::from(h)];
        (e != NO_EDGE).then_some(usize::from(e))
    }

    /// The edge between two generators, in either order.
    #[inline]
    pub fn edge_between(&self, g: u16, h: u16) -> Option<&Edge> {
        self.edge_index(g, h).map(|e| &self.edges[e])
    }

    /// Whether a generator touches the plane of a face.
    #[inline]
    pub fn face_touches(&self, face: u16, generator: u16) -> bool {
        self.incidence[usize::from(face) * self.generators.len() + usize::from(generator)]
    }

    /// The faces whose planes a generator touches.
    #[inline]
    pub fn faces_of(&self, generator: u16) -> &[u16] {
        &self.faces_of_generator[usize::from(generator)]
    }

    /// A face whose plane three generators touch.
    #[inline]
    pub fn face_through(&self, a: u16, b: u16, c: u16) -> Option<u16> {
        self.faces_of(a).iter().copied().find(|&f| self.face_touches(f, b) && self.face_touches(f, c))
    }

    /// What of the real body touches a plane of outward normal `-direction`.
    pub fn patch(&self, support: Support, direction: &Vector3<f64>) -> Patch {
        let at = |g: u16| self.generators[usize::from(g)].support(direction);
        let nothing = Patch { mode: ContactMode::Airborne, area: 0.0, line_length: 0.0, centroid: Vector3::zeros() };
        match support {
            Support::None => nothing,
            Support::Point(g) => Patch { mode: ContactMode::Point, centroid: at(g), ..nothing },
            Support::Line(g, h) => {
                let (p, q) = (at(g), at(h));
                let bare = Patch { mode: ContactMode::Line, centroid: 0.5 * (p + q), ..nothing };
                let fixed = |g: u16| matches!(self.generators[usize::from(g)], Generator::Vertex(_));
                match self.edge_between(g, h) {
                    Some(edge) if fixed(g) || fixed(h) => {
                        Patch { line_length: edge.length, centroid: edge.midpoint, ..bare }
                    }
                    Some(_) => Patch { line_length: (q - p).norm(), ..bare },
                    None => bare,
                }
            }
            Support::Face(f) => {
                let face = &self.faces[usize::from(f)];
                Patch {
                    mode: ContactMode::Surface,
                    area: face.area,
                    line_length: face.line_length,
                    centroid: if face.area > 0.0 { face.area_centroid } else { face.line_centroid },
                }
            }
        }
    }

    /// What touches a plane of outward normal `-direction` on which the body stands: the generators within `tolerance` of
    /// the farthest. A face if at least three of them at different places have one in common; a line if there are two
    /// with an edge between them; otherwise the farthest point.
    pub fn touching(&self, direction: &Vector3<f64>, tolerance: f64) -> Support {
        let (lowest, point) = self.lowest(direction);
        let height = point.dot(direction);
        let near = |g: usize| -> Option<Vector3<f64>> {
            let p = self.generators[g].support(direction);
            (p.dot(direction) >= height - tolerance).then_some(p)
        };
        let apart = |p: &Vector3<f64>, q: &Vector3<f64>| (p - q).norm() > 1e-9 * self.size() + tolerance;
        let all = || (0..self.generators.len()).filter_map(|g| near(g).map(|p| (g as u16, p)));

        let Some((first, p)) = all().next() else { return Support::Point(lowest) };
        let mut second = None;
        let mut third = None;
        for (g, r) in all() {
            match second {
                _ if !apart(&p, &r) => {}
                None => second = Some((g, r)),
                Some((_, q)) if apart(&q, &r) => {
                    third = Some(g);
                    break;
                }
                Some(_) => {}
            }
        }
        match (second, third) {
            (Some((h, _)), Some(i)) => match self.face_through(first, h, i) {
                Some(f) if all().all(|(g, _)| self.face_touches(f, g)) => Support::Face(f),
                _ => Support::Point(lowest),
            },
            (Some((_, q)), None) => all()
                .filter(|(_, r)| !apart(&p, r))
                .flat_map(|(g, _)| all().filter(move |(_, r)| !apart(&q, r)).map(move |(i, _)| (g, i)))
                .find(|&(g, i)| self.edge_between(g, i).is_some())
                .map_or(Support::Point(lowest), |(g, i)| Support::line(g, i)),
            _ => Support::Point(lowest),
        }
    }

    /// `l_i ≥ 0` with `Σ l_i ∇f_i(point) = direction`, where `direction` is the body-frame `-n`; zero for every surface
    /// that does not meet in the support. `out` has one entry for each surface.
    ///
    /// At a point where more than three surfaces meet, the three with the greatest smallest `l` are taken. Negative `l` are
    /// written as zero. False where the direction is not reproduced to 1e-6: it does not belong to the support.
    pub fn multipliers(
        &self,
        support: Support,
        point: &Vector3<f64>,
        direction: &Vector3<f64>,
        out: &mut [f64],
    ) -> bool {
        out.fill(0.0);
        match support {
            Support::None => false,
            Support::Point(g) => {
                let g = usize::from(g);
                let place = self.generators[g].place(direction);
                self.point_cones[g].multipliers(&self.surfaces, place, point, direction, out)
            }
            Support::Line(g, h) => {
                let Some(e) = self.edge_index(g, h) else { return false };
                let place = self.generators[usize::from(g)].place(direction);
                self.edge_cones[e].multipliers(&self.surfaces, place, point, direction, out)
            }
            Support::Face(f) => {
                let surface = usize::from(self.faces[usize::from(f)].surface);
                let gradient = self.surfaces[surface].gradient(point);
                out[surface] = gradient.dot(direction).max(0.0);
                (out[surface] * gradient - direction).norm() < crate::normal_cone::REPRODUCED
            }
        }
    }
}
