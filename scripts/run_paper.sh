#!/usr/bin/env bash
# The paper's experiment, with its video and Rerun log. Arguments go to `hsr8 run paper`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

exec .venv/bin/hsr8 run paper --video --log "$@"
