"""The body: its numbers, its kinematics, and what its sensors tell of it."""
