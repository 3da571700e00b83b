"""pygltflib and numpy read every glTF and GLB: the attributes must be those that meshweft reads, bit by bit.

The files are those of the test data, and one made here with every type, shape and way of storage.

Usage: python attributes_gltf.py ATTRIBUTES DATA_FOLDER [MORE_FILES...]

ATTRIBUTES is the program of that name in `compare/`.
"""

from __future__ import annotations

import sys
import tempfile
import urllib.request
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pygltflib

import attributes_made
from attributes import Attribute, Document, Mesh, Tally, difference, files_below, read_counted

TYPES = {5120: "i1", 5121: "u1", 5122: "i2", 5123: "u2", 5124: "i4", 5125: "u4", 5126: "f4", 5130: "f8"}
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
COMPRESSED_VIEW = ("EXT_meshopt_compression", "KHR_meshopt_compression")
MODES = {0: "points", 1: "lines", 2: "lines", 3: "lines", 5: "strips or fans", 6: "strips or fans"}


class Scene:
    """A glTF file as pygltflib parses it, with its buffers."""

    def __init__(self, file: Path) -> None:
        self.gltf = pygltflib.GLTF2.load(file)
        if self.gltf is None:
            raise ValueError("no JSON chunk")
        self.buffers: dict[int, bytes] = {}

    def buffer(self, number: int) -> bytes:
        if number not in self.buffers:
            uri = self.gltf.buffers[number].uri
            # pygltflib knows one media type only.
            is_data = uri is not None and uri.startswith("data:")
            content = urllib.request.urlopen(uri).read() if is_data else self.gltf.get_data_from_buffer_uri(uri)
            if content is None:
                raise ValueError(f"pygltflib finds no buffer {number}")
            self.buffers[number] = content
        return self.buffers[number]

    def is_compressed(self, accessor: pygltflib.Accessor) -> bool:
        if accessor.bufferView is None:
            return False
        extensions = self.gltf.bufferViews[accessor.bufferView].extensions or {}
        return any(name in extensions for name in COMPRESSED_VIEW)

    def stride(self, accessor: pygltflib.Accessor) -> int:
        """The bytes from one element to the next."""
        return self.gltf.bufferViews[accessor.bufferView].byteStride or sizes(accessor)[1]

    def place(self, accessor: pygltflib.Accessor) -> tuple[object, ...]:
        """Which bytes an accessor has."""
        view = self.gltf.bufferViews[accessor.bufferView]
        start = (view.byteOffset or 0) + (accessor.byteOffset or 0)
        return view.buffer, start, accessor.count, self.stride(accessor), sizes(accessor)[1]

    def values(self, accessor: pygltflib.Accessor) -> np.ndarray:
        """The elements of an accessor, one a row, in their own type."""
        if accessor.bufferView is None:
            columns, rows = SHAPES[accessor.type]
            values = np.zeros((accessor.count, columns * rows), f"<{TYPES[accessor.componentType]}")
        else:
            values = self.elements(accessor, accessor.bufferView, accessor.byteOffset, accessor.count)
        if accessor.sparse:
            sparse = accessor.sparse
            indices = pygltflib.Accessor(type="SCALAR", componentType=sparse.indices.componentType)
            places = self.elements(indices, sparse.indices.bufferView, sparse.indices.byteOffset, sparse.count)
            replaced = self.elements(accessor, sparse.values.bufferView, sparse.values.byteOffset, sparse.count)
            values[places[:, 0]] = replaced
        return values

    def elements(self, accessor: pygltflib.Accessor, view_number: int, offset: int | None, count: int) -> np.ndarray:
        """`count` elements of the accessor's type, from a buffer view."""
        view = self.gltf.bufferViews[view_number]
        columns, rows = SHAPES[accessor.type]
        number = np.dtype(f"<{TYPES[accessor.componentType]}")
        column, size = sizes(accessor)
        return (
            np.ndarray(
                (count, columns, rows),
                number,
                self.buffer(view.buffer),
                (view.byteOffset or 0) + (offset or 0),
                (view.byteStride or size, column, number.itemsize),
            )
            .reshape(count, columns * rows)
            .copy()
        )


def sizes(accessor: pygltflib.Accessor) -> tuple[int, int]:
    """The bytes of a column, and of an element: columns of matrices start at multiples of four."""
    columns, rows = SHAPES[accessor.type]
    column = rows * np.dtype(TYPES[accessor.componentType]).itemsize
    if columns > 1:
        column += -column % 4
    return column, columns * column


