//! What every command writes the same way.

use crate::input::LoadedMesh;
use crate::report::{self, VERSION};
use crate::text::{counted, figure};
use seamstress_io::{MapObj, write_map_obj, write_singularities};
use seamstress_parametrize::SeamlessMap;
use seamstress_parametrize::map::Cone;
use seamstress_parametrize::quality::Distortion;
use std::io::Write;

/// A map, certified or not, as it is written.
pub(crate) struct Written<'a> {
    pub(crate) title: &'static str,
    pub(crate) corner_uvs: &'a [[f64; 2]],
    pub(crate) cones: &'a [Cone],
    pub(crate) distortion: &'a Distortion,
}

impl<'a> Written<'a> {
    pub(crate) fn certified(map: &'a SeamlessMap, distortion: &'a Distortion) -> Self {
        let (corner_uvs, cones) = (map.corner_uvs(), map.cones());
        Self { title: "Seamless map", corner_uvs, cones, distortion }
    }
}

/// A map with its source and figures in comments.
pub(crate) fn write_map(
    file: &mut impl Write,
    mesh: &LoadedMesh,
    map: &Written<'_>,
) -> std::io::Result<()> {
    let name = mesh.path.file_name().unwrap_or(mesh.path.as_os_str());
    let repaired = match mesh.repairs.len() {
        0 => String::new(),
        n => format!(", after {}", counted(n, "repair")),
    };
    let comments = [
        format!("{} by Seamstress {VERSION}", map.title),
        format!("Source: {}{repaired}", name.display()),
        format!(
            "tau {}, symmetric Dirichlet energy {}, {}",
            figure(report::tau(map.distortion)),
            figure(map.distortion.symmetric_dirichlet),
            counted(map.cones.len(), "cone"),
        ),
    ];
    let obj = MapObj {
        positions: &mesh.soup.positions,
        faces: &mesh.soup.faces,
        corner_uvs: map.corner_uvs,
        comments: &comments,
    };
    write_map_obj(file, &obj)
}

/// Cones, with indices in quarters.
pub(crate) fn write_cones(file: &mut impl Write, cones: &[Cone]) -> std::io::Result<()> {
    let rows: Vec<(u32, i32)> = cones.iter().map(|c| (c.vertex, c.index)).collect();
    write_singularities(file, &rows)
}
