"""``hsr8 schema``: JSON Schema of scenario files, for editors."""

from hsr8.cli.options import Schema
from hsr8.cli.output_file import writing
from hsr8.files import atomic
from hsr8.scenario.reference import json_schema

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def main(options: Schema) -> int:
    """Print or write the schema."""
    schema = {"$schema": DIALECT, **json_schema(), "title": "hsr8 scenario"}
    if options.out is None:
        print(atomic.dumps(schema, indent=2))
        return 0
    with writing("--out", options.out):
        atomic.write_json(options.out, schema)
    print(f"schema      {options.out}")
    print(f'first line of a scenario, for Taplo and its editors:  "#:schema {options.out}"')
    return 0