@dataclass
class Primitive:
    """A primitive of a scene, and what pygltflib knows of it."""

    scene: Scene
    mesh: int
    number: int

    def __post_init__(self) -> None:
        self.mesh_parsed = self.scene.gltf.meshes[self.mesh]
        self.parsed = self.mesh_parsed.primitives[self.number]
        accessors = self.scene.gltf.accessors
        # By morph target and name.
        self.accessors: dict[tuple[int | None, str], pygltflib.Accessor] = {}
        sets = [(None, members(self.parsed.attributes)), *enumerate(map(members, self.parsed.targets or []))]
        for target, named in sets:
            self.accessors |= {(target, name): accessors[a] for name, a in named.items() if a is not None}
        self.position = self.accessors.get((None, "POSITION"))
        self.indices = None if self.parsed.indices is None else accessors[self.parsed.indices]

    def name(self) -> str:
        name = self.mesh_parsed.name if self.mesh_parsed.name is not None else f"mesh {self.mesh}"
        return name if len(self.mesh_parsed.primitives) == 1 else f"{name}, primitive {self.number}"

    def left_because(self) -> str | None:
        """Why meshweft does not order the faces of the primitive, and so does not list it."""
        mode = 4 if self.parsed.mode is None else self.parsed.mode
        if mode != 4:
            return MODES.get(mode, f"mode {mode}")
        if "KHR_draco_mesh_compression" in (self.parsed.extensions or {}):
            return "compressed by Draco"
        extensions = [*(self.parsed.extensions or {}), *(self.mesh_parsed.extensions or {})]
        if any(name.startswith("ACME_") for name in extensions):
            return "with an extension that is not known"
        if self.position is None:
            return "without POSITION"
        every = [*self.accessors.values(), *([self.indices] if self.indices else [])]
        if any(map(self.scene.is_compressed, every)):
            return "compressed by meshopt"
        if self.position.bufferView is None:
            return "with a POSITION of zeros"
        return self.left_because_of_indices()

    def left_because_of_indices(self) -> str | None:
        if self.indices is None:
            return "without whole triangles" if self.position.count % 3 else None
        if self.indices.sparse:
            return "with sparse indices"
        if self.indices.bufferView is None:
            return "with indices of zeros"
        if self.scene.stride(self.indices) != sizes(self.indices)[1]:
            return "with strided indices"
        return "without whole triangles" if self.indices.count % 3 else None

    def faces_place(self) -> tuple[object, ...]:
        """The same for primitives that share their faces, which are one mesh."""
        if self.indices is not None:
            return "indices", *self.scene.place(self.indices)
        return "positions", *self.scene.place(self.position)


def members(named: pygltflib.Attributes | dict[str, int]) -> dict[str, int]:
    """The accessors that a set of attributes names: pygltflib has two ways to hold it."""
    return named if isinstance(named, dict) else vars(named)


def primitives(scene: Scene) -> Iterator[Primitive]:
    for mesh, parsed in enumerate(scene.gltf.meshes):
        for number in range(len(parsed.primitives or [])):
            yield Primitive(scene, mesh, number)


def compare_mesh(where: str, ours: Mesh, theirs: Primitive, tally: Tally) -> None:
    """Compares a mesh with the primitive that it was made of."""
    tally.meshes += 1
    counts = (theirs.name(), theirs.position.count)
    if (ours.name, ours.vertices) != counts:
        tally.problems.append(f"{where}: {(ours.name, ours.vertices)} where the other reader has {counts}")
        return

    listed = {(attribute.target, attribute.name): attribute for attribute in ours.attributes}
    for key in listed.keys() - theirs.accessors.keys():
        tally.problems.append(f"{where}, {listed[key]}: the other reader has none")
    for key, accessor in theirs.accessors.items():
        if accessor.componentType not in TYPES:
            tally.left_out["attributes of 64-bit integers"] += 1
        elif key not in listed:
            tally.problems.append(f"{where}: {key} is not listed")
        elif listed[key].error and has_extension(accessor):
            tally.left_out["attributes with an extension on sparse elements"] += 1
        else:
            compare_attribute(where, listed[key], accessor, theirs.scene, tally)


def has_extension(accessor: pygltflib.Accessor) -> bool:
    """Whether sparse elements have one: meshweft does not read those."""
    sparse = accessor.sparse
    return bool(sparse and (sparse.extensions or sparse.indices.extensions or sparse.values.extensions))


