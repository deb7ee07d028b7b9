"""What stands below each attribute of a class in its source: the meaning of settings and options.

Pydantic can read it too, but when it makes a class: every process would parse the source of all
sections of a scenario, and only the schema and messages about mistakes need it.
"""

import ast
import inspect
import textwrap
from itertools import pairwise


def docstrings(described: type) -> dict[str, str]:
    """Docstring by attribute of a class and of those it extends; what has none is left out."""
    found: dict[str, str] = {}
    for part in reversed(described.__mro__):
        if part.__module__.split(".")[0] in ("builtins", "pydantic"):
            continue
        (tree,) = ast.parse(textwrap.dedent(inspect.getsource(part))).body
        assert isinstance(tree, ast.ClassDef)
        for line, below in pairwise(tree.body):
            if isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name):
                match below:
                    case ast.Expr(value=ast.Constant(value=str(text))):
                        found[line.target.id] = inspect.cleandoc(text)
    return found
