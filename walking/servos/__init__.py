"""Setpoints: pattern and feet become joint angles."""
