//! A scene prepared through the C interface, and the arguments of its next call.

use super::field::{Call, Field};
use crate::bytes::Bytes;
use crate::common::{Kind, lower};
use crate::input::{Case, limits, subdivision};
use crate::lent::{Arguments, InC, Method, WORDS, no_memory};
use crate::scribble::{Slot, scribble};
use patchray::capi::*;
use patchray::frame::PADDING;
use patchray::limits::{Acceptance, Limits};
use patchray::method::Remembered;
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use std::ops::Range;

/// Few, so that all fits into a field.
pub(super) const VOXELS: u32 = 256;
const PATCHES: u32 = 40;

/// The functions by their numbers; from `METHODS` on those of one ray, then these.
const METHODS: usize = 3;
pub(super) const ALL_HITS: usize = METHODS + 6;

pub(super) struct Prepared<P: InC> {
    nets: *mut patchray_net<P::Scalar>,
    nets_len: usize,
    pub(super) options: *mut patchray_options<P::Scalar>,
    pub(super) scene_memory: *mut patchray_scene_memory<P::Scalar>,
    pub(super) scene: *mut patchray_scene<P::Scalar>,
    pub(super) patches_memory: *mut patchray_patches_memory<P::Scalar>,
    pub(super) patches: *mut patchray_patches<P::Scalar>,
    tree: *mut patchray_tree<P::Scalar>,
    pub(super) grids_memory: *mut patchray_grids_memory<P::Scalar>,
    grids: *mut patchray_grids<P::Scalar>,
    pub(super) scratch: *mut u64,
    pub(super) scratch_words: usize,
    pub(super) memory: *mut patchray_remembered<P::Scalar>,
    pub(super) memory_len: usize,
    pub(super) scan_line: u32,
    pub(super) ray: *mut patchray_ray<P::Scalar>,
    pub(super) limits: *mut patchray_limits<P::Scalar>,
    pub(super) hit: *mut patchray_hit<P::Scalar>,
    pub(super) work: *mut patchray_work,
    pub(super) hits: *mut patchray_hit<P::Scalar>,
    pub(super) hits_len: usize,
    pub(super) found: *mut usize,
    pub(super) normal: *mut [P::Scalar; 3],
    /// The preparation that was refused, and why; none follow it.
    pub(super) stopped: Option<(usize, i32)>,
    /// What a call may write, once its arguments are spoilt.
    pub(super) written: Vec<Range<usize>>,
}

/// The method of a function.
pub(super) fn method<P: InC>(function: usize) -> Option<Method<P::Scalar>> {
    function.checked_sub(METHODS).and_then(|number| P::METHODS.into_iter().nth(number))
}

/// Limits as C has them, which takes none with which nothing is found.
pub(super) fn limits_in_c<S: Scalar>(limits: &Limits<S>) -> patchray_limits<S> {
    patchray_limits {
        tolerance: limits.tolerance.abs(),
        critical_factor: limits.critical_factor,
        clip_threshold: limits.clip_threshold,
        newton_iterations: limits.newton_iterations.max(1),
        newton_starts: limits.newton_starts.clamp(1, 3),
        newton_halvings: limits.newton_halvings,
        acceptance: match limits.acceptance {
            Acceptance::Paper => PATCHRAY_ACCEPTANCE_PAPER,
            Acceptance::Proved => PATCHRAY_ACCEPTANCE_PROVED,
        },
        surfaces: limits.surfaces,
        nodes: limits.nodes,
        patches: limits.patches,
        voxels: limits.voxels,
        spans: limits.spans,
        newton_steps: limits.newton_steps,
        clip_steps: limits.clip_steps,
        bisections: limits.bisections,
        pending_domains: limits.pending_domains,
    }
}

/// Numbers as words of any bits.
///
/// # Safety
/// So many can be read and written there, and hold numbers of 4 or 8 bytes and nothing else.
pub(super) unsafe fn words<'w, T>(place: *mut T, count: usize) -> &'w mut [u32] {
    if place.is_null() {
        // Of a table that this function does not take.
        return &mut [];
    }
    // SAFETY: the caller's.
    unsafe { std::slice::from_raw_parts_mut(place.cast(), count * size_of::<T>() / 4) }
}

