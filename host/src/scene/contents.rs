//! What a scene, or a group of it, holds: surfaces from files and generators, polygons, and other groups.
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use serde::Deserialize;
use toml::Spanned;

use super::check::Check;
use super::error::InputError;
use super::generator::{CylinderTable, Shape, SphereTable, TorusTable};
use super::nearest::did_you_mean;
use super::polygon::{Polygon, PolygonTable};
use super::transform::{self, StepTable, Transform};

/// The lists `surfaces` and `polygons` of a scene or of a group.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contents {
    /// The list `surfaces`.
    pub surfaces: Vec<Entry>,
    /// The list `polygons`, each with the index of its material; `None` where it names none.
    pub polygons: Vec<(Polygon, Option<usize>)>,
}

/// An entry of `surfaces`.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The surfaces.
    pub what: What,
    /// Where they are put.
    pub transform: Transform,
    /// The index, among the named ones, of the material of all that has none of its own; `None` where none is named.
    pub material: Option<usize>,
    /// The bytes of the scene file that say what the surfaces are.
    pub span: Range<usize>,
}

/// Where the surfaces of an entry come from.
#[derive(Clone, Debug, PartialEq)]
pub enum What {
    /// A patch file, as written; taken from the folder of the scene file.
    File(PathBuf),
    /// A generator.
    Shape(Shape),
    /// A group, by its index.
    Group(usize),
}

/// How deep groups may be nested.
const MAX_NESTING: usize = 32;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EntryTable {
    file: Option<Spanned<String>>,
    torus: Option<Spanned<TorusTable>>,
    sphere: Option<Spanned<SphereTable>>,
    cylinder: Option<Spanned<CylinderTable>>,
    group: Option<Spanned<String>>,
    material: Option<Spanned<String>>,
    transform: Option<Vec<Spanned<StepTable>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GroupTable {
    surfaces: Option<Vec<Spanned<EntryTable>>>,
    polygons: Option<Vec<PolygonTable>>,
}

/// The names that entries may use, each with its index in order.
pub(super) struct Names<'a> {
    pub(super) materials: Vec<&'a str>,
    pub(super) groups: Vec<&'a str>,
}

/// The index of `name` in `known`, which are all of the kind `what`.
fn resolve(what: &str, name: &Spanned<String>, known: &[&str], check: &Check) -> Result<usize, InputError> {
    let found = known.iter().position(|known| known == name.get_ref());
    found.ok_or_else(|| {
        let guess = did_you_mean(name.get_ref(), known).unwrap_or_default();
        let help = match known {
            [] => format!("add a table `[{what}s.{}]`", name.get_ref()),
            _ => format!("write one of {}, or add a table `[{what}s.{}]`", known.join(", "), name.get_ref()),
        };
        check.source.refuse(name.span(), format!("there is no {what} `{}`{guess}", name.get_ref()), "unknown", help)
    })
}

impl Contents {
    pub(super) fn check(
        surfaces: &[Spanned<EntryTable>],
        polygons: &[PolygonTable],
        names: &Names,
        check: &Check,
    ) -> Result<Self, InputError> {
        let material = |name: &Option<Spanned<String>>| {
            name.as_ref().map(|name| resolve("material", name, &names.materials, check)).transpose()
        };
        let entry = |table: &Spanned<EntryTable>| -> Result<Entry, InputError> {
            let (what, span) = what(table, names, check)?;
            let EntryTable { material: name, transform, .. } = table.get_ref();
            let transform = transform::check(transform.as_deref().unwrap_or_default(), check)?;
            Ok(Entry { what, transform, material: material(name)?, span })
        };
        let polygon =
            |table: &PolygonTable| -> Result<_, InputError> { Ok((table.check(check)?, material(&table.material)?)) };
        Ok(Contents {
            surfaces: surfaces.iter().map(entry).collect::<Result<_, _>>()?,
            polygons: polygons.iter().map(polygon).collect::<Result<_, _>>()?,
        })
    }
}

