use super::*;
use crate::{
    CertifyOptions, ErrorKind, Features, GridSize, Inspection, MapOptions, QuadOptions,
    SurfaceOptions,
};
use flate2::read::ZlibDecoder;
use seamstress_testkit as kit;
use std::io::Read;

fn unpacked(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    ZlibDecoder::new(&STANDARD.decode(text).unwrap()[..]).read_to_end(&mut bytes).unwrap();
    bytes
}

/// What pages say, and the headers of their drawings.
fn read(html: &str) -> Vec<[Value; 2]> {
    let page = |[facts, scene]: [&str; 2]| {
        let (facts, scene) = (unpacked(facts), unpacked(scene));
        let length = u32::from_le_bytes(scene[..4].try_into().unwrap()) as usize;
        [&facts[..], &scene[4..4 + length]].map(|json| serde_json::from_slice(json).unwrap())
    };
    embedded(html).into_iter().map(page).collect()
}

fn surface(soup: &seamstress_mesh::soup::TriangleSoup) -> Surface {
    Surface::from_triangles(&soup.positions, &soup.faces).unwrap()
}

fn claims(facts: &Value) -> Vec<bool> {
    facts["facts"]["claims"].as_array().unwrap().iter().map(|c| c["passed"] == true).collect()
}

#[test]
fn a_map_has_its_certificate_its_cones_and_its_largest_tau() {
    let surface = surface(&kit::icosphere(3));
    let map = surface.parametrize(&MapOptions::default()).unwrap();
    let html = map.page().html();
    let [facts, scene] = &read(&html)[0];
    assert_eq!(claims(facts), [true; 3]);
    let tau = map.report().distortion.tau;
    let largest = scene["values"][1].as_f64().unwrap();
    assert!((largest - tau).abs() < 1e-12 * tau, "{largest} {tau}");
    assert_eq!(facts["facts"]["cones"].as_array().unwrap().len(), map.cones().len());
    assert_eq!(facts["report"]["distortion"]["tau"], tau);
    // Nothing is loaded, and the file is small.
    assert!(!html.contains("src=") && !html.contains("href=\"http"));
    let limit = 60_000 + 15 * surface.faces().len();
    assert!(html.len() < limit, "{} of {limit}", html.len());
}

#[test]
fn quads_come_with_the_features_that_they_follow() {
    let surface = surface(&kit::subdivide(&kit::subdivide(&kit::cube())));
    let mut options = QuadOptions::default().features(Features::auto());
    options.size = GridSize::Quads(100.0);
    let quads = surface.quad_mesh(&options).unwrap();
    let [facts, scene] = &read(&quads.page().html())[0];
    assert!(claims(facts).iter().all(|&passed| passed), "{facts}");
    assert_eq!(
        (&scene["sides"], facts["facts"]["cones"].as_array().unwrap().len()),
        (&4.into(), 8)
    );
    // The 12 edges of the cube, of 4 edges each; vertices of the surface come after those of the quads.
    let kept = quads.kept_features();
    assert_eq!(kept.len(), 48);
    let drawn = scene["vertices"].as_u64().unwrap() as usize;
    assert_eq!(drawn, quads.positions().len() + 8 + 12 * 3);
}

#[test]
fn faults_are_found_in_the_drawing() {
    // Three faces at one edge, and a vertex of no face.
    let positions =
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [9.0; 3]];
    let faces = [[0u32, 1, 2], [1, 0, 3], [0, 1, 4]];
    let inspection = Inspection::of_polygons(&positions, faces, &SurfaceOptions::default());
    let [facts, scene] = &read(&Page::of_mesh(&inspection, None).html())[0];
    assert_eq!(claims(facts), [false]);
    let notes = facts["facts"]["notes"].as_array().unwrap();
    let fault = notes.iter().find(|note| note["severity"] == "error").unwrap();
    assert_eq!(fault["vertices"], serde_json::json!([0, 1]));
    let unused = notes.iter().find(|note| note["severity"] == "warning").unwrap();
    assert_eq!(unused["vertices"], serde_json::json!([5]));
    assert_eq!((&scene["vertices"], &scene["uvs"]), (&6.into(), &Value::Null));
}

