#!/usr/bin/env bash
# Build the wheel, install it into an environment where this checkout cannot be seen, and use
# its contents: command line, scenarios, models.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

echo ":: building the wheel"
rm -rf dist
.venv/bin/python -m hatchling build --target wheel >/dev/null
wheels=(dist/hsr8-*.whl)

echo ":: installing ${wheels[0]} into a separate environment"
.venv/bin/python -m venv "$scratch/venv"
"$scratch/venv/bin/python" -m pip install -qq --no-deps --no-index "${wheels[0]}"
# Dependencies are borrowed from .venv by path. A borrowed folder's own .pth files are not read,
# so the editable install there stays invisible and cmeel's prefix (pinocchio) is named here.
"$scratch/venv/bin/python" - "$(.venv/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')" <<'PYTHON'
import pathlib
import sys
import sysconfig

site = pathlib.Path(sys.argv[1])
python = f"python{sys.version_info.major}.{sys.version_info.minor}"
prefix = site / "cmeel.prefix" / "lib" / python / "site-packages"
pathlib.Path(sysconfig.get_path("purelib"), "borrowed.pth").write_text(f"{site}\n{prefix}\n")
PYTHON

echo ":: running from it"
cd "$scratch"
venv/bin/python -c '
import hsr8, sys
assert hsr8.__file__.startswith(sys.prefix), hsr8.__file__'
venv/bin/hsr8 check quick >/dev/null
venv/bin/hsr8 run quick --duration 1 --quiet --out runs >/dev/null || [[ $? -eq 1 ]]
find runs -name metrics.json | grep -q .
echo ":: the wheel works"
