"""Image of a robot in its ready posture, with its soles, its head axis and its front."""

from contextlib import closing

import mujoco
import numpy as np

from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.model.normal_form import SOLES
from hsr8.robots.shown import SHOWN_GROUP, stature
from hsr8.show.push_arrows import Arrow
from hsr8.show.scene_renderer import Image, SceneRenderer
from hsr8.world.body.physics import place_robot
from hsr8.world.field.layout import Layout
from hsr8.world.model.assembly import Optics
from walking.dimension import HSR_VIII

SIZE = 640, 800  # width and height [pixel]
SOLE = 0.90, 0.20, 0.45, 1.0  # colour of the soles
FIELD = 10.0  # side of the floor for a robot of the size of HSR-VIII [m]
ROOM = 1.4  # height of the image, in heights of the robot [1]
FOV = 45.0  # vertical, of MuJoCo's free camera [deg]
AZIMUTH, ELEVATION = 230.0, -18.0  # from the front right, looking down [deg]
FRONT = 0.15, 0.3  # start and length of the arrow to the front, in heights of the robot [1]
AXIS = 0.15  # length of the arrow along the yaw axis of the head, in heights of the robot [1]


def portrait(robot: LoadedRobot) -> Image:
    """Return an image of a robot (height, width, 3).

    Raises:
        RenderingUnavailable: there is no OpenGL.
    """
    scale = robot.model.measures().leg / HSR_VIII.leg
    side = FIELD * scale
    layout = Layout(
        (side, side), (), (), (0.0, 0.0, 0.0), np.zeros((0, 2)), None, endless=False, scale=scale
    )
    renderer = SceneRenderer(
        robot, layout, "show", SIZE, optics=Optics(), oversampling=2.0, fine=True
    )
    with closing(renderer):
        model, data = renderer.model, renderer.data
        place_robot(model, data, robot, np.zeros(3))
        for name in SOLES:
            geom = model.geom(name)
            geom.group, geom.rgba, geom.matid = SHOWN_GROUP, SOLE, -1
        renderer.set_state(data.qpos.copy(), np.zeros((0, 2)))
        height = stature(robot)
        return renderer.draw(_camera(height), _arrows(model, data, robot, height))


def _camera(height: float) -> mujoco.MjvCamera:
    camera = mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    camera.lookat[:] = 0.0, 0.0, 0.48 * height
    camera.distance = 0.5 * ROOM * height / np.tan(0.5 * np.radians(FOV))
    camera.azimuth, camera.elevation = AZIMUTH, ELEVATION
    return camera


def _arrows(
    model: mujoco.MjModel, data: mujoco.MjData, robot: LoadedRobot, height: float
) -> list[Arrow]:
    """Return arrows to the front and up the yaw axis of the head."""
    start, length = (height * part for part in FRONT)
    tail, tip = (np.array([x, 0.0, 0.02 * height]) for x in (start, start + length))
    arrows = [(tail, tip)]
    if robot.roles.head is not None:
        pan = model.joint(robot.roles.head[0]).id
        anchor, axis = data.xanchor[pan], data.xaxis[pan] * np.sign(data.xaxis[pan, 2])
        top = np.array([anchor[0], anchor[1], height])
        arrows.append((top, top + AXIS * height * axis))
    return arrows
