"""Write the suite of `fullpose.scenarios` as the TOML files beside this script (python examples/scenarios/write.py)."""

from pathlib import Path

from fullpose.scenarios import SCENARIOS
from fullpose_server.formats.scenario_file import write_scenario

HERE = Path(__file__).parent


def main() -> None:
    """One file a scenario."""
    for scenario in SCENARIOS.values():
        (HERE / f"{scenario.name}.toml").write_text(write_scenario(scenario), encoding="utf-8")


if __name__ == "__main__":
    main()
