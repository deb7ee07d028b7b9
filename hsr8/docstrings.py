"""Attribute docstrings of a class, read from its source.

Pydantic reads them when a class is made: every process would parse the source of all sections of
a scenario, but only the schema and error messages need them.
"""

import ast
import inspect
import textwrap
from itertools import pairwise


def docstrings(described: type) -> dict[str, str]:
    """Return the docstring by attribute of a class and its bases."""
    texts: dict[str, str] = {}
    for part in reversed(described.__mro__):
        if part.__module__.split(".")[0] in ("builtins", "pydantic"):
            continue
        (tree,) = ast.parse(textwrap.dedent(inspect.getsource(part))).body
        assert isinstance(tree, ast.ClassDef)
        for line, below in pairwise(tree.body):
            if isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name):
                match below:
                    case ast.Expr(value=ast.Constant(value=str(text))):
                        texts[line.target.id] = inspect.cleandoc(text)
    return texts
