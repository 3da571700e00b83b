"""trimesh reads the PLY file that meshweft makes from nothing: it must hold what was given.

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


def main(program: str) -> int:
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "create", folder], check=True)
        mesh = trimesh.load(Path(folder) / "new.ply", process=False)
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
    return bool(different)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
