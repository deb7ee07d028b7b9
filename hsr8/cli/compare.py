"""``hsr8 compare`` and ``hsr8 bench compare``: a reference and other arms on their common seeds."""

from hsr8.cli.options import BenchCompare, Compare
from hsr8.cli.output_file import require_file_name, writing
from hsr8.errors import UsageError, escaped_lines
from hsr8.files import atomic
from hsr8.files.text import shell_line
from hsr8.sweep.bench.comparison import compare_entries
from hsr8.sweep.bench.entry import read_entry
from hsr8.sweep.comparison import compare, open_side
from hsr8.sweep.comparison_page import draw, latex, page, to_json, write_csv


def main(options: Compare | BenchCompare) -> int:
    """Print the comparison, and write it as a table and a figure."""
    if not options.b:
        raise UsageError("B: missing; expected at least one folder to compare with A")
    if options.csv is not None:
        require_file_name("--csv", options.csv, (".csv",))
    if options.figure is not None:
        require_file_name("--figure", options.figure, (".png", ".svg", ".pdf"))
    words = ["hsr8", "compare", options.a, *options.b]
    if isinstance(options, BenchCompare):
        words.insert(1, "bench")
        entries = [read_entry(path) for path in (options.a, *options.b)]
        comparisons = [compare_entries(entries[0], entry) for entry in entries[1:]]
    else:
        for metric in options.metric:
            words += ["--metric", metric]
        sides = [open_side(path) for path in (options.a, *options.b)]
        comparisons = [compare(sides[0], side, options.metric) for side in sides[1:]]
    if options.csv is not None:
        with writing("--csv", options.csv):
            write_csv(comparisons, options.csv)
    if options.figure is not None:
        with writing("--figure", options.figure):
            draw(comparisons, options.figure)
    if options.json:
        values = [to_json(comparison) for comparison in comparisons]
        print(atomic.dumps(values[0] if len(values) == 1 else {"comparisons": values}))
    elif options.latex:
        print(escaped_lines(latex(comparisons)), end="")
    else:
        print(escaped_lines(page(comparisons, shell_line(words))), end="")
    return 0
