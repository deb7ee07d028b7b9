"""Do the tests notice a wrong equation: small mistakes made on purpose, one at a time.

    python scripts/mutation_study.py --each 40
    python scripts/mutation_study.py --modules navigation/motion/univector --each 1000

It prints rows of the table in docs/results/tests.md, which explains each survivor.

Each mutant is one changed operator, comparison, number, sign, condition or function name of one
module. It runs against the module's own tests in a forked process; it is killed if any of them
fails or does not come to its end.
"""

import argparse
import ast
import copy
import importlib.abc
import importlib.util
import os
import random
import signal
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType

import pytest
from hypothesis import Phase, settings

ROOT = Path(__file__).resolve().parents[1]
TESTS = {  # where they are not those of the same name
    "navigation/belief/pose_filter": (
        "navigation/belief/test_pose_filter",
        "navigation/belief/test_localization",
    ),
    "walking/zmp_solver": ("walking/test_zmp_plan",),
}
MODULES = (
    "navigation/partial_evaluation",
    "navigation/gaze/gaze_map",
    "navigation/motion/univector",
    "navigation/motion/move_to_goal",
    "navigation/motion/avoid_obstacle",
    "navigation/motion/motion_field",
    "navigation/motion/virtual_obstacle",
    "navigation/motion/velocity_modification",
    "navigation/belief/localization",
    "navigation/belief/pose_filter",
    "navigation/belief/association",
    "navigation/belief/particles",
    "navigation/belief/imm",
    "navigation/belief/local_map",
    "walking/pendulum",
    "walking/reference",
    "walking/zmp_plan",
    "walking/zmp_solver",
    "walking/balance",
    "walking/footsteps",
    "walking/swing_reaction",
    "walking/corrections",
    "walking/estimation",
)
OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.Pow: ast.Mult,
    ast.MatMult: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
}
COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
NAMES = {"cos": "sin", "sin": "cos", "min": "max", "max": "min", "exp": "abs", "any": "all"}
NAMES |= {"minimum": "maximum", "maximum": "minimum", "argmin": "argmax", "argmax": "argmin"}
NAMES |= {"all": "any", "floor": "ceil", "ceil": "floor"}
LEAST = 20.0  # a mutant hangs after this time [s], or after PATIENCE times that of the tests
PATIENCE = 6.0
PROFILE = "no shrinking"


@dataclass(frozen=True)
class Mutant:
    """One mistake: where, the code that is replaced, by what, and the whole module with it."""

    line: int
    before: str
    after: str
    tree: ast.Module


def candidates(tree: ast.AST) -> Iterator[ast.AST]:
    """Nodes that are computed with: no annotations, docstrings, assertions or messages."""
    for name, value in ast.iter_fields(tree):
        if name in ("annotation", "returns", "decorator_list"):
            continue
        for node in value if isinstance(value, list) else [value]:
            skipped = (ast.Raise, ast.Assert, ast.Import, ast.ImportFrom, ast.JoinedStr)
            if isinstance(node, ast.AST) and not isinstance(node, skipped):
                yield node
                yield from candidates(node)


def replacements(node: ast.AST) -> Iterator[ast.AST]:
    """Replacements of a node."""
    match node:
        case ast.BinOp(left, operator, right) if type(operator) in OPERATORS:
            yield ast.BinOp(left, OPERATORS[type(operator)](), right)
        case ast.AugAssign(target, operator, value) if type(operator) in OPERATORS:
            yield ast.AugAssign(target, OPERATORS[type(operator)](), value)
        case ast.Compare(left, [operator], right):
            for other in COMPARISONS[type(operator)]:
                yield ast.Compare(left, [other()], right)
        case ast.BoolOp(operator, values):
            yield ast.BoolOp(ast.Or() if isinstance(operator, ast.And) else ast.And(), values)
        case ast.UnaryOp(ast.USub() | ast.Not(), operand):
            yield operand
        case ast.IfExp(test, body, other):
            yield ast.IfExp(test, other, body)
        case ast.Constant(bool() as value):
            yield ast.Constant(not value)
        case ast.Constant(int() | float() as value):
            yield ast.Constant(value + 1 if isinstance(value, int) or not value else 1.5 * value)
        case ast.Name(name) if name in NAMES:
            yield ast.Name(NAMES[name], ast.Load())
        case ast.Attribute(value, name) if name in NAMES:
            yield ast.Attribute(value, NAMES[name], ast.Load())


