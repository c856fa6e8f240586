//! Entries of `surfaces`, groups, polygons, materials and lights.
use super::super::super::appearance::Metal;
use super::super::super::light::{MapOptions, Shadow};
use super::super::super::shapes;
use super::super::super::transform::Transform;
use super::*;

const CAMERA: &str = "[camera]\neye = [0, -5, 0]\nlook_at = [0, 0, 0]\n";

/// The scene of a text without files, the camera's table behind it.
fn scene(text: &str) -> Scene {
    let source = SourceText::new("s.toml", format!("{text}\n{CAMERA}"));
    load(source, |file| panic!("there is no {}", file.display())).expect("valid")
}

/// Refuses a text, the camera's table behind it.
fn scene_refused(text: &str, place: &str, message: &str) {
    let source = SourceText::new("s.toml", format!("{text}\n{CAMERA}"));
    assert_refused(load(source, |file| panic!("there is no {}", file.display())), place, message);
}

const TORUS: &str = "torus = { major = 2, minor = 0.5 }";

#[test]
fn the_documentation_names_every_field_in_a_scene_that_is_one() {
    let documentation = include_str!("../../../../../fixtures/scenes/README.md");
    let example = documentation.split("```toml").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    let description = parse("s.toml", example).expect("valid");
    assert_eq!((description.materials.len(), description.groups.len(), description.lights.len()), (3, 1, 2));
    for field in [
        "background",
        "surfaces",
        "polygons",
        "image",
        "camera",
        "light",
        "shadow",
        "map_size",
        "map_bias",
        "lights",
        "material",
        "materials",
        "groups",
        "trace",
        "file",
        "torus",
        "sphere",
        "cylinder",
        "group",
        "transform",
        "major",
        "minor",
        "height",
        "around",
        "across",
        "seam",
        "exact",
        "radius",
        "arc",
        "translate",
        "rotate",
        "axis",
        "degrees",
        "scale",
        "vertices",
        "size",
        "samples",
        "eye",
        "look_at",
        "up",
        "fov",
        "forward",
        "right",
        "position",
        "colour",
        "ambient",
        "diffuse",
        "highlight",
        "shininess",
        "reflect",
        "metal",
        "method",
        "precision",
        "acceptance",
        "newton_iterations",
        "newton_starts",
        "clip_threshold",
        "tolerance",
        "flatness",
        "grid_density",
        "threads",
        "limits",
    ] {
        assert!(documentation.contains(&format!("`{field}`")), "{field} is not described");
    }
}

#[test]
fn groups_are_used_with_their_places_and_materials() {
    let scene = scene(&format!(
        "surfaces = [\n\
         {{ group = \"pair\", material = \"red\" }},\n\
         {{ group = \"pair\", transform = [{{ scale = 2 }}, {{ translate = [0, 0, 9] }}] }}]\n\
         [groups.pair]\n\
         surfaces = [{{ {TORUS} }}, {{ {TORUS}, material = \"blue\", transform = [{{ translate = [1, 0, 0] }}] }}]\n\
         polygons = [{{ vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }}]\n\
         [materials.blue]\n[materials.red]\n"
    ));
    let made = parse("s.toml", &format!("surfaces = [{{ {TORUS} }}]\n{CAMERA}")).expect("valid");
    let What::Shape(torus) = made.contents.surfaces[0].what else { panic!("a shape") };
    let torus = torus.surfaces();
    assert_eq!((torus.len(), scene.model.surfaces.len()), (16, 64));
    // Default, blue, red: the entry's own material, that of the group's entry, or the scene's.
    let (blue, red) = (1, 2);
    let expected: Vec<_> = [red, blue, 0, blue].into_iter().flat_map(|material| [material; 16]).collect();
    assert_eq!(scene.appearance.surfaces, expected);
    assert_eq!(scene.appearance.polygons.iter().map(|(_, material)| *material).collect::<Vec<_>>(), [red, 0]);
    // The group's own place first, then the place where it is used.
    let place = Transform::translation([1.0, 0.0, 0.0])
        .then(Transform::scaling([2.0; 3]))
        .then(Transform::translation([0.0, 0.0, 9.0]));
    for (surface, origin) in scene.model.surfaces[48..].iter().zip(&torus) {
        for (point, [x, y, z, _]) in surface.points.iter().zip(&origin.points) {
            assert_eq!(point[..3], place.point([*x, *y, *z]));
        }
    }
    assert_eq!(scene.files.len(), 4);
    assert_eq!(scene.file_of(20).map(|file| file.surfaces.clone()), Some(16..32));
}

