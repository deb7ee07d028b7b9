#!/usr/bin/env bash
# Resolve pyproject.toml into requirements.lock: every platform, with hashes, without index
# addresses. Existing pins stay; pass --upgrade, or --upgrade-package NAME, to move them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/setup.sh
[[ -x .venv/bin/uv ]] || .venv/bin/python -m pip install --quiet "uv>=0.13,<0.14"
.venv/bin/uv pip compile --quiet --universal --generate-hashes --python-version 3.11 \
    --group dev pyproject.toml --output-file requirements.lock \
    --no-emit-index-url --no-emit-find-links --no-annotate \
    --custom-compile-command "make lock" "$@"
bash scripts/setup.sh
