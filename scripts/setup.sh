#!/usr/bin/env bash
# Bring a fresh checkout to the point where `hsr8` runs: a virtual environment, the locked
# packages, the project itself, and a software OpenGL. Safe to repeat: it does nothing while
# requirements.lock, pyproject.toml and this file are unchanged.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

venv=${VENV:-.venv}
stamp=$venv/.hsr8-setup

say() { echo ":: $*"; }
warn() { echo "!! $*" >&2; }

# apt_install PACKAGE... : install Debian packages if we may; 1 if we may not or it failed.
apt_install() {
    local root=()
    command -v apt-get >/dev/null || return 1
    if [[ $EUID -ne 0 ]]; then
        sudo -n true 2>/dev/null || return 1
        root=(sudo -n)
    fi
    say "installing Debian packages: $*"
    "${root[@]}" apt-get update -qq </dev/null >/dev/null 2>&1 || true
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "$@" </dev/null >/dev/null 2>&1
}

# The first interpreter of a supported version.
find_python() {
    local candidate
    for candidate in ${PYTHON:-python3 python3.11 python3.12 python3.13}; do
        if "$candidate" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 14))' \
            2>/dev/null; then
            command -v "$candidate"
            return
        fi
    done
    warn "no Python 3.11, 3.12 or 3.13 found${PYTHON:+ as PYTHON=$PYTHON}; on Debian: apt-get install python3"
    return 1
}

make_venv() {
    local python
    python=$(find_python)
    if ! "$python" -c 'import ensurepip, venv' 2>/dev/null && ! apt_install python3-venv; then
        warn "this Python cannot make virtual environments; as root: apt-get install python3-venv"
        return 1
    fi
    say "creating $venv with $("$python" --version)"
    "$python" -m venv "$venv"
}

gl_draws() {
    env -u MUJOCO_GL "$venv/bin/python" -c 'from hsr8.process.gl import require_gl; require_gl()' \
        >/dev/null 2>&1
}

fingerprint=$(cat requirements.lock pyproject.toml scripts/setup.sh | sha256sum | cut -d' ' -f1)
if [[ -x $venv/bin/hsr8 && -f $stamp && $(<"$stamp") == "$fingerprint" ]]; then
    exit 0
fi

started=$SECONDS
"$venv/bin/python" -m pip --version >/dev/null 2>&1 || make_venv
pip=("$venv/bin/python" -m pip --disable-pip-version-check --no-input)

say "installing the locked packages (about a minute the first time)"
"${pip[@]}" install -qq --require-hashes --no-deps --requirement requirements.lock
say "installing hsr8 itself, editable"
"${pip[@]}" install -qq --no-deps --no-build-isolation --no-index --editable .

if ! "$venv/bin/python" -c 'import pinocchio' 2>/dev/null && ! apt_install libgomp1; then
    warn "Pinocchio cannot be imported; as root: apt-get install libgomp1"
    exit 1
fi
if ! gl_draws && ! { apt_install libegl1 libgl1 && gl_draws; }; then
    warn "no OpenGL to draw with: camera and videos need it; as root: apt-get install libegl1 libgl1"
fi

"$venv/bin/python" -c '
from hsr8.cli.first_compilation import compile_all
compile_all(quiet=False)'

echo "$fingerprint" >"$stamp"
say "ready after $((SECONDS - started)) s"
