"""``hsr8 bench compare``: two entries on their common worlds."""

import shlex

from hsr8.cli.options import BenchCompare
from hsr8.evaluation.bench.comparison import compare_entries
from hsr8.evaluation.bench.entry import read_entry
from hsr8.evaluation.bench.page import comparison_page
from hsr8.files import atomic


def main(options: BenchCompare) -> int:
    """Print the comparison.

    Raises:
        UsageError: a folder or file is not an entry, or the entries are not comparable.
    """
    comparison = compare_entries(read_entry(options.a), read_entry(options.b))
    if options.json:
        print(atomic.dumps(comparison.to_json()))
    else:
        command = shlex.join(["hsr8", "bench", "compare", str(options.a), str(options.b)])
        print(comparison_page(comparison, command), end="")
    return 0
