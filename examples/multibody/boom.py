"""Makes boom.glb, the look of the erector's boom: a truss of bars, as a binary glTF 2 file.

usage: python3 boom.py boom.glb

Metres, x along the boom, y upwards. All bars are boxes; chords and diagonals have a colour each.
"""

import json
import struct
import sys

CHORD, DIAGONAL = 0.07, 0.035  # [m] sides of the bars
LENGTH, BAYS, HALF_HEIGHT, HALF_WIDTH = 5.2, 6, 0.15, 0.2
FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))

Point = tuple[float, float, float]
Bar = tuple[Point, Point, float]


def across(along: Point) -> tuple[Point, Point]:
    """Two directions across a bar."""
    x, y, z = along
    size = (x * x + y * y + z * z) ** 0.5
    flat = (x * x + y * y) ** 0.5
    u = (-y / flat, x / flat, 0.0) if flat > 0 else (1.0, 0.0, 0.0)
    v = (y * u[2] - z * u[1], z * u[0] - x * u[2], x * u[1] - y * u[0])
    return u, (v[0] / size, v[1] / size, v[2] / size)


def corners(bar: Bar) -> list[Point]:
    """Corners of a bar, end by end."""
    a, b, side = bar
    u, v = across((b[0] - a[0], b[1] - a[1], b[2] - a[2]))
    half = side / 2
    return [
        (end[0] + half * (i * u[0] + k * v[0]), end[1] + half * (i * u[1] + k * v[1]), end[2] + half * (i * u[2] + k * v[2]))
        for end in (a, b)
        for i in (-1, 1)
        for k in (-1, 1)
    ]


def truss() -> tuple[list[Bar], list[Bar]]:
    """Four chords; diagonals in zigzag on both sides and along top and bottom, with two end frames."""
    first, last = -LENGTH / 2, LENGTH / 2
    sides = [(y, z) for y in (-HALF_HEIGHT, HALF_HEIGHT) for z in (-HALF_WIDTH, HALF_WIDTH)]
    chords = [((first, y, z), (last, y, z), CHORD) for y, z in sides]
    for x in (first, last):
        chords += [((x, y, -HALF_WIDTH), (x, y, HALF_WIDTH), CHORD) for y in (-HALF_HEIGHT, HALF_HEIGHT)]
        chords += [((x, -HALF_HEIGHT, z), (x, HALF_HEIGHT, z), CHORD) for z in (-HALF_WIDTH, HALF_WIDTH)]
    step, diagonals = LENGTH / BAYS, []
    for n in range(BAYS):
        a, b, up = first + n * step, first + (n + 1) * step, 1 if n % 2 else -1
        for side in (-1, 1):
            y, z = side * HALF_HEIGHT, side * HALF_WIDTH
            diagonals.append(((a, up * HALF_HEIGHT, z), (b, -up * HALF_HEIGHT, z), DIAGONAL))
            diagonals.append(((a, y, up * HALF_WIDTH), (b, y, -up * HALF_WIDTH), DIAGONAL))
    return chords, diagonals


def glb() -> bytes:
    """The file."""
    binary, views, accessors, primitives = b"", [], [], []
    for material, bars in enumerate(truss()):
        points = [point for bar in bars for point in corners(bar)]
        indices = [8 * n + face[k] for n in range(len(bars)) for face in FACES for k in (0, 1, 2, 0, 2, 3)]
        bounds = {name: [limit(axis) for axis in zip(*points)] for name, limit in (("min", min), ("max", max))}
        parts = [
            (struct.pack(f"<{3 * len(points)}f", *[x for point in points for x in point]), 5126, "VEC3", len(points), bounds),
            (struct.pack(f"<{len(indices)}H", *indices), 5123, "SCALAR", len(indices), {}),
        ]
        for data, component, kind, count, more in parts:
            views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
            accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind, **more})
            binary += data + bytes(-len(data) % 4)
        last = len(accessors) - 1
        primitives.append({"attributes": {"POSITION": last - 1}, "indices": last, "material": material})
    colours = {"chords": [0.55, 0.2, 0.03, 1], "diagonals": [0.2, 0.22, 0.24, 1]}
    head = {
        "asset": {"version": "2.0", "generator": "boom.py"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "boom", "mesh": 0}],
        "meshes": [{"primitives": primitives}],
        "materials": [{"name": name, "pbrMetallicRoughness": {"baseColorFactor": rgba}} for name, rgba in colours.items()],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}],
    }
    text = json.dumps(head, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


if __name__ == "__main__":
    with open(sys.argv[1], "wb") as file:
        file.write(glb())