impl<P: InC + Kind + Slot> Prepared<P> {
    /// What a function takes, in a field; `None` if the field does not hold it.
    pub(super) fn of(case: &Case, function: usize, field: &mut Field, bytes: &mut Bytes<'_>) -> Option<Self> {
        let surfaces = case.model.surfaces.len();
        let mut nets = vec![];
        for surface in &case.model.surfaces {
            let points = lower::<P>(surface, 1.0);
            let place = field.take::<P>(points.len())?;
            // SAFETY: there is a place for as many.
            unsafe { place.copy_from_nonoverlapping(points.as_ptr(), points.len()) };
            nets.push(patchray_net {
                points: place.cast::<P::Scalar>().cast_const(),
                points_len: points.len() * (size_of::<P>() / size_of::<P::Scalar>()),
                degree_u: surface.degree_u as u32,
                degree_v: surface.degree_v as u32,
            });
        }
        let in_field = field.take::<patchray_net<P::Scalar>>(surfaces)?;
        // SAFETY: there is a place for as many.
        unsafe { in_field.copy_from_nonoverlapping(nets.as_ptr(), surfaces) };
        let of_patches = subdivision::<P::Scalar>(bytes);
        let line = case.ray(bytes);
        let [origin, direction] = [line.origin, line.direction].map(|v| v.map(P::Scalar::from_f64));
        let [t_min, t_max] = [line.t_min, line.t_max].map(P::Scalar::from_f64);
        let limits = limits_in_c(&limits::<P::Scalar>(bytes));
        let (of_scene, of_cut, of_grids) = no_memory::<P::Scalar>();
        let scratch_words = if bytes.rarely(4) { PATCHRAY_CLIP_CUBIC_WORDS_F64 } else { WORDS };
        let hits_len = bytes.below(5);
        // SAFETY: plain numbers, and addresses that are null.
        let mut prepared = unsafe {
            Prepared {
                nets: in_field,
                nets_len: surfaces,
                options: field.put(core::mem::zeroed())?,
                scene_memory: field.put(of_scene)?,
                scene: field.put(core::mem::zeroed())?,
                patches_memory: field.put(of_cut)?,
                patches: field.put(core::mem::zeroed())?,
                tree: field.put(core::mem::zeroed())?,
                grids_memory: field.put(of_grids)?,
                grids: field.put(core::mem::zeroed())?,
                scratch: field.take(scratch_words)?,
                scratch_words,
                memory: field.take(surfaces)?,
                memory_len: surfaces,
                scan_line: bytes.count().min(u32::MAX - 1),
                ray: field.put(patchray_ray { origin, direction, t_min, t_max })?,
                limits: field.put(limits)?,
                hit: field.put(core::mem::zeroed())?,
                work: field.put(core::mem::zeroed())?,
                hits: field.take(hits_len)?,
                hits_len,
                found: field.put(0)?,
                normal: field.put([P::Scalar::ZERO; 3])?,
                stopped: None,
                written: vec![],
            }
        };
        // SAFETY: all is in its place.
        unsafe {
            core::slice::from_raw_parts_mut(prepared.memory.cast(), surfaces).fill(Remembered::<P::Scalar>::EMPTY);
            scribble(bytes, core::slice::from_raw_parts_mut(prepared.memory.cast::<Remembered<P::Scalar>>(), surfaces));
            assert_eq!(PATCHRAY_OK, P::OPTIONS(prepared.options));
            let options = &mut *prepared.options;
            (options.flatness, options.depth) = (of_patches.flatness, of_patches.depth);
            (options.scene_voxels, options.grid_voxels, options.patches_per_surface) = (VOXELS, VOXELS, PATCHES);
            let hit = &mut *prepared.hit;
            [hit.u, hit.v] = [0; 2].map(|_| P::Scalar::from_f64(f64::from(bytes.byte()) / 255.0));
            hit.surface = bytes.below(8) as u32 % surfaces as u32;
        }
        prepared.build(function, field)?;
        Some(prepared)
    }

    /// The preparations before a function; if it is one itself, the memory for it.
    fn build(&mut self, function: usize, field: &mut Field) -> Option<()> {
        let method = method::<P>(function);
        let with_patches = method.as_ref().is_some_and(|method| method.patches);
        let with_grids = method.as_ref().is_some_and(|method| method.grids);
        let steps = [true, with_patches || matches!(function, 1 | 2), with_grids || function == 2];
        for step in (0..3).filter(|&step| steps[step]) {
            // SAFETY: all is in its place, and what is not lent is null.
            let mut code = unsafe { self.call(step) };
            if code == PATCHRAY_MEMORY {
                self.lend(step, field)?;
                if step == function {
                    return Some(());
                }
                // SAFETY: likewise.
                code = unsafe { self.call(step) };
                assert_eq!(code, PATCHRAY_OK, "preparation {step} with what it asked for");
            } else {
                self.stopped = Some((step, code));
                return Some(());
            }
        }
        Some(())
    }

