//! `--report FILE.html` and `seamstress report`.

use crate::harness::Folder;
use seamstress_testkit as kit;

/// Results in a page.
fn results(page: &str) -> usize {
    page.matches("class=\"facts\">").count()
}

#[test]
fn a_report_is_a_page_or_json_by_its_name() {
    let folder = Folder::new();
    folder.write_obj("torus.obj", &kit::torus(16, 10, 2.0, 0.8));
    let reports = ["--report", "a.html", "--report", "a.json"];
    folder.expect(0, &[&["map", "torus.obj", "-o", "m.obj"][..], &reports].concat());
    let page = folder.read("a.html");
    assert!(page.starts_with("<!doctype html>") && results(&page) == 1);
    assert!(page.contains("<title>torus.obj: seamless map</title>"));
    let json: serde_json::Value = serde_json::from_str(&folder.read("a.json")).unwrap();
    assert_eq!(json["files"][0]["kind"], "page");
    assert_eq!(json["files"][1]["kind"], "report");
}

#[test]
fn every_kind_of_result_has_a_page() {
    let folder = Folder::new();
    folder.write_obj("cube.obj", &kit::subdivide(&kit::subdivide(&kit::cube())));
    let size = ["--quads", "60"];
    folder.expect(
        0,
        &[&["quad", "cube.obj", "-o", "q.obj", "--report", "q.html"][..], &size].concat(),
    );
    folder.expect(
        0,
        &[&["integer", "cube.obj", "-o", "i.obj", "--report", "i.html"][..], &size].concat(),
    );
    folder.expect(0, &["extract", "i.obj", "-o", "e.obj", "--report", "e.html"]);
    folder.expect(0, &["check", "cube.obj", "--report", "c.html"]);
    folder.expect(0, &["check", "cube.obj", "i.obj", "--integer", "--report", "k.html"]);
    for (name, title) in [
        ("q.html", "cube.obj: quad mesh"),
        ("i.html", "cube.obj: integer-grid map"),
        ("e.html", "i.obj: quad mesh"),
        ("c.html", "cube.obj: mesh"),
        ("k.html", "cube.obj: checked map"),
    ] {
        assert!(folder.read(name).contains(&format!("<title>{title}</title>")), "{name}");
    }
    let all = ["q.html", "i.html", "e.html", "c.html", "k.html"];
    folder.expect(0, &[&["report", "-o", "all.html"][..], &all].concat());
    assert_eq!(results(&folder.read("all.html")), 5);
    // A page of several is one as well.
    folder.expect(0, &["report", "all.html", "q.html", "-o", "more.html"]);
    assert_eq!(results(&folder.read("more.html")), 6);
}

#[test]
fn a_broken_mesh_has_a_page_and_fails_all_the_same() {
    let folder = Folder::new();
    folder.write(
        "fan.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n",
    );
    folder.expect(1, &["check", "fan.obj", "--report", "fan.html"]);
    assert_eq!(results(&folder.read("fan.html")), 1);
}

#[test]
fn what_is_no_page_is_refused() {
    let folder = Folder::new();
    folder.write("a.html", "<!doctype html><p>A page of another program.");
    let run = folder.expect(1, &["report", "a.html", "-o", "b.html"]);
    assert!(
        run.stderr.contains("a.html: not a report page; `--report FILE.html` writes one"),
        "{run:?}"
    );
    let run = folder.expect(1, &["report", "missing.html", "-o", "b.html"]);
    assert!(run.stderr.contains("missing.html: "), "{run:?}");
    assert_eq!(folder.names(), ["a.html"]);
}
