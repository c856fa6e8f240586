//! Pictures in parts: rows drawn by several processes, merged, interrupted and resumed.

use std::fs;
use std::process::Stdio;
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::{Folder, printed, said};

/// A scene with what makes rows of a picture depend on one another if anything does: scan lines of jittered samples, a shadow
/// by map, one by rays, a mirror.
const SCENE: &str = "surfaces = [{ file = \"teapot.bpt\", material = \"chrome\" }]\n\
    polygons = [{ vertices = [[-6, -6, 0], [6, -6, 0], [6, 6, 0], [-6, 6, 0]] }]\n\
    [materials.chrome]\nreflect = 0.5\n\
    [image]\nsize = [32, 40]\nsamples = \"jittered\"\n\
    [camera]\neye = [7.6171875, -9.3203125, 7.59375]\nlook_at = [0.2, 0, 1.4]\nfov = 35\n\
    [[lights]]\nposition = [4, -6, 9]\nshadow = \"map\"\nmap_size = 64\n\
    [[lights]]\nposition = [-4, -6, 9]\nshadow = \"rays\"\n\
    [trace]\nflatness = 0.002\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.put("parts.toml", SCENE);
    folder
}

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    fs::read(folder.path(name)).expect("it is there")
}

#[test]
fn parts_of_two_processes_are_one_run() {
    let folder = folder();
    folder.done("render parts.toml --method newton-predicted --threads 1 -o whole.png");
    let parts = [("0..13", 1, "a"), ("13..14", 3, "b"), ("14..99", 2, "c")].map(|(rows, threads, name)| {
        let words =
            format!("render parts.toml --method newton-predicted --rows {rows} --threads {threads} -o {name}.png");
        folder.command(&words).stderr(Stdio::null()).spawn().expect("it starts")
    });
    for mut part in parts {
        assert!(part.wait().expect("it ends").success());
    }
    folder.done("merge c.png a.png b.png -o merged.png");
    assert!(bytes(&folder, "merged.png") == bytes(&folder, "whole.png"));
    folder.done("merge a.png b.png c.png a.png -o - --quiet");
    folder.fails("merge a.png c.png -o none.png", 1, &["rows 13..14 are in none of the parts"]);
    folder.fails("merge a.png b.png c.png -o a.png", 2, &["would replace an input"]);
    folder.fails("merge a.png whole.png -o none.png", 3, &["whole.png", "does not say which rows"]);
    folder.fails("merge a.png parts.toml -o none.png", 3, &["parts.toml", "no PNG"]);
    folder.done("render parts.toml --method clipping --rows 14..40 -o d.png");
    folder.fails("merge a.png b.png d.png -o none.png", 3, &["d.png", "of another picture"]);
}

#[test]
fn rows_that_are_not_there_are_refused() {
    let folder = folder();
    folder.fails("render parts.toml --rows 40..50 -o a.png", 2, &["the picture has 40"]);
    folder.fails("render parts.toml --rows 5 -o a.png", 2, &["A..B"]);
    folder.fails("render parts.toml --rows 0..4 --aov a.exr -o a.png", 2, &["--aov"]);
    folder.fails("render parts.toml --resume -o -", 2, &["standard output"]);
}

#[test]
fn statistics_name_the_rows() {
    let folder = folder();
    folder.done("render parts.toml --rows 4..6,9..10 --stats part.json -o a.png");
    folder.done("render parts.toml --stats whole.json -o whole.png");
    assert_eq!(
        (folder.json("part.json")["rows"].as_str(), folder.json("part.json")["rays"].as_u64()),
        (Some("4..6,9..10"), Some(3 * 4 * 32))
    );
    assert!(folder.json("whole.json").get("rows").is_none());
}

/// Ctrl-C, and the signal by which schedulers end a job.
#[cfg(unix)]
#[test]
fn what_an_interrupted_run_has_drawn_is_kept() {
    let folder = folder();
    let words = "render parts.toml --size 24x4000 --threads 1 -o out.png";
    // Machines differ by more than any fixed delay allows for: the whole run says when one is under way and not yet at its end.
    let begin = Instant::now();
    folder.done("render parts.toml --size 24x4000 --threads 1 -o whole.png");
    let delay = begin.elapsed() / 6;
    for signal in ["-INT", "-TERM"] {
        let run = folder.command(&format!("{words} --resume")).stderr(Stdio::piped()).spawn().expect("it starts");
        // It listens once it has begun to write.
        while !folder.names().iter().any(|name| name.starts_with(".patchray-")) {
            sleep(Duration::from_millis(5));
        }
        sleep(delay);
        let kill = std::process::Command::new("kill").args([signal, &run.id().to_string()]).status();
        assert!(kill.expect("there is such a command").success());
        let output = run.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(130), "{}", said(&output));
        assert!(said(&output).contains("of 4000 rows are kept in `out.unfinished.png`"), "{}", said(&output));
        assert!(!folder.path("out.png").exists());
        assert!(!folder.names().iter().any(|name| name.starts_with(".patchray-")));
    }
    folder.fails("render parts.toml --size 24x4001 --resume -o out.png", 3, &["out.unfinished.png", "another picture"]);
    folder.fails("merge out.unfinished.png -o merged.png", 1, &["are in none of the parts"]);
    folder.done(&format!("{words} --resume --stats rest.json"));
    assert!(!folder.path("out.unfinished.png").exists());
    assert!(folder.json("rest.json")["rays"].as_u64() < Some(24 * 4000 * 4));
    assert!(bytes(&folder, "out.png") == bytes(&folder, "whole.png"));
}

#[test]
fn the_preview_goes_to_the_terminal_and_not_into_the_data() {
    let folder = folder();
    let output = folder.done("render parts.toml --preview -o -");
    assert!(said(&output).contains('▀'));
    assert!(output.stdout.starts_with(b"\x89PNG"));
    assert!(!said(&folder.done("render parts.toml -o a.png")).contains('▀'));
    assert!(printed(&folder.done("render parts.toml -o a.png")).is_empty());
}
