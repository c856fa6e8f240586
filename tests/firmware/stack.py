"""The most stack that a program can take, from its machine code: the sizes of its functions' frames, as the compiler says or
their code shows, added up along the calls.

It holds if all calls are direct and none leads back to its caller; both are told if not.
"""

import re
import subprocess
from functools import lru_cache

CALL = {"bl", "blx", "b", "b.w", "beq", "bne", "jal", "j", "call", "tail", "jalr", "c.jal", "c.j"}
ENTRY = re.compile(r"^[0-9a-f]+ <(.+)>:$")
CODE = re.compile(r"^\s*[0-9a-f]+:\s+(\S+)(?:\s+(.*))?$")
TARGET = re.compile(r"<([^>+]+)>")


class Code:
    """The functions of an ELF file: frame, callees, and whether one calls what it cannot name."""

    def __init__(self, elf):
        sizes = subprocess.run(["llvm-readobj-22", "--stack-sizes", elf], capture_output=True, text=True, check=True)
        self.frames = {}
        for names, size in re.findall(r"Functions: \[(.*?)\]\n\s*Size: (0x[0-9A-Fa-f]+|\d+)", sizes.stdout):
            for name in names.split(", "):
                self.frames[name] = int(size, 0)
        self.calls, self.shown, self.indirect = {}, {}, set()
        listing = subprocess.run(
            ["llvm-objdump-22", "--disassemble", "--no-show-raw-insn", elf], capture_output=True, text=True, check=True
        )
        name = None
        for line in listing.stdout.splitlines():
            if entry := ENTRY.match(line):
                name = entry.group(1)
                self.calls.setdefault(name, set())
            elif name and (code := CODE.match(line)):
                self.read(name, code.group(1), code.group(2) or "")

    def read(self, name, operation, operands):
        """Notes what one instruction tells."""
        target = TARGET.search(operands)
        if operation in CALL and target:
            if target.group(1) != name:
                self.calls[name].add(target.group(1))
        elif operation in ("blx", "jalr", "c.jalr") or (operation == "bx" and operands != "lr"):
            # A return is no call.
            if "ra" not in operands.split(",")[0] or operation != "jalr":
                self.indirect.add(name)
        self.shown[name] = self.shown.get(name, 0) + frame_of(operation, operands)

    def frame(self, name):
        """Its frame: what the compiler says, else what its code shows."""
        return self.frames.get(name, self.shown.get(name, 0))

    def deepest(self, root):
        """The most stack below `root`, its own included, and the way there."""
        open_calls = []

        @lru_cache(maxsize=None)
        def below(name):
            if name in open_calls:
                raise RuntimeError(f"{name} calls itself")
            open_calls.append(name)
            deepest, way = max((below(callee) for callee in self.calls.get(name, ())), default=(0, ()))
            open_calls.pop()
            return self.frame(name) + deepest, (name, *way)

        return below(root)


def frame_of(operation, operands):
    """The bytes by which an instruction of a prologue moves the stack."""
    if operation in ("push", "push.w"):
        return 4 * len(registers(operands))
    if operation == "vpush":
        return 8 * len(registers(operands)) if "d" in operands else 4 * len(registers(operands))
    if operation in ("sub", "sub.w", "subw") and re.match(r"sp, (sp, )?#", operands):
        return int(operands.rsplit("#", 1)[1], 0)
    if operation in ("addi", "c.addi16sp", "c.addi") and re.match(r"sp, (sp, )?-", operands):
        return -int(operands.rsplit(",", 1)[1], 0)
    return 0


def registers(operands):
    """The registers of a list such as {r4, r5, r7-r9}."""
    names = []
    for part in operands.strip("{}").split(","):
        low, _, high = part.strip().partition("-")
        number = lambda name: int(re.sub(r"\D", "", name) or 0)
        names += [low] * (number(high) - number(low) + 1 if high else 1)
    return names
