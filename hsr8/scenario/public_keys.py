"""Public keys: the parameters of the libraries that a user may set.

All other parameters of walking, vision, belief and navigation are constants. Studies change them
in the table ``[constants]``: ``constants.navigation.gaze.risk.look_time = 0.3``.
"""

LIBRARIES = ("walking", "vision", "belief", "navigation")


def _dotted(sections: dict[str, str]) -> frozenset[str]:
    return frozenset(
        f"{section}.{key}" if section else key
        for section, keys in sections.items()
        for key in keys.split()
    )


PUBLIC = _dotted(
    {
        "walking.gait": "footstep_time min_footstep_time swing_height",
        "walking.pattern": "generator pelvis_height",
        "walking.odometry": "forward_noise lateral_noise slip_ratio yaw_drift",
        "walking.limits": "vx vx_backward vy wz",
        "walking.head": "max_rate max_acceleration",
        "walking.get_up": "enabled",
        "vision": "color_table obstacle_height min_radius max_radius max_obstacle_range "
        "max_beacon_range",
        "vision.pose": "tilt_sigma roll_sigma yaw_sigma height_sigma",
        "belief.localization": "landmarks",
        "belief.local_map": "cell size range",
        "belief.tracking": "max_speed reversal_rate particles forget_time",
        "navigation": "profile",
        "navigation.mission": "r_via r_goal heading_tolerance",
        "navigation.evaluation": "d_nm d_fm map_ratio",
        "navigation.gaze": "mode moved_by w_lm w_way w_sf w_ob step switch_ratio dwell fixed_tilt "
        "sweep_amplitude sweep_period sweep_stops sweep_frames max_pan min_tilt max_tilt "
        "box_fraction obstacle_votes map_votes candidates",
        "navigation.planner": "method memory",
        "navigation.univector": "s_robot margin eta_vo eta_imp d_con d_e d_b k_r w_muf w_auf "
        "arrival inside blend grouping side_memory",
        "navigation.moving_obstacles": "virtual_obstacle velocity_modification radius "
        "wait_in_band xi margin horizon",
        "navigation.unseen_ground": "enabled",
        "navigation.safety_filter": "enabled reachable margin",
        "navigation.waypoint_search": "enabled",
    }
)
"""Keys of the libraries' parameters that a scenario may set directly."""

BASIC = _dotted(
    {
        "": "extends seed duration",
        "world": "size n_static n_moving radius speed_ratio",
        "mission": "kind via_points points goal_heading_deg",
        "command": "vx vy wz",
        "robot": "model body",
        "robot.start": "position heading_deg",
        "robot.speed": "vx wz",
        "camera": "source period_ms latency_ms",
        "walking.gait": "footstep_time",
        "walking.get_up": "enabled",
        "vision": "color_table",
        "belief.localization": "landmarks",
        "navigation": "profile",
        "navigation.mission": "r_via r_goal heading_tolerance",
        "navigation.gaze": "mode",
        "navigation.planner": "method",
        "plugin": "planner gaze walker",
        "fault": "kind start duration magnitude",
        "criteria": "goal_reached max_collisions max_falls",
    }
)
"""Keys for a start."""

EXPERIMENTAL = _dotted(
    {
        "walking.pattern": "generator",
        "navigation.evaluation": "map_ratio",
        "navigation.gaze": "box_fraction obstacle_votes map_votes candidates",
        "navigation.univector": "arrival inside blend grouping side_memory",
        "navigation.moving_obstacles": "virtual_obstacle velocity_modification radius wait_in_band",
        "navigation.unseen_ground": "enabled",
        "navigation.safety_filter": "enabled reachable",
        "navigation.waypoint_search": "enabled",
    }
)
"""Keys that select variants under study: they may change or go in any version."""
