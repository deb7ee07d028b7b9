"""``hsr8 bug-report``: what helps to find a mistake, in one file to send."""

import io
import zipfile
from dataclasses import asdict
from pathlib import Path

from hsr8.cli.doctor import examine
from hsr8.cli.options import BugReport
from hsr8.cli.output_file import writing
from hsr8.errors import UsageError
from hsr8.recorder.files import atomic
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.run_reader import open_run

FILES = (
    run_folder.MANIFEST,
    run_folder.SCENARIO,
    run_folder.METRICS,
    run_folder.EVENTS,
    run_folder.CRASH,
    run_folder.FRAMES,
)
LARGEST = 300_000  # of a longer file the end is packed [byte]
NOTE = f"""What is in here: the findings of `hsr8 doctor`, and of the run its versions, scenario,
results, events, traceback and last frames (at most {LARGEST // 1000} kB of each). No pictures.
The home directory is written as ~. Please say in a sentence what you did and what you expected.
"""


def main(options: BugReport) -> int:
    """Write the ZIP file and say what is in it.

    Raises:
        UsageError: there is no such run, a file of it cannot be read, or the report is there
            already or cannot be written.
    """
    _require_new(options.out)
    folder = None if options.run is None else open_run(options.run).path
    content = contents(folder)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in content.items():
            archive.writestr(name, text)
    with writing("--out", options.out):
        options.out.write_bytes(packed.getvalue())
    if options.json:
        print(atomic.dumps({"report": str(options.out), "files": list(content)}))
        return 0
    print(f"report      {options.out} ({len(packed.getvalue()) / 1000:.0f} kB)")
    print(f"holds       {', '.join(content)}")
    return 0


def _require_new(out: Path) -> None:
    try:
        there = out.exists()
    except OSError as error:
        raise UsageError(f"--out {out}: cannot be written: {error.strerror}") from None
    if there:
        raise UsageError(f"--out {out}: is there already; choose another name")


def contents(folder: Path | None) -> dict[str, str]:
    """Text by name; of a run folder only what is there.

    Raises:
        UsageError: a file of it cannot be read.
    """
    findings = {"findings": [asdict(finding) for finding in examine()]}
    packed = {"README.txt": NOTE, "doctor.json": atomic.dumps(findings, indent=2)}
    if folder is not None:
        packed |= {f"run/{n}": _end(folder / n) for n in FILES if (folder / n).is_file()}
        sizes = {file.name: file.stat().st_size for file in folder.iterdir() if file.is_file()}
        packed["run/sizes.json"] = atomic.dumps(sizes, indent=2)
    home = str(Path.home())
    return {
        name: text.replace(home, "~") if len(home) > 1 else text for name, text in packed.items()
    }


def _end(file: Path) -> str:
    """The last of a text file, which may be damaged."""
    try:
        with file.open("rb") as stream:
            stream.seek(max(0, file.stat().st_size - LARGEST))
            return stream.read(LARGEST).decode("utf-8", errors="replace")
    except OSError as error:
        raise UsageError(f"cannot read {file}: {error.strerror}") from None
