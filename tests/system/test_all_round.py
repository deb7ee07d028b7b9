import numpy as np

from hsr8.loop import Simulation
from hsr8.scenario.loader import load_scenario

SEED = 3  # two obstacles stand behind the robot at 1.1 and 1.3 m


def test_an_omnidirectional_camera_tracks_obstacles_behind_the_robot():
    settings = ["robot.body=kinematic", "camera.source=omnidirectional", "duration=1.2"]
    settings.append("navigation.gaze.mode=fixed")
    with Simulation(load_scenario("course", settings, SEED), SEED) as simulation:
        records = [tick.record for tick in simulation if tick.record is not None]
    belief = next(r.frame for r in reversed(records) if r.frame is not None).belief
    offset = np.array([t.position for t in belief.tracks]) - belief.pose[:2]
    bearing = np.angle(np.exp(1j * (np.arctan2(offset[:, 1], offset[:, 0]) - belief.pose[2])))
    assert np.sum(np.abs(bearing) > np.radians(135.0)) >= 2
    assert belief.view.horizontal_fov == 2.0 * np.pi
    assert abs(belief.view.pan) < 0.05
    behind = belief.pose[:2] - 0.8 * np.array([np.cos(belief.pose[2]), np.sin(belief.pose[2])])
    assert belief.local_map.age_at(behind[None])[0] < 0.5
