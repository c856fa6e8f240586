//! Tables for firmware: what is written, and that `info` foretells its bytes.

use super::*;

#[test]
fn info_foretells_the_bytes_of_the_tables() {
    let folder = Folder::new();
    folder.done("info scene.toml --json -o info.json");
    let info = folder.json("info.json");
    for method in METHODS.into_iter().chain(["newton-predicted", "clipping-predicted"]) {
        for precision in ["f32", "f64"] {
            folder.done(&format!("bake scene.toml --method {method} --precision {precision} --rust tables.rs"));
            let text = folder.text("tables.rs");
            let bytes = &info["memory"][precision]["methods"][method]["baked_bytes"];
            assert!(text.contains(&format!("pub const BYTES: usize = {bytes};")), "{method} {precision}: {bytes}");
            // The module itself holds that number against its tables; here they are counted by what they say they are.
            let counted: u64 = text.lines().filter_map(|line| table_bytes(line, precision)).sum();
            assert_eq!(bytes.as_u64(), Some(counted), "{method} {precision}");
            folder.done(&format!("bake scene.toml --method {method} --precision {precision} --c in_c.h"));
            // A compiler holds that number against the sizes of the tables; tests/capi/run has one.
            assert!(folder.text("in_c.h").contains(&format!("#define in_c_BYTES {bytes}\n")), "{method} {precision}");
            let has = |name: &str| text.contains(&format!("pub fn {name}()"));
            let [patches, tree, grids] = [has("patches"), has("tree"), has("grids")];
            let predicted = method.ends_with("predicted");
            assert_eq!(patches, method != "clipping");
            assert_eq!((tree, grids), (method == "newton", !predicted && method.ends_with("coherent")));
        }
    }
}

/// The bytes of the table that this line of source declares, if it does.
fn table_bytes(line: &str, precision: &str) -> Option<u64> {
    let declared = line.strip_prefix("pub static ")?.strip_suffix("] = [")?;
    let (of, count) = declared.split_once(": [")?.1.split_once("; ")?;
    let real = if precision == "f32" { 4 } else { 8 };
    let padded = |reals: u64, words: u64| (reals * real + words * 4).next_multiple_of(real);
    let bytes = match of.split('<').next()? {
        "Plain" => padded(3, 0),
        "SurfaceSlot" => padded(15, 3),
        "Patch" => padded(13, 2),
        "Parallelepiped" => padded(12, 0),
        "GridSlot" => padded(12, 5),
        "u32" => 4,
        other => panic!("a table of {other}"),
    };
    Some(bytes * count.parse::<u64>().expect("a number"))
}

#[test]
fn bake_writes_tables_alone() {
    let folder = Folder::new();
    let to_stdout = folder.done("bake scene.toml --precision f32 --rust - --quiet");
    folder.done("bake scene.toml --precision f32 --rust tables.rs");
    assert!(to_stdout.stdout == folder.text("tables.rs").as_bytes() && to_stdout.stderr.is_empty());
    folder.fails("bake scene.toml", 2, &["--rust"]);
    folder.fails("bake scene.toml --rust a.rs -o b.rs", 2, &["--rust"]);
    folder.fails("bake scene.toml --rust scene.toml", 2, &["replace an input"]);
    folder.fails("bake scene.toml --rust a.h --c a.h", 2, &["--rust", "--c"]);
    folder.fails("bake scene.toml --c scene.toml", 2, &["replace an input"]);
    folder.fails("bake scene.toml --rust - --c -", 2, &["standard output"]);
    folder.fails("bake scene.toml --rust a.rs --limit arena-bytes=10", 4, &["10"]);
}
