"""Belief: robot pose, obstacle tracks and local map from detections."""
