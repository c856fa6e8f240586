"""Makes B-spline surfaces with geomdl (NURBS-Python 5.4), exports them, and evaluates points of them.

    python3 tests/bspline/record.py SEED SURFACES.json POSITIONS.csv

The same seed makes the same files. Seed 1 makes the ones in fixtures/.
"""

import random
import sys

import geomdl
from geomdl import BSpline, NURBS, exchange, multi


def knots(draw, degree, clamped, spans):
    """Knots of so many spans, some of them repeated; they begin anywhere, and are not brought to [0, 1]."""
    at = -1 + 2 * draw()
    runs = [degree + 1] if clamped else [1] * (degree + 1)
    runs += [1 + int(draw() * degree) if draw() < 0.4 else 1 for _ in range(spans - 1)]
    runs += [degree + 1] if clamped else [1] * (degree + 1)
    made = []
    for run in runs:
        made += [at] * run
        at += 0.05 + draw()
    return made


def surface(draw, degrees, clamped, rational, spans):
    made = (NURBS if rational else BSpline).Surface(normalize_kv=False)
    made.degree_u, made.degree_v = degrees
    lists = [knots(draw, degree, clamped, count) for degree, count in zip(degrees, spans)]
    sizes = [len(list) - degree - 1 for list, degree in zip(lists, degrees)]
    points = []
    for i in range(sizes[0]):
        for j in range(sizes[1]):
            point = [i + 0.5 * draw(), j + 0.5 * draw(), 2 * draw()]
            weight = 0.2 + 2 * draw()
            points.append([weight * c for c in point] + [weight] if rational else point)
    made.set_ctrlpts(points, *sizes)
    made.knotvector_u, made.knotvector_v = lists
    made.delta = 0.1
    return made


def trim():
    """A triangle in the surface's parameters, which geomdl keeps and its evaluation does not heed."""
    made = BSpline.Curve()
    made.degree = 1
    made.ctrlpts = [[0.2, 0.2], [0.8, 0.2], [0.2, 0.8], [0.2, 0.2]]
    made.knotvector = [0, 0, 1, 2, 3, 3]
    made.opt = ["reversed", 0]
    return made


def parameters(draw, list, degree):
    """Both ends of the domain, each knot within, and points between."""
    low, high = list[degree], list[-degree - 1]
    within = sorted({knot for knot in list if low <= knot <= high})
    return within + [low + (high - low) * draw() for _ in range(4)]


def main(seed, surfaces_file, positions_file):
    draw = random.Random(int(seed)).random
    made = [
        surface(draw, (3, 2), True, False, (3, 2)),
        surface(draw, (2, 3), True, True, (2, 3)),
        surface(draw, (2, 4), False, True, (2, 1)),
        surface(draw, (1, 5), True, False, (2, 2)),
    ]
    if int(seed) != 1:
        for _ in range(30):
            degrees = [1 + int(draw() * 9), 1 + int(draw() * 9)]
            made.append(surface(draw, degrees, draw() < 0.6, draw() < 0.6, [1 + int(draw() * 5), 1 + int(draw() * 5)]))
    made[1].add_trim(trim())
    exchange.export_json(multi.SurfaceContainer(*made), surfaces_file)
    with open(positions_file, "w") as file:
        if int(seed) == 1:
            command = f"python3 tests/bspline/record.py {seed} {surfaces_file} {positions_file}"
            file.write(f"# geomdl {geomdl.__version__}: {command}\n")
        file.write("surface,u,v,x,y,z\n")
        for number, one in enumerate(made):
            for u in parameters(draw, one.knotvector_u, one.degree_u):
                for v in parameters(draw, one.knotvector_v, one.degree_v):
                    row = [number, u, v, *one.evaluate_single((u, v))]
                    file.write(",".join(map(repr, row)) + "\n")


main(*sys.argv[1:])
