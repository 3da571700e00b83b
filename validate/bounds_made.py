"""The files whose time and memory `bounds` measures. Run as a program, so that what it takes to make them is
not counted: bounds_made.py KIND COUNT OUT
"""

from __future__ import annotations

import gzip
import json
import random
import struct
import sys
from array import array
from pathlib import Path

FLOAT, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5123, 5125


def grid(side: int) -> tuple[array, list[tuple[int, int, int]]]:
    """Positions and shuffled faces of a flat grid of `side` by `side` vertices."""
    positions = array("f")
    for y in range(side):
        for x in range(side):
            positions.extend((x, y, 0))
    faces = []
    for y in range(side - 1):
        for x in range(side - 1):
            a = y * side + x
            faces += [(a, a + 1, a + side), (a + 1, a + side + 1, a + side)]
    random.Random(3).shuffle(faces)
    return positions, faces


def positions_accessor(view: int, count: int, side: int) -> dict:
    return dict(
        bufferView=view, componentType=FLOAT, count=count, type="VEC3", min=[0, 0, 0], max=[side - 1, side - 1, 0]
    )


def root(accessors: list, views: list, meshes: list, length: int, uri=None) -> dict:
    buffer = {"byteLength": length} | ({"uri": uri} if uri else {})
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(meshes)))}],
        "nodes": [{"mesh": mesh} for mesh in range(len(meshes))],
        "meshes": meshes,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [buffer],
    }


def write_glb(path: Path, json_root: dict, binary: bytes, zeros: int = 0) -> None:
    """A GLB; after its bytes the binary chunk goes on with so many zeros, which take no room on the disk."""
    text = json.dumps(json_root, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    length = 28 + len(text) + len(binary) + zeros
    with path.open("wb") as stream:
        stream.write(struct.pack("<4sIIII", b"glTF", 2, length, len(text), 0x4E4F534A) + text)
        stream.write(struct.pack("<II", len(binary) + zeros, 0x4E4942) + binary)
        stream.truncate(length)


def primitives(count: int, path: Path) -> None:
    """So many primitives of 9 faces, all over one POSITION accessor: each reaches all over it."""
    side = next(n for n in range(2, 10**6) if 2 * (n - 1) ** 2 >= 9 * count)
    positions, faces = grid(side)
    faces = faces[: 9 * count]
    binary = positions.tobytes() + array("I", [corner for face in faces for corner in face]).tobytes()
    start = len(positions) * 4
    views = [
        dict(buffer=0, byteOffset=0, byteLength=start),
        dict(buffer=0, byteOffset=start, byteLength=len(binary) - start),
    ]
    accessors = [positions_accessor(0, side * side, side)]
    accessors += [
        dict(bufferView=1, byteOffset=108 * i, componentType=UNSIGNED_INT, count=27, type="SCALAR") for i in range(count)
    ]
    mesh = {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1 + i} for i in range(count)]}
    write_glb(path, root(accessors, views, [mesh], len(binary)), binary)


def meshes(count: int, path: Path) -> None:
    """So many meshes of 50 faces, each with buffer views of its own."""
    positions, faces = grid(6)
    vertices = positions.tobytes()
    corners = struct.pack("<150H", *(corner for face in faces for corner in face))
    step = len(vertices) + len(corners)
    accessors, views, made = [], [], []
    for i in range(count):
        views.append(dict(buffer=0, byteOffset=step * i, byteLength=len(vertices)))
        views.append(dict(buffer=0, byteOffset=step * i + len(vertices), byteLength=len(corners)))
        accessors.append(positions_accessor(2 * i, 36, 6))
        accessors.append(dict(bufferView=2 * i + 1, componentType=UNSIGNED_SHORT, count=150, type="SCALAR"))
        made.append({"primitives": [{"attributes": {"POSITION": 2 * i}, "indices": 2 * i + 1}]})
    write_glb(path, root(accessors, views, made, step * count), (vertices + corners) * count)


def scene(uri: str, path: Path) -> None:
    """A small .gltf over the buffer of that name, which is not written."""
    binary, json_root = small(uri)
    path.write_text(json.dumps(json_root))
    sys.stdout.buffer.write(binary)


def small(uri) -> tuple[bytes, dict]:
    positions, faces = grid(6)
    binary = positions.tobytes() + struct.pack("<150H", *(corner for face in faces for corner in face))
    views = [dict(buffer=0, byteOffset=0, byteLength=432), dict(buffer=0, byteOffset=432, byteLength=300)]
    accessors = [
        positions_accessor(0, 36, 6),
        dict(bufferView=1, componentType=UNSIGNED_SHORT, count=150, type="SCALAR"),
    ]
    mesh = {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}
    return binary, root(accessors, views, [mesh], len(binary), uri)


def huge_glb(zeros: int, path: Path) -> None:
    """A small mesh, and behind it a binary chunk of so many zeros that nothing reads."""
    binary, json_root = small(None)
    json_root["buffers"][0]["byteLength"] += zeros
    write_glb(path, json_root, binary, zeros)


def packed_off(blanks: int, path: Path) -> None:
    """A small OFF with so many blanks before its last line, compressed to a thousandth."""
    with gzip.open(path, "wb", compresslevel=9) as stream:
        stream.write(b"OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 2 3 0\n3 0 3 1\n")
        block = b" " * ((1 << 20) - 1) + b"\n"
        for _ in range(blanks >> 20):
            stream.write(block)
        stream.write(b"3 1 3 2\n")


def packed_gltf(blanks: int, path: Path) -> None:
    """The text of a small scene, its buffer as a data URI, with so many blanks before its end; compressed."""
    import base64

    binary, json_root = small("data:application/octet-stream;base64," + base64.b64encode(small(None)[0]).decode())
    with gzip.open(path, "wb", compresslevel=9) as stream:
        stream.write(json.dumps(json_root).encode()[:-1])
        block = b" " * (1 << 20)
        for _ in range(blanks >> 20):
            stream.write(block)
        stream.write(b"}")


KINDS = dict(
    primitives=primitives, meshes=meshes, huge_glb=huge_glb, packed_off=packed_off, packed_gltf=packed_gltf, scene=scene
)

if __name__ == "__main__":
    kind, count, out = sys.argv[1:]
    KINDS[kind](count if kind == "scene" else int(count), Path(out))
