//! The method with every choice open.

use super::baseline::LaidOut;
use super::options::MethodOptions;
use crate::error::Error;
use crate::map::SeamlessMap;
use crate::surface::Surface;
use seamstress_parametrize::{Start, make_map_from};

impl Surface {
    /// Makes a map with every choice of the method open.
    ///
    /// # Errors
    /// Those of [`Surface::parametrize`]; [`ErrorKind::BadStart`](crate::ErrorKind::BadStart) where a file to start
    /// from does not fit, and [`ErrorKind::Uncertified`](crate::ErrorKind::Uncertified) where the layout of a field has
    /// flips that are not allowed.
    pub fn parametrize_with(&self, options: &MethodOptions) -> Result<LaidOut, Error> {
        options.validate().map_err(|error| error.of(self.input()))?;
        let made = self.context().run(self.expected_for_map(), |watcher| {
            if options.start.is_baseline() {
                options.map.symmetry.refuse()?;
                return self.lay_out_field(options, watcher);
            }
            let settings = options.to_method();
            let start = options.start.read(self)?;
            let asked = self.features(&options.map.features)?;
            let sized = self.prepared_for_textures(&asked, &options.map)?;
            if matches!(start, Start::Mesh) {
                let made = sized.direct_map(asked, &options.map, settings, watcher)?;
                let made = made.packed(&options.map)?;
                return Ok(LaidOut::Certified(Box::new(made)));
            }
            options.map.symmetry.refuse()?;
            let mut observe = |progress| watcher.observe(progress);
            let made =
                make_map_from(sized.mesh(), sized.geometry(), &start, &settings, &mut observe);
            let solution = made.map_err(|cause| self.no_map(cause))?;
            let map =
                SeamlessMap::new(&sized, solution.map, None, &options.map, solution.components);
            Ok(LaidOut::Certified(Box::new(map.packed(&options.map)?)))
        });
        made.map_err(|error| error.of(self.input()))
    }
}
