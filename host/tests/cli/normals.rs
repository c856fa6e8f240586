//! Where surfaces have no normal: in answers no numbers, in pictures no speck.

use patchray_host::scene::bpt;
use patchray_host::scene::model::Model;
use patchray_host::scene::revolution::{Arcs, Curve, revolve};
use patchray_host::scene::shapes::sphere;

use super::{Folder, METHODS, PREDICTED, fields, printed};

/// A cone of four surfaces about the z axis, its apex at the height of 1 as its base is at −1.
fn cone() -> Model {
    let profile = Curve::segment(1, [0.0, 1.0], [1.0, -1.0]);
    Model::numbered(revolve(&profile, &Curve::circle(Arcs::Rational, 0.0, 360.0, 4)))
}

#[test]
fn an_apex_has_no_normal_in_answers_and_a_pole_has() {
    let folder = Folder::new();
    folder.put("cone.bpt", bpt::write(&cone()));
    folder.put("sphere.bpt", bpt::write(&sphere([0.0; 3], 1.0)));
    // Onto the point (0, 0, 1), and beside it onto the cone.
    let rays = "ox,oy,oz,dx,dy,dz\n0,0,3,0,0,-1\n0.5,0,3,-0.25,0,-1\n-0.375,0.75,4,0.125,-0.25,-1\n0.25,0,3,0,0,-1\n";
    folder.put("rays.csv", rays);
    for precision in ["f32", "f64"] {
        for method in METHODS {
            let flags = format!("rays.csv --method {method} --precision {precision} --flatness 0.01");
            let answers = printed(&folder.done(&format!("query cone.bpt {flags}")));
            let lines: Vec<_> = answers.lines().skip(1).map(fields).collect();
            for line in &lines[..3] {
                assert_eq!((line[1], &line[6..9]), ("1", &[""; 3][..]), "{flags}: {line:?}");
            }
            let normal: Vec<f64> = lines[3][6..9].iter().map(|c| c.parse().expect("a number")).collect();
            let [radial, up] = [2.0, 1.0].map(|c: f64| c / 5.0_f64.sqrt());
            assert!((normal[0].abs() - radial).abs() + (normal[2].abs() - up).abs() < 1e-5, "{flags}: {normal:?}");

            let answers = printed(&folder.done(&format!("query sphere.bpt {flags}")));
            for line in answers.lines().skip(1).take(3) {
                let up: f64 = fields(line)[8].parse().expect("a number");
                assert!((up.abs() - 1.0).abs() < 1e-5, "{flags}: {line}");
            }
        }
    }
}

#[test]
fn the_tip_of_a_cone_is_no_speck_in_its_picture() {
    let folder = Folder::new();
    folder.put("cone.bpt", bpt::write(&cone()));
    // The ray of the middle meets the tip, of which all sides are seen; light comes from one side, or from the eye.
    for (eye, light) in [("0, 0, 6", "5, 3, 8"), ("0, 0, 6", "0, 0, 6"), ("1, -1.2, 6", "5, 3, 8")] {
        for material in ["highlight = 0.6", "metal = \"gold\"", "reflect = 0.5"] {
            let camera = format!("eye = [{eye}]\nlook_at = [0, 0, 1]\nup = [0, 1, 0]\nfov = 10\n");
            let scene = format!(
                "surfaces = [{{ file = \"cone.bpt\" }}]\nbackground = [0.2, 0.3, 0.4]\n[image]\nsize = [9, 9]\n\
                 [camera]\n{camera}[light]\nposition = [{light}]\nshadow = \"rays\"\n[material]\n{material}\n"
            );
            folder.put("cone.toml", scene);
            for flags in METHODS.iter().chain(&PREDICTED).flat_map(|m| ["f32", "f64"].map(|p| [*m, p])) {
                let [method, precision] = flags;
                folder.done(&format!("render cone.toml -o o.png --method {method} --precision {precision}"));
                let picture = image::open(folder.path("o.png")).expect("a picture").to_rgb8();
                for channel in 0..3 {
                    let at = |x: u32, y: u32| i32::from(picture.get_pixel(x, y).0[channel]);
                    let around: Vec<i32> = (0..9).filter(|k| *k != 4).map(|k| at(3 + k % 3, 3 + k / 3)).collect();
                    let (least, most) = (around.iter().min().expect("eight"), around.iter().max().expect("eight"));
                    let tip = at(4, 4);
                    assert!(
                        (least - 6..=most + 6).contains(&tip),
                        "{eye} {light} {material} {flags:?}: {tip} among {around:?}"
                    );
                }
            }
        }
    }
}
