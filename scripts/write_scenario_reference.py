"""Write docs/scenarios.md, the reference of every key of a scenario file.

python scripts/write_scenario_reference.py
"""

from pathlib import Path

from hsr8.scenario.reference import markdown

PAGE = Path(__file__).resolve().parents[1] / "docs" / "scenarios.md"

if __name__ == "__main__":
    PAGE.write_text(markdown(), encoding="utf-8")
