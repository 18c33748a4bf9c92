//! What whole pictures must show.

use seamstress_parallel::with_threads;
use seamstress_render::{
    Image, LayoutOptions, Paint, Palette, Projection, RenderError, Scene, SurfaceOptions, View,
    render_layout, render_surface,
};

const SQUARE: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
const SQUARE_FACES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
const SQUARE_UVS: [[f64; 2]; 6] =
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
const WHITE: [u8; 3] = [255; 3];

fn square() -> Scene<'static> {
    Scene {
        positions: &SQUARE,
        faces: &SQUARE_FACES,
        corner_uvs: Some(&SQUARE_UVS),
        ..Scene::default()
    }
}

/// The unit cube, faces outwards.
fn cube() -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let positions = (0..8_u8).map(|v| [0, 1, 2].map(|k| f64::from((v >> k) & 1))).collect();
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    (positions, faces)
}

/// A small picture straight along `z`, without perspective.
fn flat_options(paint: Paint) -> SurfaceOptions {
    SurfaceOptions {
        size: [100, 100],
        view: View::Direction([0.0, 0.0, 1.0]),
        projection: Projection::Orthographic,
        margin: 0.0,
        occlusion: 0.0,
        paint,
        ..SurfaceOptions::default()
    }
}

fn red_green_checker(period: f64) -> Paint {
    Paint::Checker {
        period: Some(period),
        checks: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        line: [0.0, 0.0, 1.0],
        line_width: 0.1,
    }
}

/// Which of the channels are bright, written like `r--`.
fn channels(image: &Image, x: u32, y: u32) -> String {
    let bright = image.pixel(x, y).map(|c| c > 100);
    let letters = ['r', 'g', 'b'].into_iter().zip(bright);
    letters.map(|(letter, on)| if on { letter } else { '-' }).collect()
}

#[test]
fn a_checkered_square_shows_its_checks_where_they_are() {
    let image = render_surface(&square(), &flat_options(red_green_checker(0.5))).unwrap();
    assert_eq!(channels(&image, 25, 75), "r--");
    assert_eq!(channels(&image, 75, 25), "r--");
    assert_eq!(channels(&image, 25, 25), "-g-");
    assert_eq!(channels(&image, 75, 75), "-g-");
    assert_eq!(channels(&image, 50, 30), "--b");
    assert_eq!(channels(&image, 30, 50), "--b");
    assert_eq!(image.pixel(25, 75)[1..], [0, 0]);
}

#[test]
fn checks_too_fine_to_see_fade_to_their_mean() {
    let image = render_surface(&square(), &flat_options(red_green_checker(1e-4))).unwrap();
    let first = image.pixel(50, 50);
    assert!(first[0].abs_diff(first[1]) <= 1, "{first:?}");
    for (x, y) in [(10, 10), (33, 71), (90, 5), (64, 64)] {
        let pixel = image.pixel(x, y);
        assert!((0..3).all(|c| pixel[c].abs_diff(first[c]) <= 2), "{pixel:?}");
    }
}

#[test]
fn the_back_of_a_sheet_is_lit_and_mirrored() {
    let options = SurfaceOptions {
        view: View::Direction([0.0, 0.0, -1.0]),
        ..flat_options(red_green_checker(0.5))
    };
    let image = render_surface(&square(), &options).unwrap();
    assert_eq!(channels(&image, 75, 75), "r--");
    assert_eq!(channels(&image, 25, 75), "-g-");
}

#[test]
fn a_nearer_triangle_hides_a_farther_one() {
    let mut positions = SQUARE.to_vec();
    positions.extend(SQUARE.map(|[x, y, _]| [x, y, 0.5]));
    let far = [[0, 1, 2], [0, 2, 3]];
    let near = far.map(|f: [u32; 3]| f.map(|v| v + 4));
    let (red, green) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let stacks = [
        ([far, near].concat(), vec![red, red, green, green]),
        ([near, far].concat(), vec![green, green, red, red]),
    ];
    for (faces, colors) in stacks {
        let scene = Scene { positions: &positions, faces: &faces, ..Scene::default() };
        for projection in [Projection::Orthographic, Projection::default()] {
            let options =
                SurfaceOptions { projection, ..flat_options(Paint::PerFace(colors.clone())) };
            let image = render_surface(&scene, &options).unwrap();
            assert_eq!(channels(&image, 50, 30), "-g-");
            assert_eq!(channels(&image, 50, 70), "-g-");
        }
    }
}

