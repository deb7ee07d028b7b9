BOUNDSCHECK: int | None
CACHE_DIR: str
DISABLE_JIT: int
OPT: object
