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
FIELD, MOVERS = "navigation.univector", "navigation.moving_obstacles"
# Results of tune_paper.py.
TUNED_PRINTED = (
    f"{FIELD}.margin=0.0149 {FIELD}.eta_vo=0.225 {FIELD}.eta_imp=0.0698 {FIELD}.d_con=0.333 "
    f"{FIELD}.d_e=0.374 {FIELD}.d_b=0.217 {FIELD}.k_r=0.0873 {MOVERS}.margin=0.0439 "
    f"{MOVERS}.horizon=3.53 constants.{MOVERS}.omega_dist=2.54"
)
TUNED_EXCHANGED = (
    f"{FIELD}.margin=0.0688 {FIELD}.eta_vo=0.818 {FIELD}.eta_imp=0.0277 {FIELD}.d_con=0.381 "
    f"{FIELD}.d_e=0.259 {FIELD}.d_b=0.337 {FIELD}.k_r=0.279 {MOVERS}.margin=0.0365 "
    f"{MOVERS}.horizon=5.55 constants.{MOVERS}.omega_dist=2.66"
)
PAPERS = {
    "printed": PAPER,
    "printed tuned": f"{PAPER} {TUNED_PRINTED}",
    "exchanged": f"{PAPER} {EXCHANGED}",
    "exchanged tuned": f"{PAPER} {EXCHANGED} {TUNED_EXCHANGED}",
    "extended": "",
}
TABLES = {"gazes": GAZES, "blind": _blind(), "bounds": BOUNDS, "paper": PAPERS}
CAMERAS = {
    "realistic": (),
    "ideal": ("camera.preset=ideal",),
    "slow-wide": ("camera.vertical_fov_deg=70.0",),
    "narrow": (
        "camera.vertical_fov_deg=34.5",  # 45 deg horizontally
        "walking.head.max_rate=2.0",
        "walking.head.max_acceleration=20.0",
    ),
}
