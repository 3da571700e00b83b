"""trimesh reads every mesh before and after `meshweft optimize`: nothing may differ but the order.

Usage: python text_formats.py MESHWEFT DATA_FOLDER
"""

from __future__ import annotations

import gzip
import json
import logging
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import trimesh

ENDINGS = ("obj", "ply", "off", "stl", "glb")
# Above that the reading takes longer than the rest of the checks.
MOST_FACES = 250_000


@dataclass
class Tally:
    """What was compared for one ending, and what was not."""

    ending: str
    read: int = 0
    changed: int = 0
    triangles: int = 0
    columns: set[str] = field(default_factory=set)
    refused: int = 0
    left_out: list[str] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)

    def print(self) -> None:
        for problem in self.problems:
            print(f"DIFFERENT: {problem}")
        columns = ", ".join(sorted(self.columns))
        print(
            f"{self.ending.upper()}, trimesh: {self.read} files, {self.changed} re-ordered, "
            f"{self.triangles} triangles with {columns or 'nothing'}; "
            f"refused by meshweft: {self.refused}; left out: {len(self.left_out)}{names(self.left_out)}"
        )


def names(files: list[str]) -> str:
    return f" ({', '.join(files)})" if files else ""


def ending_of(file: Path) -> str:
    return file.name.removesuffix(".gz").rsplit(".", 1)[-1]


def geometries(file: Path) -> Iterator[tuple[str, trimesh.Trimesh]]:
    """The meshes of a file by name, each vertex as the file has it."""
    opened = gzip.open(file) if file.suffix == ".gz" else file.open("rb")
    options: dict[str, object] = {"process": False}
    if ending_of(file) == "obj":
        # Not `maintain_order`: that gives a vertex with several coordinates a median of them.
        options |= {"skip_materials": True, "split_objects": False}
    with opened as stream:
        scene = trimesh.load_scene(stream, file_type=ending_of(file), **options)
    for name, mesh in scene.geometry.items():
        if isinstance(mesh, trimesh.Trimesh):
            yield name, mesh


def columns_of(mesh: trimesh.Trimesh) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """All that trimesh knows of each vertex and of each face, by name."""
    vertex: dict[str, np.ndarray] = {"positions": mesh.vertices.view(np.ndarray)}
    face: dict[str, np.ndarray] = {}
    # Only what the file has: asked for without one, trimesh makes normals and colours itself.
    if "vertex_normals" in mesh._cache.cache:
        vertex["vertex normals"] = mesh._cache.cache["vertex_normals"]
    match mesh.visual.kind:
        case "vertex":
            vertex["vertex colours"] = mesh.visual.vertex_colors
        case "face":
            face["face colours"] = mesh.visual.face_colors
        case "texture" if mesh.visual.uv is not None:
            vertex["texture coordinates"] = mesh.visual.uv
    vertex |= {f"vertex {name}": values for name, values in mesh.vertex_attributes.items()}
    face |= {f"face {name}": values for name, values in mesh.face_attributes.items()}
    # PLY: the properties as they were read, known to trimesh or not.
    raw = mesh.metadata.get("_ply_raw", {})
    for element, count, columns in (("vertex", len(mesh.vertices), vertex), ("face", len(mesh.faces), face)):
        data = raw.get(element, {}).get("data")
        for name in () if data is None else properties(data):
            values = np.asarray(data[name])
            if values.dtype != object and values.dtype.names is None and len(values) == count:
                columns[f"{element} properties"] = beside(columns.get(f"{element} properties"), values)
    return vertex, face


def properties(data: dict[str, np.ndarray] | np.ndarray) -> list[str]:
    """The PLY properties that are not the vertex numbers themselves."""
    every = data.dtype.names or () if isinstance(data, np.ndarray) else data
    return [name for name in every if name not in ("vertex_indices", "vertex_index")]


def beside(columns: np.ndarray | None, values: np.ndarray) -> np.ndarray:
    values = rows(values)
    return values if columns is None else np.hstack([columns, values])


def rows(values: np.ndarray) -> np.ndarray:
    """The bytes of each row, so that not a bit may differ."""
    values = np.ascontiguousarray(values).reshape(len(values), -1)
    return values.view(np.uint8) if values.size else np.zeros((len(values), 0), np.uint8)


def joined(columns: dict[str, np.ndarray], count: int) -> np.ndarray:
    """All columns side by side as bytes."""
    return np.hstack([np.zeros((count, 0), np.uint8), *(rows(columns[key]) for key in sorted(columns))])


