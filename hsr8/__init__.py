"""hsr8: a full-body simulator of a small humanoid that sees, looks and walks."""

__version__ = "0.1.0"
