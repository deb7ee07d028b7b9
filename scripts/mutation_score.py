"""Mutation score of modules: the fraction of changed operators and numbers that tests notice.

Cosmic Ray makes the mutants, a seed draws a sample. No file is changed: a forked process imports
the mutant. Tests run uncompiled, since compiling takes longer; slow ones are left out.

    python scripts/mutation_score.py walking/plan/*.py --tests tests/walking --mutants 60
"""

import argparse
import os
import random
import re
import signal
import sys
from concurrent.futures import ProcessPoolExecutor
from importlib.machinery import SourceFileLoader
from multiprocessing import get_context
from pathlib import Path

os.environ["NUMBA_DISABLE_JIT"] = "1"
sys.path.insert(0, ".")

import pinocchio  # noqa: F401  # libraries are imported once, before the forks
import pytest
import scipy.stats  # noqa: F401
from cosmic_ray.ast import Visitor, get_ast
from cosmic_ray.plugins import get_operator, operator_names

LIMIT = 0.5  # CPU time of a test [s]; ten times as much for fixtures, five times with a mutant
OPERATORS = re.compile(
    r"core/(ReplaceBinaryOperator_(Add_Sub|Sub_Add|Mul_Div|Div_Mul|Mod_Mul)|ReplaceComparison"
    r"Operator_(Lt_LtE|LtE_Lt|Gt_GtE|GtE_Gt|Lt_Gt|Gt_Lt|LtE_GtE|GtE_LtE|Eq_NotEq|NotEq_Eq)|Number"
    r"Replacer|AddNot|Replace(True|False|And|Or|Break)With\w+|ReplaceUnaryOperator_(USub_UAdd|Delete"
    r"_Not)|ZeroIterationForLoop)"
)


class Mutation(Visitor):
    """Places of an operator in a module; the chosen one is changed."""

    def __init__(self, operator, chosen=-1):
        self.operator, self.chosen, self.places = get_operator(operator)(), chosen, []

    def visit(self, node):  # noqa: D102
        for index, (start, _) in enumerate(self.operator.mutation_positions(node)):
            if len(self.places) == self.chosen:
                node = self.operator.mutate(node, index)
            self.places.append(start)
        return node


def _limited(factor):
    """Return a hook of pytest that limits the CPU time of a phase of a test."""

    @pytest.hookimpl(wrapper=True)
    def hook(self):
        signal.signal(signal.SIGPROF, lambda *_: pytest.fail("too slow"))
        signal.setitimer(signal.ITIMER_PROF, factor * self.limit)
        try:
            return (yield)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0.0)

    return hook


class _Clock:
    """Plugin of pytest that runs the usable tests, each within a limit of CPU time [s]."""

    def __init__(self, limit, usable):
        self.limit, self.usable, self.passed = limit, usable, []

    def pytest_collection_modifyitems(self, items):
        items[:] = [item for item in items if self.usable is None or item.nodeid in self.usable]

    pytest_runtest_setup, pytest_runtest_call = _limited(10.0), _limited(1.0)

    def pytest_runtest_logreport(self, report):
        if report.when == "call" and report.passed:
            self.passed.append(report.nodeid)


def run_tests(files, limit, usable=None, module=Path(), mutant=""):
    """Run test files with a mutant as a module; return pytest's exit code and the tests passed."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    os.dup2(1, 2)
    path, load, clock = str(module.resolve()), SourceFileLoader.get_code, _Clock(limit, usable)
    SourceFileLoader.get_code = lambda self, name: (
        compile(mutant, path, "exec") if self.path == path else load(self, name)
    )
    options = ["-q", "--assert=plain", "-p", "no:cacheprovider", *(["-x"] if mutant else [])]
    return int(pytest.main([*options, *map(str, files)], [clock])), clock.passed


def forked(*arguments):
    """Return the result of `run_tests` in a process that has imported the libraries only."""
    with ProcessPoolExecutor(1, get_context("fork")) as pool:
        return pool.submit(run_tests, *arguments).result()


def concerned(module, files):
    """Return the test files that concern a module: its own, those that import it, neighbours."""
    package, name = ".".join(module.parent.parts), module.stem
    imports = re.compile(rf"\b{package}\.{name}\b|from {package} import .*\b{name}\b")
    own = [file for file in files if file.name == f"test_{name}.py"]
    users = [file for file in files if imports.search(file.read_text())]
    neighbours = [file for file in files if not own or file.parent == own[0].parent]
    return list(dict.fromkeys([*own, *users, *neighbours]))


def main():
    """Print a sample of mutants with their outcomes, and the score."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("modules", nargs="+", type=Path)
    parser.add_argument("--tests", type=Path, required=True)
    parser.add_argument("--mutants", type=int, default=60)
    options = parser.parse_args()
    places = {}
    for module in options.modules:
        tree = get_ast(module.read_text())
        for operator in filter(OPERATORS.fullmatch, operator_names()):
            (mutation := Mutation(operator)).walk(tree)
            for number, position in enumerate(mutation.places):
                places.setdefault((module, position), []).append((operator, number))
    files, draw, killed = sorted(options.tests.rglob("test_*.py")), random.Random(0), 0
    _, usable = forked(files, LIMIT)
    sample = sorted(draw.sample(sorted(places), min(options.mutants, len(places))))
    for module, (line, column) in sample:
        operator, number = draw.choice(places[module, (line, column)])
        mutant = Mutation(operator, number).walk(get_ast(module.read_text())).get_code()
        code, _ = forked(concerned(module, files), 5.0 * LIMIT, usable, module, mutant)
        survived = code in {pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED}
        killed += not survived
        change = mutant.splitlines()[line - 1].strip() if survived else ""
        print("survived" if survived else "killed  ", f"{module}:{line}", change, flush=True)
    print(f"{killed} of {len(sample)} mutants killed by {len(usable)} tests")


if __name__ == "__main__":
    main()
