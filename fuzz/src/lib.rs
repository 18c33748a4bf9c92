//! Meshes and numbers from the bytes of a fuzzer.

use seamstress_mesh::soup::TriangleSoup;
use seamstress_testkit as testkit;

/// Bytes that are read once, and zeros behind them.
pub struct Bytes<'a>(pub &'a [u8]);

impl Bytes<'_> {
    /// The next byte.
    pub fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first
    }

    /// A number below another one.
    pub fn below(&mut self, n: usize) -> usize {
        (usize::from(self.byte()) << 8 | usize::from(self.byte())) % n.max(1)
    }

    /// The next eight bytes.
    pub fn word(&mut self) -> u64 {
        (0..8).fold(0, |word, _| word << 8 | u64::from(self.byte()))
    }

    /// A coordinate: mostly of a small lattice, where things coincide, and now and then any double at all.
    pub fn coordinate(&mut self) -> f64 {
        match self.byte() {
            kind @ 0..=3 => {
                let bits = self.word();
                if kind == 0 { f64::from_bits(bits) } else { f64::from_bits(bits & !(1 << 62)) }
            }
            byte @ 4..=31 => f64::from(byte).exp2() * 1e-3,
            byte => f64::from(byte % 15) - 7.0 + f64::from(self.byte() % 4) / 4.0,
        }
    }

    /// Polygons with corners among vertices, and a few that are not.
    pub fn polygons(&mut self, n_vertices: usize) -> Vec<Vec<u32>> {
        let corner = |bytes: &mut Self| {
            let missing = usize::from(bytes.byte() == 7);
            bytes.below(n_vertices + missing) as u32
        };
        let n = self.below(24);
        let mut polygon = |_| {
            let corners = 1 + self.below(6);
            (0..corners).map(|_| corner(self)).collect()
        };
        (0..n).map(&mut polygon).collect()
    }

    /// A surface of any genus, with boundaries, needles, copies of vertices, tiny or huge; sometimes spoiled.
    pub fn surface(&mut self) -> TriangleSoup {
        let seed = u64::from(self.byte());
        let mut soup = match self.byte() % 8 {
            0 => testkit::small_sphere(seed),
            1 => testkit::torus(3 + self.below(8) as u32, 3 + self.below(8) as u32, 2.0, 0.7),
            2 => testkit::slab_with_holes(1 + self.below(3) as u32),
            3 => testkit::random_voxels(1 + self.below(8), seed),
            4 => testkit::disk_grid(1 + self.below(6) as u32, 1 + self.below(6) as u32),
            5 => testkit::fan(3 + self.below(20) as u32, 0.3, true),
            6 => testkit::disjoint_union(&[testkit::cube(), testkit::annulus(5, 2)]),
            _ => testkit::crown(3 + self.below(6) as u32),
        };
        for _ in 0..self.byte() % 5 {
            let seed = u64::from(self.byte());
            soup = match self.byte() % 7 {
                0 => testkit::bumpy(&soup, 0.3, seed),
                1 => testkit::stretch(&soup, [1.0, 1.0, 10f64.powi(-(seed as i32 % 12))]),
                2 => testkit::random_flips(&soup, self.below(40), seed),
                3 if soup.faces.len() < 400 => testkit::subdivide(&soup),
                4 => testkit::with_copied_vertices(&soup, self.below(4), seed),
                5 => testkit::relabel(&soup, seed),
                _ => testkit::scale(&soup, 10f64.powi(self.below(400) as i32 - 200)),
            };
        }
        // Spoiled in a few places.
        for _ in 0..self.byte().saturating_sub(250) {
            let (vertex, face) = (self.below(soup.positions.len()), self.below(soup.faces.len()));
            match self.byte() % 3 {
                0 => {
                    let axis = self.below(3);
                    soup.positions[vertex][axis] = self.coordinate();
                }
                1 => soup.faces[face][self.below(3)] = vertex as u32,
                _ => soup.faces.extend_from_within(face..face + 1),
            }
        }
        soup
    }
}
