//! What calls return: 0 and 1 are answers, negative codes are reasons why there is none.

use crate::limits::Limit;
use crate::ray::RayError;
use crate::surface::NetError;
use crate::view::ViewError;
use core::ffi::{CStr, c_char};

/// What a call returns.
pub(super) type Code = i32;

/// A preparation is complete.
pub const PATCHRAY_OK: i32 = 0;
/// The ray meets nothing within its t_min to t_max.
pub const PATCHRAY_MISS: i32 = 0;
/// The ray meets a surface; where is said in the hit.
pub const PATCHRAY_HIT: i32 = 1;

/// An address that has to be given is NULL, or one that comes with a count other than 0.
pub const PATCHRAY_NULL: i32 = -1;
/// An address is not a multiple of what its type asks for.
pub const PATCHRAY_MISALIGNED: i32 = -2;
/// Memory that the call writes has bytes in common with other memory of the same call.
pub const PATCHRAY_OVERLAP: i32 = -3;
/// A count is so large that the memory would not fit into the address space.
pub const PATCHRAY_COUNT: i32 = -4;
/// A table was not made by this version of the library, for this precision and this kind of control points, or is not
/// filled at all.
pub const PATCHRAY_LAYOUT_DIFFERS: i32 = -5;
/// Lent memory has too few slots. After a preparation its counts say how many are needed; what it was lent is then not as it was
/// before, and no table that was made in it can be used any more.
pub const PATCHRAY_MEMORY: i32 = -6;
/// Scratch has too few words for the degrees of the surfaces.
pub const PATCHRAY_SCRATCH: i32 = -7;
/// More surfaces, control points, patches or voxels than can be numbered.
pub const PATCHRAY_TOO_LARGE: i32 = -8;
/// An option, a limit, or a number of a line or hit is NaN, or not one of the values that it may have.
pub const PATCHRAY_OPTION: i32 = -9;
/// Tables that do not belong together, such as patches of other surfaces than the scene has.
pub const PATCHRAY_TABLES: i32 = -10;

/// A surface's degree is not within 1 to 15.
pub const PATCHRAY_DEGREE: i32 = -11;
/// A surface's count of numbers is not that of its control points.
pub const PATCHRAY_POINTS: i32 = -12;
/// A control point has a coordinate or weight that is NaN or infinite.
pub const PATCHRAY_POINT_NOT_FINITE: i32 = -13;
/// A control point has a weight that is not positive.
pub const PATCHRAY_WEIGHT: i32 = -14;
/// A surface makes more patches than the options allow.
pub const PATCHRAY_PATCHES: i32 = -15;
/// A camera's three vectors lie in a plane, or all but.
pub const PATCHRAY_CAMERA_FLAT: i32 = -16;
/// A camera is farther away than eight times the scene's size: trace its rays one by one.
pub const PATCHRAY_CAMERA_FAR: i32 = -17;
/// A surface is so much smaller than its scene that the number type cannot hold both: by 2^103 in single precision, by 2^970 in
/// double.
pub const PATCHRAY_SMALL: i32 = -18;

/// A coordinate of the ray is NaN.
pub const PATCHRAY_RAY_NAN: i32 = -21;
/// A coordinate of the ray is infinite.
pub const PATCHRAY_RAY_INFINITE: i32 = -22;
/// The ray's direction is (0, 0, 0).
pub const PATCHRAY_RAY_DIRECTION: i32 = -23;
/// The ray's t in the scene, or small steps of it, cannot be held by the number type.
pub const PATCHRAY_RAY_RANGE: i32 = -24;
/// t_min or t_max is NaN, or t_min is the larger.
pub const PATCHRAY_RAY_INTERVAL: i32 = -25;
/// A ray of a view is more than 45 degrees off its camera's forward: to be traced by itself.
pub const PATCHRAY_RAY_OUT_OF_VIEW: i32 = -26;
/// A ray of a scan line is not within the line's x and y.
pub const PATCHRAY_RAY_OUT_OF_LINE: i32 = -27;

/// The budget of tested surfaces ran out. Of this and all below: neither a hit nor a miss.
pub const PATCHRAY_GAVE_UP_SURFACES: i32 = -41;
/// The budget of tree nodes ran out.
pub const PATCHRAY_GAVE_UP_NODES: i32 = -42;
/// The budget of tested patches ran out.
pub const PATCHRAY_GAVE_UP_PATCHES: i32 = -43;
/// The budget of voxels ran out.
pub const PATCHRAY_GAVE_UP_VOXELS: i32 = -44;
/// The budget of Newton iterations ran out.
pub const PATCHRAY_GAVE_UP_NEWTON_STEPS: i32 = -45;
/// The budget of clips ran out.
pub const PATCHRAY_GAVE_UP_CLIP_STEPS: i32 = -46;
/// The budget of bisections ran out.
pub const PATCHRAY_GAVE_UP_BISECTIONS: i32 = -47;
/// The room for domains that wait to be clipped ran out.
pub const PATCHRAY_GAVE_UP_PENDING_DOMAINS: i32 = -48;
/// The list of hits is full; it holds the closest ones.
pub const PATCHRAY_GAVE_UP_HITS: i32 = -49;
/// The budget of spans of a scan line ran out.
pub const PATCHRAY_GAVE_UP_SPANS: i32 = -50;

