"""The MuJoCo model of a world, and the names in it."""
