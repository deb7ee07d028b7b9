"""Set-points: pattern and feet become joint angles."""
