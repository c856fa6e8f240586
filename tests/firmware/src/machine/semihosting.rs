//! Semihosting: console and end of a program under an emulator.
//!
//! Source: Arm, "Semihosting for AArch32 and AArch64"; RISC-V International, "RISC-V Semihosting", whose operations are the
//! same.

use super::own::call;

const WRITE0: usize = 0x04;
const EXIT_EXTENDED: usize = 0x20;
const APPLICATION_EXIT: usize = 0x2_0026;

/// Writes text on the console.
pub(super) fn write(text: &str) {
    let mut buffer = [0_u8; 65];
    let (room, end) = buffer.split_at_mut(64);
    for part in text.as_bytes().chunks(room.len()) {
        room.iter_mut().zip(part.iter().chain(end.iter())).for_each(|(to, from)| *to = *from);
        call(WRITE0, room.as_ptr() as usize);
    }
}

/// Ends the program.
pub(crate) fn exit(code: u32) -> ! {
    let block = [APPLICATION_EXIT, code as usize];
    // Ends: the emulator does not come back.
    loop {
        call(EXIT_EXTENDED, block.as_ptr() as usize);
    }
}