#[test]
fn a_map_with_flips_fails_and_says_where() {
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let surface = Surface::from_triangles(&positions, &[[0, 1, 2], [2, 1, 3]]).unwrap();
    let uvs = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.2, 0.2]];
    let face_uvs = [[0, 1, 2], [2, 1, 3]];
    let verdict = surface.certify_with(&uvs, &face_uvs, &CertifyOptions::default()).unwrap();
    let page = Page::of_map(&surface, (&uvs, &face_uvs), (&[], Some(&verdict)), None);
    let [facts, scene] = &read(&page.html())[0];
    assert_eq!(claims(facts), [false]);
    assert_eq!(facts["facts"]["notes"][0]["faces"], serde_json::json!([1]));
    // The flipped triangle has no finite tau.
    assert!(scene["values"][1].as_f64().unwrap() < 2.0);
}

#[test]
fn names_cannot_break_out_of_a_page() {
    let html = html("<script>alert(1)</script>&", &[]);
    assert!(html.contains("<title>&lt;script>alert(1)&lt;/script>&amp;</title>"));
    let forged = format!("{}<b>{CLOSING}{}QQ=={CLOSING}", opening(FACTS), opening(SCENE));
    assert!(embedded(&forged).is_empty());
}

#[test]
fn pages_side_by_side_are_the_pages() {
    let page = surface(&kit::tetrahedron()).parametrize(&MapOptions::default()).unwrap().page();
    let [facts, scene] = [page.facts().as_bytes(), page.scene()].map(packed);
    let both = html("Comparison", &[[&facts, &scene], [&facts, &scene]]);
    assert_eq!(embedded(&both), [[facts.as_str(), scene.as_str()]; 2]);
}

#[cfg(feature = "io")]
#[test]
fn a_preview_is_made_of_a_coarser_mesh_with_the_edges_that_were_picked() {
    let soup = kit::bumpy(&kit::icosphere(4), 0.1, 1);
    let mut file = String::new();
    soup.positions.iter().for_each(|[x, y, z]| file += &format!("v {x} {y} {z}\n"));
    soup.faces.iter().for_each(|face| {
        let [a, b, c] = face.map(|v| v + 1);
        file += &format!("f {a} {b} {c}\n");
    });
    let [a, b, c] = soup.faces[100];
    let task = format!(
        r#"{{"coarse": 600, "make": {{"map": {{"features": ["edges:{a}-{b},{b}-{c}"]}}}}}}"#
    );
    let done = Task::parse(&task)
        .unwrap()
        .run(file.as_bytes(), "ball.obj", crate::Context::new())
        .unwrap();
    let [facts, scene] = &read(&done.page().html())[0];
    assert!(claims(facts).iter().all(|&passed| passed), "{facts}");
    assert_eq!(
        scene["arrays"][1],
        serde_json::json!({"name": "faces", "length": 600, "planes": 2})
    );
    assert_eq!(facts["report"]["features"]["edges"], 2);
    assert!(done.file("ball.stl").is_err() && !done.file("ball.obj").unwrap().is_empty());
    let report: Value = serde_json::from_slice(&done.file("report.json").unwrap()).unwrap();
    assert_eq!(report, facts["report"]);
}

#[cfg(feature = "io")]
#[test]
fn no_task_names_a_file() {
    let named =
        |task: &str| Task::parse(task).is_err_and(|error| error.kind() == ErrorKind::Options);
    for option in ["features\": [\"pairs:x", "directions\": [\"strokes:x", "sizes\": [\"csv:x"] {
        let map = format!("{{\"{option}\"]}}");
        for make in [
            format!("{{\"map\": {map}}}"),
            format!("{{\"integer\": {{\"map\": {map}}}}}"),
            format!("{{\"quads\": {{\"map\": {map}}}}}"),
        ] {
            assert!(named(&format!("{{\"make\": {make}}}")), "{make}");
        }
    }
    assert!(named(r#"{"make": {"check": ["pairs:x"]}}"#));
    assert!(Task::parse(r#"{"make": {"map": {"sizes": ["boundary:0.5"]}}}"#).is_ok());
}
