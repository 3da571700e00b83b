"""trimesh reads the files that meshweft makes from nothing: they must hold what was given.

Usage: python created.py MESHWEFT_APPEND
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import trimesh

# What append/src/create.rs stores.
EXPECTED = {
    "positions": np.array([[0.1, 0, 0], [1, 0, 0.25], [0, 1, 0.5], [1, 1, 0.75]], np.float32),
    "faces": np.array([[0, 1, 2], [2, 1, 3]]),
    "colors": np.array([[255, 0, 0, 255], [0, 254, 1, 128], [2, 3, 253, 64], [9, 8, 7, 0]]),
    "normals": np.array([[0, 0, 1]] * 4, np.float32),
    "texture": np.arange(8).reshape(4, 2) / 16,
    "age": np.array([0.25, 1e300, -2, 4]),
    "part": np.array([-7, 70_000]),
}
# A third mesh of those files, after one without vertices and faces.
MORE = np.array([[1 / 3, -1.25e-7, 3e20], [-16_777_216, 0, 1.1754944e-38], [0.1, 7, -2e-5]], np.float32)
MORE_FACES = np.array([[2, 0, 1], [0, 0, 1]])


def triangles(path: Path) -> np.ndarray:
    """The corners of all faces of a file, mesh after mesh."""
    loaded = trimesh.load(path, process=False)
    meshes = loaded.geometry.values() if isinstance(loaded, trimesh.Scene) else [loaded]
    return np.concatenate([mesh.vertices.astype(np.float32)[mesh.faces] for mesh in meshes])


def plain(folder: Path) -> int:
    """Meshes of positions and faces alone, in every format."""
    first = EXPECTED["positions"][EXPECTED["faces"]]
    both = np.concatenate([first, MORE[MORE_FACES]])
    expected = {f"plain.{ending}": first for ending in ["glb", "ply", "obj", "off", "stl"]}
    expected |= {f"several.{ending}": both for ending in ["glb", "gltf", "obj"]}
    different = 0
    for name, corners in expected.items():
        found = triangles(folder / name)
        if not np.array_equal(found, corners):
            print(f"DIFFERENT: {name}: {found.tolist()}")
            different += 1
    scene = trimesh.load(folder / "several.glb", process=False)
    names = list(scene.geometry)
    if names != ["plain", "more # 2"] or "nothing" not in scene.graph.nodes:
        print(f"DIFFERENT: several.glb: {names}, {list(scene.graph.nodes)}")
        different += 1
    if not different:
        print(f"append: plain meshes from nothing, trimesh: {', '.join(expected)} as given")
    return different


def main(program: str) -> int:
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "create", folder], check=True)
        mesh = trimesh.load(Path(folder) / "new.ply", process=False)
        failed = plain(Path(folder))
    raw = mesh.metadata["_ply_raw"]
    columns = raw["vertex"]["data"]
    found = {
        "positions": mesh.vertices.astype(np.float32),
        "faces": mesh.faces,
        # With texture coordinates beside them trimesh makes no colors of its own.
        "colors": np.column_stack([columns[name].ravel() for name in ("red", "green", "blue", "alpha")]),
        "texture": mesh.visual.uv,
        "normals": mesh.vertex_normals.astype(np.float32),
        "age": columns["age"].ravel(),
        "part": raw["face"]["data"]["part"].ravel(),
    }
    different = [name for name, values in EXPECTED.items() if not np.array_equal(found[name], values)]
    for name in different:
        print(f"DIFFERENT: new.ply: {name}: {found[name].tolist()}")
    if not different:
        print(f"append: new.ply from nothing, trimesh: {', '.join(EXPECTED)} as given")
    return bool(different or failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
