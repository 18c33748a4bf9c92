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

impl fmt::Display for ToleranceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, unit, given, largest } = self;
        write!(f, "a tolerance of {given} {unit} for {what}: it must be from 0 to {largest}")
    }
}

impl std::error::Error for ToleranceError {}

/// A tolerance: what it is of, its unit, default and ceiling.
macro_rules! tolerance {
    ($(#[$doc:meta])* $name:ident: $what:literal in $unit:literal, $default:literal to
     $(#[$limit:meta])* $largest:literal, made by $new:ident, $(#[$got:meta])* $get:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $name(f64);

        impl $name {
            $(#[$limit])*
            pub const LARGEST: f64 = $largest;

            #[doc = concat!("A tolerance of ", $what, ", in ", $unit, ".")]
            ///
            /// # Errors
            /// A value below 0 or above the largest.
            pub fn $new(given: f64) -> Result<Self, ToleranceError> {
                let (what, unit, largest) = ($what, $unit, Self::LARGEST);
                let is_taken = (0.0..=largest).contains(&given);
                is_taken.then_some(Self(given)).ok_or(ToleranceError { what, unit, given, largest })
            }

            $(#[$got])*
            pub fn $get(&self) -> f64 {
                self.0
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self($default)
            }
        }
    };
}

tolerance! {
    /// How far rounding may take a seamless map from exactness.
    Tolerance: "seams" in "edge lengths", 1e-9 to
    /// Largest seam mismatch that can be allowed, in lengths of the edge.
    ///
    /// At a hundredth the two images of an edge still agree in two digits, and every crossing of a seam
    /// turns by half a degree from a quarter turn at most, so that matchings and the angle sums of all
    /// vertices with fewer than 80 faces stay unambiguous. Coordinates of four digits on a layout of
    /// fifty edges are that good. What is open by more is a gap, not a rounding error.
    0.01, made by seams,
    /// Seam mismatch, in lengths of the edge. The rounding of the coordinates of its own four ends is
    /// allowed on top, but never more than [`Tolerance::LARGEST`] in all.
    seam
}

tolerance! {
    /// How far rounding may take aligned edges from exactness.
    AlignmentTolerance: "aligned edges" in "degrees", 1e-9 to
    /// Largest angle to an axis that can be allowed, degrees: the ends of the edge are then apart by
    /// 1.7 % of its length, about as much as [`Tolerance::LARGEST`].
    1.0, made by axes,
    /// Angle between the image of an edge and the nearer axis, degrees.
    axis
}

tolerance! {
    /// How far from an integer may be what has to be integral, grid units: nothing by default. Then integers are integers,
    /// and the two images of an edge fit to the last bit.
    IntegralTolerance: "integers" in "grid units", 0.0 to
    /// Largest distance that can be allowed: a hundredth of a cell, as much as a seam may be open by in
    /// lengths of an edge. A number that has nothing to do with integers is that close to one in one of 50
    /// cases, and no map is without a dozen of them.
    0.01, made by new,
    /// Grid units.
    distance
}

impl IntegralTolerance {
    /// Integers are integers, and the two images of an edge fit to the last bit.
    pub const EXACT: Self = Self(0.0);
}

impl AlignmentTolerance {
    /// That of a map whose seams are within a tolerance: what may be off an edge by a part of its length may turn it as
    /// much.
    pub fn of_seams(tolerance: &Tolerance) -> Self {
        Self(tolerance.seam().to_degrees().clamp(Self::default().0, Self::LARGEST))
    }
}

/// Largest error of the angle around a vertex or between two aligned edges, radians. A wrong angle is off by a quarter
/// turn; needles lose digits.
pub(crate) const ANGLE: f64 = 1e-3;

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
        assert!(of(0.01) < AlignmentTolerance::LARGEST);
    }

    #[test]
    fn tolerances_have_a_ceiling() {
        assert_eq!(Tolerance::seams(1e-9), Ok(Tolerance::default()));
        assert_eq!(Tolerance::seams(0.01).map(|t| t.seam()), Ok(0.01));
        for seam in [-1e-12, 0.011, 10.0, f64::INFINITY, f64::NAN] {
            assert!(Tolerance::seams(seam).is_err(), "{seam}");
        }
        assert_eq!(AlignmentTolerance::axes(1e-9), Ok(AlignmentTolerance::default()));
        for axis in [-1e-9, 1.5, 90.0, f64::NAN] {
            assert!(AlignmentTolerance::axes(axis).is_err(), "{axis}");
        }
        assert_eq!(IntegralTolerance::new(0.0), Ok(IntegralTolerance::EXACT));
        assert_eq!(IntegralTolerance::default(), IntegralTolerance::EXACT);
        assert_eq!(IntegralTolerance::new(0.01).map(|t| t.distance()), Ok(0.01));
        for distance in [-1e-9, 0.02, 0.5, f64::NAN] {
            assert!(IntegralTolerance::new(distance).is_err(), "{distance}");
        }
        let text = Tolerance::seams(10.0).unwrap_err().to_string();
        assert_eq!(text, "a tolerance of 10 edge lengths for seams: it must be from 0 to 0.01");
    }

    #[test]
    fn what_is_no_number_is_not_within() {
        assert!(within(1.0, 1.0) && !within(1.1, 1.0) && !within(f64::NAN, 1.0));
    }
}
