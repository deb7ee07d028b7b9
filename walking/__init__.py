"""Walking: velocity commands become footsteps, footsteps become joint set-points.

The library knows the robot through one :class:`walking.robot_model.RobotModel` and the
world through :class:`walking.sensing.BodySensors` alone, so it would run on the real
robot unchanged.
"""
