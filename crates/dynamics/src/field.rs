//! The magnetic field over time.

use crate::Vec3;
use crate::error::{Invalid, direction, finite, not_negative};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Greatest cosine between `a` and `b0` that still counts as a right angle.
const RIGHT_ANGLE: f64 = 1e-6;

/// A uniform field that varies with time.
#[derive(Debug, Clone)]
#[allow(missing_docs)] // the formulas say what each field is
pub enum Field {
    /// `B(t) = B [i cos ωt + q sin ωt]`; `greatest` is the longer half axis of that ellipse over `B`.
    Rotating { strength: f64, frequency: f64, initial: Vec3, quadrature: Vec3, greatest: f64 },
    /// `B(t) = B b`.
    Static { field: Vec3 },
    /// Linear between rows.
    Table { times: Arc<[f64]>, fields: Arc<[Vec3]> },
}

impl Field {
    /// `B(t) = B [b0 cos ωt + (a × b0) sin ωt]`, `strength` in T, `frequency` in Hz, rotation axis `a` and initial direction
    /// `b0`.
    pub fn rotating(strength: f64, frequency: f64, axis: Vec3, initial: Vec3) -> Result<Self, Invalid> {
        not_negative("strength_T", strength)?;
        not_negative("frequency_Hz", frequency)?;
        let axis = direction("rotation_axis", axis)?;
        let initial = direction("initial_direction", initial)?;
        let cosine = axis.dot(&initial);
        if cosine.abs() > RIGHT_ANGLE {
            return Err(Invalid::NotOrthogonal { found: cosine });
        }
        Ok(Self::Rotating { strength, frequency, initial, quadrature: axis.cross(&initial), greatest: 1.0 })
    }

    /// `B(t) = B [b0 cos ωt + ρ (a × b0) sin(ωt + δ)]`: a rotating field whose second phase has the amplitude `ratio` of the
    /// first and leads by `phase` (rad). Another field stays what it is.
    pub fn with_quadrature(self, ratio: f64, phase: f64) -> Result<Self, Invalid> {
        not_negative("quadrature_ratio", ratio)?;
        finite("phase_error_deg", phase)?;
        match self {
            Self::Rotating { strength, frequency, initial, quadrature, .. } if ratio != 1.0 || phase != 0.0 => {
                let (sin, cos) = phase.sin_cos();
                let initial = initial + quadrature * (ratio * sin);
                let quadrature = quadrature * (ratio * cos);
                // The half axes are the singular values of [i q].
                let (one, other, mixed) = (initial.norm_squared(), quadrature.norm_squared(), initial.dot(&quadrature));
                let greatest = (0.5 * (one + other) + (0.5 * (one - other)).hypot(mixed)).sqrt();
                Ok(Self::Rotating { strength, frequency, initial, quadrature, greatest })
            }
            other => Ok(other),
        }
    }

    /// A constant field of `strength` (T) along `along`.
    pub fn constant(strength: f64, along: Vec3) -> Result<Self, Invalid> {
        not_negative("strength_T", strength)?;
        Ok(Self::Static { field: direction("direction", along)? * strength })
    }

    /// A field given at increasing times (s), in T.
    pub fn table(times: &[f64], fields: &[Vec3]) -> Result<Self, Invalid> {
        if times.len() < 2 || fields.len() != times.len() {
            return Err(Invalid::TableLength { found: times.len().min(fields.len()), expected: times.len().max(2) });
        }
        for (row, time) in times.iter().enumerate() {
            finite("time_s", *time)?;
            if row > 0 && *time <= times[row - 1] {
                return Err(Invalid::TableOrder { row: row + 1, found: *time, before: times[row - 1] });
            }
            for component in fields[row].iter() {
                finite("the field's table", *component)?;
            }
        }
        Ok(Self::Table { times: times.into(), fields: fields.into() })
    }

    /// `B(t)`, T. A table holds its first and last row outside its span.
    #[inline]
    pub fn at(&self, t: f64) -> Vec3 {
        match self {
            Self::Rotating { strength, frequency, initial, quadrature, .. } => {
                let (sin, cos) = (TAU * frequency * t).sin_cos();
                (initial * cos + quadrature * sin) * *strength
            }
            Self::Static { field } => *field,
            Self::Table { times, fields } => {
                let next = times.partition_point(|time| *time <= t);
                if next == 0 {
                    fields[0]
                } else if next == times.len() {
                    fields[next - 1]
                } else {
                    let share = (t - times[next - 1]) / (times[next] - times[next - 1]);
                    fields[next - 1].lerp(&fields[next], share)
                }
            }
        }
    }

    /// The field's greatest strength, T.
    pub fn greatest_strength(&self) -> f64 {
        match self {
            Self::Rotating { strength, greatest, .. } => strength * greatest,
            Self::Static { field } => field.norm(),
            Self::Table { fields, .. } => fields.iter().map(|field| field.norm()).fold(0.0, f64::max),
        }
    }

    /// The length of one cycle, s, where the field has one.
    pub fn period(&self) -> Option<f64> {
        match self {
            Self::Rotating { frequency, .. } if *frequency > 0.0 => Some(1.0 / frequency),
            _ => None,
        }
    }

    /// Refuses a table that ends before `needed` (s) or starts after 0.
    pub fn covers(&self, needed: f64) -> Result<(), Invalid> {
        match self {
            Self::Table { times, .. } => {
                let (first, last) = (times[0], times[times.len() - 1]);
                // A table written with a few digits may end a rounding before the run does.
                let slack = 1e-9 * needed.abs();
                if first > slack || last + slack < needed {
                    return Err(Invalid::TableSpan { first, last, needed });
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }
}