def numbered(before: np.ndarray, after: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Numbers for the rows of both: equal rows have equal numbers."""
    both = np.ascontiguousarray(np.vstack([before, after]))
    if not both.shape[1]:
        both = np.zeros((len(both), 1), np.uint8)
    whole = both.view(np.dtype((np.void, both.shape[1]))).ravel()
    numbers = np.unique(whole, return_inverse=True)[1].reshape(-1)
    return numbers[: len(before)], numbers[len(before) :]


def triangles(mesh: trimesh.Trimesh, vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """The triangles sorted, each with the least of its corners first, and what its face carries."""
    corners = vertices[mesh.faces].reshape(-1, 3)
    turns = np.stack([np.roll(corners, -turn, axis=1) for turn in range(3)])
    least = np.zeros(len(corners), int)
    for turn in (1, 2):
        kept = turns[least, np.arange(len(corners))]
        difference = turns[turn] - kept
        first = np.argmax(difference != 0, axis=1)
        least[difference[np.arange(len(corners)), first] < 0] = turn
    every = np.hstack([turns[least, np.arange(len(corners))], faces.reshape(-1, 1)])
    return every[np.lexsort(every.T[::-1])]


def compare(name: str, before: trimesh.Trimesh, after: trimesh.Trimesh, tally: Tally) -> None:
    if before.vertices.shape != after.vertices.shape or before.faces.shape != after.faces.shape:
        tally.problems.append(f"{name}: the number of vertices or faces")
        return
    pairs = list(zip(columns_of(before), columns_of(after), strict=True))
    for old, made in pairs:
        if old.keys() != made.keys():
            tally.problems.append(f"{name}: {sorted(old)} | {sorted(made)}")
            return
        tally.columns |= old.keys()
    counts = (len(before.vertices), len(before.faces))
    vertices, faces = (
        numbered(*(joined(columns, count) for columns in pair)) for pair, count in zip(pairs, counts, strict=True)
    )
    tally.triangles += len(before.faces)
    # Vertices without a face count as well.
    if not np.array_equal(np.sort(vertices[0]), np.sort(vertices[1])):
        tally.problems.append(f"{name}: the vertices")
    if not np.array_equal(triangles(before, vertices[0], faces[0]), triangles(after, vertices[1], faces[1])):
        tally.problems.append(f"{name}: the triangles")


def check(program: str, file: Path, scratch: Path, tally: Tally) -> None:
    name = f"{file.parent.name}/{file.name}"
    inspected = subprocess.run([program, "inspect", "--json", str(file)], capture_output=True, text=True)
    if inspected.returncode:
        # Faulty files may be refused, and are by most readers; good ones may not.
        if file.parent.name != "malformed":
            tally.problems.append(f"{name}: {inspected.stderr.strip()}")
        tally.refused += 1
        return
    if (faces := json.loads(inspected.stdout)["total"]["faces"]) > MOST_FACES:
        tally.left_out.append(f"{file.name}: {faces} faces")
        return
    result = scratch / file.name
    optimized = subprocess.run(
        [program, "optimize", str(file), "-o", str(result), "--quiet"], capture_output=True, text=True
    )
    if optimized.returncode:
        tally.problems.append(f"{name}: {optimized.stderr.strip()}")
        return
    tally.changed += file.read_bytes() != result.read_bytes()
    try:
        before = dict(geometries(file))
    except Exception as error:  # noqa: BLE001 - trimesh raises whatever comes up
        tally.left_out.append(f"{file.name}: trimesh: {type(error).__name__}")
        return
    after = dict(geometries(result))
    result.unlink()
    if list(before) != list(after):
        tally.problems.append(f"{name}: {list(before)} | {list(after)}")
        return
    for mesh, old in before.items():
        compare(f"{name}, {mesh}", old, after[mesh], tally)
    tally.read += 1


def main(program: str, data: Path) -> int:
    logging.getLogger("trimesh").setLevel(logging.CRITICAL)
    tallies = {ending: Tally(ending) for ending in ENDINGS}
    folders = (data / "meshes", data / "gltf", data / "malformed")
    with tempfile.TemporaryDirectory() as scratch:
        for folder in folders:
            for file in sorted(folder.iterdir()):
                if (ending := ending_of(file)) in tallies:
                    check(program, file, Path(scratch), tallies[ending])
    for tally in tallies.values():
        if not tally.read:
            tally.problems.append(f"no .{tally.ending} file was compared")
        tally.print()
    return int(any(tally.problems for tally in tallies.values()))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], Path(sys.argv[2])))
