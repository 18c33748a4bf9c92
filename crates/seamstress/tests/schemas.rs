//! The published schemas are those of this version, and real reports and options follow them.
#![cfg(feature = "schema")]
#![allow(clippy::unwrap_used, reason = "a test, with helpers")]

use seamstress::command_reports::{
    CheckReport, CheckedMapReport, ExtractReport, FoundFeaturesReport, MeasureReport,
};
use seamstress::{
    CertifyOptions, ExtractionOptions, FeatureSource, Features, Inspection, IntegerMapOptions,
    MapOptions, OptimizeOptions, PolygonMesh, QuadOptions, Surface, SurfaceOptions,
};
use seamstress_testkit as testkit;
use serde::Serialize;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn published(name: &str) -> Value {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/schema");
    let text = fs::read_to_string(folder.join(format!("{name}.json"))).unwrap();
    serde_json::from_str(&text).unwrap()
}

#[track_caller]
fn assert_follows(name: &str, value: &impl Serialize) {
    let schema = jsonschema::validator_for(&published(name)).unwrap();
    let value = serde_json::to_value(value).unwrap();
    let faults: Vec<String> =
        schema.iter_errors(&value).map(|e| format!("{}: {e}", e.instance_path())).collect();
    assert!(faults.is_empty(), "{name}: {faults:#?}");
}

#[test]
fn published_schemas_are_current() {
    for (name, schema) in seamstress::schemas() {
        assert_eq!(
            serde_json::to_value(&schema).unwrap(),
            published(name),
            "{name}: write them again with `cargo run -p seamstress --features schema --example schemas docs/schema`"
        );
    }
}

#[test]
fn reports_follow_their_schemas() {
    let soup = testkit::l_bracket();
    let surface = Surface::from_triangles(&soup.positions, &soup.faces).unwrap();
    assert_follows("surface", surface.report());
    let features = Features::angle(40.0);
    assert_follows("features", surface.features(&features).unwrap().report());

    let map = surface.parametrize(&MapOptions::default().features(features.clone())).unwrap();
    assert_follows("map", map.report());
    let integer = surface.integer_map(&IntegerMapOptions::count(200)).unwrap();
    assert_follows("integer", integer.report());
    let quads = surface.quad_mesh(&QuadOptions::count(200).features(features.clone())).unwrap();
    assert_follows("quad", quads.report());

    let (uvs, face_uvs) = (map.uvs(), map.face_uvs());
    let optimized = surface.optimize(uvs, face_uvs, &OptimizeOptions::default()).unwrap();
    assert_follows("optimize", optimized.report());
    let certify = CertifyOptions::default().features(features);
    assert_follows("verdict", &surface.certify_with(uvs, face_uvs, &certify).unwrap());
    assert_follows("measurements", &surface.measure(uvs, face_uvs, &certify).unwrap());
    assert_follows("field", map.field().unwrap().report());
    let polygons = PolygonMesh::new(quads.positions(), quads.quads()).unwrap();
    assert_follows("quality", &polygons.quality(None).unwrap());
}

#[test]
fn a_verdict_on_a_broken_map_follows_its_schema() {
    let soup = testkit::torus(8, 6, 2.0, 0.7);
    let surface = Surface::from_triangles(&soup.positions, &soup.faces).unwrap();
    let map = surface.parametrize(&MapOptions::default()).unwrap();
    let mut face_uvs = map.face_uvs().to_vec();
    face_uvs[3].swap(0, 1);
    let certify = CertifyOptions::default();
    let verdict = surface.certify_with(map.uvs(), &face_uvs, &certify).unwrap();
    assert!(!verdict.certified);
    assert_follows("verdict", &verdict);
    // Infinite measures are spelled out.
    assert_follows("measurements", &surface.measure(map.uvs(), &face_uvs, &certify).unwrap());
}

#[test]
fn options_follow_their_schemas_and_others_do_not() {
    let options = MapOptions::default().features(Features::angle(40.0).with_boundary());
    assert_follows("map-options", &options);
    assert_follows("quad-options", &QuadOptions::count(1500));
    assert_follows("integer-options", &IntegerMapOptions::edge_length(0.1));
    let schema = jsonschema::validator_for(&published("map-options")).unwrap();
    for wrong in [r#"{"cone_bais": 1}"#, r#"{"cone_bias": "much"}"#, "[]"] {
        assert!(!schema.is_valid(&serde_json::from_str(wrong).unwrap()), "{wrong}");
    }
}

#[test]
fn reports_of_commands_follow_their_schemas() {
    let soup = testkit::l_bracket();
    let inspection =
        Inspection::of_polygons(&soup.positions, &soup.faces, &SurfaceOptions::default());
    let surface = inspection.clone().surface().unwrap();
    let curves = surface.features(&Features::angle(40.0)).unwrap();
    let map = surface.parametrize(&MapOptions::default()).unwrap();
    let certify = CertifyOptions::default().features(Features::angle(40.0)).integer();
    let options = (SurfaceOptions::default(), certify.clone());
    assert_follows("check-report", &CheckReport::new(&inspection, None, None, options.clone()));
    // As it is, and with a triangle turned over.
    for is_broken in [false, true] {
        let mut face_uvs = map.face_uvs().to_vec();
        if is_broken {
            face_uvs[3].swap(0, 1);
        }
        let verdict = surface.certify_with(map.uvs(), &face_uvs, &certify).unwrap();
        let checked = CheckedMapReport::new("map.obj".into(), &[], Some(&verdict));
        let features = Some(curves.report());
        let report = CheckReport::new(&inspection, features, Some(checked), options.clone());
        assert_follows("check-report", &report);
    }
    assert_follows("features-report", &FoundFeaturesReport::new(surface.report(), curves.report()));
    let measured = surface.measure(map.uvs(), map.face_uvs(), &certify).unwrap();
    let options = (SurfaceOptions::default(), &certify);
    let report = MeasureReport::new(surface.report(), "map.obj".into(), &measured, options);
    assert_follows("measure-report", &report);

    let integer = surface.integer_map(&IntegerMapOptions::count(200)).unwrap();
    let (features, options) = (Features::none(), ExtractionOptions::default());
    let quads =
        surface.extract_quads(integer.uvs(), integer.face_uvs(), &features, &options).unwrap();
    let sources = [FeatureSource::Angle(40.0)];
    assert_follows("extract-report", &ExtractReport::new(quads.report(), options, &sources));
}
