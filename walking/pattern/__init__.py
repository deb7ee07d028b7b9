"""The walking pattern: footholds become a ZMP, and the ZMP a motion of the mass centre."""
