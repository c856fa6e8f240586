"""The figures of all programs: printed as a table, held against those recorded, or recorded."""

import json

# By how much a size or a number of instructions may differ from what is recorded, as a share: another compiler of the same
# series moves them by less. Hashes, rays, hits and patches have to be the same.
ALLOWED = 0.02
EXACT = ["rays", "hits", "patches", "hash"]
NEAR = ["flash", "ram", "stack_bound", "least", "mean", "worst"]


def key(row):
    """What a row is of."""
    return " ".join(row[name] for name in ("target", "machine", "memory", "scene", "program", "method", "precision"))


def show(rows):
    """The table as text."""
    heads = ["target", "memory", "program", "scene", "rays", "method", "precision", "patches", "hash = host's",
             "flash", "RAM", "stack", "bound", "least", "mean", "worst"]
    lines = [heads]
    for row in rows:
        lines.append([
            row["target"], row["memory"], row["program"], row["scene"], str(row["rays"]), row["method"], row["precision"],
            str(row["patches"]), f"{row['hash']} {'yes' if row['same'] else 'NO'}", str(row["flash"]), str(row["ram"]),
            str(row["stack"]), str(row["stack_bound"]), str(row["least"]), str(row["mean"]), str(row["worst"]),
        ])
    widths = [max(len(line[k]) for line in lines) for k in range(len(heads))]
    return "\n".join("  ".join(text.ljust(width) for text, width in zip(line, widths)).rstrip() for line in lines)


def differences(rows, recorded):
    """Where rows differ from those recorded, in words."""
    wrong = []
    known = {key(row): row for row in recorded}
    wrong += [f"{name}: recorded, and not run" for name in sorted(known.keys() - {key(row) for row in rows})]
    for row in rows:
        old = known.get(key(row))
        if old is None:
            wrong.append(f"{key(row)}: not recorded")
            continue
        wrong += [f"{key(row)}: {name} {row[name]}, recorded {old[name]}" for name in EXACT if row[name] != old[name]]
        for name in NEAR:
            if abs(row[name] - old[name]) > ALLOWED * max(abs(old[name]), 100):
                wrong.append(f"{key(row)}: {name} {row[name]}, recorded {old[name]}")
    return wrong


def of_readme(rows, code_bytes):
    """The lines of the README's table: the common view on a Cortex-M4F in f32, a program for each method."""
    lines = []
    for row in rows:
        told = ("Cortex-M4F", "an386", "teapot-common/common", "f32")
        if (row["target"], row["memory"], row["scene"], row["precision"]) != told or row["program"].startswith("all"):
            continue
        misses = row["rays"] - row["hits"]
        # Making lines ready is no miss's.
        of_miss = round(((row["mean"] - row["lines"]) * row["rays"] - row["mean_hit"] * row["hits"]) / misses)
        code = code_bytes[row["program"]]
        figures = [row["mean"], row["mean_hit"], of_miss, row["worst"], code, row["flash"] - code, row["ram"],
                   row["stack_bound"]]
        lines.append(f"| `{row['method']}` | " + " | ".join(f"{figure:,}" for figure in figures) + " |")
    return lines


def write(path, compiler, savings, rows):
    """Records rows."""
    kept = [{name: value for name, value in row.items() if name != "same"} for row in rows]
    note = "written by tests/firmware/run --record"
    text = ",\n".join("    " + json.dumps(row) for row in kept)
    head = json.dumps({"note": note, "compiler": compiler, "code_bytes": savings}, indent=2)[:-2]
    path.write_text(f'{head},\n  "rows": [\n{text}\n  ]\n}}\n')
