"""Body: robot model, kinematics and state estimation."""
