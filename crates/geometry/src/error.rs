use thiserror::Error;

/// Why a body could not be made.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum GeometryError {
    /// A number that is NaN or infinite.
    #[error("{name} is {value}, expected a finite number")]
    NotFinite {
        /// The argument's name.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A length that is zero or negative.
    #[error("{name} is {value:e}, expected a positive number")]
    NotPositive {
        /// The argument's name.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A negative angle.
    #[error("{name} is {value:e}, expected at least 0")]
    Negative {
        /// The argument's name.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A length or an angle that is too large.
    #[error("{name} is {value:e}, expected less than {limit:e}")]
    TooLarge {
        /// The argument's name.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What it has to stay below.
        limit: f64,
    },
    /// A draft that makes a face of the profile vanish before the far side plane.
    #[error("the draft angle of {angle_rad} rad makes the {vanishing} vanish over the width")]
    DraftTooLarge {
        /// The draft angle.
        angle_rad: f64,
        /// The part of the profile that vanishes.
        vanishing: &'static str,
    },
    /// A hull of fewer than four distinct points.
    #[error("the hull has {distinct} distinct points, expected at least 4")]
    TooFewPoints {
        /// Number of distinct points.
        distinct: usize,
    },
    /// A hull whose points lie in a plane.
    #[error("the hull is flat: its thickness is {thickness:e} m, expected more than {limit:e} m")]
    Flat {
        /// Extent of the points across their plane.
        thickness: f64,
        /// Least thickness that is accepted.
        limit: f64,
    },
    /// A hull that does not contain the origin, which is the centre of mass.
    #[error("the centre of mass (the origin) lies {distance:e} m outside the hull or on its boundary")]
    OriginOutside {
        /// Distance of the origin outside the nearest face's plane.
        distance: f64,
    },
    /// A centre of mass that was moved out of the hull.
    #[error("center_of_mass_m lies {distance:e} m outside the hull or on its boundary, expected inside")]
    CentreOutside {
        /// The greatest `f_i` there, for a flat face the distance outside it.
        distance: f64,
    },
    /// More points, faces or edges than the index type holds.
    #[error("the hull has {count} {what}, expected at most {limit}")]
    TooMany {
        /// What there are too many of.
        what: &'static str,
        /// Their number.
        count: usize,
        /// The greatest number accepted.
        limit: usize,
    },
    /// A hull whose faces could not be closed to rounding.
    #[error("no consistent convex hull was found for {points} points (largest excess {excess:e} m)")]
    HullNotFound {
        /// Number of distinct points.
        points: usize,
        /// The farthest that a point lies outside a face.
        excess: f64,
    },
}

impl GeometryError {
    /// Refuses what is not a finite number.
    pub(crate) fn finite(name: &'static str, value: f64) -> Result<(), Self> {
        if value.is_finite() { Ok(()) } else { Err(Self::NotFinite { name, value }) }
    }

    /// Refuses what is not a positive finite number.
    pub(crate) fn positive(name: &'static str, value: f64) -> Result<(), Self> {
        Self::finite(name, value)?;
        if value <= 0.0 {
            return Err(Self::NotPositive { name, value });
        }
        Ok(())
    }

    /// Refuses what is not below the limit.
    pub(crate) fn less(name: &'static str, value: f64, limit: f64) -> Result<(), Self> {
        if value < limit { Ok(()) } else { Err(Self::TooLarge { name, value, limit }) }
    }
}
