"""Arms of the gaze study: deliberate and blind gazes, bounds, and cameras."""

GAZE = "navigation.gaze."
BLIND = {
    "sine": ("sweep", "sweep_period={} sweep_amplitude={}", ((6.0, 1.57), (6.0, 0.75), (4.0, 0.6))),
    "triangle": (
        "triangle",
        "sweep_period={} sweep_amplitude={}",
        ((8.0, 1.57), (5.0, 1.0), (9.0, 1.2)),
    ),
    "steps": (
        "steps",
        "sweep_stops={} sweep_amplitude={}",
        ((4, 1.57), (3, 1.05), (5, 1.57)),
    ),
}
TILTS = (-0.6, -0.45)


def _blind() -> dict[str, str]:
    arms = {f"fixed {tilt}": f"{GAZE}mode=fixed {GAZE}fixed_tilt={tilt}" for tilt in (-0.6, -0.45)}
    for name, (mode, keys, values) in BLIND.items():
        for one, other in values:
            for tilt in TILTS:
                sweep = " ".join(GAZE + word for word in keys.format(one, other).split())
                text = f"{GAZE}mode={mode} {sweep} {GAZE}fixed_tilt={tilt}"
                arms[f"{name} {one:g} {other:g} {tilt}"] = text
    return arms


BOUNDS = {
    "neck-reach": f"camera.source=neck-reach {GAZE}mode=fixed",
    "omnidirectional": f"camera.source=omnidirectional {GAZE}mode=fixed",
}
GAZES = {
    "default": "",
    "info": f"{GAZE}mode=info",
    "integrated": f"{GAZE}mode=integrated",
    **BOUNDS,
}
PAPER = "navigation.profile=paper"
EXCHANGED = "navigation.univector.w_muf=0.25 navigation.univector.w_auf=0.75"
PAPERS = {"printed": PAPER, "exchanged": f"{PAPER} {EXCHANGED}", "extended": ""}
TABLES = {"gazes": GAZES, "blind": _blind(), "bounds": BOUNDS, "paper": PAPERS}
CAMERAS = {
    "honest": (),
    "ideal": ("camera.preset=ideal",),
    "slow-wide": ("camera.vertical_fov_deg=70.0",),
    "narrow": (
        "camera.vertical_fov_deg=34.5",  # 45 deg horizontally
        "walking.head.max_rate=2.0",
        "walking.head.max_acceleration=20.0",
    ),
}
