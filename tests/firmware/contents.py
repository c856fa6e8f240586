"""What a linked program holds: names that say it can panic, allocate or format; the sources of its code; and its sizes."""

import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Of a program that can panic, print or allocate.
FORBIDDEN = re.compile(r"panic_is_reachable|core::(fmt|panicking)|__rust_alloc|__rg_|\balloc::|_Unwind|rust_begin_unwind")

NEWTON = {"newton", "newton-coherent", "newton-predicted"}
CLIPPING = {"clipping", "clipping-coherent", "clipping-predicted"}
PREDICTED = {"newton-predicted", "clipping-predicted"}

# Sources that belong to one method, or are shared by some: the methods whose programs may hold code of them. Each is expected
# in those programs too, so that no check passes for want of a name.
PARTS = {
    "method/newton.rs": {"newton"},
    "method/newton_coherent.rs": {"newton-coherent"},
    "method/newton_predicted.rs": {"newton-predicted"},
    "method/clipping.rs": {"clipping"},
    "method/clipping_coherent.rs": {"clipping-coherent"},
    "method/clipping_predicted.rs": {"clipping-predicted"},
    "method/starts.rs": NEWTON,
    "method/follow.rs": PREDICTED,
    "clipper.rs": CLIPPING,
    "clip.rs": CLIPPING,
    "tree.rs": {"newton"},
    "view.rs": PREDICTED,
    "line.rs": PREDICTED,
    "span.rs": PREDICTED,
    # Of no program that traces what was baked.
    "subdivide.rs": set(),
    "measure.rs": set(),
    "bspline.rs": set(),
    "pieces.rs": set(),
}


def run(*words):
    """What a command prints."""
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


def forbidden(elf):
    """Names in it that must not be there."""
    names = run("llvm-nm-22", "--demangle", elf) + run("llvm-nm-22", elf)
    return sorted({line.split(maxsplit=2)[-1] for line in names.splitlines() if FORBIDDEN.search(line)})


def sources(elf):
    """The files of the kernel's `src` that instructions of the program come from, inlined ones included."""
    found, folders, files = set(), {}, {}
    number = name = None
    for line in run("llvm-dwarfdump-22", "--debug-line", elf).splitlines():
        if entry := re.match(r'include_directories\[\s*(\d+)\] = "(.*)"', line):
            if entry.group(1) == "0":
                folders, files = {}, {}
            folders[entry.group(1)] = entry.group(2)
        elif entry := re.match(r"file_names\[\s*(\d+)\]:", line):
            number = entry.group(1)
        elif entry := re.match(r'\s*name: "(.*)"', line):
            name = entry.group(1)
        elif entry := re.match(r"\s*dir_index: (\d+)", line):
            files[number] = (folders.get(entry.group(1)), name)
        elif entry := re.match(r"0x[0-9a-f]{8,16}\s+\d+\s+\d+\s+(\d+)\s", line):
            folder, name_of = files.get(entry.group(1), (None, ""))
            if folder == str(ROOT) and name_of.startswith("src/"):
                found.add(name_of.removeprefix("src/"))
    return found


def strangers(elf, methods):
    """What is wrong with the sources of a program of these methods: code of others, or none of its own."""
    held = sources(elf)
    wrong = []
    for part, owners in PARTS.items():
        if part in held and not owners & methods:
            wrong.append(f"holds code of {part}")
        if part not in held and owners & methods:
            wrong.append(f"shows no code of {part}: the names that this check looks for have changed")
    return wrong


def sizes(elf):
    """Bytes of flash, and of RAM without the stack."""
    flash = ram = 0
    for line in run("llvm-readelf-22", "--sections", "--wide", elf).splitlines():
        entry = re.match(r"\s*\[\s*\d+\]\s+(\S+)\s+(PROGBITS|NOBITS|ARM_EXIDX)\s+\S+\s+\S+\s+(\S+)\s+\S+\s+(\S+)", line)
        if not entry or "A" not in entry.group(4) or entry.group(1) in (".stack", ".heap"):
            continue
        size = int(entry.group(3), 16)
        flash += size if entry.group(2) != "NOBITS" else 0
        ram += size if "W" in entry.group(4) else 0
    return flash, ram


def given(memory):
    """Bytes of RAM that a layout of memory gives; the linker holds static memory and flash to it, but knows no stack."""
    text = (Path(__file__).parent / "memory" / f"{memory}.x").read_text()
    number, unit = re.search(r"RAM : ORIGIN = \w+, LENGTH = (\d+)([KM])", text).groups()
    return int(number) * {"K": 1 << 10, "M": 1 << 20}[unit]
