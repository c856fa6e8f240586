//! Scenes of generated shapes, polygons and mirrors, and pictures of four samples per pixel.

use super::*;

/// Two toruses, the upper one in a group, over a mirror.
const TORUSES: &str = "surfaces = [{ torus = { major = 1, minor = 0.3 } }, { group = 'raised' }]\n\
    polygons = [{ vertices = [[-5, -5, -1], [5, -5, -1], [5, 5, -1], [-5, 5, -1]], material = 'mirror' }]\n\
    [groups.raised]\nsurfaces = [{ torus = { major = 1, minor = 0.3 }, transform = [{ translate = [0, 0, 1] }] }]\n\
    [materials.mirror]\nreflect = 0.7\n\
    [image]\nsize = [40, 30]\nsamples = 'jittered'\n\
    [camera]\neye = [0, -6, 4]\nlook_at = [0, 0, 0]\n";

#[test]
fn four_samples_give_the_same_bytes_with_any_threads() {
    let folder = Folder::new();
    folder.put("toruses.toml", TORUSES);
    for method in METHODS {
        for threads in [1, 2, 3] {
            let flags = format!("--method {method} --threads {threads}");
            folder.done(&format!("render toruses.toml -o {threads}.png --stats {threads}.json {flags}"));
        }
        let picture = |threads| fs::read(folder.path(&format!("{threads}.png"))).expect("there");
        assert!(picture(1) == picture(2) && picture(1) == picture(3), "{method}");
        let [one, three] = [folder.json("1.json"), folder.json("3.json")];
        assert_eq!((&one["samples"], &one["rays"]), (&"jittered".into(), &4800.into()));
        for count in ["hit_rays", "intersection_points", "newton_steps", "clip_steps"] {
            assert_eq!(one[count], three[count], "{method} {count}");
        }
    }
}

#[test]
fn the_flag_chooses_other_samples_than_the_scene() {
    let folder = Folder::new();
    folder.put("toruses.toml", TORUSES);
    let pictures = ["one", "uniform", "jittered"].map(|samples| {
        folder.done(&format!("render toruses.toml -o a.png --stats s.json --samples {samples}"));
        let stats = folder.json("s.json");
        let rays: u64 = if samples == "one" { 1200 } else { 4800 };
        assert_eq!((&stats["samples"], &stats["rays"]), (&samples.into(), &rays.into()));
        fs::read(folder.path("a.png")).expect("there")
    });
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2] && pictures[0] != pictures[2]);
    folder.fails("render toruses.toml -o b.png --samples four", 2, &["uniform"]);
}

/// A mirror's rays are drawn, and counted neither as rays nor in what the method did.
#[test]
fn mirrors_and_polygons_are_seen_and_not_counted() {
    let folder = Folder::new();
    folder.put("toruses.toml", TORUSES);
    folder.put("dull.toml", TORUSES.replace("0.7", "0"));
    folder.put("bare.toml", TORUSES.replace("-5, -1]", "-5, -90]").replace("5, -1]", "5, -90]"));
    let drawn = ["toruses", "dull", "bare"].map(|name| {
        folder.done(&format!("render {name}.toml -o {name}.png --stats {name}.json"));
        let stats = folder.json(&format!("{name}.json"));
        let counts =
            ["rays", "hit_rays", "surfaces", "intersection_points", "clip_steps"].map(|key| stats[key].clone());
        (fs::read(folder.path(&format!("{name}.png"))).expect("there"), counts)
    });
    assert!(drawn[0].0 != drawn[1].0 && drawn[1].0 != drawn[2].0);
    assert_eq!((&drawn[0].1, &drawn[1].1), (&drawn[2].1, &drawn[2].1));
    let told = printed(&folder.done("info toruses.toml"));
    assert!(told.contains("surfaces        32 (0 rational)") && told.contains("polygons        1"), "{told}");
}

#[test]
fn the_surfaces_of_a_scene_answer_rays_under_their_number_in_it() {
    let folder = Folder::new();
    folder.put("toruses.toml", TORUSES);
    // Down through the upper torus, between the two, and past both.
    folder.put("rays.csv", "ox,oy,oz,dx,dy,dz\n0.7,0.7,9,0,0,-1\n0.7,0.7,0.5,0,0,-1\n0,0,9,0,0,-1\n");
    let answers = printed(&folder.done("query toruses.toml rays.csv"));
    let lines: Vec<_> = answers.lines().skip(1).map(fields).collect();
    let patch = |line: &[&str]| line[5].parse::<usize>().expect("a number");
    assert!((16..32).contains(&patch(&lines[0])) && patch(&lines[1]) < 16, "{answers}");
    assert_eq!(lines[2][9], "miss");
}

/// The toruses under two lights, whose shadows are found in two ways.
fn shadowed() -> String {
    let lights = "[[lights]]\nposition = [3, -4, 6]\nshadow = 'map'\nmap_size = 90\n\
        [[lights]]\nposition = [-5, -2, 6]\ncolour = [0.4, 0.4, 0.5]\nshadow = 'rays'\n";
    format!("{TORUSES}{lights}")
}

