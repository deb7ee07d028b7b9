"""``python -m hsr8`` is the same as ``hsr8``."""

from hsr8.cli.main import entry

if __name__ == "__main__":
    raise SystemExit(entry())
