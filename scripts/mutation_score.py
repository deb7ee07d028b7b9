"""Mutation score of modules: the fraction of changed operators and numbers that their tests notice.

Cosmic Ray makes the mutants, a seed draws a sample. No file is changed: a forked process imports the mutant instead of the module. Tests
run uncompiled, since compiling takes longer: the file of the module, those that import the module, the rest of the folder. Slow ones are left out.

    python scripts/mutation_score.py walking/plan/*.py --tests tests/walking --mutants 60
"""

import argparse
import json
import os
import random
import re
import resource
import signal
import sys
from importlib.machinery import SourceFileLoader
from pathlib import Path

os.environ["NUMBA_DISABLE_JIT"] = "1"
sys.path.insert(0, ".")

import pinocchio  # noqa: F401  # libraries are imported once, before the forks
import pytest
import scipy.stats  # noqa: F401
from cosmic_ray.ast import Visitor, get_ast
from cosmic_ray.plugins import get_operator

LIMIT = 0.5  # CPU time of a test [s], ten times as much for its fixtures; a mutant, which may loop, has five times as much
SWAPS = {
    "Binary": "Add_Sub Sub_Add Mul_Div Div_Mul Mod_Mul",
    "Comparison": "Lt_LtE LtE_Lt Gt_GtE GtE_Gt Lt_Gt Gt_Lt LtE_GtE GtE_LtE Eq_NotEq NotEq_Eq",
    "Unary": "USub_UAdd Delete_Not",
}
OPERATORS = [
    f"Replace{kind}Operator_{swap}" for kind, swaps in SWAPS.items() for swap in swaps.split()
]
OPERATORS += "NumberReplacer AddNot ReplaceTrueWithFalse ReplaceFalseWithTrue ReplaceAndWithOr ReplaceOrWithAnd".split()
OPERATORS += ["ReplaceBreakWithContinue", "ZeroIterationForLoop"]


class Mutation(Visitor):
    """Places of an operator in a module; the chosen one is changed."""

    def __init__(self, operator: str, chosen: int = -1) -> None:
        self.operator, self.chosen, self.places = get_operator(f"core/{operator}")(), chosen, []

    def visit(self, node):
        for index, (start, _) in enumerate(self.operator.mutation_positions(node)):
            if len(self.places) == self.chosen:
                node = self.operator.mutate(node, index)
            self.places.append(start)
        return node


class Clock:
    """Plugin of pytest that runs the usable tests, each within a limit of CPU time."""

    def __init__(self, limit: float, usable: list[str] | None) -> None:
        self.limit, self.usable, self.passed = limit, usable, []

    def pytest_collection_modifyitems(self, items):
        items[:] = [item for item in items if self.usable is None or item.nodeid in self.usable]

    def within(self, limit: float):
        signal.signal(signal.SIGPROF, lambda *_: pytest.fail("too slow"))
        signal.setitimer(signal.ITIMER_PROF, limit)
        try:
            return (yield)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0.0)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_setup(self):
        return (yield from self.within(10.0 * self.limit))

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self):
        return (yield from self.within(self.limit))

    def pytest_runtest_logreport(self, report):
        if report.when == "call" and report.passed:
            self.passed.append(report.nodeid)


def run_tests(
    files: list[Path],
    limit: float,
    usable: list[str] | None = None,
    mutant: tuple[Path, str] | None = None,
):
    """Run test files in a forked process, a mutant in place of its module; return pytest's exit code and the tests that passed."""
    read, write = os.pipe()
    if (child := os.fork()) == 0:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.dup2(1, 2)
        if mutant is not None:
            resource.setrlimit(resource.RLIMIT_CPU, (120, 120))
            path, source, original = str(mutant[0].resolve()), mutant[1], SourceFileLoader.get_code
            SourceFileLoader.get_code = lambda self, name: (
                compile(source, path, "exec") if self.path == path else original(self, name)
            )
        clock, stop = Clock(limit, usable), ["-x"] if mutant else []
        code = pytest.main(
            ["-q", "--assert=plain", "-p", "no:cacheprovider", *stop, *map(str, files)], [clock]
        )
        with os.fdopen(write, "w") as pipe:
            json.dump(clock.passed, pipe)
        os._exit(code)
    os.close(write)
    with os.fdopen(read) as pipe:
        passed = pipe.read()
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), json.loads(passed or "[]")


def concerned(module: Path, files: list[Path]) -> list[Path]:
    """Return the test files that concern a module, its own first."""
    package, name = ".".join(module.parent.parts), module.stem
    imports = re.compile(rf"\b{package}\.{name}\b|from {package} import .*\b{name}\b")
    own = [file for file in files if file.name == f"test_{name}.py"]
    users = [file for file in files if imports.search(file.read_text())]
    return list(
        dict.fromkeys(
            [*own, *users, *(f for f in files if f.parent in {file.parent for file in own})]
        )
    )


def main() -> None:
    """Print a sample of mutants with their outcomes, and the score."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("modules", nargs="+", type=Path)
    parser.add_argument("--tests", type=Path, required=True)
    parser.add_argument("--mutants", type=int, default=60)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    places: dict[tuple[Path, tuple[int, int]], list[tuple[str, int]]] = {}
    for module in options.modules:
        tree = get_ast(module.read_text())
        for operator in OPERATORS:
            (mutation := Mutation(operator)).walk(tree)
            for number, place in enumerate(mutation.places):
                places.setdefault((module, place), []).append((operator, number))
    files, draw, killed = sorted(options.tests.rglob("test_*.py")), random.Random(options.seed), 0
    _, usable = run_tests(files, LIMIT)
    sample = sorted(draw.sample(sorted(places), min(options.mutants, len(places))))
    for module, place in sample:
        operator, number = draw.choice(places[module, place])
        source = Mutation(operator, number).walk(get_ast(module.read_text())).get_code()
        code, _ = run_tests(concerned(module, files), 5.0 * LIMIT, usable, (module, source))
        survived = code in {pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED}
        killed += not survived
        line = f": {source.splitlines()[place[0] - 1].strip()}" if survived else ""
        print(
            "survived" if survived else "killed  ",
            f"{module}:{place[0]}",
            operator,
            line,
            flush=True,
        )
    print(f"{killed} of {len(sample)} mutants killed by {len(usable)} tests")


if __name__ == "__main__":
    main()
