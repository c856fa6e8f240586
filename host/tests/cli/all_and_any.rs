//! `query --all` and `query --any`: every hit of a ray, or whichever is found first.

use patchray_host::scanline::row;
use patchray_host::scene::model::Model;
use patchray_host::scene::{bpt, shapes, teapot};

use super::{Folder, METHODS, TEAPOT, fields, printed, said};

/// The rays of the common view, pixel by pixel.
fn common_view() -> String {
    let view = teapot::common_scene().expect("the built-in scene is valid").description.camera.view([512, 512]);
    let mut text = "ox,oy,oz,dx,dy,dz,line\n".to_owned();
    for ray in (0..view.size[1]).flat_map(|py| row(&view, py)) {
        let [[ox, oy, oz], [dx, dy, dz]] = [ray.origin, ray.direction];
        text += &format!("{ox},{oy},{oz},{dx},{dy},{dz},{}\n", ray.scan_line);
    }
    text
}

/// The lines of answers, ray by ray.
fn by_ray(answers: &str) -> Vec<Vec<&str>> {
    let lines: Vec<&str> = answers.lines().skip(1).collect();
    lines.chunk_by(|a, b| fields(a)[0] == fields(b)[0]).map(<[_]>::to_vec).collect()
}

/// What the oracle counts there: 109,540 rays hit, and they hit 237,594 times.
#[test]
fn all_roots_of_the_common_view() {
    let folder = Folder::new();
    folder.put("view.csv", common_view());
    let output = folder.done("query teapot.bpt view.csv --all --method clipping -o all.csv --stats s.json");
    assert!(said(&output).contains("262144 rays, 109540 that hit, 237594 points"), "{}", said(&output));
    let stats = folder.json("s.json");
    for (field, value) in [("rays", 262_144), ("hit_rays", 109_540), ("intersection_points", 237_594), ("gave_up", 0)] {
        assert_eq!(stats[field], value, "{field}");
    }
    assert_eq!((&stats["asked"], &stats["patches"]), (&"all".into(), &0.into()));
    assert!(stats["intersect_seconds"].as_f64() > Some(0.0));
    let all = folder.text("all.csv");
    let all = by_ray(&all);
    assert_eq!(all.len(), 262_144);
    assert_eq!(all.iter().flatten().filter(|line| fields(line)[1] == "1").count(), 237_594);
    assert_eq!(all.iter().filter(|lines| fields(lines[0])[1] == "1").count(), 109_540);
    let t = |line: &str| fields(line)[2].parse::<f64>().expect("a number");
    for (number, lines) in all.iter().enumerate() {
        assert_eq!(fields(lines[0])[0], number.to_string());
        assert!(lines.len() == 1 || lines.is_sorted_by(|a, b| t(a) <= t(b)), "{lines:?}");
    }

    // The closest of all is the closest; any one is one of all.
    for method in ["clipping", "clipping-coherent"] {
        folder.done(&format!("query teapot.bpt view.csv --method {method} -o closest.csv --stats s.json"));
        assert_eq!(folder.json("s.json")["hit_rays"], 109_540);
        let answers = folder.text("closest.csv");
        for (line, all) in answers.lines().skip(1).zip(&all) {
            let [found, first] = [line, all[0]].map(fields);
            assert_eq!(found[1], first[1], "{line}");
            let near = found[1] == "0" || (t(line) - t(all[0])).abs() < 1e-9;
            assert!(near, "{line}: {}", all[0]);
        }
    }
    folder.done("query teapot.bpt view.csv --any --method clipping -o any.csv --stats s.json");
    let stats = folder.json("s.json");
    assert_eq!((&stats["hit_rays"], &stats["asked"]), (&109_540.into(), &"any".into()));
    let any = folder.text("any.csv");
    assert_eq!(any.lines().count(), 1 + all.len());
    let mut farther = 0;
    for (line, all) in any.lines().skip(1).zip(&all) {
        assert!(all.contains(&line), "{line} is none of {all:?}");
        farther += usize::from(line != all[0]);
    }
    assert!(farther > 1000, "any hit was the closest in all but {farther} rays");
}

