//! Ctrl-C, and the signals by which schedulers end a job: what is done by then is kept.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};

use super::say;

static STOP: AtomicBool = AtomicBool::new(false);

/// From now on the first such signal sets the flag that is returned, and another one ends the process at once.
pub(crate) fn stop() -> &'static AtomicBool {
    let heard = || {
        if STOP.swap(true, Ordering::Relaxed) {
            process::exit(130);
        }
    };
    // Fails only where there is a handler already; it then is this one.
    if let Err(error @ (ctrlc::Error::System(_) | ctrlc::Error::NoSuchSignal(_))) = ctrlc::set_handler(heard) {
        say(format_args!("nothing will be kept if this is interrupted: {error}"));
    }
    &STOP
}