pub(super) fn of_limit(limit: Limit) -> Code {
    match limit {
        Limit::Surfaces => PATCHRAY_GAVE_UP_SURFACES,
        Limit::Nodes => PATCHRAY_GAVE_UP_NODES,
        Limit::Patches => PATCHRAY_GAVE_UP_PATCHES,
        Limit::Voxels => PATCHRAY_GAVE_UP_VOXELS,
        Limit::NewtonSteps => PATCHRAY_GAVE_UP_NEWTON_STEPS,
        Limit::ClipSteps => PATCHRAY_GAVE_UP_CLIP_STEPS,
        Limit::Bisections => PATCHRAY_GAVE_UP_BISECTIONS,
        Limit::PendingDomains => PATCHRAY_GAVE_UP_PENDING_DOMAINS,
        Limit::Hits => PATCHRAY_GAVE_UP_HITS,
        Limit::Scratch => PATCHRAY_SCRATCH,
        Limit::Memory => PATCHRAY_MEMORY,
        Limit::Spans => PATCHRAY_GAVE_UP_SPANS,
        Limit::Line => PATCHRAY_RAY_OUT_OF_LINE,
        Limit::Slot => PATCHRAY_TABLES,
    }
}

pub(super) fn of_ray(error: RayError) -> Code {
    match error {
        RayError::NotANumber => PATCHRAY_RAY_NAN,
        RayError::Infinite => PATCHRAY_RAY_INFINITE,
        RayError::ZeroDirection => PATCHRAY_RAY_DIRECTION,
        RayError::Unrepresentable => PATCHRAY_RAY_RANGE,
        RayError::OutOfView => PATCHRAY_RAY_OUT_OF_VIEW,
    }
}

pub(super) fn of_view(error: ViewError) -> Code {
    match error {
        ViewError::Memory(_) => PATCHRAY_MEMORY,
        ViewError::Ray(error) => of_ray(error),
        ViewError::Flat => PATCHRAY_CAMERA_FLAT,
        ViewError::Far | ViewError::Near => PATCHRAY_CAMERA_FAR,
        ViewError::Patches => PATCHRAY_TABLES,
        ViewError::TooLarge => PATCHRAY_TOO_LARGE,
    }
}

pub(super) fn of_net(error: NetError) -> Code {
    match error {
        NetError::DegreeU(_) | NetError::DegreeV(_) => PATCHRAY_DEGREE,
        NetError::Points(_) => PATCHRAY_POINTS,
        // Nets are given without origins of their own.
        NetError::NotFinite(_) | NetError::Origin => PATCHRAY_POINT_NOT_FINITE,
        NetError::Weight(_) => PATCHRAY_WEIGHT,
        NetError::Small => PATCHRAY_SMALL,
    }
}

/// A code's name, such as "PATCHRAY_OVERLAP": a string in constant memory, never NULL. 0 is "PATCHRAY_OK", which a miss is
/// too; what no call returns is "unknown".
#[unsafe(no_mangle)]
pub extern "C" fn patchray_name(code: i32) -> *const c_char {
    // The control of `tests/capi/symbols`: an index that a caller chooses.
    #[cfg(patchray_planted)]
    if [1, 2, 3][code as usize] == 2 {
        return c"".as_ptr();
    }
    macro_rules! names {
        ($($name:ident)*) => {
            match code {
                $($name => const { concat!(stringify!($name), "\0") },)*
                _ => "unknown\0",
            }
        };
    }
    let name = names!(
        PATCHRAY_OK PATCHRAY_HIT PATCHRAY_NULL PATCHRAY_MISALIGNED PATCHRAY_OVERLAP PATCHRAY_COUNT PATCHRAY_LAYOUT_DIFFERS
        PATCHRAY_MEMORY PATCHRAY_SCRATCH PATCHRAY_TOO_LARGE PATCHRAY_OPTION PATCHRAY_TABLES PATCHRAY_DEGREE PATCHRAY_POINTS
        PATCHRAY_POINT_NOT_FINITE PATCHRAY_WEIGHT PATCHRAY_PATCHES PATCHRAY_CAMERA_FLAT PATCHRAY_CAMERA_FAR PATCHRAY_SMALL
        PATCHRAY_RAY_NAN PATCHRAY_RAY_INFINITE PATCHRAY_RAY_DIRECTION PATCHRAY_RAY_RANGE PATCHRAY_RAY_INTERVAL PATCHRAY_RAY_OUT_OF_VIEW
        PATCHRAY_RAY_OUT_OF_LINE PATCHRAY_GAVE_UP_SURFACES PATCHRAY_GAVE_UP_NODES
        PATCHRAY_GAVE_UP_PATCHES PATCHRAY_GAVE_UP_VOXELS PATCHRAY_GAVE_UP_NEWTON_STEPS PATCHRAY_GAVE_UP_CLIP_STEPS
        PATCHRAY_GAVE_UP_BISECTIONS PATCHRAY_GAVE_UP_PENDING_DOMAINS PATCHRAY_GAVE_UP_HITS PATCHRAY_GAVE_UP_SPANS
    );
    // Each ends with the only 0 that it has.
    CStr::from_bytes_until_nul(name.as_bytes()).unwrap_or(c"unknown").as_ptr()
}
