"""Body of the robot: physics or kinematics, sensors, faults and pushes."""