    /// Lends a preparation what it asked for.
    fn lend(&mut self, step: usize, field: &mut Field) -> Option<()> {
        // SAFETY: the structs are in their places.
        let (of_scene, of_cut, of_grids) =
            unsafe { (&mut *self.scene_memory, &mut *self.patches_memory, &mut *self.grids_memory) };
        match step {
            0 => {
                of_scene.points =
                    field.take::<P>(of_scene.points_len / (size_of::<P>() / size_of::<P::Scalar>()))?.cast();
                of_scene.surfaces = field.take(of_scene.surfaces_len)?;
                of_scene.offsets = field.take(of_scene.offsets_len)?;
                of_scene.references = field.take(of_scene.references_len)?;
            }
            1 => {
                of_cut.patches = field.take(of_cut.patches_len)?;
                of_cut.first = field.take(of_cut.first_len)?;
                of_cut.nodes = field.take(of_cut.nodes_len)?;
                of_cut.links = field.take(of_cut.links_len)?;
            }
            _ => {
                of_grids.grids = field.take(of_grids.grids_len)?;
                of_grids.offsets = field.take(of_grids.offsets_len)?;
                of_grids.references = field.take(of_grids.references_len)?;
            }
        }
        Some(())
    }

    /// Calls a function.
    ///
    /// # Safety
    /// Its arguments are in their places.
    pub(super) unsafe fn call(&self, function: usize) -> i32 {
        // SAFETY: the caller's.
        unsafe {
            match function {
                0 => P::SCENE(self.nets, self.nets_len, self.options, self.scene_memory, self.scene),
                1 => P::PATCHES(
                    self.scene,
                    self.options,
                    self.scratch,
                    self.scratch_words,
                    self.patches_memory,
                    self.patches,
                    self.tree,
                ),
                2 => P::GRIDS(self.patches, self.options, self.grids_memory, self.grids),
                ALL_HITS => P::ALL(
                    self.scene,
                    self.ray,
                    self.limits,
                    self.scratch,
                    self.scratch_words,
                    self.hits,
                    self.hits_len,
                    self.found,
                    self.work,
                ),
                _ => match method::<P>(function) {
                    Some(method) => (method.call)(&Arguments {
                        scene: self.scene,
                        patches: self.patches,
                        tree: self.tree,
                        grids: self.grids,
                        memory: self.memory,
                        memory_len: self.memory_len,
                        line: self.scan_line,
                        ray: self.ray,
                        limits: self.limits,
                        scratch: self.scratch,
                        words: self.scratch_words,
                        hit: self.hit,
                        work: self.work,
                    }),
                    None => P::NORMAL(self.scene, self.hit, self.normal),
                },
            }
        }
    }

    /// Any bits in what calls read, but for addresses and counts; sizes and budgets stay small.
    pub(super) fn scribble(&mut self, bytes: &mut Bytes<'_>) {
        for _ in 0..bytes.below(5) {
            // SAFETY: all is in its place, and of numbers.
            unsafe {
                let (scene, patches, tree, grids) =
                    (&mut *self.scene, &mut *self.patches, &mut *self.tree, &mut *self.grids);
                let net = self.nets.add(bytes.below(8) % self.nets_len);
                let any = match bytes.below(20) {
                    0 => words(self.options, 1),
                    1 => words(self.ray, 1),
                    2 => words(self.limits, 1),
                    3 => words(self.memory, self.memory_len),
                    4 => words(self.hit, 1),
                    5 => words((*net).points.cast_mut(), (*net).points_len),
                    6 => words(&raw mut (*net).degree_u, 2),
                    7 => words(&raw mut scene.layout, 1),
                    8 => words(&raw mut scene.frame, 1),
                    9 => words(&raw mut scene.grid, 1),
                    10 => words(scene.points.cast_mut(), scene.points_len),
                    11 => words(scene.surfaces.cast_mut(), scene.surfaces_len),
                    12 => words(scene.offsets.cast_mut(), scene.offsets_len),
                    13 => words(scene.references.cast_mut(), scene.references_len),
                    14 => words(patches.patches.cast_mut(), patches.patches_len),
                    15 => words(patches.first.cast_mut(), patches.first_len),
                    16 => words(tree.nodes.cast_mut(), tree.nodes_len),
                    17 => words(tree.links.cast_mut(), tree.links_len),
                    18 => words(grids.grids.cast_mut(), grids.grids_len),
                    _ => words(grids.offsets.cast_mut(), grids.offsets_len),
                };
                scribble(bytes, any);
            }
        }
        // SAFETY: both are in their places.
        let (options, limits) = unsafe { (&mut *self.options, &mut *self.limits) };
        options.scene_voxels = options.scene_voxels.min(VOXELS);
        options.grid_voxels = options.grid_voxels.min(VOXELS);
        options.patches_per_surface = options.patches_per_surface.min(PATCHES);
        for budget in [
            &mut limits.surfaces,
            &mut limits.nodes,
            &mut limits.patches,
            &mut limits.voxels,
            &mut limits.spans,
            &mut limits.newton_steps,
            &mut limits.clip_steps,
            &mut limits.bisections,
        ] {
            *budget = (*budget).min(300);
        }
    }

