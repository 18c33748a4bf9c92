//! Colours that stay apart for colour-blind readers and in print.

/// The colours of a picture, sRGB in `0..=1`.
///
/// Cones, features and flips come from the palette of Okabe and Ito (2008), which people with any
/// common colour blindness can tell apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Palette {
    /// Behind everything.
    pub background: [f64; 3],
    /// Cones of positive index: angle less than a full turn.
    pub positive_cone: [f64; 3],
    /// Cones of negative index: angle more than a full turn.
    pub negative_cone: [f64; 3],
    /// Seams, and the boundary of a layout.
    pub seam: [f64; 3],
    /// Feature lines.
    pub feature: [f64; 3],
    /// Feature lines that could not be kept.
    pub released: [f64; 3],
    /// Where feature lines meet or turn.
    pub corner: [f64; 3],
    /// Where feature lines end inside the surface.
    pub open_end: [f64; 3],
    /// Edges of triangles in a layout.
    pub edge: [f64; 3],
    /// Triangles whose UVs are flipped.
    pub flipped: [f64; 3],
}

impl Default for Palette {
    fn default() -> Self {
        Self {
            background: hex(0xffffff),
            positive_cone: hex(0xd55e00),
            negative_cone: hex(0x0072b2),
            seam: hex(0x2b2b33),
            feature: hex(0x008f68),
            released: hex(0xcc79a7),
            corner: hex(0x00543d),
            open_end: hex(0xe69f00),
            edge: hex(0x6b717d),
            flipped: hex(0xd0212b),
        }
    }
}

/// A colour written as `0xrrggbb`.
pub(crate) const fn hex(rgb: u32) -> [f64; 3] {
    [
        ((rgb >> 16) & 255) as f64 / 255.0,
        ((rgb >> 8) & 255) as f64 / 255.0,
        (rgb & 255) as f64 / 255.0,
    ]
}

impl Palette {
    /// The colours with the names of their fields.
    pub(crate) fn entries(&self) -> [(&'static str, [f64; 3]); 10] {
        [
            ("background", self.background),
            ("positive_cone", self.positive_cone),
            ("negative_cone", self.negative_cone),
            ("seam", self.seam),
            ("feature", self.feature),
            ("released", self.released),
            ("corner", self.corner),
            ("open_end", self.open_end),
            ("edge", self.edge),
            ("flipped", self.flipped),
        ]
    }

    /// The colour of a cone of the given index in quarters, darker the further the index is from
    /// a regular vertex.
    pub(crate) fn cone(&self, index: i32) -> [f64; 3] {
        let base = match index {
            0 => hex(0x8c8c8c),
            i if i > 0 => self.positive_cone,
            _ => self.negative_cone,
        };
        let shade = match index.unsigned_abs() {
            0 | 1 => 1.0,
            2 => 0.74,
            _ => 0.55,
        };
        base.map(|c| c * shade)
    }
}
