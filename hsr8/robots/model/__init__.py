"""MuJoCo model of a robot: completed and brought into normal form."""
