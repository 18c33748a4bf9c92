# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in a process of its own, so that Blender goes on whatever becomes of it."""

from __future__ import annotations

import importlib.util
import json
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

#: The program that a job runs.
WORKER = Path(__file__).with_name("worker.py")
#: How much of what a crashed process said is shown, characters.
SAID = 300
#: Time between two looks at a job that is waited for, s.
PAUSE = 0.02


class Failure(Exception):
    """Why a job has no result, for people: a text, and what stands in its braces."""

    def __init__(
        self, text: str, *values: object, code: str = "crashed", findings: list[dict[str, Any]] | None = None
    ) -> None:
        super().__init__(text.format(*values) if values else text)
        self._text, self._values = text, values
        #: The library's name of the kind of failure; ``crashed`` or ``cancelled`` if it did not come to that.
        self.code = code
        #: What a check has found, one by one.
        self.findings = findings or []

    def translated(self, translate: Callable[[str], str]) -> str:
        """The text in another language."""
        return translate(self._text).format(*self._values) if self._values else translate(self._text)


def package_paths() -> list[str]:
    """Where the process finds the wheel and NumPy."""
    paths = []
    for name in ("seamstress_mesh", "numpy"):
        spec = importlib.util.find_spec(name)
        if spec is None or spec.origin is None:
            raise Failure("The package {} is missing; install the extension again", name)
        paths.append(str(Path(spec.origin).parents[1]))
    return paths


class Job:
    """A call of a function of the worker, running."""

    def __init__(self, function: str, **arguments: Any) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="seamstress-", ignore_cleanup_errors=True)
        folder = Path(self._folder.name)
        (folder / "job.pickle").write_bytes(pickle.dumps((function, arguments)))
        self._said = folder / "said.txt"
        flags = subprocess.CREATE_NO_WINDOW if sys.platform == "win32" else 0
        # Isolated: neither the user's packages nor variables of the environment change what runs.
        command = [sys.executable, "-I", str(WORKER), str(folder), *package_paths()]
        with self._said.open("wb") as said:
            try:
                self._process = subprocess.Popen(
                    command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=said, creationflags=flags
                )
            except OSError as error:
                raise Failure("No process could be started: {}", error) from error
        #: The stage that runs, and the share of it that is done.
        self.progress: tuple[str, float] = ("start", 0.0)
        self._is_cancelled = False
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()

    def _listen(self) -> None:
        for line in self._process.stdout:
            try:
                stage, fraction = json.loads(line)
            except ValueError:
                continue
            self.progress = (stage, fraction)

    @property
    def is_running(self) -> bool:
        """Whether there is neither a result nor a failure yet."""
        return self._process.poll() is None

    def cancel(self) -> None:
        """Ends the process at once."""
        self._is_cancelled = True
        self._process.kill()
        self._process.wait()

    def result(self) -> dict[str, Any]:
        """What the function has returned, waited for. Raises ``Failure`` if there is nothing."""
        while self.is_running:
            time.sleep(PAUSE)
        self._listener.join()
        self._process.stdout.close()
        with self._folder as folder:
            if self._is_cancelled:
                raise Failure("Cancelled", code="cancelled")
            path = Path(folder, "result.pickle")
            if not path.exists():
                raise self._crash()
            made = pickle.loads(path.read_bytes())
        if error := made.get("error"):
            raise Failure(error["message"], code=error["code"] or "failed", findings=error["findings"])
        return made["result"]

    def _crash(self) -> Failure:
        code = self._process.returncode
        said = self._said.read_text(errors="replace").strip()[-SAID:]
        if code == -getattr(signal, "SIGKILL", 0) or "memory allocation" in said or "MemoryError" in said:
            return Failure("The work was ended, probably because memory ran out. Try a mesh of fewer faces")
        how = f"signal {-code}" if code < 0 else f"code {code}"
        return Failure("The work ended unexpectedly ({}); nothing was changed. {}", how, said)
