use nalgebra::{Matrix3, Vector3};

use crate::Surface;
use crate::generator::Place;

/// Up to three surfaces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceSet {
    surfaces: [u16; 3],
    count: usize,
}

/// Surfaces of constant gradient, and the pseudo-inverse that gives their multipliers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simplex {
    set: SurfaceSet,
    inverse: Matrix3<f64>,
}

/// The directions in which a generator or an edge is farthest, as the cone of the gradients that meet there.
#[derive(Clone, Debug)]
pub(crate) enum NormalCone {
    /// The gradients are constant; the cone is the union of the simplices.
    Flat(Vec<Simplex>),
    /// The gradients depend on the point; the sets by the place along the generator: inside, low end, high end.
    Curved([SurfaceSet; 3]),
}

/// The multipliers have to reproduce a unit direction to this error.
pub(crate) const REPRODUCED: f64 = 1e-6;
/// Unit normals make no simplex where the sine between two, or between the third and the plane of the two that are farthest
/// apart, is below this. Three that are close together still span one: those of the many faces of a flat body.
const DEGENERATE: f64 = 1e-9;
/// Above this number of faces at a vertex their cone is cut into a fan instead of into all triples.
const ALL_TRIPLES: usize = 8;

impl SurfaceSet {
    pub fn new(surfaces: &[u16]) -> Self {
        let mut set = Self { surfaces: [0; 3], count: surfaces.len() };
        set.surfaces[..surfaces.len()].copy_from_slice(surfaces);
        set
    }

    fn indices(&self) -> &[u16] {
        &self.surfaces[..self.count]
    }
}

/// Rows `λ_i` with `λ_i · g_j = δ_ij` in the span of the first `count` gradients.
fn pseudo_inverse(gradients: &[Vector3<f64>; 3], count: usize) -> Option<Matrix3<f64>> {
    let [a, b, c] = gradients;
    let rows = match count {
        1 => [a / a.norm_squared(), Vector3::zeros(), Vector3::zeros()],
        2 => {
            let normal = a.cross(b);
            let square = normal.norm_squared();
            if square < DEGENERATE * DEGENERATE {
                return None;
            }
            [b.cross(&normal) / square, normal.cross(a) / square, Vector3::zeros()]
        }
        _ => {
            let crosses = [b.cross(c), c.cross(a), a.cross(b)];
            let determinant = a.dot(&crosses[0]);
            let widest = crosses.iter().map(|cross| cross.norm()).fold(0.0, f64::max);
            if determinant.abs() < DEGENERATE * widest {
                return None;
            }
            crosses.map(|cross| cross / determinant)
        }
    };
    Some(Matrix3::from_rows(&rows.map(|r| r.transpose())))
}

impl Simplex {
    pub fn new(surfaces: &[u16], all: &[Surface]) -> Option<Self> {
        let set = SurfaceSet::new(surfaces);
        let mut gradients = [Vector3::zeros(); 3];
        for (gradient, &i) in gradients.iter_mut().zip(surfaces) {
            *gradient = all[usize::from(i)].gradient(&Vector3::zeros());
        }
        pseudo_inverse(&gradients, set.count).map(|inverse| Self { set, inverse })
    }

    fn least(&self, direction: &Vector3<f64>) -> f64 {
        let l = self.inverse * direction;
        (0..self.set.count).map(|i| l[i]).fold(f64::INFINITY, f64::min)
    }
}

impl NormalCone {
    /// Of an edge between two half-spaces.
    pub fn of_edge(surfaces: [u16; 2], all: &[Surface]) -> Self {
        NormalCone::Flat(Simplex::new(&surfaces, all).into_iter().collect())
    }

    /// Of a vertex of half-spaces: all triples of them, or a fan where they are many.
    pub fn of_vertex(surfaces: &[u16], all: &[Surface]) -> Self {
        let mut triples = Vec::new();
        if surfaces.len() <= ALL_TRIPLES {
            for (k, &c) in surfaces.iter().enumerate() {
                for (j, &b) in surfaces[..k].iter().enumerate() {
                    triples.extend(surfaces[..j].iter().map(|&a| [a, b, c]));
                }
            }
        } else {
            let ordered = around_their_mean(surfaces, all);
            triples.extend(ordered[1..].windows(2).map(|w| [ordered[0], w[0], w[1]]));
        }
        NormalCone::Flat(triples.iter().filter_map(|t| Simplex::new(t, all)).collect())
    }

    /// Writes `l ≥ 0` with `Σ l_i ∇f_i = direction` into `out`, which is zero on entry. False where the direction is not
    /// in the cone.
    pub fn multipliers(
        &self,
        all: &[Surface],
        place: Place,
        point: &Vector3<f64>,
        direction: &Vector3<f64>,
        out: &mut [f64],
    ) -> bool {
        match self {
            NormalCone::Flat(simplices) => {
                let best = match simplices.as_slice() {
                    [only] => only,
                    several => {
                        let mut best: Option<(&Simplex, f64)> = None;
                        for simplex in several {
                            let least = simplex.least(direction);
                            if best.is_none_or(|(_, l)| least > l) {
                                best = Some((simplex, least));
                            }
                        }
                        match best {
                            Some((simplex, _)) => simplex,
                            None => return false,
                        }
                    }
                };
                let l = best.inverse * direction;
                write(&best.set, &l, all, point, direction, out) < REPRODUCED
            }
            NormalCone::Curved(sets) => {
                let first = place as usize;
                for turn in 0..sets.len() {
                    let set = &sets[(first + turn) % sets.len()];
                    let mut gradients = [Vector3::zeros(); 3];
                    for (gradient, &i) in gradients.iter_mut().zip(set.indices()) {
                        *gradient = all[usize::from(i)].gradient(point);
                    }
                    let Some(inverse) = pseudo_inverse(&gradients, set.count) else { continue };
                    if write(set, &(inverse * direction), all, point, direction, out) < REPRODUCED {
                        return true;
                    }
                    for &i in set.indices() {
                        out[usize::from(i)] = 0.0;
                    }
                }
                false
            }
        }
    }
}

/// Writes the multipliers, negative ones as zero, and returns `|Σ l_i ∇f_i - direction|`.
fn write(
    set: &SurfaceSet,
    l: &Vector3<f64>,
    all: &[Surface],
    point: &Vector3<f64>,
    direction: &Vector3<f64>,
    out: &mut [f64],
) -> f64 {
    let mut rest = *direction;
    for (k, &i) in set.indices().iter().enumerate() {
        let i = usize::from(i);
        out[i] = l[k].max(0.0);
        rest -= out[i] * all[i].gradient(point);
    }
    rest.norm()
}

/// Half-spaces through a vertex in their order around the mean of their normals.
fn around_their_mean(surfaces: &[u16], all: &[Surface]) -> Vec<u16> {
    let normal = |i: u16| all[usize::from(i)].gradient(&Vector3::zeros());
    let mean = surfaces.iter().map(|&i| normal(i)).sum::<Vector3<f64>>().normalize();
    let first = normal(surfaces[0]);
    let e = (first - mean * mean.dot(&first)).normalize();
    let f = mean.cross(&e);
    let mut ordered: Vec<(f64, u16)> =
        surfaces.iter().map(|&i| (normal(i).dot(&f).atan2(normal(i).dot(&e)), i)).collect();
    ordered.sort_by(|a, b| a.0.total_cmp(&b.0));
    ordered.into_iter().map(|(_, i)| i).collect()
}