def compare_attribute(where: str, ours: Attribute, accessor: pygltflib.Accessor, scene: Scene, tally: Tally) -> None:
    tally.compare(where, ours, scene.values(accessor))
    is_real = TYPES[accessor.componentType].startswith("f")
    normalized = bool(accessor.normalized) and not is_real
    if (ours.domain, ours.normalized) != ("vertex", normalized):
        tally.problems.append(f"{where}, {ours}: {ours.domain}, normalized: {ours.normalized}")

    # What kinds of storage were met.
    tally.kinds[f"{TYPES[accessor.componentType]}"] += 1
    tally.kinds["normalized"] += normalized
    tally.kinds["of morph targets"] += ours.target is not None
    tally.kinds["sparse"] += accessor.sparse is not None
    tally.kinds["of zeros"] += accessor.bufferView is None
    tally.kinds["matrices"] += accessor.type.startswith("MAT")
    tally.kinds["custom"] += ours.name.startswith("_")
    if accessor.bufferView is not None:
        tally.kinds["interleaved"] += scene.stride(accessor) != sizes(accessor)[1]


def compare_scene(name: str, ours: Document, scene: Scene, tally: Tally) -> None:
    """Walks the primitives in the order of the file: each is compared, or counted as left out."""
    rest = iter(ours.meshes)
    first_with: dict[tuple[object, ...], Primitive] = {}
    left = 0
    for primitive in primitives(scene):
        # What stays as it is, is not listed.
        where = f"{name}, mesh {primitive.mesh}, primitive {primitive.number}"
        if why := primitive.left_because():
            tally.left_out[f"primitives {why}"] += 1
            left += 1
            continue

        # Primitives that share their faces are one mesh, of which the first is listed.
        first = first_with.setdefault(primitive.faces_place(), primitive)
        if first is not primitive:
            same = [a is first.accessors.get(key) for key, a in primitive.accessors.items()]
            tally.left_out["primitives that share the faces of an earlier one"] += 1
            tally.left_out["attributes that only these name"] += same.count(False)
            continue

        # Any other is the next mesh.
        mesh = next(rest, None)
        if mesh is None:
            tally.problems.append(f"{where}: it is not listed")
            continue
        compare_mesh(where, mesh, primitive, tally)

    # Nothing else may be listed, and notes must tell of what is not.
    for mesh in rest:
        tally.problems.append(f"{name}: the other reader has no {mesh.name}")
    noted = sum(count for text, count in ours.notes if text.startswith(("left as it is", "its order stays")))
    if noted != left:
        tally.problems.append(f"{name}: notes for {noted} primitives that stay, and {left} do")


def check(program: str, file: Path, name: str, scratch: Path, tally: Tally) -> None:
    ours = read_counted(program, file, name, scratch, tally)
    if ours is None:
        return
    try:
        scene = Scene(file)
    except Exception as error:  # noqa: BLE001 - pygltflib raises whatever comes up
        tally.refuse(name, f"{type(error).__name__}, {len(ours.meshes)} meshes")
        return
    compare_scene(name, ours, scene, tally)
    tally.files += 1


def make(file: Path, tally: Tally) -> None:
    """Makes the file, and sees to it that the other reader reads what was put in."""
    content, expected = attributes_made.make()
    file.write_bytes(content)
    scene = Scene(file)
    found = 0
    for primitive in primitives(scene):
        for (target, name), accessor in primitive.accessors.items():
            found += 1
            if text := difference(expected[primitive.mesh, target, name], scene.values(accessor)):
                tally.problems.append(f"as it was made, mesh {primitive.mesh}, {name}: {text}")
    if found != len(expected):
        tally.problems.append(f"{len(expected)} attributes were made, and the other reader has {found}")


def main(program: str, data: Path, more: list[Path]) -> int:
    warnings.simplefilter("ignore")
    tally = Tally("glTF and GLB, pygltflib and numpy")
    with tempfile.TemporaryDirectory() as scratch:
        made = Path(scratch) / "types.glb"
        make(made, tally)
        # VRM is GLB under a name that meshweft does not take.
        named = {file: str(file.relative_to(data)) for file in files_below(data, ("gltf", "glb", "vrm"))}
        named |= {file: file.name for file in (made, *more)}
        for file, name in named.items():
            check(program, file, name, Path(scratch), tally)
    tally.print()
    return int(bool(tally.problems))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], Path(sys.argv[2]), [Path(file) for file in sys.argv[3:]]))
