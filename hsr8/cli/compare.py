"""``hsr8 compare``: two sweeps or two runs on their common seeds."""

import shlex

from hsr8.cli.options import Compare
from hsr8.evaluation.comparison import compare, open_side
from hsr8.evaluation.comparison_page import page, to_json
from hsr8.files import atomic


def main(options: Compare) -> int:
    """Print the comparison.

    Raises:
        UsageError: a folder is neither a sweep nor a run, or they cannot be compared.
    """
    comparison = compare(open_side(options.a), open_side(options.b), options.metric)
    if options.json:
        print(atomic.dumps(to_json(comparison)))
        return 0
    words = ["hsr8", "compare", str(options.a), str(options.b)]
    for metric in options.metric:
        words += ["--metric", metric]
    print(page(comparison, shlex.join(words)), end="")
    return 0
