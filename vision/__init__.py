"""Vision: an image and the pose of the camera become detections of coloured things."""