#[test]
fn newton_finds_hits_too() {
    let folder = Folder::new();
    let clipped = printed(&folder.done(&format!("query {TEAPOT} --all")));
    let (clipped_rays, clipped_lines) = (by_ray(&clipped).len(), clipped.lines().count());
    for precision in ["f32", "f64"] {
        let flags = format!("--method newton --precision {precision}");
        let all = printed(&folder.done(&format!("query {TEAPOT} --all {flags}")));
        assert_eq!(by_ray(&all).len(), clipped_rays);
        // It may lose one of two roots that lie close together.
        assert!(all.lines().count() + 4 > clipped_lines && clipped_lines + 4 > all.lines().count());
        let any = printed(&folder.done(&format!("query {TEAPOT} --any {flags}")));
        for (line, all) in any.lines().skip(1).zip(by_ray(&all)) {
            assert_eq!(fields(line)[1], fields(all[0])[1], "{line}");
        }
    }
}

/// Many squares, one a unit above the other.
fn stack(squares: usize) -> Model {
    let square = |number| shapes::parallelogram([0.0, 0.0, number as f64], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    Model::numbered((0..squares).map(square).collect())
}

#[test]
fn a_full_list_says_so_and_holds_the_closest() {
    let folder = Folder::new();
    folder.put("rays.csv", "ox,oy,oz,dx,dy,dz\n0.3,0.6,-1,0,0,2\n5,5,-1,0,0,1\n0.3,0.6,400,0,0,-1\n0.5,-1,9.5,0,1,0\n");
    folder.put("256.bpt", bpt::write(&stack(256)));
    folder.put("300.bpt", bpt::write(&stack(300)));
    for method in ["clipping", "newton"] {
        let flags = format!("rays.csv --all --stats s.json --method {method} --flatness 0.01");
        let output = folder.done(&format!("query 256.bpt {flags}"));
        assert!(!said(&output).contains("gave up"), "{}", said(&output));
        let answers = printed(&output);
        let lines = by_ray(&answers);
        assert_eq!(lines.iter().map(Vec::len).collect::<Vec<_>>(), [256, 1, 256, 1]);
        assert_eq!(lines[1], ["1,0,,,,,,,,miss"]);
        assert!(lines[0].iter().all(|line| fields(line)[1] == "1"));

        let output = folder.done(&format!("query 300.bpt {flags}"));
        assert!(said(&output).contains("2 of 4 rays gave up: the limit on hits ran out"), "{}", said(&output));
        let stats = folder.json("s.json");
        assert_eq!((&stats["gave_up_by_limit"]["hits"], &stats["hit_rays"]), (&2.into(), &0.into()));
        let answers = printed(&output);
        let lines = by_ray(&answers);
        for (ray, nearest, step) in [(0, 0.5, 0.5), (2, 101.0, 1.0)] {
            assert_eq!(lines[ray].len(), 256);
            for (number, line) in lines[ray].iter().enumerate() {
                let answer = fields(line);
                assert_eq!((answer[1], answer[9]), ("0", "gave-up:hits"));
                let t: f64 = answer[2].parse().expect("a number");
                assert!((t - nearest - step * number as f64).abs() < 1e-9, "{line}");
            }
        }
        assert_eq!((lines[1][0], lines[3][0]), ("1,0,,,,,,,,miss", "3,0,,,,,,,,miss"));
        // One hit is enough.
        let any = printed(&folder.done(&format!("query 300.bpt rays.csv --any --method {method} --flatness 0.01")));
        assert_eq!(any.matches(",ok").count(), 2, "{any}");
    }
}

/// What was found before another limit ran out is written, and is no answer.
#[test]
fn a_ray_given_up_has_lines_that_are_no_hits() {
    let folder = Folder::new();
    folder.put("300.bpt", bpt::write(&stack(300)));
    folder.put("rays.csv", "ox,oy,oz,dx,dy,dz\n0.3,0.6,-1,0,0,1\n5,5,-1,0,0,1\n");
    let answers = printed(&folder.done("query 300.bpt rays.csv --all --limit surfaces=5"));
    let lines = by_ray(&answers);
    assert_eq!((lines[0].len(), lines[1].len()), (5, 1), "{answers}");
    assert!(lines[0].iter().all(|line| fields(line)[1] == "0" && line.ends_with(",gave-up:surfaces")), "{answers}");
    let answers = printed(&folder.done("query 300.bpt rays.csv --all --limit surfaces=0"));
    assert!(answers.contains("0,0,,,,,,,,gave-up:surfaces\n1,0,,,,,,,,miss\n"), "{answers}");
}

/// A line through the middle of a stack of squares meets all of them, whichever of its points is the origin.
#[test]
fn whole_lines_are_answered_by_every_method() {
    let folder = Folder::new();
    folder.put("stack.bpt", bpt::write(&stack(9)));
    let ranges = ["-inf,inf", "-Infinity,", ",", "0,INF", "-inf,0", "-INF,-4.25", ",2.25"];
    let rays: String = ranges.iter().map(|range| format!("0.3,0.6,4.5,0,0,2,{range}\n")).collect();
    folder.put("lines.csv", format!("ox,oy,oz,dx,dy,dz,tmin,tmax\n{rays}"));
    // Of the squares at z = 0 to 8, how many and at which t the first.
    let expected = [(9, -2.25), (9, -2.25), (4, 0.25), (4, 0.25), (5, -2.25), (0, 0.0), (4, 0.25)];
    let on_square = |z: f64| (z - z.round()).abs() < 1e-5;
    for precision in ["f32", "f64"] {
        for method in METHODS {
            let flags = format!("query stack.bpt lines.csv --method {method} --precision {precision} --flatness 0.01");
            let check = |words: &str, counts: &dyn Fn(usize) -> usize| {
                let answers = printed(&folder.done(words));
                for (lines, (count, first)) in by_ray(&answers).iter().zip(expected) {
                    let hits: Vec<_> =
                        lines.iter().map(|line| fields(line)).filter(|fields| fields[1] == "1").collect();
                    assert_eq!(hits.len(), counts(count), "{words}: {lines:?}");
                    let t: Vec<f64> = hits.iter().map(|fields| fields[2].parse().expect("a number")).collect();
                    let is_first = words.ends_with("--any") || t.first().is_none_or(|t| (t - first).abs() < 1e-5);
                    assert!(is_first && t.iter().all(|t| on_square(4.5 + 2.0 * t)), "{words}: {lines:?}");
                }
            };
            check(&flags, &|count| count.min(1));
            if !method.ends_with("coherent") {
                check(&format!("{flags} --all"), &|count| count);
                check(&format!("{flags} --any"), &|count| count.min(1));
            }
        }
    }
    folder.put("none.csv", "ox,oy,oz,dx,dy,dz,tmin\n0.3,0.6,4.5,0,0,2,inf\n");
    folder.fails("query stack.bpt none.csv -o a.csv", 3, &["none.csv:2:19", "`tmin` is inf, which leaves no t"]);
}

#[test]
fn threads_and_order_change_no_line() {
    let folder = Folder::new();
    for flag in ["--all", "--any"] {
        let one = printed(&folder.done(&format!("query {TEAPOT} {flag} --threads 1")));
        let two = printed(&folder.done(&format!("query {TEAPOT} {flag} --threads 2 --quiet")));
        assert_eq!(one, two);
    }
    let invalid = "ox,oy,oz,dx,dy,dz\n1,2,3,0,0,0\n0.2,0.1,9,0,0,-1\n";
    folder.put("rays.csv", invalid);
    folder.fails("query teapot.bpt rays.csv --all -o a.csv", 3, &["direction is zero"]);
    let answers = printed(&folder.done("query teapot.bpt rays.csv --all --skip-invalid"));
    assert!(answers.contains("\n0,0,,,,,,,,invalid\n1,1,"), "{answers}");
}

/// Parts of methods are refused where leaving them out would change nothing.
#[test]
fn parts_are_left_out_of_what_has_them_alone() {
    let folder = Folder::new();
    folder.put("rays.csv", "ox,oy,oz,dx,dy,dz\n0,-5,1,0,1,0\n");
    let scene = "surfaces = [{ file = \"teapot.bpt\" }]\n[camera]\neye = [8, -9, 7]\nlook_at = [0, 0, 1]\nfov = 30\n";
    folder.put("scene.toml", scene);
    let ours = "not for `newton-predicted`";
    folder.fails("render scene.toml --method newton-predicted --by-the-letter -o a.png", 2, &[ours]);
    folder.fails("render scene.toml --method newton-predicted --without pruning -o a.png", 2, &[ours]);
    folder.fails("stress --method clipping-predicted --without pruning", 2, &["not for `clipping-predicted`"]);
    folder.fails("stress --without pruning", 2, &["not for several methods"]);
    folder.fails("study --by-the-letter -o study", 2, &["not for several methods"]);
    folder.fails("query teapot.bpt rays.csv --all --by-the-letter", 2, &["not for --all and --any"]);
    folder.fails("query teapot.bpt rays.csv --any --without known-roots", 2, &["not for --all and --any"]);
    folder.done("render scene.toml --size 8x8 --method newton-predicted --without coherence -o a.png");
    folder.done("query teapot.bpt rays.csv --by-the-letter");
}
