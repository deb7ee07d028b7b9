"""Write docs/scenarios.md, the reference of every key of a scenario file.

python scripts/write_scenario_reference.py
"""

from pathlib import Path

from hsr8.scenario.public_keys import BASIC, EXPERIMENTAL
from hsr8.scenario.reference_page import ReferencePage

PAGE = Path(__file__).resolve().parents[1] / "docs" / "scenarios.md"

if __name__ == "__main__":
    page = ReferencePage()
    PAGE.write_text(page.text, encoding="utf-8")
    print(f"{len(page.keys)} keys, {len(BASIC)} basic, {len(EXPERIMENTAL)} experimental")
