"""Plain readings of mesh files: the triangles in the order in which they are drawn, each corner as all
that its vertex holds. They share nothing with the program that they judge, and need Python alone.
"""

from __future__ import annotations

import base64
import gzip
import json
import re
import struct
from collections import Counter, OrderedDict
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote

TYPES = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


@dataclass
class Piece:
    """What is drawn in one go. `records` are the vertices as stored, `indices` the corners of all faces."""

    state: tuple
    records: list
    indices: list

    def corners(self) -> list:
        return [self.records[index] for index in self.indices]

    def faces(self) -> list[tuple]:
        corners = self.corners()
        return list(zip(corners[0::3], corners[1::3], corners[2::3]))

    def misses_per_face(self, size: int = 16) -> float:
        """How often a first-in first-out cache misses, for each face."""
        cache, misses = OrderedDict(), 0
        for index in self.indices:
            if index in cache:
                continue
            misses += 1
            cache[index] = None
            if len(cache) > size:
                cache.popitem(last=False)
        return misses / max(1, len(self.indices) // 3)


def turned(face: tuple) -> tuple:
    """The face with its least corner first: the same however it is turned, not when it is flipped."""
    a, b, c = face
    return min((a, b, c), (b, c, a), (c, a, b), key=repr)


def bag(pieces: list[Piece]) -> Counter:
    """Every triangle with what its corners hold and how it is drawn, and how often it occurs."""
    return Counter((piece.state, turned(face)) for piece in pieces for face in piece.faces())


def first_words(count: int, *bags: Counter) -> str:
    """A few triangles that only one of two bags has."""
    before, after = bags
    lost, new = before - after, after - before
    return f"{sum(lost.values())} lost, {sum(new.values())} new, as {list(lost)[:count]} | {list(new)[:count]}"


class Gltf:
    """A GLB or a .gltf with its buffers."""

    def __init__(self, path: Path):
        data = path.read_bytes()
        binary = b""
        if data[:4] == b"glTF":
            length = struct.unpack_from("<I", data, 12)[0]
            text, binary = data[20 : 20 + length].rstrip(b"\0 "), data[20 + length + 8 :]
        else:
            text = data
        self.json = json.loads(text)
        self.buffers = [self.buffer(path, buffer, binary) for buffer in self.json.get("buffers", [])]

    @staticmethod
    def buffer(path: Path, buffer: dict, binary: bytes) -> bytes:
        uri = buffer.get("uri")
        if uri is None:
            return binary
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        return (path.parent / unquote(uri)).read_bytes()

    def elements(self, number: int) -> list[tuple]:
        """The elements of an accessor, as stored."""
        accessor = self.json["accessors"][number]
        view = self.json["bufferViews"][accessor["bufferView"]]
        layout = struct.Struct(f"<{COMPONENTS[accessor['type']]}{TYPES[accessor['componentType']]}")
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", layout.size)
        buffer = self.buffers[view["buffer"]]
        return [layout.unpack_from(buffer, start + i * stride) for i in range(accessor["count"])]

    def pieces(self, mode: int = 4) -> list[Piece]:
        """All primitives of one mode."""
        return [
            self.piece(primitive, (mesh, number, primitive.get("material")))
            for mesh, one in enumerate(self.json.get("meshes", []))
            for number, primitive in enumerate(one["primitives"])
            if primitive.get("mode", 4) == mode
        ]

    def piece(self, primitive: dict, state: tuple) -> Piece:
        names = sorted(primitive["attributes"])
        columns = [self.elements(primitive["attributes"][name]) for name in names]
        for target in primitive.get("targets", []):
            columns += [self.elements(target[name]) for name in sorted(target)]
        records = list(zip(*columns))
        indices = range(len(records))
        if "indices" in primitive:
            indices = [index for (index,) in self.elements(primitive["indices"])]
        return Piece(state, records, list(indices))


def gltf(path: Path) -> list[Piece]:
    return Gltf(path).pieces()


def obj(path: Path) -> list[Piece]:
    """A piece a state: material, smoothing, group. Colours of `v` lines and of `#MRGB` belong to the vertices."""
    lines = path.read_text(errors="surrogateescape").splitlines()
    colours = "".join(line.split()[1] for line in lines if line.startswith("#MRGB "))
    colours = [colours[i : i + 8] for i in range(0, len(colours), 8)]
    stored: dict[str, list] = {"v": [], "vt": [], "vn": []}
    state: dict[str, str] = {}
    pieces: dict[tuple, Piece] = {}
    numbers: dict[tuple, int] = {}
    records: list[tuple] = []

    for line in lines:
        word, *rest = line.split("#")[0].split() or [""]
        if word in stored:
            colour = colours[len(stored["v"])] if word == "v" and len(stored["v"]) < len(colours) else None
            stored[word].append((*rest, colour))
        elif word in ("usemtl", "s", "g", "o"):
            state[word] = " ".join(rest)
        elif word == "f":
            key = tuple(sorted(state.items()))
            piece = pieces.setdefault(key, Piece(key, records, []))
            corners = []
            for corner in rest:
                record = []
                for kind, number in zip(("v", "vt", "vn"), corner.split("/")):
                    at = int(number) if number else 0
                    held = stored[kind]
                    record.append(held[at - 1 if at > 0 else len(held) + at] if at else None)
                record = tuple(record)
                # The vertex number is what a cache sees; what it holds is what must stay.
                index = numbers.setdefault((corner if not corner.startswith("-") else record), len(records))
                if index == len(records):
                    records.append(record)
                corners.append(index)
            for i in range(1, len(corners) - 1):
                piece.indices += [corners[0], corners[i], corners[i + 1]]
    return list(pieces.values())


def off(path: Path) -> list[Piece]:
    """Free-format OFF without colours: words, wherever the lines end."""
    text = re.sub(r"#.*", "", path.read_text())
    assert text.startswith("OFF"), "the word OFF"
    words = iter(text[3:].split())
    vertex_count, face_count, _ = (int(next(words)) for _ in range(3))
    records = [tuple(next(words) for _ in range(3)) for _ in range(vertex_count)]
    indices = []
    for _ in range(face_count):
        corners = [int(next(words)) for _ in range(int(next(words)))]
        for i in range(1, len(corners) - 1):
            indices += [corners[0], corners[i], corners[i + 1]]
    assert next(words, None) is None, "words after the last face"
    return [Piece((), records, indices)]


def stl(path: Path) -> list[Piece]:
    """ASCII STL; a face's normal belongs to its state, so that it may not change faces."""
    data = path.read_bytes().rstrip(b"\0")
    number = rb"\s+(\S+)\s+(\S+)\s+(\S+)"
    facet = rb"facet\s+normal" + number + rb"\s+outer\s+loop" + (rb"\s+vertex" + number) * 3
    pieces = []
    for found in re.findall(facet + rb"\s+endloop\s+endfacet", data):
        pieces.append(Piece(found[0:3], [found[3:6], found[6:9], found[9:12]], [0, 1, 2]))
    return pieces


def vrml(path: Path) -> list[Piece]:
    """One IndexedFaceSet of triangles with points alone; through gzip if the bytes say so."""
    data = path.read_bytes()
    text = (gzip.decompress(data) if data[:2] == b"\x1f\x8b" else data).decode()
    (points,) = re.findall(r"point\s*\[(.*?)\]", text, re.S)
    (faces,) = re.findall(r"coordIndex\s*\[(.*?)\]", text, re.S)
    numbers = points.replace(",", " ").split()
    records = list(zip(numbers[0::3], numbers[1::3], numbers[2::3]))
    indices = [int(word) for word in faces.replace(",", " ").split() if word != "-1"]
    return [Piece((), records, indices)]


def ply(path: Path) -> list[Piece]:
    """ASCII PLY with three properties a vertex and triangles alone."""
    header, body = path.read_text().split("end_header\n")
    count = {name: int(number) for name, number in re.findall(r"^element (\w+) (\d+)", header, re.M)}
    lines = [tuple(line.split()) for line in body.splitlines()]
    records = lines[: count["vertex"]]
    faces = lines[count["vertex"] :][: count["face"]]
    return [Piece((), records, [int(word) for face in faces for word in face[1:]])]