def mutants(source: str) -> list[Mutant]:
    """All mutants of a module."""
    tree = ast.parse(source)
    result = []
    for k, node in enumerate(candidates(tree)):
        for other in replacements(node):
            changed = copy.deepcopy(tree)
            original = next(n for i, n in enumerate(candidates(changed)) if i == k)
            before = ast.unparse(original)
            after = ast.unparse(ast.fix_missing_locations(copy.deepcopy(other)))
            new = ast.copy_location(copy.deepcopy(other), original)
            _Replace(original, new).visit(changed)
            ast.fix_missing_locations(changed)
            result.append(Mutant(getattr(original, "lineno", 0), before, after, changed))
    return result


class _Replace(ast.NodeTransformer):
    def __init__(self, old: ast.AST, new: ast.AST) -> None:
        self._old, self._new = old, new

    def visit(self, node: ast.AST) -> ast.AST:
        """Replace the one node."""
        return self._new if node is self._old else self.generic_visit(node)


class Planted(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Lets the mutant be imported in the node of its module."""

    def __init__(self, name: str, mutant: Mutant) -> None:
        self._name, self._mutant = name, mutant

    def find_spec(self, fullname: str, *_: object) -> ModuleSpec | None:
        """The mutant's, for its name only."""
        if fullname != self._name:
            return None
        return importlib.util.spec_from_loader(fullname, self)

    def exec_module(self, module: ModuleType) -> None:
        """Run the mutant."""
        exec(compile(self._mutant.tree, f"<mutant of {self._name}>", "exec"), module.__dict__)


def fails(tests: list[str], planted: Planted | None, patience: float) -> bool:
    """Whether the tests fail or hang, in a separate process."""
    child = os.fork()
    if not child:
        null = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(null, stream)
        signal.alarm(max(1, round(patience)))
        if planted is not None:
            sys.meta_path.insert(0, planted)
        options = [
            "-x",
            "-q",
            "-p",
            "no:cacheprovider",
            f"--hypothesis-profile={PROFILE}",
            "--timeout=0",
        ]
        os._exit(int(pytest.main([*tests, *options]) != 0))
    _, status = os.waitpid(child, 0)
    return status != 0


def study(module: str, each: int, seed: int) -> tuple[int, int, list[Mutant]]:
    """Mutants there are, mutants tried, and those that survived."""
    package, name = module.rsplit("/", 1)
    files = TESTS.get(module, (f"{package}/test_{name}",))
    tests = [str(ROOT / "tests" / f"{file}.py") for file in files]
    began = time.perf_counter()
    if fails(tests, None, 600.0):
        raise SystemExit(f"the tests of {module} fail without any mutant")
    patience = max(LEAST, PATIENCE * (time.perf_counter() - began))
    every = mutants((ROOT / f"{module}.py").read_text())
    tried = random.Random(f"{module} {seed}").sample(every, min(each, len(every)))
    survived = []
    for mutant in sorted(tried, key=lambda m: m.line):
        if not fails(tests, Planted(module.replace("/", "."), mutant), patience):
            survived.append(mutant)
    return len(every), len(tried), survived


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--modules", nargs="+", default=MODULES)
    parser.add_argument("--each", type=int, default=40, help="mutants tried per module at most")
    parser.add_argument("--seed", type=int, default=0, help="of the choice of mutants")
    options = parser.parse_args()
    settings.register_profile(
        PROFILE,
        phases=[Phase.explicit, Phase.generate],
        derandomize=True,
        database=None,
        deadline=None,
    )
    settings.load_profile(PROFILE)
    for heavy in ("scipy.linalg", "scipy.optimize", "pinocchio"):
        importlib.import_module(heavy)  # once, not in every child
    print("| module | mutants | sample | killed | what survived |\n|---|---|---|---|---|")
    for module in options.modules:
        every, tried, survived = study(module, options.each, options.seed)
        survivors = "; ".join(f"line {m.line}: `{m.before}` → `{m.after}`" for m in survived)
        cells = (f"`{module}`", every, tried, tried - len(survived), survivors.replace("|", "\\|"))
        print("| " + " | ".join(map(str, cells)) + " |", flush=True)


if __name__ == "__main__":
    main()
