"""A GLB with attributes of every type, shape and way of storage, all of random bytes."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from itertools import product

import numpy as np

COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "i4": 5124, "u4": 5125, "f4": 5126, "f8": 5130}
# Columns and rows.
SHAPES = {
    "SCALAR": (1, 1),
    "VEC2": (1, 2),
    "VEC3": (1, 3),
    "VEC4": (1, 4),
    "MAT2": (2, 2),
    "MAT3": (3, 3),
    "MAT4": (4, 4),
}
VERTICES = 9
# The vertices that sparse accessors replace.
REPLACED = (1, 4, 5, 8)

# The values of an attribute by mesh, morph target and name.
Expected = dict[tuple[int, int | None, str], np.ndarray]


class Made:
    """The file while it is made."""

    def __init__(self) -> None:
        self.random = np.random.default_rng(1)
        self.binary = bytearray()
        self.views: list[dict[str, int]] = []
        self.accessors: list[dict[str, object]] = []
        self.meshes: list[dict[str, object]] = []
        self.expected: Expected = {}

    def view(self, content: bytes, **more: int) -> int:
        self.binary += bytes(-len(self.binary) % 8)
        self.views.append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(content), **more})
        self.binary += content
        return len(self.views) - 1

    def numbers(self, kind: str, shape: str, count: int) -> np.ndarray:
        """Random elements, one a row; any bits will do, so floats may be NaN."""
        columns, rows = SHAPES[shape]
        width = np.dtype(kind).itemsize
        return np.frombuffer(self.random.bytes(count * columns * rows * width), f"<{kind}").reshape(count, -1)

    def accessor(self, kind: str, shape: str, normalized: bool, more: dict[str, object]) -> int:
        self.accessors.append(
            {"componentType": COMPONENTS[kind], "type": shape, "count": VERTICES, "normalized": normalized, **more}
        )
        return len(self.accessors) - 1

    def dense(self, kind: str, shape: str, offset: int, gap: int) -> tuple[np.ndarray, dict[str, object]]:
        """Elements that begin `offset` bytes within their view and have `gap` bytes between them."""
        values = self.numbers(kind, shape, VERTICES)
        stored = [bytes_of(row, shape) for row in values]
        stride = {"byteStride": len(stored[0]) + gap} if gap else {}
        content = self.random.bytes(offset) + b"".join(element + self.random.bytes(gap) for element in stored)
        return values, {"bufferView": self.view(content, **stride), **({"byteOffset": offset} if offset else {})}

    def sparse(
        self, kind: str, shape: str, index: str, base: tuple[np.ndarray, dict[str, object]] | None
    ) -> tuple[np.ndarray, dict[str, object]]:
        """Some elements by number, over others or over zeros."""
        replacing = self.numbers(kind, shape, len(REPLACED))
        below, more = base or (np.zeros((VERTICES, replacing.shape[1]), f"<{kind}"), {})
        values = below.copy()
        values[list(REPLACED)] = replacing
        places = np.array(REPLACED, f"<{index}").tobytes()
        content = b"".join(bytes_of(row, shape) for row in replacing)
        sparse = {
            "count": len(REPLACED),
            "indices": {"bufferView": self.view(places), "componentType": COMPONENTS[index]},
            "values": {"bufferView": self.view(content)},
        }
        return values, {**more, "sparse": sparse}

    def mesh(self, name: str, store: Callable[[str, str], tuple[np.ndarray, dict[str, object]]]) -> None:
        """A mesh with every type and shape stored one way, as attributes and in two morph targets."""
        number = len(self.meshes)
        indices = self.random.permutation(VERTICES).astype("<u2")
        view = self.view(indices.tobytes())
        self.accessors.append({"bufferView": view, "componentType": 5123, "type": "SCALAR", "count": VERTICES})
        primitive: dict[str, object] = {"indices": len(self.accessors) - 1}

        sets: list[dict[str, int]] = []
        for target in (None, 0, 1):
            position, more = self.dense("f4", "VEC3", 0, 0)
            named = {"POSITION": self.accessor("f4", "VEC3", False, more)}
            self.expected[number, target, "POSITION"] = position
            for kind, shape, normalized in product(COMPONENTS, SHAPES, (False, True)):
                values, more = store(kind, shape)
                attribute = f"_{kind}_{shape}_{normalized}".upper()
                named[attribute] = self.accessor(kind, shape, normalized, more)
                self.expected[number, target, attribute] = values
            sets.append(named)

        primitive |= {"attributes": sets[0], "targets": sets[1:]}
        self.meshes.append({"name": name, "primitives": [primitive]})

    def glb(self) -> bytes:
        self.binary += bytes(-len(self.binary) % 4)
        root = {
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": len(self.binary)}],
            "bufferViews": self.views,
            "accessors": self.accessors,
            "meshes": self.meshes,
        }
        text = json.dumps(root).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def bytes_of(row: np.ndarray, shape: str) -> bytes:
    """An element as it is stored: the columns of matrices start at multiples of four bytes."""
    columns = np.split(row, SHAPES[shape][0])
    if len(columns) == 1:
        return row.tobytes()
    return b"".join(column.tobytes() + bytes(-column.nbytes % 4) for column in columns)


def make() -> tuple[bytes, Expected]:
    """The file, always the same, and what its attributes are."""
    made = Made()
    made.mesh("tight", lambda kind, shape: made.dense(kind, shape, 0, 0))
    made.mesh("within a view", lambda kind, shape: made.dense(kind, shape, 8, 0))
    made.mesh("interleaved", lambda kind, shape: made.dense(kind, shape, 16, 8))
    for index in ("u1", "u2", "u4"):
        made.mesh(f"sparse {index}", lambda k, s, i=index: made.sparse(k, s, i, made.dense(k, s, 0, 4)))
    made.mesh("sparse over zeros", lambda kind, shape: made.sparse(kind, shape, "u2", None))
    made.mesh("zeros", lambda kind, shape: (np.zeros_like(made.numbers(kind, shape, VERTICES)), {}))
    return made.glb(), made.expected