#[test]
fn an_exact_torus_is_the_one_of_the_equation() {
    let scene = scene("surfaces = [{ torus = { major = 2, minor = 0.5, around = 8, across = 3, exact = true } }]");
    let shape = shapes::torus([0.0; 3], 2.0, 0.5, 8, 3);
    for (made, known) in scene.model.surfaces.iter().zip(&shape.surfaces) {
        for (a, b) in made.points.iter().flatten().zip(known.points.iter().flatten()) {
            assert!((a - b).abs() < 1e-14);
        }
    }
}

#[test]
fn names_that_are_not_there() {
    let with = |entry: &str| {
        format!("surfaces = [{{ {entry} }}]\n[materials.copper]\n[groups.chain]\nsurfaces = [{{ {TORUS} }}]")
    };
    scene_refused(
        &with(&format!("{TORUS}, material = \"coper\"")),
        "s.toml:1:62",
        "there is no material `coper` (did you mean `copper`?)",
    );
    scene_refused(&with("group = \"chian\""), "s.toml:1:23", "there is no group `chian` (did you mean `chain`?)");
    scene_refused(&with("tours = 1"), "s.toml:1:15", "there is no `tours` here (did you mean `torus`?)");
    let polygon = "polygons = [{ vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], material = \"x\" }]";
    scene_refused(&format!("{polygon}\nsurfaces = [{{ {TORUS} }}]"), "s.toml:1:72", "there is no material `x`");
}

#[test]
fn groups_that_cannot_be_built() {
    let inside = |group: &str| format!("[groups.{group}]\nsurfaces = [{{ group = \"{}\" }}]\n", &group[1..]);
    let base = format!("surfaces = [{{ {TORUS} }}]\n");
    scene_refused(&format!("{base}[groups.a]\nsurfaces = [{{ group = \"a\" }}]"), "s.toml:3:23", "`a` holds itself");
    scene_refused(
        &format!("{base}[groups.a]\nsurfaces = [{{ group = \"b\" }}]\n[groups.b]\nsurfaces = [{{ group = \"a\" }}]"),
        "s.toml:5:23",
        "`a` holds itself",
    );
    scene_refused(&format!("{base}[groups.a]\n"), "s.toml:2:9", "the group `a` is empty");
    // Each holds the next, the last a torus.
    let chain: String = (1..=33).rev().map(|length| inside(&"a".repeat(length + 1))).collect();
    scene_refused(&format!("{base}{chain}[groups.a]\n{base}"), "s.toml:5:23", "groups are nested deeper than 32");
    // Each holds the next twice: two to the 20 in all.
    let triangle = "polygons = [{ vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }]";
    let mut doubled = format!("surfaces = [{{ group = \"g0\" }}]\n[groups.g20]\n{triangle}\n");
    for number in 0..20 {
        let next = number + 1;
        doubled += &format!("[groups.g{number}]\nsurfaces = [{{ group = \"g{next}\" }}, {{ group = \"g{next}\" }}]\n");
    }
    scene_refused(&doubled, "s.toml:41:42", "groups put more than 65536 things into the scene");
}

/// A dozen lines once asked for more surfaces than there is memory for, and ended without a word.
#[test]
fn a_scene_has_so_many_surfaces_and_no_more() {
    let torus = |around| format!("{{ torus = {{ major = 2, minor = 0.5, around = {around}, across = 1000 }} }}");
    let text = format!("surfaces = [{}, {}]", torus(50), torus(1000));
    scene_refused(&text, "s.toml:1:91", "the scene has more than 1048576 surfaces");
}

#[test]
fn an_entry_is_one_thing() {
    scene_refused(
        &format!("surfaces = [{{ {TORUS}, sphere = {{ radius = 1 }} }}]"),
        "s.toml:1:13",
        "this entry of `surfaces` names more than one thing",
    );
}

