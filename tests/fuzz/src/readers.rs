//! The readers of patch files, scenes and rays: text of any kind is read or refused, never more than refused.

use crate::bytes::Bytes;
use patchray::bernstein::MAX_DEGREE;
use patchray_host::scene::error::{InputError, OnInvalid};
use patchray_host::scene::model::Model;
use patchray_host::scene::{bpt, file, nurbs_python, rays};
use std::cell::RefCell;
use std::io::{Seek, SeekFrom, Write};

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let kind = bytes.byte();
    let on_invalid = if kind & 64 == 0 { OnInvalid::Skip } else { OnInvalid::Refuse };
    let text = String::from_utf8_lossy(bytes.rest());
    match kind % 4 {
        0 => {
            if let Some(file) = shown(bpt::parse("any.bpt", &text, on_invalid)) {
                valid(&file.model);
                again(&file.model);
            }
        }
        1 => {
            if let Some(file) = shown(nurbs_python::parse("any.json", &text, on_invalid)) {
                valid(&file.model);
            }
        }
        2 => scene(&text),
        _ => {
            if let Some(batch) = shown(rays::parse("any.csv", &text, on_invalid)) {
                assert!(batch.rays.len() <= text.lines().count());
                let invalid = batch.rays.iter().filter(|ray| !ray.valid).count();
                assert_eq!(invalid, batch.invalid);
                assert_eq!(batch.first_invalid.is_some(), invalid > 0);
                for ray in batch.rays.iter().filter(|ray| ray.valid) {
                    assert!(ray.origin.iter().chain(&ray.direction).all(|c| c.is_finite()) && ray.t_min <= ray.t_max);
                }
            }
        }
    }
}

/// What was read; of a refusal it is asked that it can be shown, place and all.
fn shown<T>(read: Result<T, InputError>) -> Option<T> {
    match read {
        Ok(read) => Some(read),
        Err(error) => {
            let _ = error.place();
            let text = format!("{:?}", miette::Report::new(error));
            assert!(!text.is_empty());
            None
        }
    }
}

/// A model has surfaces of degrees that there are, with all their points, each of them finite.
fn valid(model: &Model) {
    for surface in &model.surfaces {
        let [n, m] = [surface.degree_u, surface.degree_v];
        assert!((1..=MAX_DEGREE).contains(&n) && (1..=MAX_DEGREE).contains(&m), "degrees {n} and {m}");
        assert_eq!(surface.points.len(), (n + 1) * (m + 1));
        assert!(surface.points.iter().flatten().all(|c| c.is_finite()));
        assert!(surface.points.iter().all(|&[.., w]| w > 0.0));
    }
}

/// What is written of a model is read as the same.
fn again(model: &Model) {
    if model.surfaces.is_empty() {
        return;
    }
    let text = bpt::write(model);
    let file = bpt::parse("again.bpt", &text, OnInvalid::Refuse).unwrap_or_else(|error| panic!("{error}:\n{text}"));
    let points = |model: &Model| model.surfaces.iter().map(|surface| surface.points.clone()).collect::<Vec<_>>();
    assert_eq!(points(&file.model), points(model));
}

/// A scene, with all that it generates. It lies in a folder without other files.
fn scene(text: &str) {
    thread_local! {
        static FILE: RefCell<Option<tempfile::NamedTempFile>> = const { RefCell::new(None) };
    }
    let _ = shown(file::parse("any.toml", text));
    FILE.with_borrow_mut(|slot| {
        let new = || tempfile::Builder::new().suffix(".toml").tempfile().expect("a file to write to");
        let file = slot.get_or_insert_with(new);
        let written = file.as_file_mut().set_len(0).and_then(|()| file.as_file_mut().seek(SeekFrom::Start(0)));
        written.and_then(|_| file.as_file_mut().write_all(text.as_bytes())).expect("the file can be written");
        if let Some(scene) = shown(file::read(file.path(), OnInvalid::Skip)) {
            valid(&scene.model);
        }
    });
}
