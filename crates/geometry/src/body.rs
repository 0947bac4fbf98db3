use nalgebra::{Matrix3, Vector3};

use crate::mass_properties::MassProperties;
use crate::normal_cone::NormalCone;
use crate::{Edge, Face, Generator, GeometryError, Surface};

/// A convex body `{ζ : f_i(ζ) ≤ 0}`, the convex hull of its generators, and the real body inside it, which has the mass
/// and of which some part touches.
#[derive(Clone, Debug)]
pub struct Body {
    pub(crate) surfaces: Vec<Surface>,
    pub(crate) generators: Vec<Generator>,
    pub(crate) faces: Vec<Face>,
    pub(crate) edges: Vec<Edge>,
    pub(crate) point_cones: Vec<NormalCone>,
    pub(crate) edge_cones: Vec<NormalCone>,
    /// Edge between the generators `g` and `h` at `g N + h`, or [`NO_EDGE`].
    pub(crate) edge_table: Vec<u16>,
    pub(crate) faces_of_generator: Vec<Vec<u16>>,
    /// Whether the generator `g` touches the face `f`, at `f N + g`.
    pub(crate) incidence: Vec<bool>,
    size: f64,
    volume: f64,
    unit_inertia: Matrix3<f64>,
    hull_perimeter: f64,
    outline: Vec<Vec<Vector3<f64>>>,
}

pub(crate) const NO_EDGE: u16 = u16::MAX;

/// What a shape hands over: everything in a frame of its own, whose origin need not be the centre of mass.
#[derive(Clone, Debug)]
pub(crate) struct Parts {
    pub surfaces: Vec<Surface>,
    pub generators: Vec<Generator>,
    pub faces: Vec<Face>,
    pub edges: Vec<Edge>,
    /// One for each generator.
    pub point_cones: Vec<NormalCone>,
    /// One for each edge.
    pub edge_cones: Vec<NormalCone>,
    pub mass_properties: MassProperties,
    pub hull_perimeter: f64,
    pub outline: Vec<Vec<Vector3<f64>>>,
}

impl Parts {
    /// The body with the real body's centre of mass as its origin.
    pub fn centred(mut self) -> Body {
        let shift = -self.mass_properties.centre;
        let outline = self.outline.iter_mut().flatten();
        translate(&mut self.surfaces, &mut self.generators, &mut self.faces, &mut self.edges, outline, &shift);
        self.in_place()
    }

    /// The body with the origin that it was given.
    pub fn in_place(self) -> Body {
        let count = self.generators.len();
        let mut edge_table = vec![NO_EDGE; count * count];
        for (e, edge) in self.edges.iter().enumerate() {
            let (g, h) = (usize::from(edge.generators.0), usize::from(edge.generators.1));
            edge_table[g * count + h] = e as u16;
            edge_table[h * count + g] = e as u16;
        }
        let mut faces_of_generator = vec![Vec::new(); count];
        let mut incidence = vec![false; self.faces.len() * count];
        for (f, face) in self.faces.iter().enumerate() {
            for &g in &face.generators {
                faces_of_generator[usize::from(g)].push(f as u16);
                incidence[f * count + usize::from(g)] = true;
            }
        }
        Body {
            size: self.generators.iter().map(Generator::greatest_distance).fold(0.0, f64::max),
            surfaces: self.surfaces,
            generators: self.generators,
            faces: self.faces,
            edges: self.edges,
            point_cones: self.point_cones,
            edge_cones: self.edge_cones,
            edge_table,
            faces_of_generator,
            incidence,
            volume: self.mass_properties.volume,
            unit_inertia: self.mass_properties.unit_inertia,
            hull_perimeter: self.hull_perimeter,
            outline: self.outline,
        }
    }
}

/// Moves all that holds points; the normal cones hold only which gradients meet.
fn translate<'a>(
    surfaces: &mut [Surface],
    generators: &mut [Generator],
    faces: &mut [Face],
    edges: &mut [Edge],
    outline: impl Iterator<Item = &'a mut Vector3<f64>>,
    shift: &Vector3<f64>,
) {
    for surface in surfaces {
        *surface = surface.translated(shift);
    }
    for generator in generators {
        *generator = generator.translated(shift);
    }
    for face in faces {
        for point in face.anchors.iter_mut().chain([&mut face.area_centroid, &mut face.line_centroid]) {
            *point += shift;
        }
    }
    for edge in edges {
        edge.midpoint += shift;
    }
    for point in outline {
        *point += shift;
    }
}

impl Body {
    /// This body with its centre of mass, and with it the origin, at `offset` from where it is now. The inertia about the
    /// centre of mass stays what it is.
    pub fn with_center_of_mass(&self, offset: [f64; 3]) -> Result<Self, GeometryError> {
        for value in offset {
            GeometryError::finite("center_of_mass_m", value)?;
        }
        let offset = Vector3::from(offset);
        let distance = self.max_value(&offset).1;
        if distance >= 0.0 {
            return Err(GeometryError::CentreOutside { distance });
        }
        let mut moved = self.clone();
        let outline = moved.outline.iter_mut().flatten();
        translate(&mut moved.surfaces, &mut moved.generators, &mut moved.faces, &mut moved.edges, outline, &-offset);
        moved.size = moved.generators.iter().map(Generator::greatest_distance).fold(0.0, f64::max);
        Ok(moved)
    }

    /// The functions `f_i` whose `f_i ≤ 0` make up the hull.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// The sets whose convex hull the body is.
    pub fn generators(&self) -> &[Generator] {
        &self.generators
    }

    /// The flat faces of the hull.
    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// The straight lines of the hull between two generators.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Greatest distance `ℓ` of a point of the body from the centre of mass, in m.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Volume of the real body, in m³.
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Inertia of the real body per unit mass about its centre of mass, in m².
    pub fn unit_inertia(&self) -> &Matrix3<f64> {
        &self.unit_inertia
    }

    /// Perimeter in m of the hull's side profile at `x = -W/2`, or of the projection onto the `y`–`z` plane for a hull of
    /// points and an ellipsoid.
    pub fn hull_perimeter(&self) -> f64 {
        self.hull_perimeter
    }

    /// The real body's faces as polygons, for drawing; curves are sampled.
    pub fn outline(&self) -> &[Vec<Vector3<f64>>] {
        &self.outline
    }
}
