//! The one place where parry's vectors (glam's) meet nalgebra's.

use std::panic::{AssertUnwindSafe, catch_unwind};

use nalgebra::{Matrix3, Vector3};
use parry3d_f64::mass_properties::details::{
    tetrahedron_unit_inertia_tensor_wrt_point, trimesh_signed_volume_and_center_of_mass,
};
use parry3d_f64::math::Vector;
use parry3d_f64::shape::Tetrahedron;
use parry3d_f64::transformation::try_convex_hull;

fn to_parry(v: &Vector3<f64>) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

fn to_nalgebra(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}

/// Outward triangles of the convex hull of distinct points, as indices of the points. `None` where parry gives up, by an
/// error or by one of its assertions.
pub(crate) fn hull_triangles(points: &[Vector3<f64>]) -> Option<Vec<[usize; 3]>> {
    let input: Vec<Vector> = points.iter().map(to_parry).collect();
    let (vertices, triangles) = catch_unwind(AssertUnwindSafe(|| try_convex_hull(&input))).ok()?.ok()?;
    let index: Option<Vec<usize>> =
        vertices.into_iter().map(|v| points.iter().position(|p| *p == to_nalgebra(v))).collect();
    let index = index?;
    Some(triangles.into_iter().map(|t| t.map(|i| index[i as usize])).collect())
}

/// Volume, centroid, and inertia per unit volume's density about the centroid of the solid inside a closed mesh of
/// outward triangles.
pub(crate) fn solid_moments(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let vertices: Vec<Vector> = vertices.iter().map(to_parry).collect();
    let (volume, centre) = trimesh_signed_volume_and_center_of_mass(&vertices, triangles);
    let mut inertia = Matrix3::zeros();
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| vertices[i as usize]);
        let part = tetrahedron_unit_inertia_tensor_wrt_point(centre, centre, a, b, c);
        let weight = Tetrahedron::new(centre, a, b, c).signed_volume();
        inertia += Matrix3::from_column_slice(&part.to_cols_array()) * weight;
    }
    (volume, to_nalgebra(centre), inertia)
}
