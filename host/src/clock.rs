//! The time that a thread has had a processor for: on a machine that others use, too, it tells more of a method than the time of
//! day does.

/// A beginning.
pub(crate) struct Clock(Instant);

impl Clock {
    /// Now.
    #[inline]
    pub(crate) fn start() -> Self {
        Clock(Instant::now())
    }

    /// Seconds of this thread's since.
    #[inline]
    pub(crate) fn seconds(&self) -> f64 {
        self.0.elapsed()
    }
}

#[cfg(unix)]
#[derive(Clone, Copy)]
struct Instant(f64);

#[cfg(unix)]
impl Instant {
    fn now() -> Self {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        Instant(time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9)
    }

    fn elapsed(self) -> f64 {
        Self::now().0 - self.0
    }
}

/// Where threads have no clock of their own it is the time of day.
#[cfg(not(unix))]
#[derive(Clone, Copy)]
struct Instant(std::time::Instant);

#[cfg(not(unix))]
impl Instant {
    fn now() -> Self {
        Instant(std::time::Instant::now())
    }

    fn elapsed(self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn waiting_costs_nothing() {
        let clock = Clock::start();
        std::thread::sleep(std::time::Duration::from_millis(200));
        assert!(clock.seconds() < 0.1, "{}", clock.seconds());
    }
}
