use std::collections::{HashMap, HashSet};

use nalgebra::{Matrix3, Vector3};

use crate::polyhedron::{Facet, edges_of};
use crate::{GeometryError, HalfSpace, parry_math};

/// Points nearer to each other than this part of the extent are one.
const SAME_POINT: f64 = 1e-12;
/// The least thickness, as a part of the extent.
const THINNEST: f64 = 1e-6;
/// Faces are merged where points lie within this part of the thickness of their plane, and within ten times that as often
/// as `MERGE_STEPS` where the hull does not close.
const MERGED: f64 = 1e-10;
const MERGE_STEPS: i32 = 5;
const ATTEMPTS: i32 = 12;
const LEAST_JOSTLE: f64 = 1e-11;
/// Indices of points are 16 bits wide.
const MOST_POINTS: usize = u16::MAX as usize;

/// The vertices of the convex hull and its faces, coplanar triangles merged.
pub(super) fn hull_facets(points: &[Vector3<f64>]) -> Result<(Vec<Vector3<f64>>, Vec<Facet>), GeometryError> {
    let extent = points.iter().map(|p| (p - points[0]).norm()).fold(0.0, f64::max);
    let mut distinct: Vec<Vector3<f64>> = Vec::new();
    for p in points {
        if distinct.iter().all(|q| (p - q).norm() > SAME_POINT * extent) {
            distinct.push(*p);
        }
    }
    if distinct.len() < 4 {
        return Err(GeometryError::TooFewPoints { distinct: distinct.len() });
    }
    if distinct.len() > MOST_POINTS {
        return Err(GeometryError::TooMany { what: "points", count: distinct.len(), limit: MOST_POINTS });
    }
    let (round, thickness) = made_round(&distinct, extent)?;

    let mut worst = 0.0;
    for attempt in 0..ATTEMPTS {
        let Some(triangles) = parry_math::hull_triangles(&jostled(&round, attempt)) else { continue };
        for step in 0..MERGE_STEPS {
            let tolerance = (MERGED * 10f64.powi(step) * thickness).max(1e-15 * extent);
            let Some(facets) = merged(&distinct, &triangles, tolerance) else { continue };
            worst = facets
                .iter()
                .flat_map(|f| distinct.iter().map(|p| f.half_space.normal.dot(p) - f.half_space.offset))
                .fold(0.0, f64::max);
            if worst <= tolerance
                && let Some(hull) = renumbered(&distinct, facets)
            {
                return Ok(hull);
            }
        }
    }
    Err(GeometryError::HullNotFound { points: distinct.len(), excess: worst })
}

/// Many points in a plane or in a line can make parry lose a vertex. From the second attempt on the points move by a tiny
/// pseudo-random amount, larger with each attempt, which tells parry how to triangulate and is not kept.
fn jostled(points: &[Vector3<f64>], attempt: i32) -> Vec<Vector3<f64>> {
    if attempt == 0 {
        return points.to_vec();
    }
    let amplitude = LEAST_JOSTLE * 10f64.powf(0.5 * f64::from(attempt));
    let spread = Vector3::new(0.819_172_513, 0.671_043_606, 0.549_700_478);
    points
        .iter()
        .enumerate()
        .map(|(i, p)| p + spread.map(|s| amplitude * ((s * (i as f64 + 7.3 * f64::from(attempt))).fract() - 0.5)))
        .collect()
}

/// The points in their principal axes, each scaled to a unit extent, and their least extent: an affine map keeps the hull
/// and spares parry flat bodies.
fn made_round(points: &[Vector3<f64>], extent: f64) -> Result<(Vec<Vector3<f64>>, f64), GeometryError> {
    let centre = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let local: Vec<Vector3<f64>> = points.iter().map(|p| (p - centre) / extent).collect();
    let spread: Matrix3<f64> = local.iter().map(|p| p * p.transpose()).sum();
    let axes = spread.symmetric_eigen().eigenvectors;
    let mut turned: Vec<Vector3<f64>> = local.iter().map(|p| axes.tr_mul(p)).collect();
    let mut thickness = f64::INFINITY;
    for k in 0..3 {
        let low = turned.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        let high = turned.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
        thickness = thickness.min(high - low);
        if high - low < THINNEST {
            return Err(GeometryError::Flat { thickness: (high - low) * extent, limit: THINNEST * extent });
        }
        for p in &mut turned {
            p[k] = (p[k] - low) / (high - low) - 0.5;
        }
    }
    if axes.determinant() < 0.0 {
        for p in &mut turned {
            p.x = -p.x;
        }
    }
    Ok((turned, thickness * extent))
}