/// Where the surfaces of an entry come from, and the bytes that say so.
fn what(table: &Spanned<EntryTable>, names: &Names, check: &Check) -> Result<(What, Range<usize>), InputError> {
    let EntryTable { file, torus, sphere, cylinder, group, .. } = table.get_ref();
    let mut all = Vec::new();
    if let Some(file) = file {
        all.push((What::File(file.get_ref().into()), file.span()));
    }
    if let Some(torus) = torus {
        all.push((What::Shape(torus.get_ref().check(check)?), torus.span()));
    }
    if let Some(sphere) = sphere {
        all.push((What::Shape(sphere.get_ref().check(check)?), sphere.span()));
    }
    if let Some(cylinder) = cylinder {
        all.push((What::Shape(cylinder.get_ref().check(check)?), cylinder.span()));
    }
    if let Some(group) = group {
        all.push((What::Group(resolve("group", group, &names.groups, check)?), group.span()));
    }
    let only = if all.len() == 1 { all.pop() } else { None };
    only.ok_or_else(|| {
        let message = if all.is_empty() {
            "this entry of `surfaces` names none"
        } else {
            "this entry of `surfaces` names more than one thing"
        };
        let help = "give each entry one of `file`, `torus`, `sphere`, `cylinder` and `group`";
        check.source.refuse(table.span(), message, "this entry", help)
    })
}

/// The contents of the groups in their order, none of which holds itself, however deep.
pub(super) fn groups(
    tables: &BTreeMap<Spanned<String>, GroupTable>,
    names: &Names,
    check: &Check,
) -> Result<Vec<Contents>, InputError> {
    let mut groups = Vec::new();
    for (name, GroupTable { surfaces, polygons }) in tables {
        let (surfaces, polygons) = (surfaces.as_deref().unwrap_or_default(), polygons.as_deref().unwrap_or_default());
        if surfaces.is_empty() && polygons.is_empty() {
            return Err(check.source.refuse(
                name.span(),
                format!("the group `{}` is empty", name.get_ref()),
                "this group",
                "give it `surfaces` or `polygons`, or remove it",
            ));
        }
        groups.push(Contents::check(surfaces, polygons, names, check)?);
    }
    let mut nesting = Nesting { groups: &groups, names, check, heights: vec![Height::Unknown; groups.len()] };
    for group in 0..groups.len() {
        nesting.height(group, 1)?;
    }
    Ok(groups)
}

/// How many groups are nested in a group, itself included.
#[derive(Clone, Copy, Debug)]
enum Height {
    Unknown,
    /// It is being counted: meeting it again is a cycle.
    Open,
    Known(usize),
}

/// The search for groups that hold themselves, or are nested too deep.
struct Nesting<'a> {
    groups: &'a [Contents],
    names: &'a Names<'a>,
    check: &'a Check<'a>,
    heights: Vec<Height>,
}

impl Nesting<'_> {
    /// The height of a group that `depth` groups hold, itself included. It ends since `depth` is bounded.
    fn height(&mut self, group: usize, depth: usize) -> Result<usize, InputError> {
        self.heights[group] = Height::Open;
        let mut height = 1;
        for entry in &self.groups[group].surfaces {
            let What::Group(inner) = entry.what else {
                continue;
            };
            let refuse = |message: String, help: &str| {
                Err(self.check.source.refuse(entry.span.clone(), message, "this group", help))
            };
            let below = match self.heights[inner] {
                Height::Open => {
                    let name = self.names.groups.get(inner).copied().unwrap_or_default();
                    let help = "leave it out here, or put what both need into a group of its own";
                    return refuse(format!("the group `{name}` holds itself"), help);
                }
                Height::Known(height) => height,
                Height::Unknown if depth < MAX_NESTING => self.height(inner, depth + 1)?,
                Height::Unknown => MAX_NESTING,
            };
            if depth + below > MAX_NESTING {
                let help = "put the contents of one group into the one that holds it";
                return refuse(format!("groups are nested deeper than {MAX_NESTING}"), help);
            }
            height = height.max(below + 1);
        }
        self.heights[group] = Height::Known(height);
        Ok(height)
    }
}
