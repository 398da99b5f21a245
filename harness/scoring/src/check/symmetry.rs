//! The eight ways in which a square map can lie.

/// The orientation of a map relative to the right one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Symmetry {
    Identity,
    FlippedV,
    MirroredU,
    Rotated180,
    Transposed,
    AntiTransposed,
    Clockwise,
    CounterClockwise,
}

impl Symmetry {
    pub const ALL: [Self; 8] = [
        Self::Identity,
        Self::FlippedV,
        Self::MirroredU,
        Self::Rotated180,
        Self::Transposed,
        Self::AntiTransposed,
        Self::Clockwise,
        Self::CounterClockwise,
    ];

    /// The column and row of the map that hold the value of column `x` and row `y`.
    pub fn source(self, x: usize, y: usize, side: usize) -> (usize, usize) {
        let (far_x, far_y) = (side - 1 - x, side - 1 - y);
        match self {
            Self::Identity => (x, y),
            Self::FlippedV => (x, far_y),
            Self::MirroredU => (far_x, y),
            Self::Rotated180 => (far_x, far_y),
            Self::Transposed => (y, x),
            Self::AntiTransposed => (far_y, far_x),
            Self::Clockwise => (far_y, x),
            Self::CounterClockwise => (y, far_x),
        }
    }

    /// The values of a square map as they should lie.
    pub fn undone<T: Copy>(self, values: &[T], side: usize) -> Vec<T> {
        let at = |texel: usize| {
            let (x, y) = self.source(texel % side, texel / side, side);
            values[y * side + x]
        };
        (0..side * side).map(at).collect()
    }

    /// This symmetry, then a mirror in u; faces are nearly their own mirror images.
    pub fn mirrored(self) -> Self {
        match self {
            Self::Identity => Self::MirroredU,
            Self::MirroredU => Self::Identity,
            Self::FlippedV => Self::Rotated180,
            Self::Rotated180 => Self::FlippedV,
            Self::Transposed => Self::CounterClockwise,
            Self::CounterClockwise => Self::Transposed,
            Self::AntiTransposed => Self::Clockwise,
            Self::Clockwise => Self::AntiTransposed,
        }
    }

    /// Id of the fault, what is wrong in words, and the fix.
    pub fn words(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Identity => ("upright", "lies as it should", "leave it"),
            Self::FlippedV => (
                "flipped-v",
                "is flipped in v",
                "write its rows in the other order (row 0 is the top, at v = 1)",
            ),
            Self::MirroredU => {
                ("mirrored-u", "is mirrored in u", "write its columns in the other order")
            }
            Self::Rotated180 => (
                "turned-180",
                "is turned by 180 degrees",
                "write its rows and columns in the other order",
            ),
            Self::Transposed => (
                "transposed",
                "is transposed",
                "swap rows and columns (rows run with v, columns with u)",
            ),
            Self::AntiTransposed => (
                "transposed-turned-180",
                "is transposed and turned by 180 degrees",
                "swap rows and columns and write both in the other order",
            ),
            Self::Clockwise => (
                "turned-90",
                "is turned by 90 degrees clockwise",
                "turn it by 90 degrees counter-clockwise",
            ),
            Self::CounterClockwise => (
                "turned-270",
                "is turned by 90 degrees counter-clockwise",
                "turn it by 90 degrees clockwise",
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_named_as_they_look() {
        // Row 0 on top: a b / c d; turned clockwise it is c a / d b.
        let upright = ['a', 'b', 'c', 'd'];
        assert_eq!(Symmetry::Clockwise.undone(&['c', 'a', 'd', 'b'], 2), upright);
        assert_eq!(Symmetry::CounterClockwise.undone(&['b', 'd', 'a', 'c'], 2), upright);
        assert_eq!(Symmetry::FlippedV.undone(&['c', 'd', 'a', 'b'], 2), upright);
        assert_eq!(Symmetry::Transposed.undone(&['a', 'c', 'b', 'd'], 2), upright);
        assert_eq!(Symmetry::AntiTransposed.undone(&['d', 'b', 'c', 'a'], 2), upright);
    }

    #[test]
    fn mirroring_twice_is_nothing_and_once_is_in_u() {
        let map: Vec<usize> = (0..9).collect();
        for symmetry in Symmetry::ALL {
            assert_eq!(symmetry.mirrored().mirrored(), symmetry);
            let rows = symmetry.undone(&map, 3);
            let mirrored: Vec<usize> =
                rows.chunks(3).flat_map(|row| row.iter().rev().copied()).collect();
            assert_eq!(symmetry.mirrored().undone(&map, 3), mirrored, "{symmetry:?}");
        }
    }
}
