"""A case of `reports`: a copy of the data, the program, and what is expected of what it writes."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import plain
from measured import Measured, measured


class Wrong(Exception):
    """What is not as the row expects."""


def expect(holds, words) -> None:
    if not holds:
        raise Wrong(words() if callable(words) else words)


class Case:
    """A copy of the data in a folder that may be written to, and the program."""

    def __init__(self, program: Path, data: Path, folder: Path):
        self.program, self.folder = program, folder
        shutil.copytree(data, folder, dirs_exist_ok=True)
        for path in [folder, *folder.rglob("*")]:
            path.chmod(0o755 if path.is_dir() else 0o644)

    def path(self, name: str) -> Path:
        return self.folder / name

    def run(self, *arguments, seconds=60) -> Measured:
        return measured([self.program, *arguments], self.folder, seconds)

    def done(self, *arguments) -> Measured:
        run = self.run(*arguments)
        expect(run.code == 0, lambda: f"`{' '.join(arguments)}` ended with {run.words()}")
        return run

    def refused(self, *arguments) -> str:
        """What the program says; it must end with 1 and say where."""
        run = self.run(*arguments)
        expect(run.code == 1, lambda: f"`{' '.join(arguments)}` ended with {run.words()}, not refused")
        expect("panicked" not in run.error, run.error)
        return run.error

    def optimized(self, name: str, read, *flags, output=None) -> tuple[list, list, Measured, dict]:
        """The pieces before and after; the triangles must be the same, by two readers."""
        output = output or f"out/{name}"
        run = self.done("optimize", name, "-o", output, "--json", *flags)
        before, after = read(self.path(name)), read(self.path(output))
        old, new = plain.bag(before), plain.bag(after)
        expect(old == new, lambda: f"other triangles: {plain.first_words(2, old, new)}")
        expect(sum(old.values()) > 0, "this check reads no triangle")
        self.same(name, output)
        return before, after, run, json.loads(run.output)

    def same(self, name: str, output: str) -> None:
        found = json.loads(self.done("compare", name, output, "--json").output)
        expect(found["same_triangles"], "`compare` says other triangles")

    def moved(self, name: str, read, *flags) -> tuple[list, list, Measured]:
        """Like `optimized`; faces must have moved, and the report must say so."""
        before, after, run, report = self.optimized(name, read, *flags)
        expect(is_changed(report), "the report says that nothing changed")
        expect(faces_of(before) != faces_of(after), "the faces are where they were")
        return before, after, run


def is_changed(report: dict) -> bool:
    return any(mesh["changed"] for mesh in report["meshes"])


def faces_of(pieces: list) -> list:
    """The faces in the order in which they are drawn, each turned so that corners may start anywhere."""
    return [(piece.state, plain.turned(face)) for piece in pieces for face in piece.faces()]


def misses(pieces: list) -> float:
    """Misses per face of all pieces drawn one after the other."""
    return plain.Piece((), pieces[0].records, [i for piece in pieces for i in piece.indices]).misses_per_face()


def gain(before: list, after: list) -> str:
    return f"{misses(before):.3f} -> {misses(after):.3f} misses per face"


def notes(run: Measured, *words: str) -> str:
    """The line on standard error that has all these words."""
    for line in run.error.splitlines():
        if all(re.search(word, line, re.I) for word in words):
            return line
    said = [line for line in run.error.splitlines() if line.startswith(("note", "error"))]
    raise Wrong(f"no note with {words} in: {said or 'nothing'}")
