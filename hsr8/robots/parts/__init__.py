"""Parts of a robot and their roles: legs, soles, head, arms, from its kinematic tree."""