#[test]
fn visible_cones_have_the_colour_of_their_sign_and_hidden_ones_do_not_show() {
    let (positions, faces) = cube();
    let options = SurfaceOptions {
        size: [200, 200],
        view: View::Direction([0.4, 0.5, 1.0]),
        paint: Paint::Plain([0.9; 3]),
        cone_radius: 0.04,
        ..SurfaceOptions::default()
    };
    let picture = |cones: &[(u32, i32)]| {
        let scene = Scene { positions: &positions, faces: &faces, cones, ..Scene::default() };
        render_surface(&scene, &options).unwrap()
    };
    let count = |image: &Image, wanted: fn([u8; 3]) -> bool| {
        image.rgb8().chunks(3).filter(|p| wanted([p[0], p[1], p[2]])).count()
    };
    let reddish = |[r, _, b]: [u8; 3]| i32::from(r) - i32::from(b) > 60;
    let bluish = |[r, _, b]: [u8; 3]| i32::from(b) - i32::from(r) > 60;

    let bare = picture(&[]);
    assert_eq!((count(&bare, reddish), count(&bare, bluish)), (0, 0));
    // Vertex 7 is the corner nearest to the viewer, vertex 0 the one behind the cube.
    assert_eq!(picture(&[(0, 1)]), bare);
    let positive = picture(&[(7, 1)]);
    assert!(count(&positive, reddish) > 60 && count(&positive, bluish) == 0);
    let negative = picture(&[(7, -1)]);
    assert!(count(&negative, bluish) > 60 && count(&negative, reddish) == 0);

    let brightness = |image: &Image| image.rgb8().iter().map(|&b| u64::from(b)).sum::<u64>();
    assert!(brightness(&picture(&[(7, 2)])) < brightness(&positive));
    assert!(brightness(&picture(&[(7, -2)])) < brightness(&negative));
}

#[test]
fn seams_show_in_front_only_and_over_features() {
    let (positions, faces) = cube();
    let options = SurfaceOptions {
        line_width: 0.02,
        palette: Palette { seam: [0.0, 0.0, 1.0], feature: [1.0, 0.0, 0.0], ..Palette::default() },
        ..flat_options(Paint::Plain([0.9; 3]))
    };
    let picture = |seams: &[[u32; 2]], features: &[[u32; 2]]| {
        let scene =
            Scene { positions: &positions, faces: &faces, seams, features, ..Scene::default() };
        render_surface(&scene, &options).unwrap()
    };
    // Diagonals of the back (0 to 3) and of the front (4 to 7).
    assert_eq!(picture(&[[0, 3]], &[]), picture(&[], &[]));
    assert_eq!(picture(&[[4, 7]], &[]).pixel(30, 69), [0, 0, 255]);
    assert_eq!(picture(&[], &[[4, 7]]).pixel(30, 69), [255, 0, 0]);
    assert_eq!(picture(&[[4, 7]], &[[7, 4]]).pixel(30, 69), [0, 0, 255]);
    assert_ne!(picture(&[[4, 7]], &[]).pixel(30, 60), [0, 0, 255]);
}

#[test]
fn released_features_have_their_own_colour() {
    let (positions, faces) = cube();
    let options = SurfaceOptions {
        line_width: 0.02,
        palette: Palette {
            feature: [1.0, 0.0, 0.0],
            released: [0.0, 1.0, 0.0],
            seam: [0.0, 0.0, 1.0],
            ..Palette::default()
        },
        ..flat_options(Paint::Plain([0.9; 3]))
    };
    let front = [[4, 7]];
    let scene = Scene { positions: &positions, faces: &faces, ..Scene::default() };
    let picture = |scene: Scene| render_surface(&scene, &options).unwrap();
    let kept = picture(Scene { features: &front, ..scene });
    let released = picture(Scene { released: &front, ..scene });
    assert_eq!((kept.pixel(30, 69), released.pixel(30, 69)), ([255, 0, 0], [0, 255, 0]));
    // A seam leaves a stripe of the feature on either side.
    let both = picture(Scene { features: &front, seams: &front, ..scene });
    assert_eq!((channels(&both, 30, 69), channels(&both, 30, 67)), ("--b".into(), "r--".into()));
    // A released feature covers the seam.
    let both = picture(Scene { released: &front, seams: &front, ..scene });
    assert_eq!(both.pixel(30, 69), [0, 255, 0]);
    // At the back neither shows.
    let back = [[0, 3]];
    let hidden = picture(Scene { features: &back, released: &back, corners: &[0], ..scene });
    assert_eq!(hidden, picture(scene));
}

