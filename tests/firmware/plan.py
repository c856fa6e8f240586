"""What is built and run: programs, the machines that they run on, and the memory that they are held to."""

from dataclasses import dataclass

METHODS = ["newton", "newton-coherent", "newton-predicted", "clipping", "clipping-coherent", "clipping-predicted"]
# Those that need no view.
OF_ANY_RAYS = ("newton", "newton-coherent", "clipping", "clipping-coherent")
PRECISIONS = ["f32", "f64"]

# Each scene is traced by at most two samples of its picture: see `Picture::named`.
SCENES = {"teapot-common": ["common", "few"], "hill": ["hill"]}

ARM, RISCV = "qemu-system-arm", "qemu-system-riscv32"


@dataclass(frozen=True)
class Machine:
    """A machine that QEMU stands for."""

    title: str
    target: str
    emulator: str
    name: str
    # Nanoseconds per instruction are 2^shift. Arm's counter ticks at a rate of its own, so that a small shift leaves it room
    # for long rays and still tells instructions apart; RISC-V counts instructions themselves.
    shift: int


M4F = Machine("Cortex-M4F", "thumbv7em-none-eabihf", ARM, "mps2-an386", 5)
M4F_SMALL = Machine("Cortex-M4F", "thumbv7em-none-eabihf", ARM, "netduinoplus2", 5)
M33 = Machine("Cortex-M33", "thumbv8m.main-none-eabihf", ARM, "mps2-an505", 5)
M3 = Machine("Cortex-M3", "thumbv7m-none-eabi", ARM, "lm3s6965evb", 5)
M0 = Machine("Cortex-M0", "thumbv6m-none-eabi", ARM, "microbit", 5)
IMAFC = Machine("RV32IMAFC", "riscv32imafc-unknown-none-elf", RISCV, "virt", 0)
IMAC = Machine("RV32IMAC", "riscv32imac-unknown-none-elf", RISCV, "virt", 0)


@dataclass(frozen=True)
class Build:
    """Programs that are built at once: one target, one layout of memory, one scene."""

    machine: Machine
    memory: str
    scene: str
    picture: str
    programs: tuple


def singles(precision, methods=tuple(METHODS)):
    """Programs of one method each."""
    return tuple(f"{method.replace('-', '_')}_{precision}" for method in methods)


# What fits where. Soft floating point takes the small sample, or it would take minutes.
BUILDS = [
    Build(M4F, "an386", "teapot-common", "common", singles("f32") + ("all_f32",)),
    Build(M4F, "an386", "teapot-common", "few", singles("f64")),
    # The whole teapot by clipping within 64 KB of RAM.
    Build(M4F, "an386-64k", "teapot-common", "common", ("clipping_f32",)),
    # Patches and grid from flash on a part with 128 KB of RAM.
    Build(M4F_SMALL, "netduino", "teapot-common", "common", ("newton_coherent_f32",)),
    Build(M33, "an505", "teapot-common", "common", ("all_f32",)),
    Build(M33, "an505", "teapot-common", "few", ("all_f64",)),
    Build(IMAFC, "virt", "teapot-common", "common", ("all_f32",)),
    Build(IMAFC, "virt", "teapot-common", "few", ("all_f64",)),
    Build(IMAC, "virt", "teapot-common", "few", ("all_f32", "all_f64")),
    Build(M3, "lm3s6965", "teapot-common", "few", ("clipping_f32", "clipping_f64")),
    Build(M3, "lm3s6965", "hill", "hill", singles("f32") + singles("f64")),
    # One surface on a part with 16 KB of RAM; a view of it would take all of that.
    Build(M0, "microbit", "hill", "hill", singles("f32", OF_ANY_RAYS) + singles("f64", OF_ANY_RAYS)),
]