    /// Other addresses and counts for a function.
    pub(super) fn spoil(&mut self, function: usize, call: &mut Call<'_, '_, '_>) {
        // SAFETY: structs that hold addresses are in their places.
        unsafe {
            match function {
                0 => {
                    for k in 0..self.nets_len {
                        let net = &mut *self.nets.add(k);
                        let (points, len) = call.slots::<_, P>(net.points.cast_mut(), net.points_len, false);
                        (net.points, net.points_len) = (points, len);
                    }
                    let memory = &mut *self.scene_memory;
                    (memory.points, memory.points_len) = call.slots::<_, P>(memory.points, memory.points_len, true);
                    (memory.surfaces, memory.surfaces_len) = call.many(memory.surfaces, memory.surfaces_len, true);
                    (memory.offsets, memory.offsets_len) = call.many(memory.offsets, memory.offsets_len, true);
                    (memory.references, memory.references_len) =
                        call.many(memory.references, memory.references_len, true);
                    self.nets = call.holder_of(self.nets, self.nets_len);
                    self.options = call.bounds_if_any(self.options);
                    self.scene_memory = call.holder(self.scene_memory, true);
                    self.scene = call.one(self.scene, true);
                }
                1 => {
                    self.spoil_scene(call);
                    self.options = call.bounds_if_any(self.options);
                    (self.scratch, self.scratch_words) = call.many(self.scratch, self.scratch_words, true);
                    let memory = &mut *self.patches_memory;
                    (memory.patches, memory.patches_len) = call.many(memory.patches, memory.patches_len, true);
                    (memory.first, memory.first_len) = call.many(memory.first, memory.first_len, true);
                    (memory.nodes, memory.nodes_len) = call.many(memory.nodes, memory.nodes_len, true);
                    (memory.links, memory.links_len) = call.many(memory.links, memory.links_len, true);
                    self.patches_memory = call.holder(self.patches_memory, true);
                    self.patches = call.one(self.patches, true);
                    self.tree = call.one_if_any(self.tree, true);
                }
                2 => {
                    self.spoil_patches(call);
                    self.options = call.bounds_if_any(self.options);
                    let memory = &mut *self.grids_memory;
                    (memory.grids, memory.grids_len) = call.many(memory.grids, memory.grids_len, true);
                    (memory.offsets, memory.offsets_len) = call.many(memory.offsets, memory.offsets_len, true);
                    (memory.references, memory.references_len) =
                        call.many(memory.references, memory.references_len, true);
                    self.grids_memory = call.holder(self.grids_memory, true);
                    self.grids = call.one(self.grids, true);
                }
                _ => self.spoil_trace(function, call),
            }
        }
        self.written = call.written();
    }

