"""Pictures and video made from a recorded run."""
