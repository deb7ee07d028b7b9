"""Walking parameters of a robot: rules, rehearsal, and the defaults of its scenarios."""
