"""The world: MuJoCo model, body, sensors and cameras."""
