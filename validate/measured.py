"""A command's result, time and memory, and how much memory the project promises to need."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
from dataclasses import dataclass

MIB = 1 << 20


@dataclass
class Measured:
    """How a command ended. `peak` is the most resident memory in bytes, `processor` seconds of all threads."""

    code: int
    output: str
    error: str
    processor: float
    peak: int
    is_hung: bool

    def words(self) -> str:
        """How it ended, for a line of a report."""
        if self.is_hung:
            return "not done in time"
        said = self.error.strip().splitlines()
        return f"exit {self.code}" + (f": {said[0][:300]}" if said else "")


def measured(command: list, folder=None, seconds: float = 60, most_bytes: int = 0) -> Measured:
    """Runs a command; it is ended after `seconds`, and gets no more address space than `most_bytes`, if given."""
    command = [str(word) for word in command]
    if most_bytes:
        command = ["sh", "-c", f'ulimit -v {most_bytes // 1024}; exec "$@"', "sh", *command]
    run = subprocess.Popen(
        command,
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    texts = {}

    def keep(name, stream):
        texts[name] = stream.read().decode(errors="replace")

    readers = [
        threading.Thread(target=keep, args=(name, stream), daemon=True)
        for name, stream in (("output", run.stdout), ("error", run.stderr))
    ]
    for reader in readers:
        reader.start()
    is_hung = threading.Event()

    def end():
        is_hung.set()
        os.killpg(run.pid, signal.SIGKILL)

    timer = threading.Timer(seconds, end)
    timer.start()
    _, status, usage = os.wait4(run.pid, 0)
    timer.cancel()
    # What `wait4` has taken, `Popen` must not wait for.
    run.returncode = os.waitstatus_to_exitcode(status)
    for reader in readers:
        reader.join(5)
    run.stdout.close()
    run.stderr.close()
    processor = usage.ru_utime + usage.ru_stime
    return Measured(
        run.returncode, texts.get("output", ""), texts.get("error", ""), processor, usage.ru_maxrss * 1024, is_hung.is_set()
    )


def allowed(file_bytes: int) -> int:
    """The memory that the README promises for a file of that size, unpacked."""
    return 64 * MIB + 20 * file_bytes