#[test]
fn shadows_give_the_same_bytes_with_any_threads() {
    let folder = Folder::new();
    folder.put("toruses.toml", shadowed());
    for method in METHODS.into_iter().chain(PREDICTED) {
        for threads in [1, 2, 3] {
            let flags = format!("--method {method} --threads {threads}");
            folder.done(&format!("render toruses.toml -o {threads}.png --stats {threads}.json {flags}"));
        }
        let picture = |threads| fs::read(folder.path(&format!("{threads}.png"))).expect("there");
        assert!(picture(1) == picture(2) && picture(1) == picture(3), "{method}");
        let [one, three] = [folder.json("1.json"), folder.json("3.json")];
        assert_eq!(one["rays_by_kind"], three["rays_by_kind"], "{method}");
    }
}

/// Magenta pixels once came without a word: only rays of the camera were told.
#[test]
fn rays_to_lights_without_an_answer_are_told() {
    let folder = Folder::new();
    folder.put("toruses.toml", shadowed());
    let words = "render toruses.toml --size 24x24 -o a.png --stats a.json --method newton-predicted";
    let output = folder.done(&format!("{words} --limit nodes=1"));
    let stats = folder.json("a.json");
    let (gave_up, rays) = (&stats["gave_up_by_kind"], &stats["rays_by_kind"]);
    assert!(gave_up["shadow"].as_u64() > Some(0), "{gave_up}");
    assert_eq!((&gave_up["camera"], &gave_up["mirrored"], &gave_up["map"]), (&0.into(), &0.into(), &0.into()));
    let told = format!("{} of {} rays to lights have no answer", gave_up["shadow"], rays["shadow"]);
    assert!(said(&output).contains(&told), "{}", said(&output));
    assert!(!said(&folder.done(words)).contains("no answer"));
    assert_eq!(folder.json("a.json")["gave_up_by_kind"]["shadow"], 0);
}

/// What shadows take is told, and nothing is prepared for those that there are not.
#[test]
fn stats_say_what_shadows_took() {
    let folder = Folder::new();
    let rays = shadowed().replace("shadow = 'map'\nmap_size = 90\n", "shadow = 'rays'\n");
    let map = shadowed().replace("shadow = 'rays'", "shadow = 'map'\nmap_size = 40");
    let none = shadowed().replace("shadow = 'map'\nmap_size = 90\n", "").replace("shadow = 'rays'\n", "");
    let stats = [("both", shadowed()), ("rays", rays), ("map", map), ("none", none)].map(|(name, text)| {
        folder.put(&format!("{name}.toml"), text);
        folder.done(&format!("render {name}.toml -o {name}.png --stats {name}.json --method newton-predicted"));
        folder.json(&format!("{name}.json"))
    });
    let pictures = ["both", "rays", "map", "none"].map(|name| fs::read(folder.path(&format!("{name}.png"))));
    let [both, rays, map, none] = pictures.map(|picture| picture.expect("there"));
    assert!(both != rays && both != map && both != none && rays != map && rays != none && map != none);
    for (stats, sizes) in stats.iter().zip([&[90][..], &[], &[90, 40], &[]]) {
        let maps = stats["shadow_maps"].as_array().cloned().unwrap_or_default();
        assert_eq!(maps.iter().map(|map| map["size"].as_u64().expect("a size")).collect::<Vec<_>>(), sizes);
        for map in &maps {
            let texels = map["size"].as_u64().expect("a size").pow(2);
            assert_eq!((&map["rays"], &map["faces"], &map["gave_up"]), (&texels.into(), &1.into(), &0.into()));
            assert_eq!(map["bytes"], 12 * texels);
            assert_eq!(map["method"], "newton-predicted");
        }
        let of_maps: u64 = maps.iter().map(|map| map["rays"].as_u64().expect("a number")).sum();
        assert_eq!(stats["rays_by_kind"]["map"], of_maps);
    }
    let shadow = stats.each_ref().map(|stats| stats["rays_by_kind"]["shadow"].as_u64().expect("a number"));
    assert!(shadow[0] > 0 && shadow[1] > shadow[0] && shadow[2] == 0 && shadow[3] == 0, "{shadow:?}");
    // Rays to lights ask the tree of the original method, and the camera's and the mirrors' none.
    let trees = stats.each_ref().map(|stats| stats["arena_bytes_by_kind"]["tree_nodes"].as_u64());
    assert!(trees[0].is_some() && trees[0] == trees[1] && trees[2].is_none() && trees[3].is_none(), "{trees:?}");
    let methods = stats.each_ref().map(|stats| stats["methods_by_kind"]["shadow"].as_str().map(str::to_owned));
    assert_eq!(methods, [Some("newton".to_owned()), Some("newton".to_owned()), None, None]);
    // What the camera's rays took is the same with shadows and without.
    let points = stats.each_ref().map(|stats| [&stats["intersection_points"], &stats["hit_rays"], &stats["rays"]]);
    assert!(points.iter().all(|of| *of == points[3]));
}
