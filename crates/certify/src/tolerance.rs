//! How far a map may be from exactness, within ceilings above which a check would mean nothing.

use std::fmt;

/// A tolerance that is negative, not a number, or so large that the check would mean nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ToleranceError {
    /// What the tolerance is for.
    pub what: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The value given.
    pub given: f64,
    /// The largest value that is taken.
    pub largest: f64,
}

impl ToleranceError {
    fn unless_within(
        given: f64,
        largest: f64,
        what: &'static str,
        unit: &'static str,
    ) -> Result<f64, Self> {
        match (0.0..=largest).contains(&given) {
            true => Ok(given),
            false => Err(Self { what, unit, given, largest }),
        }
    }
}

impl fmt::Display for ToleranceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, unit, given, largest } = self;
        write!(f, "a tolerance of {given} {unit} for {what}: it must be from 0 to {largest}")
    }
}

impl std::error::Error for ToleranceError {}

/// How far rounding may take a seamless map from exactness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    seam: f64,
    angle: f64,
}

impl Tolerance {
    /// Largest seam mismatch that can be allowed, in lengths of the edge.
    ///
    /// At a hundredth the two images of an edge still agree in two digits, and every crossing of a seam
    /// turns by half a degree from a quarter turn at most, so that matchings and the angle sums of all
    /// vertices with fewer than 80 faces stay unambiguous. Coordinates of four digits on a layout of
    /// fifty edges are that good. What is open by more is a gap, not a rounding error.
    pub const LARGEST_SEAM: f64 = 0.01;
    /// Largest error of an angle sum that can be allowed, radians: an eighth of the half step between
    /// two multiples of a quarter turn.
    pub const LARGEST_ANGLE: f64 = 0.1;

    /// Tolerances of seams, in lengths of the edge, and of angle sums, in radians.
    ///
    /// # Errors
    /// Values below 0 or above the largest.
    pub fn new(seam: f64, angle: f64) -> Result<Self, ToleranceError> {
        let (of_seams, of_angles) = (("seams", "edge lengths"), ("angle sums", "radians"));
        let checked =
            |x, largest, (what, unit)| ToleranceError::unless_within(x, largest, what, unit);
        Ok(Self {
            seam: checked(seam, Self::LARGEST_SEAM, of_seams)?,
            angle: checked(angle, Self::LARGEST_ANGLE, of_angles)?,
        })
    }

    /// A tolerance of seams, in lengths of the edge; that of angle sums is the default.
    ///
    /// # Errors
    /// A value below 0 or above [`Tolerance::LARGEST_SEAM`].
    pub fn seams(seam: f64) -> Result<Self, ToleranceError> {
        Self::new(seam, Self::default().angle)
    }

    /// Seam mismatch, in lengths of the edge. The rounding of the coordinates of its own four ends is
    /// allowed on top, but never more than [`Tolerance::LARGEST_SEAM`] in all.
    pub fn seam(&self) -> f64 {
        self.seam
    }

    /// Error of an angle sum, radians. A wrong sum is off by a quarter turn; needles lose digits.
    pub fn angle(&self) -> f64 {
        self.angle
    }
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { seam: 1e-9, angle: 1e-3 }
    }
}

/// How far rounding may take aligned edges from exactness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlignmentTolerance {
    axis: f64,
    sector: f64,
}

impl AlignmentTolerance {
    /// Largest angle to an axis that can be allowed, degrees: the ends of the edge are then apart by
    /// 1.7 % of its length, about as much as [`Tolerance::LARGEST_SEAM`].
    pub const LARGEST_AXIS: f64 = 1.0;
    /// Largest error of the angle of a sector that can be allowed, radians.
    pub const LARGEST_SECTOR: f64 = Tolerance::LARGEST_ANGLE;

    /// Tolerances of the angle to an axis, in degrees, and of the angles of sectors, in radians.
    ///
    /// # Errors
    /// Values below 0 or above the largest.
    pub fn new(axis: f64, sector: f64) -> Result<Self, ToleranceError> {
        let (of_axes, of_sectors) = (("aligned edges", "degrees"), ("sectors", "radians"));
        let checked =
            |x, largest, (what, unit)| ToleranceError::unless_within(x, largest, what, unit);
        Ok(Self {
            axis: checked(axis, Self::LARGEST_AXIS, of_axes)?,
            sector: checked(sector, Self::LARGEST_SECTOR, of_sectors)?,
        })
    }

