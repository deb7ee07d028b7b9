"""Walking: velocity commands become footsteps, footsteps become joint setpoints.

The library reads the robot from one :class:`walking.body.robot_model.RobotModel` and its sensors
from :class:`walking.state.BodySensors` only, so it would run on the real robot unchanged.

Another humanoid is another `walking.body.tree.RobotTree`::

    robot = RobotModel(tree)
    engine = WalkingEngine(robot, parameters_for(robot))

The default parameters were tuned for HSR-VIII; `parameters_for` scales them to the robot.
"""
