"""The body in the world: physics or kinematics, its sensors, and what disturbs both."""
