"""Names of the partial evaluations, the reasons to look, in log and video."""

EVALUATIONS = ("ground (ψ_lm)", "pose (ψ_sf)", "obstacle (ψ_ob)", "path (ψ_way)")
"""In the order of the column ``psi`` of frames."""
