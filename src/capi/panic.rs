//! What a static library has to say of panics: that none can be reached.

/// Calls what is defined nowhere: where a panic can be reached, a program cannot be linked. `tests/capi/run` checks that
/// none can.
///
/// Only where a panic aborts, as in the profile `capi` and on bare metal: tests, lints and documentation have the handler of
/// `std`, whatever features are on.
#[cfg(all(panic = "abort", not(test)))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn patchray_panic_is_reachable() -> !;
    }
    // SAFETY: no program with this call can be linked, so none runs it.
    unsafe { patchray_panic_is_reachable() }
}
