"""``hsr8 compare`` and ``hsr8 bench compare``: two sides on their common seeds."""

from hsr8.cli.options import BenchCompare, Compare
from hsr8.errors import escaped_lines
from hsr8.evaluation.bench.comparison import compare_entries
from hsr8.evaluation.bench.entry import read_entry
from hsr8.evaluation.comparison import compare, open_side, page, to_json
from hsr8.files import atomic
from hsr8.files.shell import shell_line


def main(options: Compare | BenchCompare) -> int:
    """Print the comparison."""
    if isinstance(options, BenchCompare):
        words = ["hsr8", "bench", "compare", str(options.a), str(options.b)]
        comparison = compare_entries(read_entry(options.a), read_entry(options.b))
    else:
        words = ["hsr8", "compare", str(options.a), str(options.b)]
        for metric in options.metric:
            words += ["--metric", metric]
        comparison = compare(open_side(options.a), open_side(options.b), options.metric)
    if options.json:
        print(atomic.dumps(to_json(comparison)))
    else:
        print(escaped_lines(page(comparison, shell_line(words))), end="")
    return 0
