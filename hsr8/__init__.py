"""hsr8: a full-body simulator of a small humanoid that sees, looks and walks."""

from hsr8.gl import choose_backend

__version__ = "0.1.0"

choose_backend()
