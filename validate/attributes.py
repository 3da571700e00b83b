"""What meshweft reads of a file, for the scripts that compare it with other readers."""

from __future__ import annotations

import json
import subprocess
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

# Folders of the test data that hold no meshes.
NO_MESHES = ("terrain", "nvidia")
# Folders of files that every reader should read.
GOOD_FILES = ("meshes", "gltf")


@dataclass
class Attribute:
    """An attribute: one row of `values` an element, in the type that it has in the file."""

    name: str
    target: int | None
    values: np.ndarray
    domain: str = "vertex"
    normalized: bool = False
    # Why it cannot be read, though it is listed.
    error: str | None = None

    def __str__(self) -> str:
        target = "" if self.target is None else f", morph target {self.target}"
        return f"{self.name}{target}"


@dataclass
class Mesh:
    name: str
    vertices: int
    faces: np.ndarray
    attributes: list[Attribute] = field(default_factory=list)


@dataclass
class Document:
    meshes: list[Mesh] = field(default_factory=list)
    # Text, and for how many places it holds.
    notes: list[tuple[str, int]] = field(default_factory=list)


class Refused(Exception):
    """meshweft does not open the file."""


def read(program: str, file: Path, scratch: Path) -> Document:
    """What the program `attributes` of `compare/` prints of a file.

    # Raises
    `Refused`; `RuntimeError` if the program fails in another way.
    """
    # Run the program.
    path = scratch / "values"
    ran = subprocess.run([program, str(file), str(path)], capture_output=True, text=True)
    if ran.returncode == 1:
        raise Refused(ran.stderr.strip())
    if ran.returncode:
        raise RuntimeError(f"{file.name}: exit code {ran.returncode}: {ran.stderr.strip()}")

    # Split at line feeds alone: names may hold what Python takes for line ends.
    lines = [json.loads(line) for line in ran.stdout.split("\n") if line]

    # Each line takes its share of the values.
    document, content, at = Document(), path.read_bytes(), 0
    for line in lines:
        values = content[at : at + line.get("bytes", 0)]
        at += len(values)
        if "note" in line:
            document.notes.append((line["note"], 1 + line["more"]))
        elif "attribute" not in line:
            faces = np.frombuffer(values, "<u4").reshape(line["faces"], 3)
            document.meshes.append(Mesh(line["name"], line["vertices"], faces))
        else:
            rows = np.frombuffer(values, f"<{line['type']}").reshape(line["count"], line["components"])
            labels = (line[key] for key in ("domain", "normalized", "error"))
            document.meshes[-1].attributes.append(Attribute(line["attribute"], line["target"], rows, *labels))

    # Nothing may be left.
    if at != len(content):
        raise RuntimeError(f"{file.name}: {len(content)} bytes of values, and lines for {at}")
    return document


def difference(ours: np.ndarray, theirs: np.ndarray) -> str | None:
    """The first element that is not the same, bit by bit; `None` if all are."""
    theirs = np.ascontiguousarray(theirs).astype(theirs.dtype.newbyteorder("<"), copy=False)
    kinds = [f"{array.dtype.str[1:]} {'x'.join(map(str, array.shape))}" for array in (ours, theirs)]
    if kinds[0] != kinds[1]:
        return f"{kinds[0]} where the other reader has {kinds[1]}"
    if ours.tobytes() == theirs.tobytes():
        return None
    width = ours.dtype.itemsize * ours.shape[1]
    rows = [np.frombuffer(array.tobytes(), np.uint8).reshape(-1, width) for array in (ours, theirs)]
    first = int((rows[0] != rows[1]).any(axis=1).argmax())
    return f"element {first} is {ours[first].tolist()} where the other reader has {theirs[first].tolist()}"


@dataclass
class Tally:
    """What was compared, and what was not."""

    title: str
    files: int = 0
    meshes: int = 0
    attributes: int = 0
    values: int = 0
    # What the attributes were like.
    kinds: Counter[str] = field(default_factory=Counter)
    # What was not compared, by reason.
    left_out: Counter[str] = field(default_factory=Counter)
    # Files that the other reader does not open, and why.
    refused: list[str] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)

    def compare(self, where: str, ours: Attribute, theirs: np.ndarray) -> None:
        """Compares the values of one attribute."""
        self.attributes += 1
        self.values += ours.values.size
        if found := ours.error or difference(ours.values, theirs):
            self.problems.append(f"{where}, {ours}: {found}")

    def refuse(self, name: str, why: str) -> None:
        """Counts a file that the other reader does not open; one that is made here must be read."""
        self.refused.append(f"{name}: {why}")
        if "/" not in name:
            self.problems.append(self.refused[-1])

    def print(self) -> None:
        if not self.attributes:
            self.problems.append("no attribute was compared")
        for problem in self.problems[:20]:
            print(f"DIFFERENT: {self.title}: {problem}")
        if len(self.problems) > 20:
            print(f"DIFFERENT: {self.title}: and {len(self.problems) - 20} more")
        if self.refused:
            self.left_out[f"files refused by the other reader ({'; '.join(self.refused)})"] = len(self.refused)
        print(
            f"attributes, {self.title}: {self.files} files, {self.meshes} meshes, {self.attributes} attributes "
            f"({self.values} numbers) are the same bit by bit: {counts(self.kinds)}; "
            f"left out: {counts(self.left_out) or 'nothing'}"
        )


def read_counted(program: str, file: Path, name: str, scratch: Path, tally: Tally) -> Document | None:
    """As `read`; `None`, and counted, if meshweft refuses the file."""
    try:
        return read(program, file, scratch)
    except Refused as refused:
        # Good files may not be refused. Of the faulty ones most are.
        folder = name.split("/")[0]
        if folder in GOOD_FILES:
            tally.problems.append(f"{name}: {refused}")
        tally.left_out[f"files of {folder}/ refused by meshweft"] += 1
        return None


def counts(counter: Counter[str]) -> str:
    return ", ".join(f"{count} {what}" for what, count in sorted(counter.items()) if count)


def files_below(data: Path, endings: tuple[str, ...]) -> Iterator[Path]:
    """The files of the test data with one of these endings, gzipped or not, sorted."""
    for file in sorted(data.rglob("*")):
        folder = file.relative_to(data).parts[0]
        if file.is_file() and folder not in NO_MESHES and ending_of(file) in endings:
            yield file


def ending_of(file: Path) -> str:
    return file.name.lower().removesuffix(".gz").rpartition(".")[2]
