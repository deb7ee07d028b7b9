"""Walking: velocity commands become footsteps, footsteps become joint setpoints.

The library knows the robot through one :class:`walking.body.robot_model.RobotModel` and the
world through :class:`walking.sensing.BodySensors` alone, so it would run on the real
robot unchanged.

Another humanoid is another MJCF file; `RobotModel.from_mjcf` says what it has to name::

    robot = RobotModel.from_mjcf(path)
    engine = WalkingEngine(robot, parameters_for(robot))

The parameters are the choices made for HSR-VIII, carried over by the robot's own measures.
"""