/// Grows each face from the largest triangle left, across edges, over all triangles in its plane. A vertex of fewer than
/// three faces lies inside a face or an edge and is left out. `None` where the faces do not close.
fn merged(points: &[Vector3<f64>], triangles: &[[usize; 3]], tolerance: f64) -> Option<Vec<Facet>> {
    let cross = |t: &[usize; 3]| (points[t[1]] - points[t[0]]).cross(&(points[t[2]] - points[t[0]]));
    let mut beyond = HashMap::new();
    for (t, triangle) in triangles.iter().enumerate() {
        for k in 0..3 {
            beyond.insert((triangle[(k + 1) % 3], triangle[k]), t);
        }
    }
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|&a, &b| cross(&triangles[b]).norm().total_cmp(&cross(&triangles[a]).norm()));
    let mut group = vec![usize::MAX; triangles.len()];
    let mut planes = Vec::new();
    for seed in order {
        if group[seed] != usize::MAX {
            continue;
        }
        let normal = cross(&triangles[seed]).try_normalize(0.0)?;
        let height = normal.dot(&points[triangles[seed][0]]);
        let mut stack = vec![seed];
        group[seed] = planes.len();
        while let Some(t) = stack.pop() {
            for k in 0..3 {
                let &next = beyond.get(&(triangles[t][k], triangles[t][(k + 1) % 3]))?;
                let flat = triangles[next].iter().all(|&i| (normal.dot(&points[i]) - height).abs() <= tolerance);
                if group[next] == usize::MAX && flat {
                    group[next] = planes.len();
                    stack.push(next);
                }
            }
        }
        planes.push(normal);
    }

    let mut faces_of: Vec<HashSet<usize>> = vec![HashSet::new(); points.len()];
    let mut boundary: Vec<HashMap<usize, usize>> = vec![HashMap::new(); planes.len()];
    for (t, triangle) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
            faces_of[from].insert(group[t]);
            if group[*beyond.get(&(from, to))?] != group[t] && boundary[group[t]].insert(from, to).is_some() {
                return None;
            }
        }
    }
    planes.iter().zip(&boundary).map(|(normal, next)| facet(points, normal, next, &faces_of)).collect()
}

/// The face inside a closed chain of boundary edges.
fn facet(
    points: &[Vector3<f64>],
    normal: &Vector3<f64>,
    next: &HashMap<usize, usize>,
    faces_of: &[HashSet<usize>],
) -> Option<Facet> {
    let &start = next.keys().min()?;
    let mut chain = vec![start];
    let mut at = *next.get(&start)?;
    while at != start {
        chain.push(at);
        at = *next.get(&at)?;
        if chain.len() > next.len() {
            return None;
        }
    }
    if chain.len() != next.len() {
        return None;
    }
    chain.retain(|&i| faces_of[i].len() >= 3);
    if chain.len() < 3 {
        return None;
    }
    let offset = chain.iter().map(|&i| normal.dot(&points[i])).fold(f64::NEG_INFINITY, f64::max);
    let polygon: Option<Vec<u16>> = chain.iter().map(|&i| u16::try_from(i).ok()).collect();
    Some(Facet { half_space: HalfSpace { normal: *normal, offset }, polygon: polygon? })
}

/// Numbers the vertices that faces use, in the order of the points; `None` where the faces do not close to a polyhedron
/// of `V - E + F = 2`.
fn renumbered(points: &[Vector3<f64>], mut facets: Vec<Facet>) -> Option<(Vec<Vector3<f64>>, Vec<Facet>)> {
    let mut used: Vec<u16> = facets.iter().flat_map(|f| f.polygon.iter().copied()).collect();
    used.sort_unstable();
    used.dedup();
    for facet in &mut facets {
        for i in &mut facet.polygon {
            *i = used.binary_search(i).ok()? as u16;
        }
    }
    let edges = edges_of(&facets)?;
    let vertices = used.iter().map(|&i| points[usize::from(i)]).collect();
    (used.len() + facets.len() == edges.len() + 2).then_some((vertices, facets))
}