#[test]
fn corners_and_open_ends_are_dots_under_cones() {
    let (positions, faces) = cube();
    let options = SurfaceOptions {
        size: [200, 200],
        view: View::Direction([0.4, 0.5, 1.0]),
        cone_radius: 0.06,
        palette: Palette {
            corner: [1.0, 0.0, 0.0],
            open_end: [0.0, 1.0, 0.0],
            positive_cone: [0.0, 0.0, 1.0],
            ..Palette::default()
        },
        paint: Paint::Plain([0.9; 3]),
        ..SurfaceOptions::default()
    };
    let scene = Scene { positions: &positions, faces: &faces, ..Scene::default() };
    // How many pixels each channel rules.
    let ruled = |scene: Scene| {
        let image = render_surface(&scene, &options).unwrap();
        let rules = |p: &[u8], c: usize| (0..3).all(|k| k == c || p[c].saturating_sub(p[k]) > 60);
        [0, 1, 2].map(|c| image.rgb8().chunks(3).filter(|p| rules(p, c)).count())
    };
    assert_eq!(ruled(scene), [0; 3]);
    let [red, green, blue] = ruled(Scene { corners: &[7], ..scene });
    assert!(red > 60 && green == 0 && blue == 0);
    let [red, green, blue] = ruled(Scene { open_ends: &[7], ..scene });
    assert!(red == 0 && green > 60 && blue == 0);
    let [red, _, blue] = ruled(Scene { corners: &[7], cones: &[(7, 1)], ..scene });
    assert!(red == 0 && blue > 100);
}

#[test]
fn features_of_a_layout_run_along_their_sides() {
    let palette = Palette {
        feature: [1.0, 0.0, 0.0],
        released: [0.0, 1.0, 1.0],
        seam: [0.0; 3],
        ..Palette::default()
    };
    let options = LayoutOptions { palette, ..layout_options() };
    let diagonal = [[2, 0]];
    let kept = render_layout(&Scene { features: &diagonal, ..square() }, &options).unwrap();
    assert_eq!((channels(&kept, 50, 49), channels(&kept, 80, 50)), ("r--".into(), "-g-".into()));
    let released = render_layout(&Scene { released: &diagonal, ..square() }, &options).unwrap();
    assert_eq!(channels(&released, 50, 49), "-gb");
    // Beside the rim, which is drawn over it.
    let rim = render_layout(&Scene { features: &[[0, 3]], ..square() }, &options).unwrap();
    assert_eq!((channels(&rim, 0, 50), channels(&rim, 3, 50)), ("---".into(), "r--".into()));
}

#[test]
fn silhouettes_are_smooth() {
    let triangle = Scene {
        positions: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        faces: &[[0, 1, 2]],
        ..Scene::default()
    };
    let image = render_surface(&triangle, &flat_options(Paint::Plain([0.0; 3]))).unwrap();
    assert_eq!(image.pixel(20, 80), [0; 3]);
    assert_eq!(image.pixel(80, 20), WHITE);
    let edge = image.pixel(50, 50)[0];
    assert!((100..230).contains(&edge), "{edge}");
}

fn layout_options() -> LayoutOptions {
    LayoutOptions {
        size: [100, 100],
        margin: 0.0,
        paint: Paint::Plain([0.0, 1.0, 0.0]),
        palette: Palette { flipped: [1.0, 0.0, 0.0], seam: [0.0, 0.0, 1.0], ..Palette::default() },
        line_width: 0.04,
        ..LayoutOptions::default()
    }
}

#[test]
fn flipped_triangles_are_red_and_on_top() {
    let plain = render_layout(&square(), &layout_options()).unwrap();
    assert_eq!(channels(&plain, 70, 70), "-g-");
    assert_eq!(channels(&plain, 30, 30), "-g-");

    // The second triangle folds over onto the first.
    let mut uvs = SQUARE_UVS;
    uvs[5] = [1.0, 0.0];
    let mut faces = SQUARE_FACES;
    for _ in 0..2 {
        let scene = Scene { corner_uvs: Some(&uvs), faces: &faces, ..square() };
        let folded = render_layout(&scene, &layout_options()).unwrap();
        assert_eq!(channels(&folded, 70, 70), "r--");
        assert_eq!(folded.pixel(30, 30), WHITE);
        faces.swap(0, 1);
        uvs.rotate_left(3);
    }
}

#[test]
fn the_thinnest_flip_is_seen() {
    let mut uvs = SQUARE_UVS;
    uvs[5] = [0.5 + 1e-9, 0.5 - 1e-9];
    let scene = Scene { corner_uvs: Some(&uvs), ..square() };
    let options = LayoutOptions { line_width: 0.0, ..layout_options() };
    let image = render_layout(&scene, &options).unwrap();
    let red = image.rgb8().chunks(3).filter(|p| p[0] > 200 && p[1] < 120).count();
    assert!(red > 50, "{red}");
}

