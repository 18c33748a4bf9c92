//! Options: what a user has a reason to change. One text each, for documentation, command line and JSON.

mod grid;
mod map;
mod quads;
mod values;

pub use grid::{GridRounding, IntegerMapOptions};
pub use map::MapOptions;
pub use quads::{QuadOptions, ShapeOptions};
#[cfg(feature = "clap")]
pub(crate) use values::parse;
pub(crate) use values::{not_negative, seconds};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feature_sources::Features;
    use seamstress_parametrize::Objective;
    use std::time::Duration;

    #[test]
    fn options_survive_json() {
        let mut options = QuadOptions::count(1500).features(Features::angle(40.0)).smooth(3);
        options.map.polish_time = Some(Duration::from_millis(2500));
        options.map.objective = Some(Objective::SymmetricDirichlet);
        let text = serde_json::to_string(&options).unwrap();
        assert_eq!(serde_json::from_str::<QuadOptions>(&text).unwrap(), options);
        assert_eq!(serde_json::from_str::<QuadOptions>("{}").unwrap(), QuadOptions::default());
    }

    /// Found by the fuzz target `options`: what is too short for a duration came back as none.
    #[test]
    fn times_are_longer_than_none() {
        let read = |text: &str| serde_json::from_str::<MapOptions>(text).map(|o| o.polish_time);
        assert_eq!(read(r#"{"polish_time": 1e-9}"#).unwrap(), Some(Duration::from_nanos(1)));
        for seconds in ["7e-17", "0", "-1"] {
            let error = read(&format!(r#"{{"polish_time": {seconds}}}"#)).unwrap_err();
            assert!(error.to_string().starts_with("expected a number of seconds"), "{error}");
        }
    }

    #[test]
    fn unknown_and_impossible_options_are_named() {
        let unknown = serde_json::from_str::<MapOptions>(r#"{"cone_bais": 1}"#).unwrap_err();
        assert!(unknown.to_string().contains("cone_bais"), "{unknown}");
        let cases: [(MapOptions, &str); 6] = [
            (MapOptions { corner_angle: 0.0, ..Default::default() }, "corner_angle"),
            (MapOptions::default().cone_bias(-1.0), "cone_bias"),
            (MapOptions { align: Some(1.5), ..Default::default() }, "align"),
            (MapOptions::default().cone_price(f64::NAN), "cone_price"),
            (MapOptions::default().features(Features::angle(0.0)), "features"),
            (
                MapOptions { max_energy_rise: f64::INFINITY, ..Default::default() },
                "max_energy_rise",
            ),
        ];
        for (options, name) in cases {
            let error = options.validate().unwrap_err();
            assert_eq!(error.code(), "options");
            assert!(error.to_string().starts_with(name), "{error}");
        }
        let error = QuadOptions::edge_length(0.0).validate().unwrap_err();
        assert!(error.to_string().starts_with("edge_length"), "{error}");
    }
}