#[test]
fn measures_out_of_range() {
    let torus = |rest: &str| format!("surfaces = [{{ torus = {{ major = 2, {rest} }} }}]");
    scene_refused(&torus("minor = 0"), "s.toml:1:44", "`minor` is 0");
    scene_refused(&torus("minor = 1, height = -1"), "s.toml:1:56", "`height` is -1");
    scene_refused(&torus("minor = 1, around = 1"), "s.toml:1:56", "`around` is 1");
    scene_refused(&torus("minor = 1, across = 2, exact = true"), "s.toml:1:56", "`across` is 2");
    scene_refused(&torus("minor = 1, across = 100000"), "s.toml:1:56", "`across` is 100000");
    for count in ["-4", "1001", "1000000000000"] {
        let text = format!("{}\n{CAMERA}", torus(&format!("minor = 1, around = {count}")));
        refused(&text, "s.toml:1:56", &format!("`around` is {count}"));
        let report = rendered(&parse("s.toml", &text).expect_err("refused"));
        assert!(report.contains("help: write a whole number from 2 to 1000"), "{report}");
    }
    scene_refused(&torus("minor = 1, seam = nan"), "s.toml:1:54", "`seam` is NaN");
    let wall = |arc: &str| format!("surfaces = [{{ cylinder = {{ radius = 2, height = 1, arc = {arc} }} }}]");
    for arc in ["[0]", "[30, 30]", "[30, -30]", "[0, 361]", "[nan, 1]", "[0, inf]"] {
        scene_refused(&wall(arc), "s.toml:1:58", "`arc` is no part of a circle");
    }
    // A part of a circle needs no more than its share of arcs.
    scene(&wall("[0, 90], around = 1, exact = true"));
}

#[test]
fn transforms_that_leave_nothing() {
    let with = |step: &str| format!("surfaces = [{{ {TORUS}, transform = [{step}] }}]");
    for scale in ["0", "0.0", "[1, 0, 1]"] {
        scene_refused(&with(&format!("{{ scale = {scale} }}")), "s.toml:1:74", "`scale` is 0");
    }
    scene_refused(&with("{ scale = inf }"), "s.toml:1:74", "`scale` is not finite");
    scene_refused(&with("{ scale = [1, 2] }"), "s.toml:1:74", "`scale` is neither a number nor three numbers");
    scene_refused(&with("{ scale = \"big\" }"), "s.toml:1:74", "`scale` is neither a number nor three numbers");
    scene_refused(&with("{ rotate = { axis = [0, 0, 0], degrees = 9 } }"), "s.toml:1:84", "has no direction");
    scene_refused(&with("{ rotate = { axis = [0, 0, 1], degrees = inf } }"), "s.toml:1:105", "`degrees` is inf");
    scene_refused(&with("{}"), "s.toml:1:64", "is one of `translate`, `rotate` and `scale`");
    scene_refused(&with("{ scale = 1, translate = [0, 0, 1] }"), "s.toml:1:64", "is one of");
    scene_refused(&with("{ scale = 1e200 }, { scale = 1e200 }"), "s.toml:1:83", "moves points to infinity");
    scene_refused(&with("{ scale = 1e308 }"), "s.toml:1:23", "move these surfaces to infinity");
    let axis = "{ rotate = { axis = [1.5e308, 1.5e308, 0], degrees = 9 } }";
    scene_refused(&with(axis), "s.toml:1:84", "`axis` is too long");
    for small in ["1e-200", "[1, 1e-200, 1]"] {
        let twice =
            format!("{{ scale = {small} }}, {{ rotate = {{ axis = [0, 1, 0], degrees = 9 }} }}, {{ scale = {small} }}");
        let last = 64 + twice.rfind("{ scale").expect("it is there");
        scene_refused(&with(&twice), &format!("s.toml:1:{last}"), "multiply to 0, which leaves nothing to see");
    }
    let nested = |inside: &str, scale: &str| {
        format!(
            "surfaces = [{{ group = \"a\", transform = [{{ scale = {scale} }}] }}]\n\
             [groups.a]\nsurfaces = [{{ group = \"b\", transform = [{{ scale = {scale} }}] }}]\n[groups.b]\n{inside}"
        )
    };
    let triangle = "polygons = [{ vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }]";
    for inside in [&format!("surfaces = [{{ {TORUS} }}]"), triangle] {
        scene_refused(&nested(inside, "1e-200"), "s.toml:3:23", "of nested groups multiply to 0");
    }
    scene_refused(&nested(triangle, "1e100"), "s.toml:3:23", "transforms make a polygon of this group too large");
}