    /// A tolerance of the angle to an axis, in degrees; that of sectors is the default.
    ///
    /// # Errors
    /// A value below 0 or above [`AlignmentTolerance::LARGEST_AXIS`].
    pub fn axes(axis: f64) -> Result<Self, ToleranceError> {
        Self::new(axis, Self::default().sector)
    }

    /// That of a map whose seams are within a tolerance: what may be off an edge by a part of its length may turn it as
    /// much.
    pub fn of_seams(tolerance: &Tolerance) -> Self {
        let default = Self::default();
        let axis = tolerance.seam.to_degrees().min(Self::LARGEST_AXIS);
        Self { axis: axis.max(default.axis), ..default }
    }

    /// Angle between the image of an edge and the nearer axis, degrees.
    pub fn axis(&self) -> f64 {
        self.axis
    }

    /// Error of the angle of a sector, radians. A wrong angle is off by a quarter turn; needles lose
    /// digits.
    pub fn sector(&self) -> f64 {
        self.sector
    }
}

impl Default for AlignmentTolerance {
    fn default() -> Self {
        Self { axis: 1e-9, sector: 1e-3 }
    }
}

/// How far from an integer may be what has to be integral, grid units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntegralTolerance(f64);

impl IntegralTolerance {
    /// Integers are integers, and the two images of an edge fit to the last bit.
    pub const EXACT: Self = Self(0.0);
    /// Largest distance that can be allowed: a hundredth of a cell, as much as a seam may be open by in
    /// lengths of an edge. A number that has nothing to do with integers is that close to one in one of 50
    /// cases, and no map is without a dozen of them.
    pub const LARGEST: f64 = 0.01;

    /// A tolerance for maps written with few digits.
    ///
    /// # Errors
    /// A value below 0 or above [`IntegralTolerance::LARGEST`].
    pub fn new(distance: f64) -> Result<Self, ToleranceError> {
        ToleranceError::unless_within(distance, Self::LARGEST, "integers", "grid units").map(Self)
    }

    /// Grid units; 0 is [`IntegralTolerance::EXACT`].
    pub fn distance(self) -> f64 {
        self.0
    }
}

/// Whether a figure is at most a limit; a figure that is not a number is not.
pub(crate) fn within(figure: f64, limit: f64) -> bool {
    figure <= limit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alignment_allows_what_seams_do() {
        let of = |seam| AlignmentTolerance::of_seams(&Tolerance::seams(seam).unwrap()).axis();
        assert_eq!(of(0.0), 1e-9);
        assert_eq!(of(1e-3), 1e-3f64.to_degrees());
        assert!(of(0.01) < AlignmentTolerance::LARGEST_AXIS);
        assert_eq!(AlignmentTolerance::default().sector(), 1e-3);
        assert_eq!(Tolerance::default().angle(), 1e-3);
    }

    #[test]
    fn tolerances_have_a_ceiling() {
        assert_eq!(Tolerance::seams(1e-9), Ok(Tolerance::default()));
        assert_eq!(Tolerance::seams(0.01).map(|t| t.seam()), Ok(0.01));
        for seam in [-1e-12, 0.011, 10.0, f64::INFINITY, f64::NAN] {
            assert!(Tolerance::seams(seam).is_err(), "{seam}");
        }
        assert!(Tolerance::new(0.0, 0.2).is_err());
        assert_eq!(AlignmentTolerance::axes(1e-9), Ok(AlignmentTolerance::default()));
        for (axis, sector) in [(1.5, 1e-3), (90.0, 1e-3), (f64::NAN, 1e-3), (1e-9, 1.0)] {
            assert!(AlignmentTolerance::new(axis, sector).is_err(), "{axis} {sector}");
        }
        assert_eq!(IntegralTolerance::new(0.0), Ok(IntegralTolerance::EXACT));
        assert_eq!(IntegralTolerance::new(0.01).map(IntegralTolerance::distance), Ok(0.01));
        for distance in [-1e-9, 0.02, 0.5, f64::NAN] {
            assert!(IntegralTolerance::new(distance).is_err(), "{distance}");
        }
        let text = Tolerance::seams(10.0).unwrap_err().to_string();
        assert_eq!(text, "a tolerance of 10 edge lengths for seams: it must be from 0 to 0.01");
    }
}