#[test]
fn islands_and_their_borders_all_show() {
    let mut uvs = SQUARE_UVS;
    uvs[3..].iter_mut().for_each(|uv| uv[0] += 3.0);
    let scene = Scene { corner_uvs: Some(&uvs), cones: &[(0, 1)], ..square() };
    let options = LayoutOptions { size: [400, 100], cone_radius: 0.08, ..layout_options() };
    let image = render_layout(&scene, &options).unwrap();
    assert_eq!(channels(&image, 70, 70), "-g-");
    assert_eq!(channels(&image, 330, 30), "-g-");
    assert_eq!(image.pixel(200, 50), WHITE);
    // Both sides of the diagonal are seams, for their UVs differ.
    assert_eq!(channels(&image, 50, 50), "--b");
    assert_eq!(channels(&image, 350, 50), "--b");
    // Vertex 0 has a dot in each island.
    assert_eq!(channels(&image, 2, 97), channels(&image, 302, 97));
    assert_eq!(channels(&image, 2, 97), "r--");
    // Without a jump, the diagonal is no seam, unless it is listed.
    let whole = render_layout(&square(), &layout_options()).unwrap();
    assert_eq!(channels(&whole, 50, 49), "-g-");
    let listed = Scene { seams: &[[2, 0]], ..square() };
    let listed = render_layout(&listed, &layout_options()).unwrap();
    assert_eq!(channels(&listed, 50, 49), "--b");
}

#[test]
fn the_number_of_threads_leaves_no_trace() {
    let (positions, faces) = cube();
    let scene = Scene {
        positions: &positions,
        faces: &faces,
        cones: &[(7, 1)],
        seams: &[[4, 7]],
        ..Scene::default()
    };
    let options =
        SurfaceOptions { size: [150, 170], paint: Paint::plain(), ..SurfaceOptions::default() };
    let on = |count: usize| {
        let draw = || {
            let layout = render_layout(&square(), &LayoutOptions::default());
            (render_surface(&scene, &options).unwrap(), layout.unwrap())
        };
        with_threads(count, draw).unwrap()
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(5));
}

#[test]
fn powers_of_two_change_no_pixel_and_extreme_scales_draw() {
    let (positions, faces) = cube();
    let uvs: Vec<[f64; 2]> = faces
        .iter()
        .flatten()
        .map(|&v| [positions[v as usize][0], positions[v as usize][1]])
        .collect();
    let picture = |scale: f64, uv_scale: f64| {
        let positions: Vec<_> = positions.iter().map(|p| p.map(|x| x * scale)).collect();
        let uvs: Vec<_> = uvs.iter().map(|p| p.map(|x| x * uv_scale)).collect();
        let scene = Scene {
            positions: &positions,
            faces: &faces,
            corner_uvs: Some(&uvs),
            ..Scene::default()
        };
        let surface = SurfaceOptions { size: [60, 60], ..SurfaceOptions::default() };
        let layout = LayoutOptions { size: [60, 60], ..LayoutOptions::default() };
        [render_surface(&scene, &surface).unwrap(), render_layout(&scene, &layout).unwrap()]
    };
    let reference = picture(1.0, 1.0);
    for e in [-660, 660] {
        assert_eq!(reference, picture(2.0_f64.powi(e), 2.0_f64.powi(-e)));
    }
    for (scale, uv_scale) in [(1e-200, 1e200), (1e200, 1e-200), (1e200, 1e200)] {
        let [surface, _] = picture(scale, uv_scale);
        assert_ne!(surface.pixel(30, 30), WHITE);
    }
}

#[test]
fn degenerate_triangles_are_skipped() {
    let options = flat_options(Paint::plain());
    let reference = render_surface(&square(), &options).unwrap();
    let faces = [&SQUARE_FACES[..], &[[0, 0, 0], [0, 1, 1], [2, 0, 2]]].concat();
    let scene = Scene { faces: &faces, corner_uvs: None, ..square() };
    assert_eq!(render_surface(&scene, &options).unwrap(), reference);
}

#[test]
fn vertices_off_the_surface_do_not_count() {
    let mut positions = SQUARE.to_vec();
    positions.push([1e150, -1e200, 3.0]);
    let scene = Scene { positions: &positions, cones: &[(4, 1)], seams: &[[0, 4]], ..square() };
    let options = flat_options(Paint::plain());
    let reference = render_surface(&square(), &options).unwrap();
    assert_eq!(render_surface(&scene, &options).unwrap(), reference);
}