#[test]
fn polygons_that_are_none() {
    let with = |vertices: &str| format!("polygons = [{{ vertices = {vertices} }}]\nsurfaces = [{{ {TORUS} }}]");
    scene_refused(&with("[[0, 0, 0], [1, 0, 0]]"), "s.toml:1:26", "a polygon has at least three vertices");
    scene_refused(&with("[[0, 0, 0], [1, 1, 1], [2, 2, 2]]"), "s.toml:1:26", "has no area");
    scene_refused(&with("[[-1e200, 0, 0], [1e200, 0, 0], [0, 1e200, 0]]"), "s.toml:1:26", "polygon is too large");
    scene_refused(&with("[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1]]"), "s.toml:1:26", "not lie in one plane");
    scene_refused(&with("[[0, 0, 0], [3, 3, 0], [3, 0, 0], [0, 1, 0]]"), "s.toml:1:26", "cross or touch");
    scene_refused(&with("[[0, 0, 0], [1, 0], [0, 1, 0]]"), "s.toml:1:38", "a vertex has 2 numbers");
}

#[test]
fn lights_and_mirrors() {
    let lit = |lights: &str| scene(&format!("surfaces = [{{ {TORUS} }}]\n{lights}")).appearance.lights.len();
    assert_eq!(lit("[[lights]]\nposition = [1, 2, 3]\n[[lights]]\n"), 2);
    assert_eq!(lit(""), 1);
    let both = format!("surfaces = [{{ {TORUS} }}]\n[light]\n[[lights]]\n");
    assert!(parse("s.toml", &format!("{both}{CAMERA}")).is_err_and(|e| e.to_string().contains("both `light`")));
    refused_after("[material]\nreflect = 1.5\n", "s.toml:6:11", "`reflect` is 1.5");
    refused_after("[image]\nsamples = \"jitered\"\n", "s.toml:6:11", "(did you mean `jittered`?)");
}

#[test]
fn shadows_are_chosen_per_light() {
    let of = |table: &str| parse("s.toml", &format!("surfaces = [{{ {TORUS} }}]\n{CAMERA}\n[light]\n{table}\n"));
    let shadow = |table: &str| of(table).expect("valid").lights[0].shadow;
    assert_eq!((shadow(""), shadow("shadow = \"none\"")), (Shadow::None, Shadow::None));
    assert_eq!(shadow("shadow = \"rays\""), Shadow::Rays);
    assert_eq!(shadow("shadow = \"map\""), Shadow::Map(MapOptions::default()));
    let table = "shadow = \"map\"\nmap_size = 300\nmap_bias = 0";
    assert_eq!(shadow(table), Shadow::Map(MapOptions { size: 300, bias: 0.0 }));
    for kind in ["", "shadow = \"rays\"\n", "shadow = \"none\"\n"] {
        for (field, name) in [("map_size = 300", "map_size"), ("map_bias = 0.1", "map_bias")] {
            let refused = of(&format!("{kind}{field}")).expect_err("refused").to_string();
            assert!(refused.contains(&format!("`{name}` means nothing without a shadow map")), "{refused}");
        }
    }
}

#[test]
fn a_metal_is_named_and_scatters_no_light() {
    let of = |table: &str| parse("s.toml", &format!("surfaces = [{{ {TORUS} }}]\n{CAMERA}\n[material]\n{table}\n"));
    let gold = of("metal = \"gold\"\nhighlight = 0.6").expect("valid").material;
    assert_eq!((gold.metal, gold.reflect, gold.highlight), (Some(Metal::Gold), 1.0, 0.6));
    assert_eq!(of("metal = \"silver\"\nreflect = 0.5").expect("valid").material.reflect, 0.5);
    for metal in Metal::ALL {
        let name = format!("{metal:?}").to_lowercase();
        assert_eq!(of(&format!("metal = \"{name}\"")).expect("valid").material.metal, Some(metal));
    }
    refused_after(
        "[material]\nmetal = \"cooper\"\n",
        "s.toml:6:9",
        "there is no `cooper` here (did you mean `copper`?)",
    );
    for (field, place) in
        [("colour = [1, 1, 1]", "s.toml:7:10"), ("ambient = 0.1", "s.toml:7:11"), ("diffuse = 0", "s.toml:7:11")]
    {
        let text = format!("[material]\nmetal = \"gold\"\n{field}\n");
        refused_after(&text, place, "means nothing for a metal");
    }
}
