"""trimesh reads every OFF and binary STL: the attributes must be those that meshweft reads, bit by bit.

Of OFF it has the positions: numpy reads the rest. What STL has beside the two bytes of each facet is compared with
stl_io in `compare/` too, also of ascii files. The files are those of the test data, and two made here: of the others
none has colours, and no facet bytes other than zeros.

Usage: python attributes_trimesh.py ATTRIBUTES DATA_FOLDER

ATTRIBUTES is the program of that name in `compare/`.
"""

from __future__ import annotations

import gzip
import sys
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import BinaryIO

import numpy as np
from trimesh.exchange.off import load_off
from trimesh.exchange.stl import HeaderError, load_stl_binary

from attributes import Mesh, Tally, files_below, read_counted

# The values of each attribute, by name and domain; STL has positions by corner.
Columns = dict[tuple[str, str], np.ndarray]
POSITION = ("POSITION", "vertex")
FACETS = 100


def off(file: Path) -> Columns:
    """Positions by trimesh; what the keyword promises, and colours of faces, by numpy."""
    with opened(file) as stream:
        columns = {POSITION: single(load_off(stream)["vertices"])}
        stream.seek(0)
        text = stream.read().decode(errors="replace")
    lines = [line for line in (line.partition("#")[0].split() for line in text.splitlines()) if line]
    keyword, (vertices, faces) = lines[0][0], map(int, lines[1][:2])
    rows = [lines[2 : 2 + vertices], lines[2 + vertices : 2 + vertices + faces]]

    # The columns of vertices stand in the order normal, colour, texture.
    start = 3
    end = -2 if "ST" in keyword else None
    if "N" in keyword:
        columns["NORMAL", "vertex"] = single(table(line[start : start + 3] for line in rows[0]))
        start += 3
    if "C" in keyword:
        columns["COLOR_0", "vertex"] = colours([line[start:end] for line in rows[0]])
    if end:
        columns["TEXCOORD_0", "vertex"] = single(table(line[end:] for line in rows[0]))

    # After its corners a face may have a colour, which all of its triangles have.
    corners = [int(line[0]) for line in rows[1]]
    behind = [line[1 + count :] for line, count in zip(rows[1], corners, strict=True)]
    if behind and len(behind[0]) in (3, 4):
        columns["COLOR_0", "face"] = np.repeat(colours(behind), np.array(corners) - 2, axis=0)
    return columns


def table(rows: Iterable[list[str]]) -> np.ndarray:
    return np.array(list(rows), np.float64)


def colours(rows: list[list[str]]) -> np.ndarray:
    """Bytes if all are whole numbers."""
    return table(rows).astype("u1") if all(word.isdigit() for row in rows for word in row) else single(table(rows))


def stl(file: Path) -> Columns:
    with opened(file) as stream:
        loaded = load_stl_binary(stream)
    return {
        POSITION: single(loaded["vertices"]),
        ("NORMAL", "face"): single(loaded["face_normals"]),
        ("attribute", "face"): loaded["face_attributes"]["stl"].reshape(-1, 1),
    }


def make(scratch: Path) -> tuple[dict[Path, str], dict[Path, str]]:
    """An OFF with everything it can have, and a binary STL of random bytes, by name."""
    random = np.random.default_rng(1)
    files = [scratch / "made.off", scratch / "made.stl"]
    vertices = "\n".join(" ".join(map(str, row)) for row in random.random((6, 12)).tolist())
    faces = "3 0 1 2 255 0 7\n4 2 3 4 5 1 2 3\n3 4 5 0 9 8 7\n"
    files[0].write_text(f"STCNOFF\n6 3 0\n{vertices}\n{faces}")
    files[1].write_bytes(bytes(80) + FACETS.to_bytes(4, "little") + random.bytes(50 * FACETS))
    return {files[0]: files[0].name}, {files[1]: files[1].name}


def opened(file: Path) -> BinaryIO:
    return gzip.open(file) if file.suffix == ".gz" else file.open("rb")


def single(values: np.ndarray) -> np.ndarray:
    """In the type of meshweft, which rounds once: text is read as the nearest number of 32 bits."""
    return values.astype("<f4")


def compare_mesh(name: str, ours: Mesh, theirs: Columns, is_by_corner: bool, tally: Tally) -> None:
    for attribute in ours.attributes:
        key = (attribute.name, attribute.domain)
        if key not in theirs:
            tally.problems.append(f"{name}, {attribute} of {attribute.domain}: the other reader has none")
            continue
        if key == POSITION and is_by_corner:
            attribute.values = attribute.values[ours.faces.reshape(-1)]
        tally.compare(name, attribute, theirs.pop(key))
        tally.kinds[f"{attribute.name} of {attribute.domain}"] += 1
    for column in theirs:
        tally.problems.append(f"{name}: {column} is not listed")
    tally.meshes += 1
    tally.files += 1


def check(program: str, named: dict[Path, str], load: Callable[[Path], Columns], scratch: Path) -> Tally:
    is_stl = load is stl
    tally = Tally("STL, trimesh" if is_stl else "OFF, trimesh and numpy")
    for file, name in named.items():
        ours = read_counted(program, file, name, scratch, tally)
        if ours is None:
            continue
        if not ours.meshes:
            tally.left_out["files without faces"] += 1
            continue
        try:
            theirs = load(file)
        except HeaderError:
            tally.left_out["ascii files"] += 1
        except Exception as error:  # noqa: BLE001 - trimesh raises whatever comes up
            tally.refuse(name, type(error).__name__)
        else:
            compare_mesh(name, ours.meshes[0], theirs, is_stl, tally)
    return tally


def main(program: str, data: Path) -> int:
    def below(ending: str) -> dict[Path, str]:
        return {file: str(file.relative_to(data)) for file in files_below(data, (ending,))}

    with tempfile.TemporaryDirectory() as folder:
        scratch = Path(folder)
        made_off, made_stl = make(scratch)
        tallies = [
            check(program, below("off") | made_off, off, scratch),
            check(program, below("stl") | made_stl, stl, scratch),
        ]
    for tally in tallies:
        tally.print()
    return int(any(tally.problems for tally in tallies))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], Path(sys.argv[2])))