#[test]
fn bad_scenes_are_errors() {
    let surface = |scene: &Scene| render_surface(scene, &flat_options(Paint::plain()));
    let layout = |scene: &Scene| render_layout(scene, &layout_options());
    let broken = |change: fn(&mut Scene)| {
        let mut scene = square();
        change(&mut scene);
        (surface(&scene), layout(&scene))
    };

    let (a, b) = broken(|s| s.faces = &[]);
    assert!(matches!(a, Err(RenderError::EmptyScene)));
    assert!(matches!(b, Err(RenderError::EmptyScene)));
    for bad in [f64::NAN, f64::INFINITY] {
        let mut positions = SQUARE;
        positions[2][1] = bad;
        let scene = Scene { positions: &positions, ..square() };
        assert!(matches!(
            surface(&scene),
            Err(RenderError::NotFinite { what: "vertex", index: 2 })
        ));
        let mut uvs = SQUARE_UVS;
        uvs[4][0] = bad;
        let scene = Scene { corner_uvs: Some(&uvs), ..square() };
        assert!(matches!(layout(&scene), Err(RenderError::NotFinite { index: 4, .. })));
    }
    type Change = fn(&mut Scene);
    let changes: [(&str, Change); 7] = [
        ("face", |s| s.faces = &[[0, 1, 4], [0, 1, 2]]),
        ("cone", |s| s.cones = &[(9, 1)]),
        ("seam", |s| s.seams = &[[0, 4]]),
        ("feature", |s| s.features = &[[u32::MAX, 0]]),
        ("released feature", |s| s.released = &[[0, 4]]),
        ("corner", |s| s.corners = &[4]),
        ("open end", |s| s.open_ends = &[7]),
    ];
    for (expected, change) in changes {
        let (a, b) = broken(change);
        for result in [a, b] {
            assert!(
                matches!(&result, Err(RenderError::VertexOutOfRange { what, index: 0, .. }) if *what == expected),
                "{expected}: {result:?}"
            );
        }
    }
    let (a, _) = broken(|s| s.corner_uvs = Some(&[[0.0, 0.0]; 5]));
    assert!(matches!(a, Err(RenderError::WrongCount { expected: 6, found: 5, .. })));
    let (_, b) = broken(|s| s.corner_uvs = None);
    assert!(matches!(b, Err(RenderError::MissingUvs)));
    let (a, _) = broken(|s| s.positions = &[[1.0, 2.0, 3.0]; 4]);
    assert!(matches!(a, Err(RenderError::NoExtent { .. })));
    let (_, b) = broken(|s| s.corner_uvs = Some(&[[0.5, 0.5]; 6]));
    assert!(matches!(b, Err(RenderError::NoExtent { .. })));
}

#[test]
fn bad_options_are_errors() {
    let failure = |change: fn(&mut SurfaceOptions)| {
        let mut options = flat_options(Paint::plain());
        change(&mut options);
        render_surface(&square(), &options).unwrap_err()
    };
    for size in [[0, 5], [5, 0], [8193, 5], [5, u32::MAX]] {
        let options = SurfaceOptions { size, ..SurfaceOptions::default() };
        let error = render_surface(&square(), &options);
        assert!(matches!(error, Err(RenderError::BadSize { .. })));
    }
    type Change = fn(&mut SurfaceOptions);
    let changes: [(&str, Change); 7] = [
        ("supersampling", |o| o.supersampling = 0),
        ("supersampling", |o| o.supersampling = 9),
        ("margin", |o| o.margin = 0.5),
        ("line_width", |o| o.line_width = f64::NAN),
        ("occlusion", |o| o.occlusion = -0.1),
        ("view", |o| o.view = View::Direction([0.0; 3])),
        ("period", |o| o.paint = Paint::checker(Some(0.0))),
    ];
    for (expected, change) in changes {
        let error = failure(change);
        assert!(
            matches!(error, RenderError::BadOption { name, .. } if name == expected),
            "{expected}: {error}"
        );
    }
    let error = failure(|o| o.paint = Paint::PerFace(vec![[0.0; 3]]));
    assert!(matches!(error, RenderError::WrongCount { expected: 2, found: 1, .. }));
    let error = failure(|o| o.palette.seam[1] = f64::NAN);
    assert!(matches!(error, RenderError::NotFinite { what: "seam", .. }));
}

#[test]
fn the_largest_side_is_allowed() {
    let options =
        SurfaceOptions { size: [8192, 1], supersampling: 8, ..flat_options(Paint::plain()) };
    assert_eq!(render_surface(&square(), &options).unwrap().width(), 8192);
}
