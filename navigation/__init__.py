"""Navigation: detections become a belief, the belief a gaze and a velocity."""