    /// # Safety
    /// Structs that hold addresses are in their places, here and below.
    unsafe fn spoil_trace(&mut self, function: usize, call: &mut Call<'_, '_, '_>) {
        let method = method::<P>(function);
        // SAFETY: the caller's.
        unsafe {
            self.spoil_scene(call);
            if let Some(method) = &method {
                if method.patches {
                    self.spoil_patches(call);
                }
                if method.tree {
                    let tree = &mut *self.tree;
                    let (nodes, len) = call.many(tree.nodes.cast_mut(), tree.nodes_len, false);
                    (tree.nodes, tree.nodes_len) = (nodes, len);
                    let (links, len) = call.many(tree.links.cast_mut(), tree.links_len, false);
                    (tree.links, tree.links_len) = (links, len);
                    self.tree = call.holder(self.tree, false);
                }
                if method.grids {
                    let grids = &mut *self.grids;
                    let (slots, len) = call.many(grids.grids.cast_mut(), grids.grids_len, false);
                    (grids.grids, grids.grids_len) = (slots, len);
                    let (offsets, len) = call.many(grids.offsets.cast_mut(), grids.offsets_len, false);
                    (grids.offsets, grids.offsets_len) = (offsets, len);
                    let (references, len) = call.many(grids.references.cast_mut(), grids.references_len, false);
                    (grids.references, grids.references_len) = (references, len);
                    self.grids = call.holder(self.grids, false);
                    (self.memory, self.memory_len) = call.many(self.memory, self.memory_len, true);
                }
            }
            if method.is_none() && function != ALL_HITS {
                self.hit = call.one(self.hit, false);
                self.normal = call.one(self.normal, true);
                return;
            }
        }
        self.ray = call.one(self.ray, false);
        self.limits = call.bounds_if_any(self.limits);
        (self.scratch, self.scratch_words) = call.many(self.scratch, self.scratch_words, true);
        if function == ALL_HITS {
            (self.hits, self.hits_len) = call.many(self.hits, self.hits_len, true);
            self.found = call.one(self.found, true);
        } else {
            self.hit = call.one(self.hit, true);
        }
        self.work = call.one_if_any(self.work, true);
    }

    /// # Safety
    /// See [`Prepared::spoil_trace`].
    pub(super) unsafe fn spoil_scene(&mut self, call: &mut Call<'_, '_, '_>) {
        // SAFETY: the caller's.
        let scene = unsafe { &mut *self.scene };
        let (points, len) = call.slots::<_, P>(scene.points.cast_mut(), scene.points_len, false);
        (scene.points, scene.points_len) = (points, len);
        let (surfaces, len) = call.many(scene.surfaces.cast_mut(), scene.surfaces_len, false);
        (scene.surfaces, scene.surfaces_len) = (surfaces, len);
        let (offsets, len) = call.many(scene.offsets.cast_mut(), scene.offsets_len, false);
        (scene.offsets, scene.offsets_len) = (offsets, len);
        let (references, len) = call.many(scene.references.cast_mut(), scene.references_len, false);
        (scene.references, scene.references_len) = (references, len);
        self.scene = call.holder(self.scene, false);
    }

    /// # Safety
    /// See [`Prepared::spoil_trace`].
    pub(super) unsafe fn spoil_patches(&mut self, call: &mut Call<'_, '_, '_>) {
        // SAFETY: the caller's.
        let patches = unsafe { &mut *self.patches };
        let (slots, len) = call.many(patches.patches.cast_mut(), patches.patches_len, false);
        (patches.patches, patches.patches_len) = (slots, len);
        let (first, len) = call.many(patches.first.cast_mut(), patches.first_len, false);
        (patches.first, patches.first_len) = (first, len);
        self.patches = call.holder(self.patches, false);
    }

    /// How surfaces are divided.
    ///
    /// # Safety
    /// Options are in their place.
    pub(super) unsafe fn subdivision(&self) -> Subdivision<P::Scalar> {
        // SAFETY: the caller's.
        let &patchray_options { flatness, depth, patches_per_surface, .. } = unsafe { &*self.options };
        Subdivision { flatness, depth, patches_per_surface, padding: PADDING }
    }

    /// Where a preparation that is refused names the surface.
    pub(super) fn says_why(&self, function: usize) -> Option<Range<usize>> {
        let (begin, size) = match function {
            0 => (self.scene_memory.addr(), size_of::<patchray_scene_memory<P::Scalar>>()),
            1 => (self.patches_memory.addr(), size_of::<patchray_patches_memory<P::Scalar>>()),
            _ => return None,
        };
        Some(begin..begin + size)
    }

    /// No counter of an answer is beyond its budget.
    pub(super) fn within_limits(&self, function: usize) {
        if !(METHODS..=ALL_HITS).contains(&function) || self.work.is_null() || self.limits.is_null() {
            return;
        }
        // SAFETY: the call had them read and written there.
        unsafe { within(&*self.work, &*self.limits) };
    }
}

/// No counter is beyond its budget.
pub(super) fn within<S: Scalar>(work: &patchray_work, limits: &patchray_limits<S>) {
    for (count, budget) in [
        (work.surfaces_tested, limits.surfaces),
        (work.nodes_visited, limits.nodes),
        (work.patches_tested, limits.patches),
        (work.voxels_visited, limits.voxels),
        (work.spans_visited, limits.spans),
        (work.newton_steps, limits.newton_steps),
        (work.clip_steps, limits.clip_steps),
        (work.bisections, limits.bisections),
    ] {
        assert!(count <= budget, "{work:?}, by {limits:?}");
    }
}
