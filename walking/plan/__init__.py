"""Plan of the walk: steering, footsteps, gait, ZMP reference, pendulum and balance."""
