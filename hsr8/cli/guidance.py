"""What was probably meant by a command line that is wrong, from the words other programs have."""

from collections.abc import Sequence
from pathlib import Path

from hsr8.suggestion import suggestion

# Words that other programs have for what ours calls otherwise.
COMMANDS = {
    **dict.fromkeys(("start", "simulate", "sim", "launch"), "run"),
    **dict.fromkeys(("play", "view", "open", "show", "watch"), "replay"),
    **dict.fromkeys(("video", "movie", "film", "draw"), "render"),
    **dict.fromkeys(("scenarios", "ls"), "list"),
    **dict.fromkeys(("validate", "verify"), "check"),
    **dict.fromkeys(("graph", "figure"), "plot"),
    **dict.fromkeys(("batch", "evaluate"), "sweep"),
    **dict.fromkeys(("results", "status"), "info"),
}
OPTIONS = {
    "--planner": "--set navigation.planner.method=NAME",
    "--gaze": "--set navigation.gaze.mode=NAME",
    "--profile": "--set navigation.profile=NAME",
    "--lens": "--set camera.lens=NAME",
    "--time": "--duration S",
    "--headless": "nothing: no display is needed",
    "--video": "hsr8 render RUN, after the run",
    "--render": "hsr8 render RUN, after the run",
}


def no_command(word: str, rest: Sequence[str], commands: Sequence[str]) -> str:
    """What to say of a first word that is no command.

    Args:
        word: the first word.
        rest: the words after it.
        commands: those there are.
    """
    hint = _scenario(word, rest)
    if not hint and word in COMMANDS:
        hint = f"; did you mean '{COMMANDS[word]}'?"
    hint = hint or suggestion(word, commands)
    return f"there is no command {word!r}{hint} (commands: {', '.join(commands)})"


def _scenario(word: str, rest: Sequence[str]) -> str:
    from hsr8.scenario.loader import built_in_names  # noqa: PLC0415  half a second

    if word not in built_in_names() and not (word.endswith(".toml") and Path(word).exists()):
        return ""
    return f", it is a scenario; did you mean '{' '.join(('hsr8 run', word, *rest))}'?"


def hints(given: Sequence[str]) -> list[str]:
    """Lines to say after what the parser had to say of its own."""
    said = [f"instead of {word}: {OPTIONS[word]}" for word in given if word in OPTIONS]
    before = given[: given.index("--set")] if "--set" in given else given
    for word in before[1:]:
        key, equals, _ = word.lstrip("-").partition("=")
        if equals and "." in key:
            said.append(f"a setting is given so: --set {word.lstrip('-')}")
    if given[:1] == ["run"]:
        said += [f"a seed is given so: --seed {word}" for word in given[2:3] if word.isdigit()]
    return said
