//! The machine that a program runs on: its start and end, its console, and its count of instructions.

#[cfg_attr(all(target_os = "none", target_arch = "arm"), path = "arm.rs")]
#[cfg_attr(all(target_os = "none", target_arch = "riscv32"), path = "riscv.rs")]
#[cfg_attr(not(target_os = "none"), path = "host.rs")]
mod own;
#[cfg(target_os = "none")]
mod semihosting;

/// Where a program starts: it calls `run` with the machine, and ends.
#[macro_export]
macro_rules! start {
    () => {
        #[cfg(target_os = "none")]
        #[unsafe(export_name = "main")]
        extern "C" fn start() -> ! {
            $crate::machine::Machine::run(run)
        }

        #[cfg(not(target_os = "none"))]
        fn main() {
            $crate::machine::Machine::run(run)
        }
    };
}

/// What was chosen when the program was built.
#[cfg(target_os = "none")]
pub fn chosen(built: &str) -> &str {
    built
}

/// What the environment says in place of what was chosen when the program was built.
#[cfg(not(target_os = "none"))]
pub fn chosen(built: &str) -> String {
    std::env::var("PICTURE").unwrap_or_else(|_| built.to_owned())
}

/// The machine.
#[derive(Debug)]
pub struct Machine {
    own: own::Own,
    /// Instructions between two readings that do nothing else.
    between: u64,
    failed: bool,
}

impl Machine {
    fn new() -> Self {
        let mut machine = Machine { own: own::Own::new(), between: 0, failed: false };
        let begin = machine.instructions();
        machine.between = machine.since(begin);
        machine
    }

    /// Starts the machine, has `run` do its work, and ends.
    #[cfg(target_os = "none")]
    pub fn run(run: impl FnOnce(&mut Machine)) -> ! {
        let painted = crate::paint::paint();
        let mut machine = Machine::new();
        run(&mut machine);
        machine.tell("stack", painted.used() as u64);
        semihosting::exit(u32::from(machine.failed))
    }

    /// Has `run` do its work, and ends.
    #[cfg(not(target_os = "none"))]
    pub fn run(run: impl FnOnce(&mut Machine)) {
        let mut machine = Machine::new();
        run(&mut machine);
        std::process::exit(i32::from(machine.failed));
    }

    /// A reading for [`Machine::since`].
    #[inline(always)]
    pub fn instructions(&self) -> own::Reading {
        self.own.read()
    }

    /// Instructions since a reading, without those of the readings; 0 on the host.
    #[inline(always)]
    pub fn since(&self, begin: own::Reading) -> u64 {
        let end = self.own.read();
        self.own.instructions(begin, end).saturating_sub(self.between)
    }

    /// Says something.
    pub fn say(&mut self, text: &str) {
        own::say(text);
    }

    /// Says that something went wrong; the program then ends with 1.
    pub fn fail(&mut self, text: &str) {
        self.failed = true;
        self.say("fail ");
        self.say(text);
    }

    /// Says a name and a number, on a line.
    pub fn tell(&mut self, name: &str, number: u64) {
        self.say(name);
        self.say(" ");
        // Twenty digits hold any; the last is written first.
        let mut digits = [b'0'; 20];
        let (mut rest, mut first) = (number, digits.len());
        for (place, digit) in digits.iter_mut().enumerate().rev() {
            *digit = b'0' + (rest % 10) as u8;
            (rest, first) = (rest / 10, place);
            if rest == 0 {
                break;
            }
        }
        self.say(digits.get(first..).and_then(|digits| core::str::from_utf8(digits).ok()).unwrap_or(""));
        self.say("\n");
    }
}

/// The end of a program that panicked: 101, as Rust's programs end elsewhere.
#[cfg(target_os = "none")]
pub(crate) fn end_of_panic() -> ! {
    semihosting::exit(101)
}
